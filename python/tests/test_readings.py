"""Bases, plans, readings and reconstructions: what goes through the whole chain."""
import numpy as np
import pytest

import gonio


def test_a_basis_and_its_arrays(basis):
    assert basis.grid == "sectored" and basis.channel_model == "separate" and basis.components == 60
    assert basis.mean.shape == (basis.rows,) and not basis.mean.flags.writeable
    assert basis.loadings.shape[1] == 60 and np.all(np.diff(basis.variances) <= 0.0)
    v = basis.vectors()
    assert v.shape == (basis.rows, 60) and np.allclose(v.T @ v, np.eye(60), atol=1e-5)
    assert np.array_equal(basis.vectors(5, 2, 3), v[5:7, :3])
    with pytest.raises(gonio.ArgumentError):
        basis.vectors(basis.rows, 1)


def test_learning_from_anything(tmp_path):
    paths = gonio.atlas()[:3]
    gonio.Material(paths[0]).save(tmp_path / "gold-polished.binary")
    mixed = [tmp_path / "gold-polished.binary", gonio.Material(paths[1]), paths[2]]
    made = gonio.learn(mixed, grid="bivariate", components=2)
    assert made.names == [p[6:] for p in paths] and made.channel_model == "joint" and made.mixtures == 0
    assert np.allclose(made.variances, gonio.learn(paths, grid="bivariate", components=2).variances, rtol=1e-6)
    with pytest.raises(gonio.ArgumentError, match="grid|representation"):
        gonio.learn(paths, grid="hexagonal")
    with pytest.raises(gonio.ArgumentError, match="empty"):
        gonio.learn([])


def test_plans_are_tables(plan, tmp_path):
    assert len(plan) == 12 and plan.wi.shape == (12, 3) and plan.theta_i.shape == (12,)
    assert np.allclose(gonio.directions(plan.theta_o, plan.phi_o), plan.wo)
    assert np.all(np.diff(plan.expected_error) < 0.0) and plan.method == "expected-error"
    plan.to_csv(tmp_path / "plan.csv")
    again = gonio.Readings.load(tmp_path / "plan.csv", values_needed=False)
    assert np.allclose(again.wi, plan.wi, atol=1e-9) and np.all(np.isnan(again.values))
    assert "theta_i_deg" in plan._repr_html_()


def test_plans_as_pandas(plan):
    pytest.importorskip("pandas")
    table = plan.to_pandas()
    assert len(table) == 12 and np.allclose(np.radians(table["theta_i_deg"]), plan.theta_i)


def test_plans_within_reach(basis, some_directions):
    reach = gonio.SimulatedInstrument("atlas:gold-polished", directions=some_directions)
    within = basis.plan(4, instrument=reach)
    assert within.expected_error is not None
    for wi, wo in zip(within.wi, within.wo):
        assert np.min(np.abs(some_directions[0] - wi).sum(1) + np.abs(some_directions[1] - wo).sum(1)) < 1e-9
    assert np.array_equal(basis.plan(4, candidates=some_directions).wi, within.wi)
    assert len(basis.plan(target_error=30.0)) < 10
    for bad in (dict(n=0), dict(metric="luck"), dict(n=2, method="luck"), dict(candidates=np.empty((0, 6)))):
        with pytest.raises(gonio.ArgumentError):
            basis.plan(**bad)


def test_readings_and_files(plan, values, tmp_path):
    readings = gonio.Readings(plan.wi, plan.wo, values, noise=0.01 * values)
    assert len(readings) == 12 and np.array_equal(readings.values, values)
    assert np.array_equal(readings.noise, 0.01 * values) and readings.wavelengths is None
    for name in ("r.csv", "r.json"):
        readings.save(tmp_path / name)
        again = gonio.Readings.load(tmp_path / name)
        assert np.allclose(again.values, values, rtol=1e-9) and np.allclose(again.wo, plan.wo, atol=1e-8)
    factor = gonio.Readings.load(tmp_path / "r.csv", convention="values=factor")
    assert np.allclose(np.pi * factor.values, values, rtol=1e-8)
    (tmp_path / "bare.csv").write_text("theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,value\n30,0,30,180,0.5\n")
    assert gonio.Readings.load(tmp_path / "bare.csv").values[0, 0] == pytest.approx(0.5)
    bare = gonio.Readings.load(tmp_path / "bare.csv", instrument=gonio.Goniometer("two-arms"))
    assert bare.values[0, 0] == pytest.approx(0.5 / np.pi)
    with pytest.raises(gonio.ArgumentError, match="angles"):
        gonio.Readings.load(tmp_path / "r.csv", convention="angels=radians")
    with pytest.raises(gonio.ArgumentError, match="12 directions need"):
        gonio.Readings(plan.wi, plan.wo, values[:5])
    with pytest.raises(gonio.DataError, match="negative|below zero"):
        gonio.Readings(plan.wi, plan.wo, -values)


