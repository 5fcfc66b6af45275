#!/usr/bin/env python3
"""What bench_interpolation does, with SciPy's RBFInterpolator (Debian: python3-scipy): processor seconds and errors."""
import time

import numpy as np
from scipy.interpolate import RBFInterpolator


def franke(points):
    x, y = 9 * points.T
    return (0.75 * np.exp(-((x - 2) ** 2 + (y - 2) ** 2) / 4) + 0.75 * np.exp(-((x + 1) ** 2) / 49 - (y + 1) / 10)
            + 0.5 * np.exp(-((x - 7) ** 2 + (y - 3) ** 2) / 4) - 0.2 * np.exp(-((x - 4) ** 2) - (y - 7) ** 2))


random = np.random.default_rng(1)
targets = random.random((10000, 2))
exact = franke(targets)
# All points together take memory and time that grow with their square and cube; beyond, SciPy has fits to neighbours.
for count, neighbours in ((1000, None), (4000, None), (10000, 50), (100000, 50)):
    points = random.random((count, 2))
    begun = time.process_time()
    fit = RBFInterpolator(points, franke(points), kernel="thin_plate_spline", neighbors=neighbours)
    fitted = time.process_time()
    errors = fit(targets) - exact
    print(f"{count} points, {neighbours or 'no'} neighbours: fit {fitted - begun:.3g} s, "
          f"evaluate {time.process_time() - fitted:.3g} s, rms error {np.sqrt(np.mean(errors ** 2)):.2e}")
