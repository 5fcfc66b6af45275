#!/usr/bin/python3
"""Writes scipy-sphere-paths.csv: where particles go in a wind on longitudes and latitudes, by SciPy.

The wind is known every 15 degrees of longitude from 0 to 345, in metres per second; here it is continued by hand. Linear:
RegularGridInterpolator. Cubic: tensor products of CubicHermiteSpline with the slopes of numpy.gradient. The paths: DOP853 of
dx/dt = u / (R cos y), dy/dt = v / R, in degrees and days. tests/input/scipy_sphere_paths_test.cpp has the same wind.
Debian: apt-get install python3-numpy python3-scipy; then: /usr/bin/python3 tests/reference/scipy-sphere-paths.py
"""
import pathlib

import numpy
import scipy
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicHermiteSpline, RegularGridInterpolator

radius = 6371000.0
x = numpy.arange(-450.0, 451.0, 15.0)
y = numpy.arange(-75.0, 76.0, 7.5)
t = numpy.array([0.0, 2.0, 4.0, 7.0, 10.0])
T, Y, X = numpy.meshgrid(t, y, x, indexing="ij")
along, up = numpy.radians(X), numpy.radians(Y)
u = 20 * numpy.cos(up) * (1.5 + numpy.sin(2 * along + 0.3 * T))
v = 12 * numpy.cos(up) * numpy.cos(along - 0.2 * T)


def linear():
    parts = [RegularGridInterpolator((t, y, x), values) for values in (u, v)]
    return lambda time, place: [part((min(time, t[-1]), place[1], place[0])).item() for part in parts]


def cubic():
    def along_axis(axis, values, at):
        slopes = numpy.gradient(values, axis, axis=0, edge_order=2)
        return CubicHermiteSpline(axis, values, slopes, axis=0)(at)

    def near(axis, at):  # a few points around, with the same slopes in their middle
        cell = int(numpy.clip(numpy.searchsorted(axis, at, side="right") - 1, 0, len(axis) - 2))
        return slice(max(0, cell - 2), min(len(axis), cell + 4))

    def velocity(time, place):
        rows, columns = near(y, place[1]), near(x, place[0])
        return [
            along_axis(x[columns], along_axis(y[rows], along_axis(t, values[:, rows, columns], time), place[1]), place[0])
            for values in (u, v)
        ]

    return velocity


def rate_of(velocity):
    def rate(time, place):
        east, north = velocity(time, place)
        metres_a_degree = radius * numpy.pi / 180
        return [86400 * east / (metres_a_degree * numpy.cos(numpy.radians(place[1]))), 86400 * north / metres_a_degree]

    return rate


end = 10.0
lines = [f"# by SciPy {scipy.__version__}, tests/reference/scipy-sphere-paths.py: x0, y0 at t = 0; x, y at t = {end:g} days",
         "interpolation,x0,y0,x,y"]
for name, velocity, longest in (("linear", linear(), 0.004), ("cubic", cubic(), 0.02)):
    for start in ((170.0, 10.0), (-20.0, 40.0), (100.0, -55.0)):
        path = solve_ivp(rate_of(velocity), (0, end), start, method="DOP853", rtol=1e-12, atol=1e-12, max_step=longest)
        assert path.success
        lines.append(f"{name},{start[0]},{start[1]},{path.y[0, -1]:.15g},{path.y[1, -1]:.15g}")
pathlib.Path(__file__).with_name("scipy-sphere-paths.csv").write_text("\n".join(lines) + "\n")
