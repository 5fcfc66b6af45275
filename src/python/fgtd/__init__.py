"""Sums of Gaussians and of their derivatives, to a promised accuracy, in linear time.

    s(y) = sum over j of  weights[j] exp(-sigma |y - sources[j]|^2)

in 1, 2, 3 or 4 dimensions, at points or on a tensor grid; and densities that are estimated from points.

>>> import numpy as np, fgtd
>>> points = np.random.default_rng(1).random((2000, 2))     # a row is a point
>>> sums = fgtd.transform(points, np.ones(2000), sigma=50, tolerance=1e-8)
>>> pairs = np.exp(-50 * ((points[0] - points) ** 2).sum(axis=1)).sum()
>>> bool(abs(sums[0] - pairs) <= 1e-8 * 2000)
True

Arrays of float64 whose rows are contiguous are read where they are, whatever lies between the rows. Others are copied
once: columns-first (Fortran) order, other types. Results own their memory. Other threads run during long calls, and
Ctrl-C ends these. docs/fgtd.md has the methods, the promise and the costs.
"""
from ._plan import (Choice, Error, Grid, InvalidArgument, MemoryLimitError, Plan, TimeLimitError, ToleranceError,
                    smallest_tolerance, transform)
from .density import bandwidth_matrix, density_estimate

__all__ = ["Choice", "Error", "Grid", "InvalidArgument", "MemoryLimitError", "Plan", "TimeLimitError", "ToleranceError",
           "bandwidth_matrix", "density_estimate", "smallest_tolerance", "transform"]
for _name in __all__:  # whatever file of the package they are written in
    if hasattr(globals()[_name], "__module__"):
        globals()[_name].__module__ = __name__
