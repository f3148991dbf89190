"""The workers that share trials: how they start, and how they are stopped."""

import os
import signal
import threading
from concurrent.futures import ProcessPoolExecutor

import pytest

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


@pytest.mark.parametrize("masks", [True, False])
def test_ctrl_c_waits_until_no_worker_is_half_started(other_thread, monkeypatch, masks):
    """A worker whose parent ends while it starts tells of the pipe that broke. Windows has no masks."""
    if not masks:
        monkeypatch.delattr(signal, "pthread_sigmask")
    heard = signal.signal(signal.SIGINT, signal.default_int_handler)
    started = []
    submit = ProcessPoolExecutor.submit

    def interrupted(pool, work):
        os.kill(os.getpid(), signal.SIGINT)
        future = submit(pool, work)
        started.append(future)
        return future

    monkeypatch.setattr(ProcessPoolExecutor, "submit", interrupted)
    try:
        with pytest.raises(KeyboardInterrupt), worker_pool(2):
            pytest.fail("nobody heard it")
        assert [future.result(timeout=0) > 0 for future in started] == [True, True]
        assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
        if masks:
            assert signal.SIGINT not in signal.pthread_sigmask(signal.SIG_BLOCK, [])
    finally:
        signal.signal(signal.SIGINT, heard)
