"""Each check catches a method that was written to break it, and built-in methods pass them all."""

import math
import re
from dataclasses import dataclass, replace

import numpy as np
import pytest

from footfall.hdr import check as module
from footfall.hdr.check import Case, Failed, checks, examine, synthetic_case
from footfall.hdr.method import Method
from footfall.hdr.methods import METHODS, find_method
from footfall.hdr.tracks import Reckoning, pdr_track
from footfall.pdr.reckoning import StartPose, dead_reckon
from footfall.pdr.track import Track
from footfall.recording import Recording

NAMES = [name for name, _ in checks(METHODS["pdr"])]
HERE = [name for name in NAMES if name != "survives pickling"]  # without another process: a matter of seconds


@pytest.fixture(autouse=True, scope="module")
def cases_once():
    """The same recordings for all tests."""
    made = {seed: synthetic_case(seed) for seed in (1, 2)}
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(module, "synthetic_case", lambda seed: made[seed])
        yield


def good(recording, start):
    return pdr_track(dead_reckon(recording, start=start))


def failing(method, names=HERE):
    """Name -> reason of the checks that fail."""
    found = {}
    for name, check in checks(find_method(method) if not isinstance(method, Method) else method):
        if name in names:
            try:
                check()
            except Failed as failed:
                found[name] = str(failed)
    return found


def test_there_are_twelve_named_checks():
    assert len(NAMES) == len(set(NAMES)) == 12


@pytest.mark.parametrize("name", METHODS)
def test_a_built_in_method_passes(name):
    assert failing(METHODS[name]) == {}


def test_an_honest_method_of_others_passes():
    assert failing(good) == {}


def test_built_in_methods_are_the_same_in_another_process(monkeypatch):
    """All in one process, which costs its start once."""
    method = METHODS["pdr"]
    rest = [one for one in METHODS.values() if one is not method]
    here = {id(one): module._bytes(module._track(one, module.synthetic_case(2))) for one in rest}
    elsewhere = module._elsewhere
    seen = []

    class Pool(module.ProcessPoolExecutor):
        def submit(self, function, method, case):
            seen.extend(super(Pool, self).submit(elsewhere, one, case).result() for one in rest)
            return super().submit(function, method, case)

    monkeypatch.setattr(module, "ProcessPoolExecutor", Pool)
    assert failing(method, ["survives pickling"]) == {}
    assert seen == list(here.values())


# Methods written to break one check each.


def raises(recording, start):
    raise KeyError("gain")


def draws_lots(recording, start):
    made = good(recording, start)
    return replace(made, heading=made.heading + np.random.default_rng().normal(0, 1e-9))


@dataclass
class Remembering:
    last: float = 0.0

    def __call__(self, recording, start):
        made = good(recording, start)
        made = replace(made, heading=made.heading + 1e-9 * self.last)
        object.__setattr__(self, "last", float(recording.gyro[100, 0]))
        return made


def writes(recording, start):
    recording.gyro[:] -= recording.gyro[:5000].mean(axis=0)
    return good(recording, start)


def starts_at_the_origin(recording, start):
    return good(recording, StartPose(heading=start.heading))


def starts_north(recording, start):
    return good(recording, StartPose(start.position))


def turned_to_the_right(recording, start):
    return good(
        recording, StartPose(start.position, 6.0 - start.heading)
    )  # the same at the check's own start


def faces_where_it_is_told_and_goes_elsewhere(recording, start):
    made = good(recording, StartPose(start.position, 3.0))
    return replace(made, heading=made.heading + start.heading - 3.0)


def counts_the_present_twice(recording, start):
    made = good(recording, start)
    return replace(made, t=np.concatenate([made.t[:-1], made.t[-2:-1]]))


def goes_on_after_the_end(recording, start):
    made = good(recording, start)
    return replace(made, t=made.t + 60)


def wraps(recording, start):
    made = good(recording, start)
    return replace(made, heading=(made.heading + math.pi) % (2 * math.pi) - math.pi)


def wants_temperature(recording, start):
    return good(recording, start) if recording.temperature.mean() > -50 else None


