"""
Which error of the sensor turned the heading
============================================

Only a simulation knows this. Footfall splits the drift of every stride among the effects of the data sheet.
The heading errors of the causes add up to the total heading error.
"""

import matplotlib.pyplot as plt
import numpy as np

from footfall.scenarios.parameters import documents
from footfall.scenarios.trial import Trial, perform, walk_of

plt.style.use("footfall.footfall")

setup = documents("block", methods=["pdr"]).setup()
trial = Trial(setup, number=0, walk_seed=1, unit_seed=7, noise_seed=7)
budget = perform(trial, walk_of(trial), keep=True).kept.budget


def along_the_walk(drift):
    """Heading error (deg) that a drift (rad/s) of each stride has made until its end."""
    return np.degrees(np.cumsum(drift * budget.interval))


# %%
# The largest causes by what they made at any time.

turned = {name: along_the_walk(drift) for name, drift in budget.causes.items()}
largest = sorted(turned, key=lambda name: -np.abs(turned[name]).max())[:5]

figure, axis = plt.subplots(figsize=(7, 4))
for name in largest:
    axis.plot(budget.t, turned[name], label=name.replace("_", " "))
axis.plot(budget.t, along_the_walk(budget.total), color="#222222", linewidth=2, label="all")
axis.set(xlabel="time (s)", ylabel="heading error (deg)")
axis.legend(ncols=2)
plt.show()
