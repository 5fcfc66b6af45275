#!/usr/bin/python3
"""Writes scipy-paths.csv: where particles go in a velocity on a grid, by SciPy.

Linear: RegularGridInterpolator. Cubic: tensor products of CubicHermiteSpline with the slopes of numpy.gradient, which are
those of parabolas. The paths: DOP853. tests/input/scipy_paths_test.cpp has the same velocity and compares.
Debian: apt-get install python3-numpy python3-scipy; then: /usr/bin/python3 tests/reference/scipy-paths.py
"""
import pathlib

import numpy
import scipy
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicHermiteSpline, RegularGridInterpolator

x = numpy.array([2.0 * (i / 12 + 0.02 * (i % 3)) / 1.04 for i in range(13)])
y = numpy.array([j / 8 for j in range(9)])
t = numpy.array([0.0, 0.5, 1.0, 1.75, 2.0, 3.0])
T, Y, X = numpy.meshgrid(t, y, x, indexing="ij")
phase = X + 0.1 * numpy.sin(2 * T)
u = -numpy.sin(numpy.pi * phase) * numpy.cos(numpy.pi * Y)
v = numpy.cos(numpy.pi * phase) * numpy.sin(numpy.pi * Y)


def linear():
    parts = [RegularGridInterpolator((t, y, x), values) for values in (u, v)]
    return lambda time, place: [part((min(time, t[-1]), place[1], place[0])).item() for part in parts]


def cubic():
    def along(axis, values, at):
        slopes = numpy.gradient(values, axis, axis=0, edge_order=2)
        return CubicHermiteSpline(axis, values, slopes, axis=0)(at)

    def velocity(time, place):
        return [along(x, along(y, along(t, values, time), place[1]), place[0]) for values in (u, v)]

    return velocity


end = 3.0
lines = [f"# by SciPy {scipy.__version__}, tests/reference/scipy-paths.py: x0, y0 at t = 0; x, y at t = {end:g}",
         "interpolation,x0,y0,x,y"]
for name, velocity, longest in (("linear", linear(), 0.002), ("cubic", cubic(), 0.01)):
    for start in ((0.3, 0.4), (0.75, 0.2), (1.1, 0.6), (1.5, 0.5), (1.8, 0.85)):
        path = solve_ivp(velocity, (0, end), start, method="DOP853", rtol=1e-12, atol=1e-13, max_step=longest)
        assert path.success
        lines.append(f"{name},{start[0]},{start[1]},{path.y[0, -1]:.15g},{path.y[1, -1]:.15g}")
pathlib.Path(__file__).with_name("scipy-paths.csv").write_text("\n".join(lines) + "\n")
