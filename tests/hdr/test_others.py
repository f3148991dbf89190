"""Methods of others: what a text means, what a callable is given, and how each mistake is told."""

import pickle
import subprocess
import sys
from dataclasses import dataclass
from functools import partial
from importlib.metadata import EntryPoint
from textwrap import dedent

import numpy as np
import pytest

from footfall.errors import InputError
from footfall.hdr import others
from footfall.hdr.hdr import HdrParams
from footfall.hdr.methods import METHODS, Reckoning, find_method, tracks
from footfall.pdr.footfalls import Footfalls
from footfall.pdr.reckoning import PdrParams, StartPose, dead_reckon
from footfall.pdr.track import Track
from footfall.recording import Recording
from footfall.settings import leaves
from tests.helpers.synthetic_foot import walk

SHORT = PdrParams(bias_s=5.0)
DRIFT = 0.01  # rad/s


def compass(recording, start):
    """The gyro alone, once a second."""
    rows = np.searchsorted(recording.t, np.arange(6.0, recording.t[-1]))
    heading = start.heading + DRIFT * recording.t[rows]
    return Track(t=recording.t[rows], position=np.zeros((len(rows), 3)), heading=heading)


@dataclass(frozen=True)
class Turning:
    """Turns at a rate of its own."""

    rate: float = DRIFT

    def __call__(self, recording, start):
        made = compass(recording, start)
        return Track(t=made.t, position=made.position, heading=start.heading + self.rate * made.t)


@dataclass(frozen=True)
class Rates:
    rate: float = 0.5


def by_default(recording, start, params=Rates()):
    return Turning(params.rate)(recording, start)


def by_annotation(recording, start, params: Rates):
    return Turning(params.rate)(recording, start)


def untyped(recording, start, params):
    return Turning(params.get("rate", 0.25))(recording, start)


def with_an_option(recording, start, window=5):
    assert window == 5
    return compass(recording, start)


def on_footfalls(footfalls, start):
    assert isinstance(footfalls, Footfalls)
    return Track(t=footfalls.t, position=footfalls.position, heading=footfalls.heading + DRIFT)


on_footfalls.needs = "footfalls"


@pytest.fixture(scope="module")
def recording():
    return walk(np.zeros(9), still_s=5.5).recording()


@pytest.fixture
def reckoning(recording):
    return Reckoning(recording, StartPose(heading=0.5), SHORT)


@pytest.fixture
def nav(tmp_path):
    """Writes a file of methods; returns the text that means one of them."""

    def write(body, name="Mine", file="nav.py"):
        head = "import numpy as np\nfrom footfall.pdr.track import Track\nfrom dataclasses import dataclass\n"
        (tmp_path / file).write_text(head + dedent(body))
        return f"{tmp_path / file}:{name}"

    return write


GOOD = """
@dataclass(frozen=True)
class Mine:
    '''A file's method.'''
    window: int = 7
    def __call__(self, recording, start):
        t = np.array([recording.t[0], recording.t[-1]])
        return Track(t=t, position=np.zeros((2, 3)), heading=start.heading + 0.01 * self.window * t)
"""


def expected(reckoning, rate):
    t = compass(reckoning.recording, reckoning.start).t
    return reckoning.start.heading + rate * t


def test_a_function_is_a_method(reckoning):
    method = find_method(compass)
    assert (method.name, method.description) == ("compass", "The gyro alone, once a second.")
    assert method.params is None
    made = tracks(reckoning, ["pdr", compass])
    np.testing.assert_array_equal(made["compass"].heading, expected(reckoning, DRIFT))
    assert made["compass"].meta["start"]["heading_rad"] == 0.5
    assert made["compass"].meta["version"] == method.version


@pytest.mark.parametrize("found", [Turning, Turning(), find_method(Turning)])
def test_a_dataclass_has_its_fields_for_parameters(reckoning, found):
    method = find_method(found, params={"rate": 0.125})
    assert [leaf.name for leaf in leaves(method.params)] == ["rate"]
    np.testing.assert_array_equal(method.track(reckoning).heading, expected(reckoning, 0.125))
    with pytest.raises(InputError, match=r"^ratte: unknown; did you mean rate\?$"):
        method.with_params({"ratte": 1})


@pytest.mark.parametrize(
    ("found", "before"),
    [(by_default, 0.5), (by_annotation, 0.5), (untyped, 0.25)],
    ids=lambda given: getattr(given, "__name__", str(given)),
)
def test_a_third_argument_is_given_the_parameters(reckoning, found, before):
    method = find_method(found)
    np.testing.assert_array_equal(method.track(reckoning).heading, expected(reckoning, before))
    after = method.with_params({"rate": 0.125})
    np.testing.assert_array_equal(after.track(reckoning).heading, expected(reckoning, 0.125))
    assert after.track(reckoning).meta["params"] == {"rate": 0.125}


def test_a_whole_dataclass_may_be_given_for_params(reckoning):
    method = find_method("hdr", params=HdrParams(tau_s=3.0), name="mine")
    assert (method.name, method.params.tau_s) == ("mine", 3.0)


def test_an_option_of_a_function_is_no_parameter(reckoning):
    assert find_method(with_an_option).params is None
    find_method(with_an_option).track(reckoning)


def test_what_needs_footfalls_is_given_footfalls(reckoning):
    walked = dead_reckon(reckoning.recording, SHORT, reckoning.start)
    for method in (
        find_method(on_footfalls),
        find_method(partial(on_footfalls), needs="footfalls", name="p"),
    ):
        assert method.needs == "footfalls"
        np.testing.assert_array_equal(method.track(reckoning).heading, walked.heading + DRIFT)
    with pytest.raises(InputError, match=r'needs = \'all\', expected "footfalls" or "samples"'):
        find_method(compass, needs="all")


