"""What tests share: a small basis, a plan, readings, directions."""
import pathlib

import numpy as np
import pytest

import gonio

SOURCE = pathlib.Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def source():
    return SOURCE


@pytest.fixture(scope="session")
def basis_path(tmp_path_factory):
    path = tmp_path_factory.mktemp("basis") / "small.gonio"
    gonio.learn(gonio.atlas()[::14], mixtures=40, components=60).save(path)
    return path


@pytest.fixture(scope="session")
def basis(basis_path):
    return gonio.Basis.load(basis_path)


@pytest.fixture(scope="session")
def sample():
    return gonio.Material("atlas:red-glossy-plastic")


@pytest.fixture(scope="session")
def plan(basis):
    return basis.plan(12)


@pytest.fixture(scope="session")
def values(plan, sample):
    return sample.eval(plan.wi, plan.wo)


@pytest.fixture(scope="session")
def model(basis, plan, values):
    return gonio.Regressor(basis).fit(plan.directions, values)


@pytest.fixture(scope="session")
def some_directions():
    random = np.random.default_rng(5)
    return tuple(gonio.directions(random.uniform(0.0, 1.4, 40), random.uniform(-3.0, 3.0, 40)) for _ in range(2))


@pytest.fixture(autouse=True)
def in_scratch(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("MPLBACKEND", "Agg")
