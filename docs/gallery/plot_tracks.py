"""
Where three methods end
=======================

One walk round a block with one unit of the HDR paper's IMU, navigated without correction, with HDR and with
IHDE. HDR corrects on long straights, but here a corner comes every forty metres or so.
"""

import matplotlib.pyplot as plt

from footfall.scenarios.judge.score import compare
from footfall.scenarios.parameters import documents
from footfall.scenarios.report.style import colours_of, label_of
from footfall.scenarios.trial import Trial, perform, walk_of

plt.style.use("footfall.footfall")

METHODS = ["pdr", "hdr", "ihde"]

# %%
# A trial is one walk, one unit of an IMU and its noise, each by its seed. Walks are kept in a cache.

setup = documents("block", methods=METHODS).setup()
trial = Trial(setup, number=0, walk_seed=1, unit_seed=7, noise_seed=7)
walk = walk_of(trial)
outcome = perform(trial, walk, keep=True)
for row in outcome.rows:
    print(f"{row.method:5s} final heading error {row.require().heading_error_final_deg:5.1f} deg")

# %%
# Tracks and truth are compared in the world's coordinates; nothing is fitted.

figure, axis = plt.subplots(figsize=(7, 5))
for method, colour in colours_of(METHODS).items():
    beside = compare(outcome.kept.tracks[method], walk)
    axis.plot(*beside.estimate.T, color=colour, label=label_of(method))
    axis.plot(*beside.estimate[-1], "o", color=colour)
axis.plot(*beside.truth.T, color="#222222", linewidth=1, linestyle="--", label="truth")
axis.plot(*beside.truth[0], "^", color="#222222", markersize=9, label="start")
axis.set(xlabel="x (m)", ylabel="y (m)", aspect="equal")
axis.legend()
plt.show()
