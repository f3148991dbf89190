"""The compiled beam and smoother against the same in matrices."""

from dataclasses import replace

import numpy as np
import pytest

from footfall.hdr.hypotheses import _beam, _plain, _smooth
from footfall.hdr.hypotheses._linear import (
    ALIGNED,
    CURVE,
    DRIFT,
    GENTLE,
    PATH,
    REFERENCE,
    STATES,
    STAYS,
    STRAIGHT,
    TURN,
)
from footfall.hdr.hypotheses._sight import COURSE, DISTANCE, JUMP, LOAD, REST, REST_RATE, SIGHT
from footfall.hdr.hypotheses.filter import rows_of
from footfall.hdr.hypotheses.params import HypothesesParams
from tests.hdr.test_hypotheses import varied
from tests.helpers.drifting_feet import DEG

PARAMS = HypothesesParams(hypotheses=32)


@pytest.fixture(scope="module")
def rows():
    return rows_of(varied(), PARAMS.constants)


def test_the_rows_hold_everything_that_there_is(rows):
    """Or the comparison would say little."""
    assert (rows[1:, DISTANCE] < PARAMS.shortest_m).sum() == 1
    assert (rows[:, REST] > 0).sum() == 1
    assert (rows[:, JUMP:SIGHT] != 0).any(axis=1).sum() >= 2
    assert (rows[-1, LOAD:JUMP] != 0).sum() >= 2


@pytest.mark.parametrize("reference", [None, 100 * DEG], ids=["learned", "known"])
def test_the_beam_equals_its_twin(rows, reference):
    c = replace(PARAMS, reference=reference).constants
    told, history, _ = _beam.beam(rows, c, True)
    twin = _plain.PlainBeam(c)
    for i in range(1, len(rows)):
        twin.step(rows[i])
        plain = twin.told
        expected = [plain["mean"], plain["sd"], *plain["chances"], plain["rate"], plain["second"]]
        expected += [plain["second_weight"], plain["evidence"]]
        np.testing.assert_allclose(told[i], expected, rtol=1e-8, atol=1e-9, err_msg=str(i))
        labels = [[o.mode, o.habit, o.scale, o.world, o.entry, o.parent, o.goes_on] for o in twin.found]
        assert history[i, : len(labels)].tolist() == labels


def test_the_smoother_equals_rauch_tung_striebel(rows):
    c = PARAMS.constants
    n = len(rows)
    modes, entries, habits = np.zeros(n, dtype=int), np.zeros(n, dtype=int), np.zeros(n, dtype=int)
    modes[20:22], modes[45:70], entries[45], habits[22:] = TURN, CURVE, GENTLE, 2
    modes[10:15] = CURVE
    entries[22] = entries[70] = ALIGNED
    drift, variance = _smooth.smooth(rows, c, modes, habits, entries, c.scales[0], CURVE, 1, False)

    before = _plain.first(c, rows[1, COURSE])
    start = next(o for o in before if (o.mode, o.habit, o.scale) == (CURVE, 1, 0))
    mean, cov, steps, last = start.mean, start.cov, [], 0.0
    for i in range(1, n):
        F, Q, told = _plain.drift_model(rows[i], c.scales[0], c)
        steps.append((mean, cov, F, F @ mean + told, F @ cov @ F.T + Q))
        mean, cov = steps[-1][3:]
        if rows[i, REST] > 0:
            noise = (c.scales[0] * c.random_walk) ** 2 / rows[i, REST]
            mean, cov, _ = _plain.updated(mean, cov, _plain.rest_row(rows[i]), rows[i, REST_RATE], noise)
        F, Q = _plain.age_model(rows[i], habits[i - 1] if i > 1 else 1, c.scales[0], c)
        steps.append((mean, cov, F, F @ mean, F @ cov @ F.T + Q))
        mean, cov = steps[-1][3:]
        good = rows[i, DISTANCE] >= c.shortest_m
        G, R = np.eye(STATES), np.zeros((STATES, STATES))
        if good:
            length = 0.5 * (rows[i, DISTANCE] + (last or rows[i, DISTANCE]))
            G, R = _plain.mode_model(modes[i], entries[i], habits[i], length, c)
            last = rows[i, DISTANCE]
        steps.append((mean, cov, G, G @ mean, G @ cov @ G.T + R))
        mean, cov = steps[-1][3:]
        if good:
            seen = _plain.course_seen(rows[i])
            mean, cov, _ = _plain.updated(mean, cov, _plain.course_row(rows[i]), seen, c.course**2)
        if entries[i] == ALIGNED:
            sector = 2 * np.pi / c.directions
            along = sector * np.round((mean[PATH] - mean[REFERENCE]) / sector)
            mean, cov, _ = _plain.updated(mean, cov, _plain.along_row(), along, c.beside**2)
    found = [(mean[DRIFT], cov[DRIFT, DRIFT])]
    for k in range(len(steps) - 1, 0, -1):
        m, p, F, pm, pp = steps[k]
        gain = p @ F.T @ np.linalg.pinv(pp, rcond=1e-14, hermitian=True)
        mean, cov = m + gain @ (mean - pm), p + gain @ (cov - pp) @ gain.T
        if k % 3 == 0:
            found.append((mean[DRIFT], cov[DRIFT, DRIFT]))
    expected = np.array(found[::-1])
    np.testing.assert_allclose(drift[1:], expected[:, 0], rtol=1e-5, atol=1e-7)
    np.testing.assert_allclose(variance[1:], expected[:, 1], rtol=1e-4, atol=1e-10)
    assert STRAIGHT == STAYS == 0  # what the zeros above stand for