def lost_without_temperature(recording, start):
    made = good(recording, start)
    if recording.temperature is None:
        made.heading[3] = np.nan
    return made


def lost_in_a_gap(recording, start):
    made = good(recording, start)
    if np.diff(recording.t).max() > 0.05:
        made.position[-1] = np.nan
    return made


def two_hundred_hertz(recording, start):
    """As if samples came 200 times a second."""
    if len(recording.t) < 100:
        raise ValueError("too short")
    way = 1.4 * 0.005 * np.cumsum(recording.t > 26)
    along = np.column_stack([np.cos(start.heading) * way, np.sin(start.heading) * way, 0 * way])
    return Track(recording.t, along + start.position, np.full(len(way), start.heading))


def never_refuses(recording, start):
    if len(recording.t) < 100:
        return Track(recording.t, np.zeros((2, 3)), np.zeros(2))
    return good(recording, start)


def makes_nothing_of_what_is_short(recording, start):
    return None if len(recording.t) < 100 else good(recording, start)


def falls_over_what_is_short(recording, start):
    recording.t[5000]
    return good(recording, start)


def returns_an_array(recording, start):
    return recording.t


@pytest.mark.parametrize(
    ("method", "caught", "reason"),
    [
        (raises, "runs", "KeyError: 'gain'"),
        (returns_an_array, "runs", "returned a ndarray, expected a Track"),
        (draws_lots, "same input, same bytes", "two runs on the same recording differ"),
        (Remembering, "same input, same bytes", "two runs on the same recording differ"),
        (writes, "leaves the recording alone", "is read-only"),
        (starts_at_the_origin, "starts where it is told", "m from where it is told that it rests"),
        (starts_north, "starts where it is told", "its first heading is -?0.* deg, and it is told 171.9 deg"),
        (turned_to_the_right, "turns with its start", r"does not turn the track by 90 deg: it is off by \d+"),
        (
            faces_where_it_is_told_and_goes_elsewhere,
            "turns with its start",
            "does not turn the track by 90 deg",
        ),
        (counts_the_present_twice, "t increases inside the recording", "t does not increase at row"),
        (
            goes_on_after_the_end,
            "t increases inside the recording",
            "a track from t = 8.* of a recording from 0",
        ),
        (wraps, "heading is unwrapped", r"a heading that jumps by 3\d\d deg at row \d+: unwrap it"),
        (
            wants_temperature,
            "finite without temperature",
            "AttributeError: 'NoneType' object has no attribute",
        ),
        (lost_without_temperature, "finite without temperature", "heading is not finite at row 3"),
        (lost_in_a_gap, "finite with 0.1 s lost", r"position is not finite at row \d+"),
        (two_hundred_hertz, "the same at 100 Hz", r"at 100 Hz it ends \d+\.\d m"),
        (
            never_refuses,
            "refuses what is too short",
            "a track of 2 rows of two samples, expected a ValueError",
        ),
        (
            makes_nothing_of_what_is_short,
            "refuses what is too short",
            "expected a ValueError: .*returned None",
        ),
        (falls_over_what_is_short, "refuses what is too short", "IndexError: .*, expected a ValueError"),
    ],
)
def test_a_check_catches_what_was_written_to_break_it(method, caught, reason):
    found = failing(method)
    assert caught in found, found
    assert re.search(reason, found[caught]), found[caught]
    alone = {one: set(HERE) for one in (raises, returns_an_array, writes)}  # none of which runs at all
    alone[writes].remove("refuses what is too short")  # by chance
    alone[starts_north] = {caught, "turns with its start"}
    assert set(found) == alone.get(method, {caught})


def test_what_is_kept_from_another_recording_is_caught():
    last = []

    def averaging(recording, start):
        if recording.gyro[1, 0] not in last:
            last.append(recording.gyro[1, 0])
        made = good(recording, start)
        return replace(made, heading=made.heading + 1e-9 * len(last))

    found = failing(averaging)
    assert set(found) == {"same input, same bytes"}
    assert "differs after another recording" in found["same input, same bytes"]


