"""A mistake carries its culprit as a field, through every caller and from process to process."""

import pickle
from pathlib import Path

import numpy as np
import pytest

from footfall.errors import InputError
from footfall.recording import Recording
from footfall.simulate.walking import FallError


def test_the_sentence_begins_with_the_subject():
    error = InputError("no such file", Path("walk.csv"))
    assert (str(error), error.subject, error.message) == (
        "walk.csv: no such file",
        "walk.csv",
        "no such file",
    )
    assert str(InputError("seed = -1: expected more")) == "seed = -1: expected more"


def test_a_stand_in_makes_way_and_any_other_subject_stays():
    error = InputError("2 samples, expected more", "recording")
    assert str(error.about(Path("a.csv"), "recording")) == "a.csv: 2 samples, expected more"
    assert str(error.about("a.csv", "track")) == "a.csv: recording: 2 samples, expected more"
    assert str(error.about("a.csv")) == "a.csv: recording: 2 samples, expected more"
    assert str(error) == "recording: 2 samples, expected more"


def test_a_subject_is_said_once():
    error = InputError("unknown key", "sensor").about("a.toml")
    assert str(error.about("a.toml")) == str(error) == "a.toml: sensor: unknown key"
    assert error.subject == "a.toml"


def test_a_message_that_begins_like_a_stand_in_is_left_alone():
    error = InputError("recording: is a strange name for a key")
    assert str(error.about("a.csv", "recording")) == "a.csv: recording: is a strange name for a key"


@pytest.mark.parametrize(
    "error", [InputError("empty", "a.csv"), InputError("empty"), FallError("fell", "stairs")]
)
def test_a_mistake_goes_from_process_to_process(error):
    again = pickle.loads(pickle.dumps(error))
    assert type(again) is type(error)
    assert (str(again), again.subject, again.message) == (str(error), error.subject, error.message)
    assert type(again.about("walk 3")) is type(error)


def test_what_is_wrong_with_a_recording_names_it_by_a_stand_in():
    with pytest.raises(InputError) as caught:
        Recording(t=np.zeros(1), gyro=np.zeros((1, 3)), accel=np.zeros((1, 3)))
    assert caught.value.subject == "recording"
