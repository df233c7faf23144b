"""Threads, forks, Ctrl-C, progress, NumPy's own BLAS: the library among others in one process."""
import concurrent.futures
import ctypes
import logging
import multiprocessing
import os
import re
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import gonio
from gonio import _calls

LONG = """
import gonio, time
print("begin", flush=True)
try:
    gonio.learn(gonio.atlas(), mixtures=100000)
except KeyboardInterrupt:
    print("stopped", flush=True)
print(gonio.learn(gonio.atlas()[:3], grid="bivariate", components=2))
"""


def test_ctrl_c_stops_the_work():
    work = subprocess.Popen([sys.executable, "-c", LONG], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    assert work.stdout.readline() == "begin\n"
    time.sleep(1.0)
    work.send_signal(signal.SIGINT)
    out, err = work.communicate(timeout=60)
    assert out.startswith("stopped\n<gonio.Basis") and err == "" and work.returncode == 0


def in_child(arguments):
    model, wi, wo = arguments
    fitted = gonio.Regressor(model.basis).fit_readings(model.reconstruction_.readings)
    return gonio._calls.threads(), fitted.predict(wi, wo)


@pytest.mark.parametrize("method", ["fork", "spawn"])
def test_multiprocessing(method, model, some_directions):
    here = model.predict(*some_directions)
    tasks = [(model, *some_directions)] * 2
    with multiprocessing.get_context(method).Pool(2) as pool:
        results = pool.map_async(in_child, tasks).get(timeout=100)
    for threads, value in results:
        assert np.array_equal(value, here)
        assert threads == 1 or method == "spawn"


def test_threads_share_objects(model, sample, some_directions):
    wi, wo = some_directions
    expected = sample.eval(wi, wo), model.predict(wi, wo)
    with concurrent.futures.ThreadPoolExecutor(4) as pool:
        for done in [pool.submit(lambda: (sample.eval(wi, wo), model.predict(wi, wo))) for _ in range(16)]:
            assert all(map(np.array_equal, done.result(), expected))


def test_the_number_of_threads_does_not_matter(basis, plan, values, some_directions):
    try:
        gonio.settings.threads = 1
        alone = gonio.Regressor(basis).fit(plan.directions, values).predict(*some_directions)
        gonio.settings.threads = 3
        assert np.array_equal(gonio.Regressor(basis).fit(plan.directions, values).predict(*some_directions), alone)
        gonio.settings.threads = -1
        with pytest.raises(gonio.ArgumentError, match="threads"):
            basis.plan(2)
    finally:
        gonio.settings.threads = 0


def test_the_gil_is_released():
    counted = 0
    done = threading.Event()

    def count():
        nonlocal counted
        while not done.is_set():
            counted += 1
            time.sleep(0.001)

    thread = threading.Thread(target=count)
    thread.start()
    try:
        gonio.Material("atlas:gold-polished").to_numpy()
    finally:
        done.set()
        thread.join()
    assert counted > 5


def numpys_blas():
    """NumPy's OpenBLAS in this process, if it is one."""
    np.linalg.inv(np.eye(3))
    paths = set(re.findall(r"\S+/libopenblas\S*\.so\S*", open("/proc/self/maps").read()))
    own = [p for p in paths if "/gonio/libs/" not in p]
    assert len(paths) > len(own)
    return ctypes.CDLL(own[0]) if own else None


def test_numpys_blas_is_left_alone(basis, plan, values):
    blas = numpys_blas()
    random = np.random.default_rng(1)
    a = random.standard_normal((300, 300))
    before, threads = a @ a, blas.openblas_get_num_threads() if blas is not None else 0
    gonio.Regressor(basis).fit(plan.directions, values)
    assert np.array_equal(a @ a, before)
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        products = [pool.submit(lambda: a @ a) for _ in range(8)]
        gonio.Regressor(basis).fit(plan.directions, values)
        assert all(np.allclose(p.result(), before, rtol=1e-12) for p in products)
    if blas is not None:
        assert blas.openblas_get_num_threads() == threads


def test_progress_by_tqdm(capsys, monkeypatch):
    pytest.importorskip("tqdm")
    monkeypatch.setattr(gonio.settings, "progress", True)
    bar = _calls._Bar()
    bar.show("early", 0.1)
    assert bar._bar is None
    bar._begin -= 2.0
    bar.show("learning", 0.5)
    bar.close()
    assert "learning" in capsys.readouterr().err


def test_nothing_is_printed(capfd, basis, plan, values):
    gonio.Regressor(basis).fit(plan.directions, values)
    assert capfd.readouterr() == ("", "")


def test_notes_are_logged(caplog, plan, values, tmp_path):
    (tmp_path / "r.csv").write_text("theta_in,phi_in,theta_out,phi_out,brdf\n10,0,10,180,0.3\n")
    with caplog.at_level(logging.INFO, logger="gonio"):
        readings = gonio.Readings.load(tmp_path / "r.csv")
    assert len(caplog.records) + len(readings.notes) > 0


def test_loading_is_quick():
    code = "import numpy, time; t = time.process_time(); import gonio; print(time.process_time() - t)"
    times = [float(subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True,
                                  env={**os.environ, "OPENBLAS_NUM_THREADS": "1"}).stdout) for _ in range(2)]
    assert min(times) < 0.3
