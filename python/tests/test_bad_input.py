"""Arguments of any kind: an exception that names the argument, or a result of the right shape; never a crash."""
import numpy as np
import pytest

import gonio

pytest.importorskip("hypothesis")
from hypothesis import HealthCheck, given, settings, strategies as st  # noqa: E402
from hypothesis.extra import numpy as arrays  # noqa: E402

quick = settings(max_examples=60, deadline=None, derandomize=True, database=None,
                 suppress_health_check=list(HealthCheck))
TYPES = st.sampled_from(["f8", "f4", "f2", "i4", "u1", "?", "c16", "U3", "O", ">f8"])
SHAPES = st.one_of(arrays.array_shapes(min_dims=0, max_dims=4, min_side=0, max_side=4),
                   st.tuples(st.integers(0, 5), st.just(3)), st.just((3,)), st.tuples(st.integers(0, 4), st.just(6)))


def of_type(kind):
    if kind == "O":
        return st.lists(st.one_of(st.none(), st.text(), st.floats()), max_size=4)
    return SHAPES.flatmap(lambda shape: arrays.arrays(kind, shape))


ANYTHING = st.one_of(TYPES.flatmap(of_type), st.none(), st.text(), st.integers(), st.floats(),
                     st.lists(st.lists(st.floats(), max_size=4), max_size=4))
VECTORS = st.tuples(st.floats(-1.0, 1.0), st.floats(-1.0, 1.0), st.floats(-0.2, 1.0))


def attempt(function, *arguments, **keywords):
    """The result, or None if it was refused."""
    with np.errstate(all="ignore"):
        try:
            return function(*arguments, **keywords)
        except gonio.GonioError as error:
            assert str(error)
            return None


@pytest.fixture(autouse=True)
def without_warnings():
    import warnings

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        yield


@quick
@given(wi=ANYTHING, wo=ANYTHING, cosine=st.booleans())
def test_eval(sample, wi, wo, cosine):
    values = attempt(sample.eval, wi, wo, cosine=cosine)
    if values is not None:
        assert values.shape == np.broadcast_shapes(np.shape(wi)[:-1], np.shape(wo)[:-1]) + (3,)


@quick
@given(wi=st.lists(VECTORS, min_size=1, max_size=5), wo=VECTORS, below=st.sampled_from(["raise", "nan", "zero"]))
def test_eval_of_vectors(sample, wi, wo, below):
    values = attempt(sample.eval, wi, wo, below=below)
    if values is not None:
        assert values.shape == (len(wi), 3) and not np.any(values < 0.0)


@quick
@given(theta=ANYTHING, phi=ANYTHING)
def test_directions(theta, phi):
    w = attempt(gonio.directions, theta, phi)
    if w is not None:
        assert w.shape == np.broadcast_shapes(np.shape(theta), np.shape(phi)) + (3,)
        attempt(gonio.angles, w)


@quick
@given(directions=ANYTHING, values=ANYTHING, noise=ANYTHING)
def test_fit(basis, directions, values, noise):
    model = attempt(gonio.Regressor(basis, checks=False).fit, directions, values, noise)
    assert model is None or model.expected_error_ > 0.0


@settings(quick, max_examples=25)
@given(pairs=st.lists(st.tuples(st.floats(0.0, 1.5), st.floats(0.0, 1.5), st.floats(0.0, 6.3),
                                st.one_of(st.floats(), st.floats(0.0, 10.0))), min_size=1, max_size=6),
       noise=st.one_of(st.none(), st.floats()), floor=st.floats(), saturation=st.floats())
def test_fit_of_values(basis, pairs, noise, floor, saturation):
    theta_i, theta_o, phi_o, value = np.array(pairs).T
    model = attempt(gonio.Regressor(basis, floor=floor, saturation=saturation, average_repeats=True, checks=False).fit,
                    (gonio.directions(theta_i), gonio.directions(theta_o, phi_o)), value, noise)
    if model is not None:
        assert model.predict([0, 0, 1], [0, 0, 1]).shape == ()