@pytest.mark.parametrize("needs", ["samples", "footfalls"])
def test_what_a_method_is_given_cannot_be_written_to(reckoning, needs):
    def careless(given, start):
        for array in vars(given).values():
            if isinstance(array, np.ndarray):
                array[0] = 7.0

    with pytest.raises(InputError, match=r"careless: ValueError: assignment destination is read-only"):
        find_method(careless, needs=needs).track(reckoning)


def test_a_method_in_a_file(reckoning, nav):
    use = nav(GOOD)
    method = find_method(use, params={"window": 2})
    assert (method.name, method.description) == ("Mine", "A file's method.")
    made = tracks(reckoning, [method])["Mine"]
    assert made.heading[-1] == 0.5 + 0.02 * reckoning.recording.t[-1]
    assert (made.meta["use"], made.meta["params"]) == (use, {"window": 2})


def test_a_method_in_a_file_with_what_lies_beside_it(reckoning, nav, tmp_path):
    (tmp_path / "beside_the_method.py").write_text("FACTOR = 3\n")
    method = find_method(nav("from beside_the_method import FACTOR\n" + GOOD.replace("= 7", "= FACTOR")))
    assert method.params.window == 3


def test_a_file_that_changes_is_another_method(reckoning, nav):
    one = find_method(nav(GOOD))
    same = find_method(nav(GOOD))
    other = find_method(nav(GOOD.replace("= 7", "= 8")))
    assert one == same
    assert (one.params.window, other.params.window) == (7, 8)
    assert one.version != other.version


def test_a_version_of_its_own_stands_for_the_content(nav):
    versioned = GOOD.replace("    window: int", "    version = 'v1'\n    window: int")
    one, other = find_method(nav(versioned)), find_method(nav(versioned + "\n# more"))
    assert one.version == other.version == "v1"


def test_a_version_holds_what_a_callable_holds():
    def made(rate):
        return lambda recording, start: Turning(rate)(recording, start)

    assert find_method(made(1.0)).version == find_method(made(1.0)).version
    assert find_method(made(1.0)).version != find_method(made(2.0)).version
    bound = [find_method(partial(by_default, params=Rates(rate)), name="p").version for rate in (1.0, 2.0)]
    assert bound[0] != bound[1]
    assert find_method(compass).version != find_method(untyped).version


def test_a_method_of_a_file_goes_to_another_process(nav, tmp_path):
    """Which has never seen the file, as a worker has not."""
    method = find_method(nav(GOOD), name="mine", params={"window": 2})
    (tmp_path / "method.pickle").write_bytes(pickle.dumps(method))
    program = (
        "import pickle, sys; m = pickle.load(open(sys.argv[1], 'rb'));"
        "print(m.name, m.params.window, m.version, type(m.params).__name__)"
    )
    said = subprocess.run(
        [sys.executable, "-c", program, tmp_path / "method.pickle"],
        capture_output=True,
        text=True,
        check=True,
    )
    assert said.stdout.split() == ["mine", "2", method.version, "Mine"]


def test_a_method_in_a_package(reckoning, tmp_path, monkeypatch):
    """Of the folder that one works in, if it is not installed."""
    package = tmp_path / "mypkg_of_others"
    package.mkdir()
    (package / "__init__.py").touch()
    (package / "nav.py").write_text(
        "import numpy as np\nfrom footfall.pdr.track import Track\nfrom dataclasses import dataclass\n" + GOOD
    )
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "path", list(sys.path))
    method = find_method("mypkg_of_others.nav:Mine")
    assert method.name == "Mine"
    assert len(method.track(reckoning)) == 2


@pytest.fixture
def installed(monkeypatch):
    """Says what entry points there are: a name -> a value, or several."""

    def install(**values):
        points = [
            EntryPoint(name.replace("_", "-"), value, others.GROUP)
            for name, several in values.items()
            for value in ([several] if isinstance(several, str) else several)
        ]
        monkeypatch.setattr(others, "entry_points", lambda group: points if group == others.GROUP else [])

    return install


def test_a_method_of_an_installed_package(reckoning, installed):
    installed(my_compass="tests.hdr.test_others:compass")
    assert find_method("my-compass").name == "my-compass"
    assert find_method("my-compass", name="mine").name == "mine"
    with pytest.raises(
        InputError, match=r"'hdx' is unknown, expected one of pdr, hdr, .*my-compass, package"
    ):
        find_method("hdx")


def test_a_built_in_method_is_never_replaced(installed):
    installed(hdr="tests.hdr.test_others:compass")
    assert find_method("hdr") is METHODS["hdr"]


def test_the_name_of_a_built_in_method_is_not_given_away(nav, installed):
    use = nav(GOOD)
    with pytest.raises(InputError, match=r"Mine: method name 'hdr' is that of a built-in one: call yours"):
        find_method(use, name="hdr")
    assert find_method("hdr", name="hdr", params={"tau_s": 3.0}).params.tau_s == 3.0
    with pytest.raises(InputError, match=r"'recording': this is Footfall's own name for something else"):
        find_method(use, name="recording")
    with pytest.raises(InputError, match=r"'imu': this is Footfall's own name for something else"):
        METHODS["hdr"].renamed("imu")


def test_two_packages_with_one_name_are_told(installed):
    installed(twice=["one:A", "two:B"])
    with pytest.raises(InputError, match=r"^twice: several packages have it: one:A, two:B; say which$"):
        find_method("twice")


@pytest.mark.parametrize(
    ("use", "sentence"),
    [
        ("hdx", "method 'hdx' is unknown, expected one of pdr, hdr"),
        ("", "method '' is unknown, expected one of pdr, hdr"),
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
