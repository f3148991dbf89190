"""Still start and stances as rows of the recording."""

import numpy as np
import pytest

from footfall.conventions import GRAVITY
from footfall.errors import InputError
from footfall.pdr.reckoning import PdrParams, detect, refuse_gaps
from footfall.recording import Recording
from tests.helpers.synthetic_foot import walk

DEG = np.pi / 180
RATE, N = 200.0, 2400
T = np.arange(N) / RATE
STRIDES = (2.5, 3.6, 4.7)  # s, when the foot is quietest


class Spy:
    """A detector that keeps what it is given, and says that the foot is quietest at `STRIDES` alone."""

    def __call__(self, t, gyro, accel):
        self.t, self.gyro, self.accel = t, gyro, accel
        score = np.full(len(t), 5.0)
        for at in STRIDES:
            score[np.abs(t - at) < 0.15] = 0.5
            score[np.abs(t - at) < 0.002] = 0.1
        return score


def still(bias=0.0):
    rng = np.random.default_rng(0)
    gyro = 0.1 * DEG * rng.standard_normal((N, 3)) + bias
    return Recording(T, gyro, np.tile([0.0, 0.0, GRAVITY], (N, 1)))


def test_a_reset_is_the_row_of_the_quietest_sample():
    found = detect(still(), PdrParams(bias_s=1.0, detector=Spy()))
    np.testing.assert_allclose(T[found.stances.resets], [1.0, *STRIDES], atol=1e-9)
    assert found.stances.footfalls.tolist() == [0, 1, 2, 3]
    assert found.stances.resets[0] == found.rest.last
    assert len(found.score) == N
    np.testing.assert_array_equal(found.score[found.stances.resets[1:]], 0.1)


def test_the_detector_sees_the_gyro_less_its_static_bias_and_no_first_row():
    """Row 0 belongs to the time before the record."""
    spy, bias = Spy(), np.array([20.0, -30.0, 10.0]) * DEG
    recording = still(bias)
    found = detect(recording, PdrParams(bias_s=1.0, detector=spy))
    np.testing.assert_array_equal(spy.t, T[1:])
    np.testing.assert_array_equal(spy.accel, recording.accel[1:])
    np.testing.assert_allclose(spy.gyro, recording.gyro[1:] - found.rest.gyro_bias)
    assert np.abs(spy.gyro.mean(axis=0)).max() < 0.02 * DEG


def test_one_stride_is_a_walk():
    truth = walk(np.zeros(2), still_s=2.0)
    found = detect(truth.recording(), PdrParams(bias_s=2.0))
    assert len(found.stances.footfalls) == 2


@pytest.mark.parametrize(("hole", "bridged"), [(9, True), (10, False), (19, False), (20, True)])
def test_only_holes_between_the_first_reset_and_the_last_matter(hole, bridged):
    """Rows 10 to 20 are navigated; `hole` is the row before a second without samples."""
    t = np.arange(30) * 0.01
    t[hole + 1 :] += 1.0
    if bridged:
        refuse_gaps(t, 10, 20, 0.25)
    else:
        with pytest.raises(InputError, match=rf"no samples for 1\.01 s after t = {t[hole]:.6g} s"):
            refuse_gaps(t, 10, 20, 0.25)


@pytest.mark.parametrize(("at", "refused"), [(0.5, False), (1.5, True), (4.2, True), (6.0, False)])
def test_holes_in_any_stride_are_refused_and_elsewhere_they_do_not_matter(at, refused):
    """Rest until 1 s, footfalls at 2.5, 3.6 and 4.7 s."""
    recording = Recording(np.where(at < T, T + 0.3, T), still().gyro, still().accel)
    if refused:
        with pytest.raises(InputError, match=rf"no samples for 0\.305 s after t = {at:g} s"):
            detect(recording, PdrParams(bias_s=1.0, detector=Spy()))
    else:
        found = detect(recording, PdrParams(bias_s=1.0, detector=Spy()))
        assert len(found.stances.footfalls) == 4
