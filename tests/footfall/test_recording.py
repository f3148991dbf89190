"""What a recording promises to the methods that get it."""

import copy
import dataclasses
import pickle

import numpy as np
import pytest

from footfall.recording import Recording, read_recording, write_recording

ARRAYS = ("t", "gyro", "accel", "temperature")


def made() -> Recording:
    rng = np.random.default_rng(0)
    return Recording(
        t=np.arange(20) / 200,
        gyro=rng.normal(size=(20, 3)),
        accel=rng.normal(size=(20, 3)),
        temperature=rng.normal(size=20),
    )


def handed_out(tmp_path):
    recording = made()
    write_recording(recording, tmp_path / "r.parquet")
    yield from (
        recording,
        read_recording(tmp_path / "r.parquet"),
        dataclasses.replace(recording, meta={"a": 1}),
    )
    yield from (copy.deepcopy(recording), copy.copy(recording), pickle.loads(pickle.dumps(recording)))


def test_no_method_can_write_into_a_recording(tmp_path):
    """Fresh, read, replaced, copied, or sent to another process."""
    for recording in handed_out(tmp_path):
        for name in ARRAYS:
            with pytest.raises(ValueError, match="read-only"):
                getattr(recording, name)[0] = 0.0
            with pytest.raises(ValueError, match="read-only"):
                getattr(recording, name)[1:][...] = 0.0


def test_who_made_the_arrays_may_still_write_into_them():
    """A recording takes views: it does not lock what others own, and copies nothing."""
    t, gyro = np.arange(20) / 200, np.zeros((20, 3))
    recording = Recording(t=t, gyro=gyro, accel=np.zeros((20, 3)))
    assert gyro.flags.writeable
    assert np.shares_memory(recording.gyro, gyro)
    assert recording.temperature is None


def test_a_copy_of_an_array_is_free():
    gyro = made().gyro.copy()
    gyro -= 1.0