@quick
@given(theta=ANYTHING, image=ANYTHING, table=ANYTHING)
def test_other_arguments(sample, theta, image, table):
    attempt(sample.albedo, theta)
    attempt(gonio.tone_map, image) if not isinstance(image, (list, str)) else None
    if isinstance(table, np.ndarray):
        attempt(gonio.Material, table)


@quick
@given(n=st.one_of(st.integers(-3, 3), st.floats(-2.0, 3.0)), target=st.one_of(st.none(), st.floats()),
       candidates=ANYTHING)
def test_plans(basis, n, target, candidates):
    made = attempt(basis.plan, n, target_error=target, candidates=candidates)
    assert made is None or len(made) <= max(n, 1)


SCALARS = st.one_of(st.none(), st.text(max_size=3), st.integers(), st.integers(-2, 3), st.floats(), st.booleans(),
                    st.lists(st.floats(), max_size=2), st.just(b"x"), st.complex_numbers())


FEW = st.one_of(st.integers(-2, 3), st.floats(-1.0, 3.0), st.sampled_from([np.nan, np.inf, "3", b"3", 1j, [2], True]))


@settings(quick, max_examples=40)
@given(n=FEW, given=st.dictionaries(st.sampled_from(["target_error", "metric", "method", "components", "seed",
                                                     "restarts", "start", "phi_d"]), SCALARS, max_size=2))
def test_words_and_numbers_of_plans(basis, n, given):
    made = attempt(basis.plan, n, **given)
    assert made is None or 0 < len(made) <= n


@settings(quick, max_examples=40)
@given(given=st.dictionaries(st.sampled_from(["noise", "floor", "saturation", "method", "average_repeats"]), SCALARS,
                             max_size=3), level=SCALARS)
def test_words_and_numbers_of_models(basis, plan, values, given, level):
    model = attempt(gonio.Regressor(basis, checks=False, **given).fit, plan.directions, values)
    if model is not None:
        attempt(model.interval, plan.directions, level=level)


@settings(quick, max_examples=25)
@given(given=st.dictionaries(st.sampled_from(["seed", "azimuth", "elevation", "field_of_view", "lamp", "lamp_position",
                                              "environment", "mesh", "environment_turn"]), SCALARS, max_size=2),
       size=st.integers(-1, 4))
def test_words_and_numbers_of_renderings(sample, given, size):
    image = attempt(gonio.render, sample, **{"width": size, "height": 4, "samples": 1, **given})
    assert image is None or image.shape == (4, size, 4)


@pytest.mark.parametrize("wi, message", [
    ([1.0, 0.0], r"wi has shape \(2,\).*gonio.directions"),
    ([[0.0, 0.0, np.nan]], r"wi\[0\].*not finite"),
    ([[0, 0, 1], [0, 0, 0]], r"wi\[1\].*no direction"),
    ([0.0, 1.0, -0.5], r"wi .*horizon"),
    (np.ma.masked_array([[0.0, 0.0, 1.0]], mask=[[True, False, False]]), r"wi has shape \(1, 3\) and masked"),
    (["a", "b", "c"], r"wi has shape \(3,\) and dtype"),
    (np.array([0, 0, 1j]), r"wi has shape \(3,\) and dtype complex128"),
    (np.zeros((2, 3)) + [0, 0, 1], r"wi has shape \(2, 3\) and wo \(5, 3\).*broadcast"),
])
def test_messages_name_argument_shape_and_remedy(sample, wi, message):
    with pytest.raises(gonio.ArgumentError, match=message):
        sample.eval(wi, np.tile([0.0, 0.0, 1.0], (5, 1)) if "broadcast" in message else [0.0, 0.0, 1.0])


def test_empty(basis):
    with pytest.raises(gonio.ArgumentError, match="at least 1"):
        gonio.Regressor(basis).fit((np.empty((0, 3)), np.empty((0, 3))), np.empty((0, 3)))
    with pytest.raises(gonio.ArgumentError, match="values has shape"):
        gonio.Regressor(basis).fit(([[0, 0, 1]], [[0, 0, 1]]), np.empty((0, 3)))


def test_unmasked_arrays_are_arrays(sample):
    w = np.ma.masked_array([[0.0, 0.0, 1.0]])
    assert np.array_equal(sample.eval(w, w), sample.eval([[0, 0, 1]], [[0, 0, 1]]))
