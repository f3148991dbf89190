"""
When the foot is at rest
========================

Dead reckoning of a foot depends on the moments at which the foot stands, because its speed is zero there.
This foot is synthetic. Recordings of real feet work in the same way.
"""

import matplotlib.pyplot as plt
import numpy as np

from footfall.pdr.reckoning import PdrParams, detect
from footfall.pdr.synthetic import walk

plt.style.use("footfall.footfall")

foot = walk(np.zeros(40))  # the headings of 40 footfalls: straight ahead
recording = foot.recording(angle_random_walk=np.radians(0.1) / 60, seed=1)
found = detect(recording, PdrParams())

# %%
# A detector scores every sample; below 1 the foot is at rest. Each stance gives one instant of zero velocity.

resets = recording.t[found.stances.resets]
rate = np.degrees(np.linalg.norm(recording.gyro, axis=1))
figure, (above, below) = plt.subplots(2, figsize=(7, 4.5), sharex=True)
above.plot(recording.t, rate, color="#444f9b")
above.set(ylabel="rate of the foot (deg/s)")
below.semilogy(recording.t, found.score, color="#444f9b")
below.axhline(1.0, color="#222222", linestyle="--", label="at rest below this")
below.set(xlabel="time (s)", ylabel="detector's score", xlim=(24, 33))
for axis in (above, below):
    for instant in resets:
        axis.axvline(instant, color="#c1440e", alpha=0.5)
below.legend()
plt.show()
