"""
How long to rest before a walk
==============================

The Allan deviation of a gyro at rest falls while averaging removes white noise, and stops falling where the
bias wanders. It does not help to average for longer than that. The HDR paper calls this time T_bias.
"""

import matplotlib.pyplot as plt
import numpy as np

from footfall.models.imu import draw_unit, load_spec
from footfall.pdr.allan import allan_deviation, suggest_bias_time
from footfall.scenarios.report.allan import resting_recording

plt.style.use("footfall.footfall")

figure, axis = plt.subplots(figsize=(7, 4))
for name, colour in (("nimu", "#c1440e"), ("mtig710", "#1f6fb4")):
    resting = resting_recording(draw_unit(load_spec(name), seed=1), seconds=1200.0, seed=1, rate_hz=100.0)
    seconds = np.geomspace(0.1, resting.t[-1] / 9, 40)
    deviation = np.sqrt(np.mean(allan_deviation(resting.gyro, resting.interval, seconds) ** 2, axis=1))
    axis.loglog(seconds, np.degrees(deviation) * 3600, color=colour, label=name)
    suggested = suggest_bias_time(resting.gyro, resting.interval)
    axis.axvline(suggested, color=colour, linestyle=":", label=f"{name}: rest for {suggested:.0f} s")
axis.set(xlabel="averaging time (s)", ylabel="Allan deviation (deg/h)")
axis.legend()
plt.show()
