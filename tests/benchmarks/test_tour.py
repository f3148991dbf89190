"""The tour of benchmarks.validation: it tells what failed, its method is one, its steps are all there."""

import numpy as np

from benchmarks.validation.tour import METHOD, SCENARIO, STEPS, tour
from footfall.pdr.reckoning import StartPose
from footfall.scenarios.scenario import stock_scenarios
from tests.helpers.synthetic_foot import footfalls


def test_it_ends_with_the_first_step_that_fails():
    found = tour(("footfall --version", "footfall lst", "footfall list"))
    assert [one.code for one in found] == [0, 2]
    assert "lst" in found[-1].said
    assert all(one.seconds > 0 and one.processor_s > 0 for one in found)


def test_its_method_goes_four_ways():
    names = {"__name__": "method"}
    exec(METHOD, names)
    falls = footfalls(np.radians([1.0, 2.0, 75.0, 9.0]), interval=1.0)
    made = names["four_ways"](falls, StartPose())
    np.testing.assert_allclose(np.degrees(made.heading), [0, 0, 0, 90, 90])
    np.testing.assert_allclose(made.position[1, 1], 0.0, atol=1e-12)


def test_it_takes_what_it_promises():
    commands = [step.split()[1] for step in STEPS]
    simulated = ["list", "run", "walk", "record", "track", "score", "render"]
    assert commands == [*simulated, "sample", "track", "score", "method.py"]
    assert SCENARIO in stock_scenarios()
