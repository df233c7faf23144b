"""The scripts in examples/python run; what they write is looked at field by field."""
import math
import os
import re
import struct
import subprocess
import sys
import xml.etree.ElementTree as xml

import pytest

import gonio


@pytest.fixture
def run(source, basis_path, tmp_path):
    def run(name):
        done = subprocess.run([sys.executable, source / "examples/python" / name, tmp_path, basis_path],
                              capture_output=True, text=True, cwd=tmp_path, env={**os.environ, "MPLBACKEND": "Agg"})
        assert done.returncode == 0 and done.stderr == "", done.stderr
        return done.stdout

    return run


def test_readings_to_bands(run, tmp_path):
    out = run("readings_to_bands.py")
    assert int(re.search(r"(\d+)% of the true values", out)[1]) > 60
    stated = float(re.search(r"Errors\(e6=([\d.]+)", out)[1])
    written = gonio.errors("atlas:red-glossy-plastic", tmp_path / "material.bsdf")["e6"]
    assert (tmp_path / "plan.csv").exists() and abs(written - stated) < 1.0


def test_drive_instrument(run, tmp_path):
    out = run("drive_instrument.py")
    errors = [float(e) for e in re.findall(r"readings: expected error \(E6\) ([\d.]+) %", out)]
    assert len(errors) > 1 and ("enough" in out and errors[-1] <= 6.0 or "no more time" in out)
    readings = gonio.Readings.load(tmp_path / "readings.csv")
    assert len(readings) == 4 * len(errors) or "enough" in out
    assert readings.pairs[:, 0].max() < math.radians(76)


def test_laboratory(run, tmp_path):
    out = run("laboratory.py")
    assert "gantry: 8" in out and "16 readings of the gantry in" in out and "blind: " in out
    assert "dark row subtracted" in out and "theta_o = 85: " in out and "out of reach" in out
    assert float(re.search(r"Errors\(e6=([\d.]+)", out)[1]) < 10.0
    assert "axis_receive_deg" in (tmp_path / "more.csv").read_text()


def test_the_readme(source, basis_path, tmp_path):
    page = (source / "README.md").read_text()
    [code] = re.findall(r"^    import gonio\n(?:    .*\n)+", page, flags=re.M)
    (tmp_path / "merl.gonio").write_bytes(basis_path.read_bytes())
    assert len(code.splitlines()) == 6
    sample = gonio.Material("atlas:gold-polished")
    wi, wo = gonio.directions(0.5, 0.0), gonio.directions([0.4, 0.5], 3.0)
    names = {"my_instrument": sample.eval, "wi": wi, "wo": wo}
    exec("\n".join(line[4:] for line in code.splitlines()), names)
    assert names["value"].shape == names["std"].shape == (2, 3) and (tmp_path / "material.bsdf").exists()


def tensor_fields(path):
    """Fields of a tensor file, {name: (type, shape, values)}; the layout is that of Mitsuba's tensor.h."""
    data = path.read_bytes()
    assert data[:12] == b"tensor_file\0" and data[12:14] == b"\1\0"
    types = {1: "B", 2: "b", 3: "H", 4: "h", 5: "I", 6: "i", 7: "Q", 8: "q", 9: "e", 10: "f", 11: "d"}
    count, at, fields = struct.unpack_from("<I", data, 14)[0], 18, {}
    for _ in range(count):
        length = struct.unpack_from("<H", data, at)[0]
        name = data[at + 2:at + 2 + length].decode()
        at += 2 + length
        dims, kind, offset = struct.unpack_from("<HBQ", data, at)
        shape = struct.unpack_from(f"<{dims}Q", data, at + 11)
        at += 11 + 8 * dims
        values = struct.unpack_from(f"<{math.prod(shape)}{types[kind]}", data, offset)
        fields[name] = (types[kind], shape, values)
    return fields


def test_mitsuba_scene(run, tmp_path):
    run("mitsuba_scene.py")
    scene = xml.parse(tmp_path / "scene.xml").getroot()
    bsdf = scene.find("shape/bsdf")
    assert scene.tag == "scene" and bsdf.get("type") == "measured"
    assert bsdf.find("string").attrib == {"name": "filename", "value": "material.bsdf"}
    fields = tensor_fields(tmp_path / "material.bsdf")
    assert {"description", "jacobian", "luminance", "ndf", "phi_i", "rgb", "sigma", "theta_i", "vndf"} <= set(fields)
    phi, theta = fields["phi_i"][1][0], fields["theta_i"][1][0]
    assert fields["jacobian"][2] == (1,) or len(fields["jacobian"][2]) == 1
    assert phi == 1 and list(fields["theta_i"][2]) == sorted(fields["theta_i"][2])
    assert 0.0 <= fields["theta_i"][2][0] < 0.1 and fields["theta_i"][2][-1] <= math.pi / 2 + 1e-6
    assert fields["ndf"][1] == fields["sigma"][1] and len(fields["ndf"][1]) == 2
    assert fields["vndf"][1][:2] == (phi, theta) and fields["luminance"][1][:2] == (phi, theta)
    assert fields["rgb"][1] == (phi, theta, 3, *fields["luminance"][1][2:])
    for name in ("ndf", "sigma", "vndf", "luminance", "rgb"):
        kind, _, values = fields[name]
        assert kind == "f" and all(map(math.isfinite, values)), name
        assert name == "rgb" or min(values) >= 0.0, name
    assert bytes(fields["description"][2])
    assert (tmp_path / "expected.png").stat().st_size > 0
