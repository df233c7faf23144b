"""Goniometers: their files, reach, times and order; plans for them and what a laboratory's script does with a run."""
import json
import pickle

import numpy as np
import pytest

import gonio

ARMS = {
    "gonio_instrument": 1, "name": "gantry", "kinematics": "arms",
    "axes": {"incidence": {"from_deg": 0, "to_deg": 75, "step_deg": 5, "speed_deg_per_s": 2},
             "azimuth": {"from_deg": -90, "to_deg": 90, "step_deg": 1, "speed_deg_per_s": 5},
             "receive": {"from_deg": -80, "to_deg": 80, "step_deg": 1, "speed_deg_per_s": 10}},
    "forbidden": [{"name": "the detector hides the lamp", "separation_deg": [0, 6]}],
    "channels": ["R", "G", "B"],
    "sensor": {"noise": 0.01, "floor_per_sr": 2e-4, "dark_per_sr": 1e-3, "drift_per_hour": 0.03},
    "times": {"exposure_s": 2, "incidence_change_s": 10, "reference_every_min": 5, "reference_s": 30},
}


@pytest.fixture(scope="module")
def rig():
    return gonio.Goniometer(ARMS)


@pytest.fixture(scope="module")
def run_plan(basis, rig):
    return basis.plan(12, instrument=rig)


def at(theta_i, theta_o, phi_o):
    return gonio.directions(np.radians(theta_i)), gonio.directions(np.radians(theta_o), np.radians(phi_o))


def test_what_a_file_says(rig, tmp_path):
    assert gonio.goniometers() == ["in-plane", "two-arms", "four-axis"]
    assert rig.name == "gantry" and rig.kinematics == "arms" and rig.axes == ["incidence", "azimuth", "receive"]
    assert (rig.noise, rig.floor, rig.dark, rig.saturation) == (0.01, 2e-4, 1e-3, np.inf)
    assert gonio.Goniometer("in-plane").wavelengths == pytest.approx([532.0])
    path = tmp_path / "rig.json"
    path.write_text(json.dumps(ARMS))
    assert gonio.Goniometer(path).survey() == rig.survey()
    again = pickle.loads(pickle.dumps(rig))
    assert again.axes == rig.axes and again.noise == rig.noise
    assert repr(rig) == "<gonio.Goniometer: gantry (arms: incidence, azimuth, receive)>"
    assert rig.deviation([0.0, 1.0]) == pytest.approx([2e-4, np.hypot(0.01, 2e-4)])


@pytest.mark.parametrize("source, error, message", [
    ("no-such.json", gonio.FileError, "no-such.json"),
    ({**ARMS, "exposure": 3}, gonio.FormatError, "exposure: unknown key"),
    ({**ARMS, "limits": {"theta_o_deg": [85, 90]}}, gonio.DataError, "theta_o"),
    ({"axes": {1, 2}}, gonio.ArgumentError, "no description"),
])
def test_what_is_refused(source, error, message):
    with pytest.raises(error, match=message):
        gonio.Goniometer(source).survey()


def test_reach(rig):
    found = rig.survey()
    assert 0.5 < found["share"] < 1.0 and "receive" in found["kept_out"]
    assert np.degrees(found["least_separation"]) == pytest.approx(6.0, abs=1.0)
    wi, wo = at([30, 30, 30, 80], [40, 30, 85, 20], [180, 0, 180, 180])
    assert rig.reaches(wi, wo).tolist() == [True, False, False, False]
    assert rig.reaches(wi.reshape(2, 2, 3), wo.reshape(2, 2, 3)).shape == (2, 2)


def test_positions_forth_and_back(rig):
    wi, wo = at([30, 45, 60], [40, 20, 50], [180, 150, 120])
    positions = rig.positions(wi, wo)
    assert np.degrees(positions[0]) == pytest.approx([30, 0, 40], abs=1e-9)
    light, detector = rig.directions_at(positions)
    assert np.einsum("ij,ij->i", light, detector) == pytest.approx(np.einsum("ij,ij->i", wi, wo))
    assert rig.obstacle(positions) == [None] * 3
    assert rig.obstacle(np.radians([[30.0, 0.0, -30.0], [80.0, 0.0, 10.0]])) == [
        "the detector hides the lamp", "incidence"]
    with pytest.raises(gonio.MismatchError, match="cannot read direction 1 .*80"):
        rig.positions(*at([30, 80], [40, 20], [180, 180]))
    with pytest.raises(gonio.ArgumentError, match="incidence, azimuth, receive"):
        rig.directions_at([[1.0, 2.0]])


