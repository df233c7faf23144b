"""Materials: values, conventions, sources, files."""
import numpy as np
import pytest

import gonio


def test_values_follow_numpy_rules(sample, some_directions):
    wi, wo = some_directions
    values = sample.eval(wi, wo)
    assert values.shape == (40, 3) and values.dtype == np.float64 and np.all(values >= 0.0)
    assert np.array_equal(sample.eval(wi.reshape(5, 8, 3), wo.reshape(5, 8, 3)).reshape(40, 3), values)
    one_light = sample.eval(wi[0], wo)
    assert np.array_equal(one_light, sample.eval(np.tile(wi[0], (40, 1)), wo))
    assert sample.eval(wi[:, None], wo[None]).shape == (40, 40, 3)
    assert np.array_equal(sample.eval(wi[0], wo[0]), values[0])
    assert sample.eval(np.empty((0, 3)), wo[0]).shape == (0, 3)


def test_strides_and_precision_do_not_matter(sample, some_directions):
    wi, wo = some_directions
    wide = np.zeros((40, 6))[:, ::2]
    wide[:] = wi
    assert np.array_equal(sample.eval(wide, wo), sample.eval(wi, wo))
    assert np.array_equal(sample.eval(np.asfortranarray(wi), wo.tolist()), sample.eval(wi, wo))
    assert np.allclose(sample.eval(wi.astype(np.float32), wo), sample.eval(wi, wo), rtol=1e-4)


def test_reciprocity(sample, some_directions):
    wi, wo = some_directions
    assert np.allclose(sample.eval(wi, wo), sample.eval(wo, wi), rtol=1e-9)


def test_mitsubas_convention(sample, some_directions):
    wi, wo = some_directions
    assert np.allclose(sample.eval(wi, wo, cosine=True), sample.eval(wi, wo) * wo[:, 2:], rtol=1e-12)
    below = wo * [1.0, 1.0, -1.0]
    assert np.all(sample.eval(wi, below, cosine=True) == 0.0)
    assert np.all(np.isnan(sample.eval(wi, below, below="nan")))
    with pytest.raises(gonio.ArgumentError, match=r"wo\[0\].*horizon"):
        sample.eval(wi, below)


def test_vectors_that_are_not_of_unit_length(sample, some_directions):
    wi, wo = some_directions
    with pytest.warns(gonio.DirectionWarning, match="wi.*normalised") as caught:
        scaled = sample.eval(2.0 * wi, wo)
    assert caught[0].filename == __file__
    assert np.allclose(scaled, sample.eval(wi, wo), rtol=1e-12)
    sample.eval(1.0005 * wi, wo)  # no warning, which would be an error


def test_angles_and_vectors(some_directions):
    theta, phi = gonio.angles(some_directions[0])
    assert np.allclose(gonio.directions(theta, phi), some_directions[0], atol=1e-15)
    assert np.allclose(gonio.directions(np.pi / 2, [0.0, np.pi / 2]), [[1, 0, 0], [0, 1, 0]], atol=1e-15)
    assert gonio.directions(0.3).shape == (3,)
    assert np.allclose(gonio.angles([0.0, 1.0, 1.0 / np.sqrt(3.0)] / np.sqrt(4.0 / 3.0)), [np.pi / 3, np.pi / 2])


def test_albedo():
    grey = gonio.Material(np.full((90, 90, 180), 0.5 / np.pi), name="grey")
    assert grey.name == "grey" and grey.channels == 3
    assert np.allclose(grey.albedo([[0.0, 0.7], [1.0, 1.2]]), 0.5, rtol=2e-3)
    assert grey.albedo([[0.0, 0.7], [1.0, 1.2]]).shape == (2, 2, 3) and np.ndim(grey.coverage(0.3)) == 0
    with pytest.raises(gonio.ArgumentError, match="radians"):
        grey.albedo(45.0)


def test_tables_go_out_and_in(sample):
    table = sample.to_numpy()
    assert table.shape == (90, 90, 180, 3) and np.isnan(table).sum() > 0
    again = gonio.Material(table)
    assert np.array_equal(again.to_numpy(), table, equal_nan=True)
    centres = gonio.grid()
    assert centres["theta_h"].shape == (90,) and np.all(np.diff(centres["theta_h"]) > 0.0)
    assert np.isclose(centres["phi_d"][0], np.pi / 360)


