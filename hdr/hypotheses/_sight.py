"""Compiled: what the filter is shown of each footfall. Explained in docs/hypotheses.md.

The course is told from the heading at the start on. It is unwrapped beside the heading, from which it may
differ by any angle: that of the mount.
Of the 27 loads only the few directions are shown in which they leave rest on this walk, learned on the way.
"""

from __future__ import annotations

import math

import numpy as np

from footfall.compiled import kernel

DIRECTIONS = 4  # of loads that are told apart
LEARN = 6  # strides before the first is known
MEMORY = 8.0  # strides over which loads are averaged
NEW = 1.4e-4  # rad/s, of drift that known directions do not explain: a new one

# A row of sight.
INTERVAL, ACTIVE, MOVING, DISTANCE, COURSE, WARMTH, TOLD, REST, REST_RATE, REST_WARMTH = range(10)
LOAD = 10  # DIRECTIONS columns: rate that a load of one standard deviation makes
JUMP = LOAD + DIRECTIONS  # angle that it made before it was known
SIGHT = JUMP + DIRECTIONS

# Of the memory: sums of the angle between course and heading; strides counted; directions known
COSINE, SINE, STRIDES, KNOWN, LAST_X, LAST_Y, LAST_HEADING, WARM_START, SEEN, FIRST_HEADING = range(10)
MEMORIES = 10
# Hypotheses are dropped by their weights, which hands on every bit: courses are rounded to a nanoradian, so
# that the way in which a walk sets out, and another machine's last bits, change nothing.
NANO = 1e9


@kernel()
def sight(given, loads, numbers, mean, turned, basis, load_sd, shortest, row):  # type: ignore[no-untyped-def]
    """Fill `row` from a footfall, whose numbers are those of `filter.Given`.

    numbers, mean (27) of loads, turned (27) by them so far and basis (4, 27) are remembered.
    """
    interval, x, y, heading, moving, warm, rest_s, rest_rate, rest_warm = given
    row[:] = 0.0
    if numbers[SEEN] == 0.0:
        numbers[SEEN], numbers[WARM_START] = 1.0, warm
        numbers[LAST_X], numbers[LAST_Y], numbers[LAST_HEADING] = x, y, heading
        numbers[FIRST_HEADING] = heading
        return
    dx, dy = x - numbers[LAST_X], y - numbers[LAST_Y]
    middle = 0.5 * (heading + numbers[LAST_HEADING])
    numbers[LAST_X], numbers[LAST_Y], numbers[LAST_HEADING] = x, y, heading
    distance = np.rint(math.sqrt(dx * dx + dy * dy) * NANO) / NANO
    active = max(interval - rest_s, 1e-3)  # s, less what a rest tells of the drift
    row[INTERVAL], row[ACTIVE], row[MOVING], row[DISTANCE] = interval, active, moving, distance
    if distance >= shortest:
        beside = math.atan2(dy, dx) - middle
        beside -= 2.0 * math.pi * math.floor(beside / (2.0 * math.pi) + 0.5)
        usual = math.atan2(numbers[SINE], numbers[COSINE]) if numbers[STRIDES] > 0.0 else beside
        off = beside - usual
        off -= 2.0 * math.pi * math.floor(off / (2.0 * math.pi) + 0.5)
        row[COURSE] = np.rint((middle - numbers[FIRST_HEADING] + usual + off) * NANO) / NANO
        numbers[COSINE] += math.cos(beside)
        numbers[SINE] += math.sin(beside)
    told = not math.isnan(warm - numbers[WARM_START])
    row[TOLD] = 1.0 if told else 0.0
    row[WARMTH] = warm - numbers[WARM_START] if told else 0.0
    row[REST], row[REST_RATE] = rest_s, rest_rate
    row[REST_WARMTH] = rest_warm - numbers[WARM_START] if told and rest_s > 0.0 else 0.0
    scaled = loads * load_sd
    known = int(numbers[KNOWN])
    walked = distance >= shortest and rest_s == 0.0
    if walked:
        numbers[STRIDES] += 1.0
        weight = max(1.0 / numbers[STRIDES], 1.0 / MEMORY)
        for j in range(27):
            mean[j] += weight * (scaled[j] - mean[j])
    if walked and numbers[STRIDES] >= LEARN and known < DIRECTIONS:
        left = mean.copy()
        for k in range(known):
            along = 0.0
            for j in range(27):
                along += left[j] * basis[k, j]
            for j in range(27):
                left[j] -= along * basis[k, j]
        length = math.sqrt((left * left).sum())
        if length > NEW:
            jump = 0.0
            for j in range(27):
                basis[known, j] = left[j] / length
                jump += turned[j] * basis[known, j]
            row[JUMP + known] = jump
            known += 1
            numbers[KNOWN] = known
    for j in range(27):
        turned[j] += interval * scaled[j]
    for k in range(known):
        rate = 0.0
        for j in range(27):
            rate += scaled[j] * basis[k, j]
        row[LOAD + k] = rate * interval / active


@kernel()
def remembered():  # type: ignore[no-untyped-def]
    """What `sight` remembers, empty."""
    return np.zeros(MEMORIES), np.zeros(27), np.zeros(27), np.zeros((DIRECTIONS, 27))


@kernel()
def sights(given, loads, load_sd, shortest):  # type: ignore[no-untyped-def]
    """Rows (n, SIGHT) of a whole walk from given (n, 9) and loads (n, 27)."""
    numbers, mean, turned, basis = remembered()
    rows = np.zeros((len(given), SIGHT))
    for i in range(len(given)):
        sight(given[i], loads[i], numbers, mean, turned, basis, load_sd, shortest, rows[i])
    return rows
