"""Sums of radial basis functions, and interpolation of scattered data by them, to a promised accuracy.

>>> import numpy as np, rbf
>>> points = np.random.default_rng(1).random((400, 2))      # a row is a point
>>> values = np.sin(3 * points[:, 0]) * points[:, 1]
>>> interpolant = rbf.Interpolant(points, values)
>>> at = np.array([[0.3, 0.4], [0.6, 0.5]])
>>> bool(np.abs(interpolant.evaluate(at) - np.sin(3 * at[:, 0]) * at[:, 1]).max() < 1e-3)
True

Kernels: "gaussian" exp(-r^2/c^2), "multiquadric" sqrt(r^2 + c^2), "inverse-multiquadric" 1 / sqrt(r^2 + c^2),
"inverse-quadratic" 1 / (r^2 + c^2), "thin-plate" r^2 ln r, "matern32" and "matern52". The shape c is a length.

Arrays of float64 whose rows are contiguous are read where they are, others are copied once. Other threads run during
long calls, and Ctrl-C ends these. docs/rbf.md has the promise and the costs. Grids are those of fgtd.
"""
from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Union

import numpy as np

from fgtd._plan import Grid, _columns_of, _Evaluated

from . import _core

__all__ = ["Choice", "Error", "FitReport", "Grid", "IllConditioned", "Interpolant", "InvalidArgument",
           "MemoryLimitError", "Plan", "TimeLimitError", "ToleranceError", "range_of", "smallest_tolerance"]

Array = np.ndarray[Any, np.dtype[np.float64]]

#: Tolerances below are not promised by "gaussians".
smallest_tolerance = _core.smallest_tolerance


class Error(Exception):
    """Base of the errors of this package.

    >>> import rbf
    >>> issubclass(rbf.InvalidArgument, rbf.Error)
    True
    """


class InvalidArgument(Error, ValueError):
    """An argument breaks a rule. The text names the argument, its value and the rule.

    >>> import rbf
    >>> try:
    ...     rbf.Plan("spline", [[0.0, 0.0]], [1.0])
    ... except ValueError as error:
    ...     print(str(error)[:34])
    rbf: there is no kernel "spline".
    """


class ToleranceError(Error, ValueError):
    """The tolerance cannot be promised.

    >>> import rbf
    >>> try:
    ...     rbf.Plan("multiquadric", [[0.0, 0.0]], [1.0], shape=1, tolerance=1e-13, method="gaussians")
    ... except rbf.ToleranceError:
    ...     print("below", rbf.smallest_tolerance)
    below 1e-11
    """


class MemoryLimitError(Error, MemoryError):
    """The work would need more than `memory_limit`. `needed` and `limit` are bytes.

    >>> import numpy as np, rbf
    >>> try:
    ...     rbf.Plan("thin-plate", np.zeros((100000, 2)), np.ones(100000), memory_limit=1000)
    ... except MemoryError as error:
    ...     print(error.needed > 1000)
    True
    """

    needed: float
    limit: int


class TimeLimitError(Error):
    """The work is predicted to take longer than `most_seconds`. `seconds` is the prediction on one thread, `method` its method.

    >>> import numpy as np, rbf
    >>> try:
    ...     rbf.Plan("thin-plate", np.zeros((100000, 2)), np.ones(100000), method="direct", most_seconds=1e-3)
    ... except rbf.TimeLimitError as error:
    ...     print(error.method)
    direct
    """

    seconds: float
    method: str


class IllConditioned(Error, ArithmeticError):
    """The data do not determine an interpolant in float64. The text says what helps.

    >>> import rbf
    >>> issubclass(rbf.IllConditioned, ArithmeticError)
    True
    """


@dataclass(frozen=True)
class Choice:
    """The method that a plan has chosen, and what it promises and predicts.

    >>> import rbf
    >>> rbf.Plan("thin-plate", [[0.0, 0.0]], [1.0]).choice.method
    'direct'
    """

    method: str  #: "direct" or "gaussians"
    tolerance: float  #: that was asked for
    range: float  #: that the promise is for, in the units of the points
    largest: float  #: |kernel| within the range, which the promise is relative to
    bound: float  #: of the error of "gaussians", relative to that
    gaussians: int  #: how many stand for the kernel
    seconds: float  #: predicted, on one thread
    centres: int  #: their number
    targets: int  #: that the prediction is for
    text: str  #: all of that in a line


@dataclass(frozen=True)
class FitReport:
    """What a fit has done, and how good it is.

    >>> import rbf
    >>> rbf.Interpolant([0.0, 1.0, 2.0], [0.0, 1.0, 0.0], kernel="gaussian", shape=1).report.solver
    'dense'
    """

    kernel: str  #: that was asked for
    shape: float  #: that was given or chosen
    solver: str  #: "dense" or "krylov"
    residual: float  #: of the equations, relative to the largest value
    condition: float  #: an estimate
    iterations: int  #: of "krylov"
    left_out: list[float]  #: for each column: the root mean square of the errors of values that are left out
    text: str  #: all of that in a line


