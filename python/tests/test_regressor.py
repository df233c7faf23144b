"""The regressor's manners, and scikit-learn with it."""
import copy
import pickle

import numpy as np
import pytest

import gonio


def test_shapes_of_directions(model, plan, values, basis, some_directions):
    wi, wo = some_directions
    value = model.predict(wi, wo)
    assert np.array_equal(model.predict(np.hstack([wi, wo])), value)
    assert np.array_equal(model.predict(np.stack([wi, wo], axis=1)), value)
    assert np.array_equal(model.predict((wi, wo)), value)
    assert np.array_equal(model.predict(wi.reshape(4, 10, 3), wo.reshape(4, 10, 3)).reshape(40, 3), value)
    other = gonio.Regressor(basis).fit((plan.wi, plan.wo), values)
    assert np.array_equal(other.predict(wi, wo), value)


def test_parameters():
    model = gonio.Regressor(noise=0.02)
    assert model.get_params()["noise"] == 0.02 and model.set_params(noise=0.03) is model and model.noise == 0.03
    with pytest.raises(gonio.ArgumentError, match="no parameter 'luck'"):
        model.set_params(luck=1)
    assert repr(model) == "Regressor(noise=0.03)"
    with pytest.raises(gonio.NotFittedError, match="fit"):
        model.predict([0, 0, 1], [0, 0, 1])


def test_noise_of_readings(basis, plan, values, some_directions):
    usual = gonio.Regressor(basis).fit(plan.directions, values)
    stated = gonio.Regressor(basis).fit(plan.directions, values, noise=np.hypot(0.01 * values, 1e-5))
    assert np.allclose(stated.predict(*some_directions), usual.predict(*some_directions), rtol=1e-6)
    loose = gonio.Regressor(basis).fit(plan.directions, values, noise=0.2 * values)
    assert loose.expected_error_ > usual.expected_error_
    gonio.Regressor(basis).fit(plan.directions, values, noise=0.001)
    with pytest.raises(gonio.ArgumentError, match="noise has shape"):
        gonio.Regressor(basis).fit(plan.directions, values, noise=np.ones(5))


def test_a_basis_by_its_path(basis_path, plan, values):
    models = [gonio.Regressor(path).fit(plan.directions, values) for path in (basis_path, str(basis_path))]
    assert models[0].reconstruction_.basis is models[1].reconstruction_.basis
    with pytest.raises(gonio.FileError, match="no-such"):
        gonio.Regressor("no-such.gonio").fit(plan.directions, values)


def test_warnings_may_be_exceptions(basis, sample, some_directions):
    import warnings

    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(gonio.GonioWarning):
            gonio.Regressor(basis).fit(some_directions, 100.0 * np.pi * sample.eval(*some_directions))


def test_score(model, sample, some_directions):
    truth = sample.eval(*some_directions)
    assert model.score(some_directions, model.predict(*some_directions)) == 1.0
    assert 0.3 < model.score(some_directions, truth) < 1.0
    holes = truth.copy()
    holes[3] = np.nan
    assert np.isclose(model.score(some_directions, holes), model.score(
        some_directions, truth, sample_weight=np.arange(40) != 3))
    with pytest.raises(gonio.ArgumentError, match="values has shape"):
        model.score(some_directions, truth[:3])


def test_missing_values(basis, plan, values):
    holes = values.copy()
    holes[2, 1] = np.nan
    assert gonio.Regressor(basis).fit(plan.directions, holes).expected_error_ > 0.0
    with pytest.raises(gonio.GonioError):
        gonio.Regressor(basis).fit(plan.directions, np.full_like(values, np.nan))
    with pytest.raises(gonio.GonioError, match="finite|infinite|inf"):
        gonio.Regressor(basis).fit(plan.directions, np.full_like(values, np.inf))


def test_scikit_learn(basis, plan, values):
    base = pytest.importorskip("sklearn.base")
    from sklearn.model_selection import GridSearchCV, cross_val_score
    from sklearn.pipeline import make_pipeline
    from sklearn.preprocessing import FunctionTransformer

    copied = base.clone(gonio.Regressor(basis, noise=0.02))
    assert copied.basis is basis and copied.noise == 0.02 and base.is_regressor(copied)

    def from_angles(x):
        return np.hstack([gonio.directions(x[:, 0], x[:, 1]), gonio.directions(x[:, 2], x[:, 3])])

    x = np.column_stack([plan.theta_i, plan.phi_i, plan.theta_o, plan.phi_o])
    pipe = make_pipeline(FunctionTransformer(from_angles), gonio.Regressor(basis, checks=False)).fit(x, values)
    assert pipe.predict(x).shape == values.shape and pipe.score(x, values) > 0.9
    assert cross_val_score(gonio.Regressor(basis, checks=False), plan.directions, values, cv=3).shape == (3,)
    search = GridSearchCV(gonio.Regressor(basis, checks=False), {"noise": [0.01, 0.1]}, cv=2)
    assert search.fit(plan.directions, values).best_params_["noise"] in (0.01, 0.1)


def same(a, b):
    return np.array_equal(a, b, equal_nan=True)


def test_pickling_and_copies(model, plan, basis, sample, some_directions, tmp_path):
    for thing in (basis, sample, plan, model.reconstruction_, model.reconstruction_.readings):
        assert copy.copy(thing) is thing and copy.deepcopy(thing) is thing
    again = pickle.loads(pickle.dumps(plan))
    assert same(again.wi, plan.wi) and same(again.expected_error, plan.expected_error)
    again.to_csv(tmp_path / "a.csv")
    plan.to_csv(tmp_path / "b.csv")
    assert (tmp_path / "a.csv").read_bytes() == (tmp_path / "b.csv").read_bytes()
    value, std = model.predict(*some_directions, return_std=True)
    other = pickle.loads(pickle.dumps(model))
    assert all(map(same, other.predict(*some_directions, return_std=True), (value, std)))
    assert len(pickle.dumps(basis)) < 1000
    table = gonio.Material(sample.to_numpy(), name="table")
    for material in (sample, table, model.reconstruction_.material(), model.reconstruction_.deviation_material()):
        made = pickle.loads(pickle.dumps(material))
        assert made.name == material.name and same(made.eval(*some_directions), material.eval(*some_directions))
    readings = model.reconstruction_.readings
    again = pickle.loads(pickle.dumps(readings))
    assert same(again.values, readings.values) and same(again.pairs, readings.pairs)


def test_a_basis_without_a_file_is_pickled_whole():
    basis = gonio.learn(gonio.atlas()[:3], grid="bivariate", components=2)
    other = pickle.loads(pickle.dumps(basis))
    assert other.fingerprint == basis.fingerprint and np.array_equal(other.vectors(), basis.vectors())


def test_objects_keep_alive_what_they_stand_on(basis_path, plan, values, some_directions):
    import gc

    material = gonio.Regressor(gonio.Basis.load(basis_path)).fit(plan.directions, values).reconstruction_.material()
    mean = gonio.Basis.load(basis_path).mean
    image = gonio.render(gonio.Material("atlas:gold-polished"), width=8, height=8, samples=1)
    gc.collect()
    assert np.isfinite(material.eval(*some_directions)).all() and np.isfinite(mean).all() and image.shape == (8, 8, 4)
