"""Plots by Matplotlib: lobes in the plane of incidence, slices, plans on the hemisphere, renderings.

Each takes `ax`, by default the current one, and returns it.
"""
from __future__ import annotations

from typing import Any, Optional

import numpy as np
import numpy.typing as npt

from ._directions import angles, directions, split
from ._exceptions import ArgumentError
from ._materials import as_material, grid
from ._plans import Plan
from ._reconstruction import Reconstruction
from ._rendering import tone_map

COLOURS = ("tab:red", "tab:green", "tab:blue")


def _axes(ax: Any, **how: Any) -> Any:
    if ax is not None:
        return ax
    import matplotlib.pyplot as plt

    return plt.subplot(**how) if how else plt.gca()


def _of_channels(channels: int) -> list[Any]:
    return list(COLOURS) if channels == 3 else [None] * channels


def lobes(material: Any, theta_i: npt.ArrayLike = (0.0, 0.5, 1.0), *, level: float = 0.95, log: bool = True,
          ax: Optional[Any] = None) -> Any:
    """The BRDF in the plane of incidence, against the viewer's polar angle, a curve for each channel.

    Parameters
    ----------
    material : Material, Reconstruction, or what a material is made of
        Of a reconstruction with standard deviations the interval of `level` is shaded.
    theta_i : array_like
        Polar angles of the light, radians.
    level : float
    log : bool
        Whether the axis of values is logarithmic.
    ax : matplotlib.axes.Axes, optional
    """
    ax = _axes(ax)
    theta_o = np.radians(np.linspace(-88.0, 88.0, 353))
    wo = directions(np.abs(theta_o), np.where(theta_o < 0.0, 0.0, np.pi))
    for k, angle in enumerate(np.atleast_1d(np.asarray(theta_i, float))):
        wi = directions(angle, 0.0)
        band = None
        if isinstance(material, Reconstruction):
            values = np.asarray(material.predict(wi, wo))
            band = material.interval(wi, wo, level) if material.field is not None else None
        else:
            values = as_material(material).eval(wi, wo)
        style = ("-", "--", ":", "-.")[k % 4]
        for c, colour in enumerate(_of_channels(values.shape[-1])):
            [line] = ax.plot(np.degrees(theta_o), values[..., c], style, color=colour,
                             label=f"{np.degrees(angle):.0f} deg" if c == 0 else None)
            if band is not None:
                ax.fill_between(np.degrees(theta_o), band[0][..., c], band[1][..., c], color=line.get_color(),
                                alpha=0.2, linewidth=0)
    if log:
        ax.set_yscale("log")
    ax.set_xlabel("theta_o, degrees (mirror direction to the right)")
    ax.set_ylabel("BRDF, 1/sr")
    ax.legend(title="theta_i")
    return ax


def slice(material: Any, phi_d: float = np.pi / 2, *, ax: Optional[Any] = None) -> Any:
    """The image slice: colours over theta_h (across, spaced as MERL's bins) and theta_d (up) at one phi_d.

    Parameters
    ----------
    material : Material, Reconstruction, or what a material is made of
    phi_d : float
        Radians, in [0, pi).
    ax : matplotlib.axes.Axes, optional
    """
    if not 0.0 <= phi_d < np.pi:
        raise ArgumentError(f"phi_d is {phi_d}: it lies in [0, pi), radians")
    ax = _axes(ax)
    centres = grid()["phi_d"]
    values = as_material(material).to_numpy()[:, :, int(np.argmin(np.abs(centres - phi_d)))]
    shown = np.clip(np.nan_to_num(values, nan=1.0), 0.0, 1.0) ** (1.0 / 2.2)
    ax.imshow(np.swapaxes(shown, 0, 1), origin="lower", extent=(0.0, 90.0, 0.0, 90.0))
    ticks = np.array([0.0, 5.0, 20.0, 45.0, 90.0])
    ax.set_xticks(90.0 * np.sqrt(ticks / 90.0), [f"{t:.0f}" for t in ticks])
    ax.set_xlabel("theta_h, degrees")
    ax.set_ylabel("theta_d, degrees")
    return ax


def plan(where: Any, *, ax: Optional[Any] = None) -> Any:
    """A plan on the hemisphere seen from above: light (orange) and viewer (blue) of each reading, joined by a line.

    Parameters
    ----------
    where : Plan, or directions as of `Regressor.fit`
    ax : matplotlib.projections.polar.PolarAxes, optional
    """
    ax = _axes(ax, projection="polar")
    wi, wo = (where.wi, where.wo) if isinstance(where, Plan) else split(where)
    (theta_i, phi_i), (theta_o, phi_o) = angles(wi), angles(wo)
    for ti, pi, to, po in zip(np.ravel(theta_i), np.ravel(phi_i), np.ravel(theta_o), np.ravel(phi_o)):
        turn = (po - pi + np.pi) % (2.0 * np.pi) - np.pi
        ax.plot([pi, pi + turn], np.degrees([ti, to]), color="0.8", linewidth=0.8, zorder=1)
    ax.scatter(np.ravel(phi_i), np.degrees(np.ravel(theta_i)), color="tab:orange", label="light", zorder=2, s=18)
    ax.scatter(np.ravel(phi_o), np.degrees(np.ravel(theta_o)), color="tab:blue", label="viewer", zorder=2, s=18)
    ax.set_rmax(90.0)
    ax.set_rgrids([30.0, 60.0, 90.0], ["30°", "60°", "90°"], angle=22.5)
    ax.legend(loc="lower left", bbox_to_anchor=(0.95, 0.95))
    return ax


def image(rendering: npt.ArrayLike, *, key: float = 0.18, ax: Optional[Any] = None) -> Any:
    """A rendering, tone-mapped with `key`."""
    ax = _axes(ax)
    ax.imshow(tone_map(rendering, key=key))
    ax.set_axis_off()
    return ax
