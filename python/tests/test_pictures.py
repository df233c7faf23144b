"""Renderings, pages and plots."""
import numpy as np
import pytest

import gonio


def test_rendering(sample, tmp_path):
    image = gonio.render(sample, width=32, height=24, samples=4, environment=gonio.environments()[0])
    assert image.shape == (24, 32, 4) and image.dtype == np.float32
    assert image[12, 16, 3] == 1.0 and image[0, 0, 3] == 0.0
    assert np.array_equal(image, gonio.render(sample, width=32, height=24, samples=4,
                                              environment=gonio.environments()[0]))
    gonio.save_image(image, tmp_path / "a.exr")
    assert np.array_equal(gonio.read_image(tmp_path / "a.exr"), image)
    gonio.save_image(image, tmp_path / "a.png")
    assert (tmp_path / "a.png").read_bytes()[:4] == b"\x89PNG"
    shown = gonio.tone_map(image)
    assert shown.shape == (24, 32, 3) and shown.dtype == np.uint8 and 60 < shown[12, 16].max() <= 255
    assert gonio.tone_map(image[..., :3] * 0.0).max() == 0
    assert gonio.image_errors(image, image)["delta_e_itp"] == 0.0
    assert gonio.image_errors(image, image * 0.5)["psnr"] < 40.0
    for bad in (dict(lamp="sun"), dict(width=0), dict(lamp_position=[1.0]), dict(environment="no-such")):
        with pytest.raises(gonio.GonioError):
            gonio.render(sample, **{"width": 8, "height": 8, **bad})
    with pytest.raises(gonio.ArgumentError, match="image has shape"):
        gonio.tone_map(np.zeros((4, 4)))


def test_materials_show_themselves(sample):
    assert sample._repr_png_().startswith(b"\x89PNG")


def test_report(sample, model, tmp_path):
    try:
        page = gonio.report(sample, model.reconstruction_)
    except gonio.FileError as error:
        pytest.skip(str(error))
    assert page._repr_html_().startswith("<iframe srcdoc=") and "&lt;html" in page._repr_html_()
    page.save(tmp_path / "page.html")
    assert (tmp_path / "page.html").read_text(encoding="utf-8") == page.html


def test_plots(sample, model, plan, tmp_path):
    pyplot = pytest.importorskip("matplotlib.pyplot")
    figure = pyplot.figure()
    assert gonio.plot.lobes(model.reconstruction_, [0.0, 0.7]).get_xlabel()
    pyplot.figure()
    gonio.plot.lobes(sample, 0.5, log=False)
    pyplot.figure()
    gonio.plot.slice(sample)
    pyplot.figure()
    gonio.plot.plan(plan)
    pyplot.figure()
    gonio.plot.image(gonio.render(sample, width=8, height=8, samples=1))
    pyplot.savefig(tmp_path / "a.png")
    assert figure.axes and (tmp_path / "a.png").stat().st_size > 0
    pyplot.close("all")