def test_times_and_order(rig):
    wi, wo = at([60, 30, 60, 30, 60, 30], [20, 30, 30, 40, 40, 50], 180.0)
    order = rig.order(wi, wo)
    assert sorted(order) == list(range(6))
    assert rig.times(wi[order], wo[order])[-1] < 0.8 * rig.times(wi, wo)[-1]
    assert (np.diff(rig.times(wi, wo)) >= 2.0).all()


def test_a_plan_of_a_run(basis, rig, run_plan, tmp_path):
    run = run_plan.run
    assert run.axes == rig.axes and run.positions.shape == (12, 3) and run.instrument == "gantry"
    assert run.duration == pytest.approx(run.times[-1]) and run.duration < run.unordered
    assert rig.times(run_plan.wi, run_plan.wo)[-1] == pytest.approx(run.duration)
    assert sum(part["share"] for part in run.parts) == pytest.approx(1.0) and run.parts[0]["obstacle"] == ""
    assert np.allclose(rig.directions_at(run.positions)[1], run_plan.wo, atol=1e-9)
    assert basis.plan(5).run is None and "min" in repr(run)
    assert list(run_plan.columns())[-4:] == ["axis_incidence_deg", "axis_azimuth_deg", "axis_receive_deg", "time_s"]
    run_plan.to_csv(tmp_path / "a.csv")
    again = pickle.loads(pickle.dumps(run_plan))
    again.to_csv(tmp_path / "b.csv")
    assert (tmp_path / "a.csv").read_text() == (tmp_path / "b.csv").read_text()
    short = basis.plan(8, instrument=rig, budget=120.0)
    assert 0 < len(short) and short.run.duration <= 120.0


def test_what_plans_refuse(basis, rig):
    for wrong in (dict(budget=60.0), dict(nested=True)):
        with pytest.raises(gonio.ArgumentError, match="need a gonio.Goniometer"):
            basis.plan(**wrong)
    with pytest.raises(gonio.ArgumentError, match="not both"):
        basis.plan(instrument=rig, candidates=at([30], [30], [180]))
    with pytest.raises(gonio.ArgumentError, match="budget"):
        basis.plan(instrument=rig, budget=-1.0)


def test_a_laboratory_script(basis, rig, run_plan, sample, tmp_path):
    readings = rig.rehearse(run_plan, sample, tmp_path / "run.csv", seed=3)
    assert len(readings) == 12 and readings.times[-1] == pytest.approx(run_plan.run.duration, abs=0.1)
    assert any("dark row" in note for note in readings.notes)
    again = rig.rehearse(run_plan, sample, tmp_path / "again.csv", seed=3)
    assert np.array_equal(readings.values, again.values)
    blank = gonio.Readings(run_plan.wi[:4], run_plan.wo[:4], np.full((4, 3), 1e-3), noise=1e-5)
    less = readings.less_blank(blank, noise=rig.noise, floor=rig.floor)
    bright = readings.values > 0.01
    assert np.allclose((readings.values - less.values)[bright], 1e-3) and less.noise is not None
    made = gonio.reconstruct(basis, readings, noise=rig.noise, floor=rig.floor)
    energy, std = made.reflectance([0.0, 0.5])
    assert energy.shape == std.shape == (2, 3) and (0 < energy).all() and (energy < 1.2).all() and (std > 0).all()
    more = made.next(3, instrument=rig)
    assert len(more) == 3 and more.run is not None and rig.reaches(more.wi, more.wo).all()
    with pytest.raises(gonio.MismatchError):
        gonio.Goniometer("in-plane").rehearse(run_plan, sample, tmp_path / "no.csv")


def test_relative_to_a_reference():
    wi, wo = at([30, 30], [20, 60], 180.0)
    relative = gonio.Readings(wi, wo, [[0.3], [0.3]])
    made = relative.times_reference(np.radians([60.0, 20.0]), [0.9, 1.1])
    assert made.values[:, 0] == pytest.approx([0.33, 0.27])
    with pytest.raises(gonio.ArgumentError, match="a factor for each angle"):
        relative.times_reference([0.1, 0.2], [1.0])
