#!/usr/bin/python3
"""Measures fgtd.density_estimate and scipy.stats.gaussian_kde on the same points: a row of the table in docs/python.md each.

  PYTHONPATH=build/release/python tools/bench/scipy_density.py [MOST [MOST_OF_SCIPY]]

Points 10^3, 10^4, ... up to MOST (10^6), normal, with Scott's bandwidth, evaluated at the points. SciPy sums all pairs, so beyond
MOST_OF_SCIPY (10^4) its time is that of the largest run times the square of the number of points. Seconds are those of the
processor, all threads together, so that other programs on the machine disturb little.
"""
import sys
import time

import numpy as np
from scipy import stats

import fgtd

most, most_of_scipy = (int(float(word)) for word in (*sys.argv[1:], 1e6, 1e4)[:2])


def seconds(work):
    start = time.process_time()
    result = work()
    return time.process_time() - start, result


print("| d | points | fgtd, s | SciPy, s | SciPy / fgtd | difference / peak |\n|---|---|---|---|---|---|")
for dimension in (1, 2, 3):
    count, last = 1000, (0.0, 0)
    while count <= most:
        points = np.random.default_rng(1).standard_normal((count, dimension))
        ours, density = seconds(lambda: fgtd.density_estimate(points, tolerance=1e-9))
        if count <= most_of_scipy:
            estimate = stats.gaussian_kde(points.T)
            theirs, exact = seconds(lambda: estimate(points.T))
            peak = 1 / np.sqrt(np.linalg.det(2 * np.pi * estimate.covariance))
            last, mark, difference = (theirs, count), "", f"{np.abs(density - exact).max() / peak:.1e}"
        else:
            theirs, mark, difference = last[0] * (count / last[1]) ** 2, "about ", "-"
        print(f"| {dimension} | {count} | {ours:.3g} | {mark}{theirs:.3g} | {theirs / ours:.3g} | {difference} |", flush=True)
        count *= 10