@pytest.mark.parametrize("part", ["gyro", "meta"])
def test_a_method_that_writes_is_caught_where_nothing_guards_the_recording(part):
    def careless(reckoning, params):
        if part == "meta":
            reckoning.recording.meta["seen"] = True
        elif reckoning.recording.gyro.flags.writeable:
            reckoning.recording.gyro[7] += 1e-12
        return good(reckoning.recording, reckoning.start)

    found = failing(Method("careless", "", careless))
    assert found["leaves the recording alone"].startswith(f"it writes into the recording's {part}")


FIRST = []


def calibrated_once(recording, start):
    """Keeps the bias of the first recording that it is ever given."""
    FIRST.append(recording.gyro[1:5000].mean(axis=0))
    made = good(recording, start)
    return replace(made, heading=made.heading + FIRST[0][2])


def test_what_is_kept_for_good_shows_in_another_process():
    FIRST.clear()
    found = failing(calibrated_once, ["same input, same bytes", "survives pickling"])
    assert set(found) == {"survives pickling"}
    assert found["survives pickling"].startswith("its track in another process is another one")


def test_what_cannot_travel_is_told():
    found = failing(lambda recording, start: good(recording, start), ["survives pickling"])
    assert found["survives pickling"].startswith("it does not reach another process: ")


def test_where_a_method_does_not_run_nothing_else_is_tried():
    results = list(examine(find_method(raises)))
    assert [result.name for result in results] == NAMES
    assert not any(result.passed for result in results)
    assert results[0].reason.startswith("synthetic 1: raises: KeyError")
    assert {result.reason for result in results[1:]} == {"not tried, for it does not run"}


def test_it_runs_on_further_recordings():
    """Here one that the method does not get over, and which is named."""
    one = synthetic_case(1)
    recording = Recording(one.recording.t, one.recording.gyro, one.recording.accel * 0.1)
    cases = [Case("the moon", recording, one.start)]
    (result, *_) = examine(METHODS["pdr"], cases)
    assert result.reason.startswith("the moon: recording: the accelerometers measure 0.98")


def test_checks_are_for_pytest():
    pairs = list(checks(find_method(good)))
    assert all(isinstance(name, str) and callable(check) for name, check in pairs)
    assert issubclass(Failed, AssertionError)


def test_the_recordings_of_the_checks_are_walks_that_tell_something():
    one, other = synthetic_case(1), synthetic_case(2)
    assert one.recording.sha == synthetic_case(1).recording.sha != other.recording.sha
    made = good(one.recording, one.start)
    assert len(made) > 30
    assert np.ptp(made.heading) > 2 * math.pi  # a wrapped heading jumps
    assert one.recording.temperature is not None
    assert len(module._halved(one).recording.t) == pytest.approx(len(one.recording.t) / 2, abs=1)
    assert np.diff(module._lossy(one).recording.t).max() == pytest.approx(0.105, abs=0.006)


def test_a_slower_recording_says_the_same():
    """Halves of the rate are means over both samples: angle and velocity are those of the whole."""
    one = synthetic_case(1)
    slow = module._halved(one).recording
    dt = np.diff(one.recording.t)[:, None]
    for name in ("gyro", "accel"):
        whole = (getattr(one.recording, name)[1:] * dt).sum(axis=0)
        half = (getattr(slow, name)[1:] * np.diff(slow.t)[:, None]).sum(axis=0)
        np.testing.assert_allclose(half, whole, atol=1e-9 * abs(whole).max() + 1e-6)


def test_a_method_on_footfalls_is_checked_too():
    def turned(footfalls, start):
        return pdr_track(footfalls)

    assert failing(find_method(turned, needs="footfalls")) == {}


def test_a_reckoning_of_a_case_goes_by_its_rest():
    one = synthetic_case(1)._replace(bias_s=10.0)
    seen = []

    def look(reckoning: Reckoning, params):
        seen.append((reckoning.pdr.bias_s, reckoning.start))
        return good(reckoning.recording, reckoning.start)

    module._track(Method("look", "", look), one)
    assert seen == [(10.0, one.start)]