def range_of(centres: Any, targets: Any) -> float:
    """The range that a plan needs for these targets: the largest distance of one from a corner of the box of the centres.

    >>> import rbf
    >>> rbf.range_of([[0.0, 0.0], [1.0, 0.0]], [[4.0, 0.0]])
    4.0
    """
    return _core.range_of(centres, targets)


class Plan(_Evaluated):
    """A prepared sum of weights[j] phi(|y - centres[j]|). evaluate(), gradient() and combinations() are those of fgtd.Plan.

    kernel: by name, see the page of the package.
    centres: N x d, a point a row, d = 1 to 3; or N numbers, for points on a line.
    weights: N numbers; or N x c for c sums that share the centres.
    shape: c > 0, in the units of the points; 0 for "thin-plate", which has none.
    tolerance: allowed error, relative to the largest |phi| within the range times sum |weights|.
    derivatives: the highest order of derivatives, 0 to 2 as the kernel has them.
    method: "auto", "direct" or "gaussians".
    range: no target is farther from a corner of the box around the centres; 0: targets inside that box. See range_of().
    threads, memory_limit, most_seconds, expected: as of fgtd.Plan.

    Raises InvalidArgument and ToleranceError (both ValueErrors), MemoryLimitError (a MemoryError), TimeLimitError.

    >>> import rbf
    >>> plan = rbf.Plan("multiquadric", [[0.0, 0.0], [3.0, 0.0]], [1.0, 1.0], shape=4)
    >>> plan.evaluate([[0.0, 0.0]]).tolist()
    [9.0]
    """

    def __init__(self, kernel: str, centres: Any, weights: Any, *, shape: float = 0.0, tolerance: float = 1e-6,
                 derivatives: int = 0, method: str = "auto", range: float = 0.0, threads: int = 0,
                 memory_limit: int = 8 << 30, most_seconds: float = float("inf"),
                 expected: Union[int, Grid] = 0) -> None:
        grid = expected._lists() if isinstance(expected, Grid) else []
        count = 0 if isinstance(expected, Grid) else expected
        self._columns = _columns_of(weights)
        self._sums = _core.plan(kernel, shape, centres, weights, tolerance, derivatives, method, threads, memory_limit,
                                most_seconds, range, count, grid)

    def set_weights(self, weights: Any) -> None:
        """Keeps the centres and takes other weights, N or N x c. It waits for evaluations of other threads.

        >>> import rbf
        >>> plan = rbf.Plan("gaussian", [0.0], [1.0], shape=1)
        >>> plan.set_weights([2.0])
        >>> plan.evaluate([0.0]).tolist()
        [2.0]
        """
        self._sums.set_weights(weights)
        self._columns = _columns_of(weights)

    @property
    def choice(self) -> Choice:
        """What was chosen, and what it promises and predicts."""
        return Choice(**self._sums.choice())

    def __repr__(self) -> str:
        return f"<rbf.Plan: {self.choice.text}>"


class Interpolant(_Evaluated):
    """A function that takes given values at given points, or stays near them. evaluate(), gradient() and combinations()
    are those of fgtd.Plan, at targets anywhere.

    points: N x d, a point a row, d = 1 to 3; or N numbers, for points on a line. Distinct, unless there is regularisation.
    values: N numbers; or N x c for c functions.
    kernel: by name, see the page of the package.
    shape: a length, in the units of the points. 0: chosen by the errors of values that are left out.
    accuracy: allowed error of the equations and of evaluation, relative to the largest |value|.
    regularisation: 0 takes the values; more is smoother, and stays near them. In units of the kernel's values.
    solver: "auto", "dense" or "krylov".
    threads: 0 for all. memory_limit: bytes.

    Raises InvalidArgument (a ValueError), IllConditioned (an ArithmeticError), MemoryLimitError (a MemoryError).

    >>> import rbf
    >>> parabola = rbf.Interpolant([0.0, 1.0, 2.0], [0.0, 1.0, 4.0], shape=2)
    >>> parabola.evaluate([1.0]).round(6).tolist()
    [1.0]
    """

    def __init__(self, points: Any, values: Any, *, kernel: str = "multiquadric", shape: float = 0.0,
                 accuracy: float = 1e-7, regularisation: float = 0.0, solver: str = "auto", threads: int = 0,
                 memory_limit: int = 8 << 30) -> None:
        self._columns = _columns_of(values)
        self._sums, weights, left_out = _core.fit(kernel, shape, points, values, accuracy, regularisation, solver,
                                                  threads, memory_limit)
        #: Factors of the kernel at every point, in the shape of the values.
        self.weights: Array = weights if self._columns else weights[:, 0]
        #: The error of each value, if the others predict it.
        self.left_out_errors: Array = left_out if self._columns else left_out[:, 0]

    @property
    def report(self) -> FitReport:
        """What was done, and how good it is."""
        return FitReport(**self._sums.choice())

    def __repr__(self) -> str:
        return f"<rbf.Interpolant: {self.report.text}>"
