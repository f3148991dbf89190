"""Methods of others: what a text means, what a callable is given, and how each mistake is told."""

import pickle
import subprocess
import sys
from dataclasses import dataclass
from functools import partial
from importlib.metadata import EntryPoint

import numpy as np
import pytest

from footfall.errors import InputError
from footfall.hdr import others
from footfall.hdr.hdr import HdrParams
from footfall.hdr.methods import METHODS, find_method, tracks
from footfall.pdr.footfalls import Footfalls
from footfall.pdr.reckoning import PdrParams, dead_reckon
from footfall.pdr.track import Track
from footfall.settings import leaves

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


def test_a_file_that_changes_is_another_method(reckoning, nav, monkeypatch):
    """Within a second, and as long as before: compiled code that was kept of it must not be taken for it."""
    monkeypatch.setattr(sys, "dont_write_bytecode", False)
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
        InputError, match=r"'nothing' is unknown; expected one of pdr, hdr, .*my-compass, package"
    ):
        find_method("nothing")


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
