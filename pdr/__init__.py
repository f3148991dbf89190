"""Dead reckoning: detectors, ZUPT and the inertial filters."""