def test_xarray(sample):
    pytest.importorskip("xarray")
    table = sample.to_xarray()
    assert table.dims == ("theta_h", "theta_d", "phi_d", "channel") and table.attrs["units"] == "1/sr"
    assert float(table.sel(channel="R").isel(theta_h=0, theta_d=3, phi_d=4)) == sample.to_numpy()[0, 3, 4, 0]


def test_functions_are_materials(some_directions):
    wi, wo = some_directions

    def lambert(light, viewer):
        assert light.shape == viewer.shape and light.shape[1] == 3
        return np.broadcast_to([0.1, 0.2], (len(light), 2))

    two = gonio.Material(lambert, wavelengths=[500.0, 600.0])
    assert two.channels == 2 and np.array_equal(two.wavelengths, [500.0, 600.0])
    assert np.allclose(two.eval(wi, wo), [0.1, 0.2])
    phong = gonio.Material(lambda a, b: 0.2 + np.sum(a * b * [-1, -1, 1], axis=1).clip(0) ** 20, channels=1)
    assert np.allclose(phong.eval(wi, wo)[:, 0], 0.2 + np.sum(wi * wo * [-1, -1, 1], axis=1).clip(0) ** 20)


def test_what_a_function_raises_comes_out(some_directions):
    def broken(wi, wo):
        raise ZeroDivisionError("mine")

    for work in (lambda m: gonio.errors("atlas:gold-leaf", m), lambda m: gonio.render(m, width=8, height=8),
                 lambda m: gonio.learn([m, "atlas:gold-leaf"]), lambda m: m.to_numpy(), lambda m: m.save("a.binary"),
                 lambda m: gonio.SimulatedInstrument(m).read(*some_directions)):
        with pytest.raises(ZeroDivisionError, match="mine"):
            work(gonio.Material(broken))
    with pytest.raises(ZeroDivisionError, match="mine"):
        gonio.Material(broken).eval(*some_directions)
    with pytest.raises(gonio.ArgumentError, match="returned shape"):
        gonio.Material(lambda wi, wo: np.zeros(7)).eval(*some_directions)


@pytest.mark.parametrize("name", ["a.binary", "a.csv"])
def test_formats(sample, name, tmp_path, some_directions):
    steps = dict(theta_i_step=0.4, theta_o_step=0.4, phi_step=0.8) if name.endswith("csv") else {}
    sample.save(tmp_path / name, **steps)
    kind, format = gonio.file_kind(tmp_path / name)
    assert kind == ("readings" if name.endswith("csv") else "material") and format
    if kind == "material":
        other = gonio.Material(tmp_path / name)
        assert gonio.errors(sample, other)["e6"] < 1e-6
        assert np.allclose(other.to_numpy(), sample.to_numpy(), rtol=1e-12, equal_nan=True)


def test_every_format_is_written(sample, tmp_path):
    assert {"merl", "rgl", "klems", "csv"} <= set(gonio.formats())
    for format in set(gonio.formats()) - {"merl", "rgl", "klems"}:  # merl above, rgl by the examples; klems takes long
        sample.save(tmp_path / format, format=format, theta_i_step=0.4, theta_o_step=0.4, phi_step=0.8)
        assert gonio.file_kind(tmp_path / format)[0] in ("material", "readings")
    with pytest.raises(gonio.ArgumentError):
        sample.save(tmp_path / "x", format="no-such-format")


def test_messages_are_the_librarys(tmp_path):
    with pytest.raises(gonio.FileError, match="nowhere.binary"):
        gonio.Material(tmp_path / "nowhere.binary")
    with pytest.raises(OSError):
        gonio.Material(tmp_path / "nowhere.binary")
    (tmp_path / "text.binary").write_text("no material")
    with pytest.raises(gonio.FormatError, match="text.binary"):
        gonio.Material(tmp_path / "text.binary")
    with pytest.raises(gonio.ArgumentError, match="atlas:no-such"):
        gonio.Material("atlas:no-such")


def test_errors_between_materials(sample):
    same = gonio.errors(sample, "atlas:red-glossy-plastic")
    assert same["e6"] == 0.0 and same.compared == 1096216 and list(same) == gonio.metrics()
    other = gonio.errors(sample, "atlas:gold-polished")
    assert other["e6"] > 10.0 and other.channels["e6"].shape == (3,)