def test_survey(sample):
    theta_o, phi_o = np.meshgrid(np.radians(np.arange(5, 80, 10)), np.radians(np.arange(0, 360, 20)))
    wi = gonio.directions(np.full(theta_o.size, 0.5))
    found = gonio.Readings(wi, gonio.directions(theta_o.ravel(), phi_o.ravel())).measured(sample).survey()
    assert found["measured"] == theta_o.size and found["empty"] == 0 and found["outliers"] == []
    [one] = found["incidences"]
    assert one["count"] == theta_o.size and one["covered"] > 0.9 and np.all(one["albedo"] > 0.0)
    assert np.allclose(found["theta_i"], 0.5)


def test_spectra_and_single_sensors(basis, plan, values, some_directions):
    nm = [450.0, 550.0, 650.0, 700.0]
    spectra = np.column_stack([values, values[:, 0]])
    model = gonio.Regressor(basis, wavelengths=nm).fit(plan.directions, spectra)
    assert model.predict(*some_directions).shape == (40, 4)
    assert np.array_equal(model.reconstruction_.wavelengths, nm)
    made = model.reconstruction_.material()
    assert np.allclose(made.eval(*some_directions), model.predict(*some_directions), rtol=1e-9)
    single = gonio.Regressor(basis).fit(plan.directions, values[:, 1])
    value, std = single.predict(*some_directions, return_std=True)
    assert value.shape == std.shape == (40,)


def test_the_bands_hold_the_truth(model, sample, some_directions):
    value, std = model.predict(*some_directions, return_std=True)
    low, high = model.interval(*some_directions)
    truth = sample.eval(*some_directions)
    assert np.all((low >= 0.0) & (low <= value) & (value <= high)) and np.all(std > 0.0)
    assert np.mean((truth >= low) & (truth <= high)) > 0.8
    narrow = model.interval(*some_directions, level=0.5)
    assert np.all(narrow[1] <= high) and np.all(narrow[0] >= low)


def test_a_reconstruction_is_the_librarys(model, basis, plan, values, some_directions, sample, tmp_path):
    made = model.reconstruction_
    assert made.expected_error > 0.0 and made.field.shape == (3, basis.rows) and made.suspicion is None
    assert made.field_std.shape == made.field.shape and made.coefficients.shape == (3, made.coefficients.shape[1])
    same = made.predicted_readings(gonio.Readings(*some_directions))
    assert np.allclose(same.values, made.predict(*some_directions), rtol=1e-9)
    made.save(tmp_path / "made.binary")
    assert gonio.errors(tmp_path / "made.binary", made)["e6"] < 1e-5
    assert gonio.errors(sample, made)["e6"] < 30.0
    assert gonio.errors(gonio.Readings(plan.wi, plan.wo, values), made, left_out=np.arange(12) < 6).compared == 6
    deviations = made.deviation_material()
    assert deviations.channels == 3


def test_what_to_read_next(model, some_directions):
    more = model.reconstruction_.next(3)
    assert len(more) == 3 and more.expected_error[-1] < model.expected_error_
    assert model.reconstruction_.next(3, target_error=99.0) is None
    assert len(model.reconstruction_.next(2, candidates=some_directions)) == 2


def test_mistakes_are_warned_of(basis, sample, some_directions):
    wi, wo = some_directions
    with pytest.warns(gonio.GonioWarning, match="mistake"):
        model = gonio.Regressor(basis).fit((wi, wo), 100.0 * np.pi * sample.eval(wi, wo))
    assert model.suspicion_


def test_the_papers_method(sample):
    basis = gonio.learn(gonio.atlas()[:8], grid="bivariate", components=5)
    plan = basis.plan(10, method="condition")
    assert plan.condition_number >= 1.0 and plan.expected_error is None
    readings = gonio.Readings.of_plan(plan).measured("atlas:gold-polished")
    made = gonio.reconstruct(basis, readings)
    assert np.isnan(made.expected_error) and made.predict([0, 0, 1], [0, 0, 1]).shape == (3,)
    with pytest.raises(gonio.ArgumentError, match="posterior"):
        made.predict([0, 0, 1], [0, 0, 1], return_std=True)
    with pytest.raises(gonio.UndeterminedError):
        gonio.reconstruct(basis, gonio.Readings(plan.wi[:1], plan.wo[:1], [[1.0, 1.0, 1.0]]), components=5)
    with pytest.raises(gonio.ArgumentError, match="choose|no .*method|unknown"):
        gonio.reconstruct(basis, readings, method="luck")


def test_instruments(basis, sample, plan):
    asked = []

    def read(wi, wo):
        asked.append(len(wi))
        return sample.eval(wi, wo)

    assert gonio.Instrument(read).read(plan.wi, plan.wo).shape == (12, 3) and asked == [12]
    with pytest.raises(gonio.ArgumentError, match="instrument returned"):
        gonio.Instrument(lambda wi, wo: np.zeros(3)).read(plan.wi, plan.wo)
    noisy = gonio.SimulatedInstrument(sample, noise=0.02, seed=4)
    first, second = noisy.read(plan.wi, plan.wo), noisy.read(plan.wi, plan.wo)
    assert not np.array_equal(first, second)
    assert np.array_equal(gonio.SimulatedInstrument(sample, noise=0.02, seed=4).read(plan.wi, plan.wo), first)
    assert 0.001 < np.std(first / sample.eval(plan.wi, plan.wo)) < 0.1
