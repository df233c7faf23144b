"""What the package adds to the library's time. Processor time, so that other work does not count."""
import time

import numpy as np

import gonio
from gonio import _calls, _directions
from gonio._backend import ffi, lib

COUNT = 200_000


def least_time(work, repeats=3):
    times = []
    for _ in range(repeats):
        begin = time.process_time()
        work()
        times.append(time.process_time() - begin)
    return min(times)


def test_prediction_takes_the_librarys_time(model):
    random = np.random.default_rng(2)
    wi, wo = (gonio.directions(random.uniform(0.0, 1.5, COUNT), random.uniform(-3.0, 3.0, COUNT)) for _ in range(2))
    at, value = _directions.pairs(wi, wo), np.empty((COUNT, 3))
    made = model.reconstruction_

    def library():
        lib.gonio_python_predict(made.basis._handle, made._handle, _calls.buffer(at, "gonio_pair"), COUNT, 3,
                                 _calls.threads(), _calls.buffer(value), ffi.NULL)

    ratios = []
    while len(ratios) < 5 and min(ratios, default=9.0) > 1.2:
        ratios.append(least_time(lambda: model.predict(wi, wo)) / least_time(library))
    assert min(ratios) <= 1.2
    assert np.array_equal(model.predict(wi, wo), value)


def test_fitting_is_quick(basis, sample):
    plan = basis.plan(20)
    values = sample.eval(plan.wi, plan.wo)
    model = gonio.Regressor(basis).fit(plan.directions, values)
    assert least_time(lambda: model.fit(plan.directions, values)) < 0.3 * _calls.threads()
