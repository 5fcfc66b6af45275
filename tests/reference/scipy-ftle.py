#!/usr/bin/python3
"""Writes scipy-ftle.csv: finite-time Lyapunov exponents of the double gyre and of a Bickley jet, by SciPy.

Twice at each place: from the ends of four paths that begin h to each side, as a run has them from its lattice, and from
the variational equations F' = grad u F. tests/effect/flow_map_test.cpp compares.
Debian: apt-get install python3-numpy python3-scipy; then: /usr/bin/python3 tests/reference/scipy-ftle.py
"""
import pathlib

import numpy
import scipy
from scipy.integrate import solve_ivp

end = 5.0
exact = dict(method="DOP853", rtol=1e-12, atol=1e-13)


def gyre(t, x, y):
    """The velocity and its gradient."""
    amplitude, sway, period = 0.1, 0.25, 10.0
    a = sway * numpy.sin(2 * numpy.pi * t / period)
    f, slope, bend = a * x * x + (1 - 2 * a) * x, 2 * a * x + 1 - 2 * a, 2 * a
    s, c = numpy.sin(numpy.pi * f), numpy.cos(numpy.pi * f)
    sy, cy = numpy.sin(numpy.pi * y), numpy.cos(numpy.pi * y)
    k = numpy.pi * amplitude
    u = numpy.array([-k * s * cy, k * c * sy * slope])
    gradient = numpy.array([[-k * numpy.pi * c * slope * cy, k * numpy.pi * s * sy],
                            [k * sy * (c * bend - numpy.pi * s * slope * slope), k * numpy.pi * c * slope * cy]])
    return u, gradient


def jet(t, x, y):
    """The same for cases/jet.toml: psi = U L tanh(y/L) - U L waves / cosh(y/L)^2."""
    speed, width, wave = 5.4138, 1.77, 2 * numpy.pi / 20
    modes = ((0.1, 2 * wave, 0.205 * speed), (0.3, 3 * wave, 0.461 * speed))
    waves, slope, bend = (sum(a * k**n * part(k * (x - c * t)) for a, k, c in modes)
                          for n, part in ((0, numpy.cos), (1, lambda z: -numpy.sin(z)), (2, lambda z: -numpy.cos(z))))
    th, sech2 = numpy.tanh(y / width), numpy.cosh(y / width)**-2
    scale = speed * width
    d1, d2 = -2 * th * sech2 / width, (4 * th * th * sech2 - 2 * sech2 * sech2) / width**2  # of sech2
    u = numpy.array([speed * sech2 - scale * waves * d1, scale * slope * sech2])
    cross = scale * slope * d1
    gradient = numpy.array([[-cross, speed * d1 - scale * waves * d2], [scale * bend * sech2, cross]])
    return u, gradient


def end_of_path(flow, x, y):
    path = solve_ivp(lambda t, z: flow(t, z[0], z[1])[0], (0, end), (x, y), **exact)
    assert path.success
    return path.y[:, -1]


def exponent(gradient):
    return numpy.log(numpy.linalg.svd(gradient, compute_uv=False)[0]) / end


def by_differences(flow, x, y, h):
    along = [(end_of_path(flow, x + dx, y + dy) - end_of_path(flow, x - dx, y - dy)) / (2 * h) for dx, dy in ((h, 0), (0, h))]
    return exponent(numpy.array(along).T)


def by_variations(flow, x, y):
    def rates(t, z):
        u, gradient = flow(t, z[0], z[1])
        return numpy.concatenate([u, (gradient @ z[2:].reshape(2, 2)).ravel()])

    path = solve_ivp(rates, (0, end), (x, y, 1, 0, 0, 1), **exact)
    assert path.success
    return exponent(path.y[2:, -1].reshape(2, 2))


lines = [f"# by SciPy {scipy.__version__}, tests/reference/scipy-ftle.py: from t = 0 to {end:g}; h = 0.05 in the gyre, 0.1 in the jet",
         "flow,x,y,differences,variations"]
for flow, h, places in (
        (gyre, 0.05, ((0.2, 0.3), (0.5, 0.5), (0.95, 0.4), (1.05, 0.6), (1.0, 0.15), (1.4, 0.8), (1.75, 0.5))),
        (jet, 0.1, ((2.0, 0.0), (5.0, 1.2), (9.1, -1.5), (12.0, 2.0), (15.5, -0.6), (0.0, 1.7), (19.9, -2.2)))):
    for x, y in places:
        lines.append(f"{flow.__name__},{x},{y},{by_differences(flow, x, y, h):.15g},{by_variations(flow, x, y):.15g}")
pathlib.Path(__file__).with_name("scipy-ftle.csv").write_text("\n".join(lines) + "\n")
