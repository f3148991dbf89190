"""What a method is: its parameters by name, its name, its journey to another process."""

import pickle

import numpy as np
import pytest

from footfall.errors import InputError
from footfall.hdr.hdr import HdrParams
from footfall.hdr.method import Method
from footfall.hdr.methods import METHODS, Reckoning, find_method, hdr_track, tracks
from footfall.hdr.tracks import UNTOLD
from footfall.pdr.reckoning import StartPose
from footfall.settings import leaves
from tests.helpers.synthetic_foot import walk

DEG = np.pi / 180


@pytest.fixture(scope="module")
def reckoning():
    truth = walk(np.repeat([0, 90, 90], 12) * DEG, still_s=25.5)
    return Reckoning(truth.recording(gyro_error=0.02 * DEG), StartPose(heading=0.3))


@pytest.mark.parametrize("name", METHODS)
def test_a_built_in_method_is_the_same_after_a_journey(reckoning, name):
    method = pickle.loads(pickle.dumps(METHODS[name]))
    assert method == METHODS[name]
    np.testing.assert_array_equal(method.track(reckoning).heading, METHODS[name].track(reckoning).heading)


@pytest.mark.parametrize("name", [name for name in METHODS if name != "pdr"])
def test_every_parameter_of_a_built_in_method_can_be_set_to_what_it_is(name):
    method = METHODS[name]
    values = {leaf.name: leaf.value for leaf in leaves(method.params)}
    assert values
    assert method.with_params(values) == method


def test_parameters_reach_the_method(reckoning):
    mine = METHODS["hdr"].with_params({"theta_w_deg_s": 3.0, "i_c_deg_s": 0.05}).renamed("mine")
    made = tracks(reckoning, ["hdr", mine])
    assert list(made) == ["hdr", "mine"]
    expected = hdr_track(reckoning.footfalls, HdrParams.from_degrees(i_c_deg_s=0.05, theta_w_deg_s=3.0))
    np.testing.assert_array_equal(made["mine"].heading, expected.heading)
    assert np.abs(made["hdr"].heading - expected.heading).max() > 0
    assert made["mine"].meta["method"] == "mine"
    assert made["mine"].meta["params"]["theta_w"] == pytest.approx(3 * DEG)


@pytest.mark.parametrize(("name", "key"), [("iez", "sigma_velocity"), ("iez-paper", "sigma_velocity")])
def test_a_filter_has_its_settings_for_parameters(reckoning, name, key):
    method = METHODS[name].with_params({key: 0.3})
    assert method.track(reckoning).meta["filter"][key] == 0.3


@pytest.mark.parametrize("name", ["hde-2010", "hde", "ihde", "ihde-jimenez", "ihde-plus"])
def test_directions_of_its_own_go_before_those_that_it_is_told(reckoning, name):
    method = METHODS[name]

    def used(method, **told):
        given = Reckoning(reckoning.recording, reckoning.start, **told)
        directions = method.track(given).meta["params"]["directions"]
        return directions["count"], directions["reference"]

    own = method.with_params({"directions.count": 8, "directions.reference_deg": 10.0})
    told = {"directions": type(UNTOLD)(2, 0.7)}
    assert used(own, **told) == (8, 10 * DEG)
    assert used(method, **told) == (2, 0.7)
    assert used(method) == (4, pytest.approx(reckoning.setting_out))


def test_learned_directions_are_as_many_as_told_and_never_told(reckoning):
    told = Reckoning(reckoning.recording, directions=type(UNTOLD)(8, 0.7))
    directions = METHODS["ihde-learned"].track(told).meta["params"]["directions"]
    assert (directions["count"], directions["reference"]) == (8, None)


def test_what_a_method_refuses_is_told():
    with pytest.raises(InputError, match=r"^theta_w_deg_s = -1: expected a positive number$"):
        METHODS["hdr"].with_params({"theta_w_deg_s": -1})
    with pytest.raises(InputError, match=r"^theta: unknown; did you mean theta_w_deg_s\?"):
        METHODS["hdr"].with_params({"theta": 1})
    with pytest.raises(InputError, match=r"^gain: unknown; there is nothing to set$"):
        METHODS["pdr"].with_params({"gain": 1})


def test_parameters_without_types_are_taken_as_they_are():
    method = Method("mine", "", METHODS["pdr"].run, {"window": 7})
    assert method.with_params({"gain": "high"}).params == {"window": 7, "gain": "high"}
    assert method.params == {"window": 7}


@pytest.mark.parametrize("name", ["", "a b", "a.b", "a/b", "a=b"])
def test_a_name_is_one_for_files_and_addresses(name):
    with pytest.raises(InputError, match="expected letters, digits, - and _"):
        METHODS["pdr"].renamed(name)


def test_a_method_is_found_by_name_or_as_it_is():
    assert find_method("hdr") is METHODS["hdr"]
    mine = METHODS["hdr"].renamed("mine-2_b")
    assert find_method(mine) is mine


def test_built_in_methods_on_footfalls_ask_for_no_samples(reckoning):
    """A recording too long to be held has footfalls alone."""

    class Streamed(Reckoning):
        @property
        def recording(self):
            raise AssertionError("asked for samples")

        @recording.setter
        def recording(self, _):
            pass

    class Footless(Streamed):
        footfalls = reckoning.footfalls

    for name, method in METHODS.items():
        given = object.__new__(Footless)
        vars(given).update(start=reckoning.start, pdr=reckoning.pdr, directions=UNTOLD, guided=None)
        if method.needs == "footfalls":
            assert len(method.track(given)) == len(reckoning.footfalls), name
        else:
            with pytest.raises((AssertionError, AttributeError)):
                method.track(given)
