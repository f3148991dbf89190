"""The workers that share trials: how they start, and how they are stopped."""

import os
import signal
import threading
from concurrent.futures import ProcessPoolExecutor
from types import SimpleNamespace

import pytest

from footfall.scenarios import execute
from footfall.scenarios.execute import worker_pool


@pytest.fixture
def other_thread():
    """To which a signal may go as well as to the main one."""
    ended = threading.Event()
    thread = threading.Thread(target=ended.wait)
    thread.start()
    yield
    ended.set()
    thread.join()


@pytest.fixture(params=["masks", "no masks"])
def masks(request, monkeypatch):
    """Threads have signal masks, or none, as on Windows."""
    if request.param == "no masks":
        monkeypatch.setattr(execute, "sys", SimpleNamespace(platform="win32"))
        monkeypatch.delattr(signal, "pthread_sigmask", raising=False)
    elif not hasattr(signal, "pthread_sigmask"):
        pytest.skip("this system has no masks")


def test_ctrl_c_waits_until_no_worker_is_half_started(other_thread, masks, monkeypatch):
    """A worker whose parent ends while it starts tells of the pipe that broke."""
    heard = signal.signal(signal.SIGINT, signal.default_int_handler)
    started = []
    submit = ProcessPoolExecutor.submit

    def interrupted(pool, work):
        if os.name == "posix":
            os.kill(os.getpid(), signal.SIGINT)  # to any thread
        else:
            signal.raise_signal(signal.SIGINT)
        future = submit(pool, work)
        started.append(future)
        return future

    monkeypatch.setattr(ProcessPoolExecutor, "submit", interrupted)
    try:
        with pytest.raises(KeyboardInterrupt), worker_pool(2):
            pytest.fail("nobody heard it")
        assert [future.result(timeout=0) > 0 for future in started] == [True, True]
        assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
        if hasattr(signal, "pthread_sigmask"):
            assert signal.SIGINT not in signal.pthread_sigmask(signal.SIG_BLOCK, [])
    finally:
        signal.signal(signal.SIGINT, heard)


def test_cores_are_those_that_this_process_may_use_where_the_system_tells(monkeypatch):
    monkeypatch.setattr(os, "cpu_count", lambda: 7)
    monkeypatch.setattr(os, "sched_getaffinity", lambda process: {0, 4, 5}, raising=False)
    assert execute.cores() == 3
    monkeypatch.delattr(os, "sched_getaffinity")
    assert execute.cores() == 7
    monkeypatch.setattr(os, "cpu_count", lambda: None)
    assert execute.cores() == 1
