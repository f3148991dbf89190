"""
A method of three lines, scored
===============================

This method knows that the way round the block turns by 270 degrees. It takes every further change of heading
for drift, and spreads it evenly over the walk. HDR does not know the path.
"""

import matplotlib.pyplot as plt
import numpy as np

import footfall
from footfall.hdr.correct import turned_positions

plt.style.use("footfall.footfall")


def comes_back(footfalls, start):
    """The heading, less what it gained beyond the three corners of the block."""
    gained = footfalls.heading[-1] - footfalls.heading[0] - np.radians(270)
    heading = footfalls.heading - gained * (footfalls.t - footfalls.t[0]) / np.ptp(footfalls.t)
    return footfall.Track(footfalls.t, turned_positions(footfalls, heading), heading)


comes_back.needs = "footfalls"

# %%
# The same walk, heard by ten units of the IMU.

rows = footfall.evaluate(["pdr", "hdr", comes_back], "block", units=10, workers=1)
print(rows)

# %%
# One point a unit: below the line the method did better than no correction.

figure, axis = plt.subplots(figsize=(5.5, 5))
bare = rows.of("pdr").values("heading_error_mean_deg")
for method, colour in (("hdr", "#1f6fb4"), ("comes_back", "#6a9f3a")):
    axis.plot(bare, rows.of(method).values("heading_error_mean_deg"), "o", color=colour, label=method)
axis.axline((0, 0), slope=1, color="#222222", linestyle="--", linewidth=1)
axis.set(xlabel="without correction (deg)", ylabel="with the method (deg)", title="Mean heading error")
axis.legend()
plt.show()
