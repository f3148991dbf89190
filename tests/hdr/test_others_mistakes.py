"""How each mistake of a method of others is told."""

import numpy as np
import pytest

from footfall.errors import InputError
from footfall.hdr.methods import find_method
from footfall.pdr.reckoning import dead_reckon
from footfall.pdr.track import Track
from footfall.recording import Recording
from tests.hdr.test_others import compass


@pytest.mark.parametrize(
    ("use", "sentence"),
    [
        ("hdx", "method 'hdx' is unknown; did you mean hdr?"),
        ("nothing", "method 'nothing' is unknown; expected one of pdr, hdr"),
        ("", "method '' is unknown; expected one of pdr, hdr"),
        ("nav.py", "nav.py: say which of its names: nav.py:NAME"),
        ("no-such.py:Mine", "no-such.py: cannot be read (No such file or directory)"),
        ("./nav:Mine", "./nav: expected a file of Python, file.py:NAME"),
        ("no_such_pkg.nav:Mine", "no_such_pkg.nav:Mine: there is no module 'no_such_pkg'"),
        ("footfall.nav:Mine", "footfall.nav:Mine: there is no module 'footfall.nav'"),
        ("my pkg:Mine", "my pkg:Mine: expected package.module:NAME or file.py:NAME"),
        (":Mine", ":Mine: expected package.module:NAME or file.py:NAME"),
        ("json:dumbs", "json: there is no 'dumbs' in it; did you mean dump"),
        ("json:", "json: there is no '' in it"),
        (
            "math:pi",
            "math:pi: is a float, expected a callable (recording, start) or (recording, start, params)",
        ),
    ],
)
def test_a_text_that_means_no_method_is_told(use, sentence):
    with pytest.raises(InputError) as refused:
        find_method(use)
    assert str(refused.value).startswith(sentence)


@pytest.mark.parametrize(
    ("body", "sentence"),
    [
        ("1 / 0", "cannot be loaded: ZeroDivisionError: division by zero (nav.py, line 4)"),
        ("def Mine(:", "cannot be loaded: SyntaxError: invalid syntax (nav.py, line 4)"),
        (
            "import no_such_pkg",
            "cannot be loaded: ModuleNotFoundError: No module named 'no_such_pkg' (nav.py, l",
        ),
        ("raise SystemExit(3)", "cannot be loaded: SystemExit: 3 (nav.py, line 4)"),
    ],
)
def test_a_file_that_cannot_be_loaded_is_told(nav, body, sentence):
    use = nav(body)
    with pytest.raises(InputError) as refused:
        find_method(use)
    assert str(refused.value).startswith(f"{use.removesuffix(':Mine')}: {sentence}")


@pytest.mark.parametrize(
    ("body", "sentence"),
    [
        ("Mine = 3", "is an int, expected a callable"),
        ("class Mine: pass", "is a Mine, expected a callable"),
        ("def Mine(): pass", "takes (), expected (recording, start)"),
        ("def Mine(a): pass", "takes (a), expected (recording, start) or (recording, start, params)"),
        ("def Mine(a, b, c, d): pass", "takes (a, b, c, d), expected (recording, start)"),
        ("def Mine(a, b, *, c): pass", "takes (a, b, *, c), expected (recording, start)"),
        (
            "class Mine:\n def __init__(self, x): pass",
            "cannot be made without arguments: TypeError: Mine.__init",
        ),
        (
            "@dataclass\nclass Mine:\n a: int = 0\n def __call__(self, r, s, params): pass",
            "has its fields for parameters, expected __call__(recording, start)",
        ),
        ("@dataclass\nclass P:\n a: int\ndef Mine(r, s, params: P): pass", "its params P lack defaults"),
    ],
)
def test_what_is_no_method_is_told(nav, body, sentence):
    use = nav(body)
    with pytest.raises(InputError) as refused:
        find_method(use)
    assert str(refused.value).startswith(f"{use}: {sentence}")


TWO = "t, z = np.array([1.0, 2.0]), np.zeros((2, 3))"


