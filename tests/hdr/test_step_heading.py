"""The heading of a step: yaw, course, both, and the toe-out that a walk shows."""

import math

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from footfall.conventions import wrap
from footfall.errors import InputError
from footfall.hdr.hde import HdeParams
from footfall.hdr.ihde import IhdeParams
from footfall.hdr.ihde_plus import IhdePlusParams
from footfall.hdr.jimenez import JimenezParams
from footfall.hdr.step_heading import StepHeadings
from tests.helpers.walked_steps import DEG, T, walked

ANY = st.floats(-180, 180)


def headings(source, steps, memory=1):
    made = StepHeadings(source, memory)
    return made, [made(step) for step in steps]


@given(ANY, st.floats(-25, 25))
def test_the_three_headings_of_a_straight(course, toe_out):
    """The yaw is the foot's; course and both are the way's, whatever the foot's angle."""
    steps = walked(np.full(12, course * DEG), toe_out * DEG)
    for source, expected in (("yaw", course + toe_out), ("course", course), ("both", course)):
        _, found = headings(source, steps)
        assert wrap(np.array(found) - expected * DEG) == pytest.approx(0, abs=1e-9)


@given(ANY, st.floats(-179, 179), st.floats(-3, 3), st.floats(-0.5, 0.5))
@example(0.0, 0.0, 2.2e-309, 0.0)
def test_a_toe_out_of_any_angle_is_learned_in_curves_and_under_drift(course, toe_out, turn, drift):
    """Turning by `turn` deg a step while the heading runs away by `drift` deg a step."""
    steps = walked((course + turn * np.arange(15)) * DEG, toe_out * DEG, drift=drift * DEG)
    made, _ = headings("both", steps)
    assert float(wrap(made.toe_out - toe_out * DEG)) == pytest.approx(0, abs=1e-6)


def test_both_is_half_way_between_course_and_foot():
    """The last foot lands 4 deg beside its habit: so much of it counts."""
    yaw_off = np.zeros(40)
    yaw_off[-1] = 4 * DEG
    made, found = headings("both", walked(np.zeros(40), 8 * DEG, yaw_off=yaw_off))
    assert found[-1] == pytest.approx((0 + 8 + 4 - made.toe_out / DEG) / 2 * DEG)
    assert found[-1] == pytest.approx(2 * DEG, abs=0.05 * DEG)


def test_the_toe_out_is_told_by_three_long_strides():
    made = StepHeadings("both")
    for k, step in enumerate(walked(np.zeros(8), 5 * DEG, length=0.65)):
        assert made.toe_out is None, k
        made(step)
    for k, step in enumerate(walked(np.zeros(4), 5 * DEG, length=0.75)):
        made(step)
        assert (made.toe_out is None) == (k < 2)


def test_a_step_on_the_spot_has_no_course():
    assert headings("course", walked(np.zeros(1), length=0.25))[1] == [None]
    assert headings("yaw", walked(np.zeros(1), 5 * DEG, length=0.25))[1] == [pytest.approx(5 * DEG)]
    assert headings("course", walked(np.zeros(1), length=0.35))[1] == [0.0]


@given(st.lists(st.floats(-170, 170), min_size=1, max_size=20))
def test_courses_go_on_through_the_turns_of_the_circle(turns):
    course = np.cumsum(turns) * DEG
    _, found = headings("course", walked(course))
    assert np.diff(found) == pytest.approx(np.diff(course), abs=1e-9)


@pytest.mark.parametrize("source", ["yaw", "course", "both"])
def test_what_is_remembered_turns_with_the_filter(source):
    """Turned by 10 deg after six of twelve steps, it knows and says the same as if it had been so always."""
    steps, turned = walked(np.zeros(12), 7 * DEG), walked(np.full(12, 10 * DEG), 7 * DEG)
    made, always = StepHeadings(source, 5), StepHeadings(source, 5)
    for step in steps[:6]:
        made(step)
    made.applied(10 * DEG)
    for step in turned[:6]:
        always(step)
    assert list(made.recent) == pytest.approx(list(always.recent))
    assert [made(step) for step in turned[6:]] == pytest.approx([always(step) for step in turned[6:]])
    if source != "yaw":
        assert made.toe_out == pytest.approx(7 * DEG)


def test_it_remembers_as_many_as_it_is_asked_to():
    made, found = headings("course", walked(np.arange(9) * DEG), memory=4)
    assert list(made.recent) == found[-4:]


@pytest.mark.parametrize("params", [HdeParams, IhdeParams, JimenezParams, IhdePlusParams])
def test_another_heading_is_refused(params):
    with pytest.raises(InputError, match=r"heading = 'foot', expected \"yaw\", \"course\" or \"both\""):
        params(heading="foot")
    assert params(heading="both").heading == "both"


def test_steps_of_these_tests_are_what_they_say():
    steps = walked([0.0, math.pi / 2], 0.1)
    assert [step.t for step in steps] == pytest.approx([T, 2 * T])
    np.testing.assert_allclose(steps[1].position, [1.4, 1.4, 0], atol=1e-12)