@pytest.mark.parametrize(
    ("body", "sentence"),
    [
        ("x = {}['gain']", "KeyError: 'gain' (nav.py, line 5)"),
        ("raise RuntimeError", "RuntimeError (nav.py, line 5)"),
        ("np.zeros((2, 3)) @ np.zeros(2)", "ValueError: matmul: Input operand 1 has a mismatch"),
        ("return None", "returned None, expected a Track"),
        ("return recording.t", "returned a ndarray, expected a Track"),
        (f"{TWO}; return Track(t, z, t * np.nan)", "returned a track whose heading is not finite at row 0"),
        (
            f"{TWO}; z[1, 2] = np.inf; return Track(t, z, t)",
            "returned a track whose position is not finite at row 1",
        ),
        (
            f"{TWO}; return Track(t, z[:, :2], t)",
            "returned a track whose position is float64 of shape (2, 2)",
        ),
        (f"{TWO}; return Track(t, z, t[:1])", "returned a track whose heading is float64 of shape (1,)"),
        (
            f"{TWO}; return Track(t, z, t, {{'a': t[:1]}})",
            "returned a track whose a is float64 of shape (1,)",
        ),
        (
            f"{TWO}; return Track(t[::-1], z, t)",
            "returned a track whose t does not increase at row 1 (t = 1 s)",
        ),
        (f"{TWO}; return Track(t[:1], z[:1], t[:1])", "returned a track of 1 rows, expected at least 2"),
        (
            f"{TWO}; return Track(t - 9, z, t)",
            "returned a track from t = -8 to -7 s of a recording from 0 to ",
        ),
        (
            f"{TWO}; return Track(t + 98, z, t)",
            "returned a track from t = 99 to 100 s of a recording from 0 to ",
        ),
        (
            f"{TWO}; return Track(t, z, t * 5.5)",
            "returned a heading that jumps by 315 deg at row 1: unwrap it",
        ),
    ],
)
def test_what_a_method_does_wrong_is_told(reckoning, nav, body, sentence):
    use = nav(f"def Mine(recording, start):\n    {body}")
    with pytest.raises(InputError) as refused:
        find_method(use).track(reckoning)
    assert str(refused.value).startswith(f"{use}: {sentence}")


def test_a_turn_on_the_spot_is_none_that_jumps(reckoning, nav):
    find_method(nav(f"def Mine(recording, start):\n    {TWO}; return Track(t, z, t * 4.0)")).track(reckoning)


@pytest.mark.parametrize(("first", "last"), [(0.0, 16.3), (-0.004, 16.304), (-0.006, 16.3), (0.0, 16.306)])
def test_stamps_may_miss_the_recording_by_a_sample(reckoning, first, last):
    def mine(recording, start):
        return Track(np.array([first, last]), np.zeros((2, 3)), np.zeros(2))

    assert reckoning.recording.t[-1] == pytest.approx(16.3)
    method = find_method(mine)
    if first < -0.005 or last > 16.305:
        with pytest.raises(InputError, match=r"of a recording from 0 to 16\.3 s"):
            method.track(reckoning)
    else:
        method.track(reckoning)


def test_the_place_of_a_mistake_is_in_the_methods_file(reckoning, nav):
    use = nav("def Mine(recording, start):\n    return np.linalg.inv(np.zeros((2, 2)))")
    with pytest.raises(InputError, match=r"LinAlgError: Singular matrix \(nav.py, line 5\)$"):
        find_method(use).track(reckoning)


def test_what_navigation_refuses_in_a_method_is_told_as_it_is(reckoning):
    def mine(recording, start):
        return dead_reckon(recording)

    with pytest.raises(InputError, match=r"^recording: lasts .* shorter than the 25 s at rest"):
        find_method(mine).track(reckoning)


def test_what_a_method_prints_is_no_result(reckoning, capsys):
    def mine(recording, start):
        print("hello")
        return compass(recording, start)

    find_method(mine).track(reckoning)
    assert capsys.readouterr() == ("", "hello\n")


def test_the_recording_is_given_as_it_is(reckoning):
    seen = {}

    def mine(recording, start):
        seen.update(recording=recording, start=start)
        return compass(recording, start)

    find_method(mine).track(reckoning)
    assert isinstance(seen["recording"], Recording)
    for name in ("t", "gyro", "accel"):
        np.testing.assert_array_equal(getattr(seen["recording"], name), getattr(reckoning.recording, name))
    assert seen["start"] == reckoning.start
