"""Plans of sums of Gaussians: what the package shows of its core."""
from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Mapping, Optional, Sequence, Union

import numpy as np

from . import _core

Array = np.ndarray[Any, np.dtype[np.float64]]
#: A multi-index: how often to derive along each axis. (1, 0) is the derivative along x.
MultiIndex = Sequence[int]
#: Multi-indices with their coefficients. {(2, 0): 1, (0, 2): 1} is the Laplacian in the plane.
Operator = Mapping[tuple[int, ...], float]

#: Tolerances below cannot be promised in double precision.
smallest_tolerance = _core.smallest_tolerance


class Error(Exception):
    """Base of the errors of this package.

    >>> import fgtd
    >>> issubclass(fgtd.InvalidArgument, fgtd.Error)
    True
    """


class InvalidArgument(Error, ValueError):
    """An argument breaks a rule. The text names the argument, its value and the rule.

    >>> import fgtd
    >>> try:
    ...     fgtd.Plan([[0.0, 0.0]], [1.0], sigma=-1)
    ... except ValueError as error:
    ...     print(error)
    fgtd: sigma = -1, must be positive and finite
    """


class ToleranceError(Error, ValueError):
    """The tolerance cannot be promised.

    >>> import fgtd
    >>> try:
    ...     fgtd.Plan([[0.0, 0.0]], [1.0], sigma=1, tolerance=1e-20)
    ... except fgtd.ToleranceError:
    ...     print("below", fgtd.smallest_tolerance)
    below 1e-14
    """


class MemoryLimitError(Error, MemoryError):
    """The work would need more than `memory_limit`. `needed` and `limit` are bytes.

    >>> import numpy as np, fgtd
    >>> try:
    ...     fgtd.Plan(np.zeros((100000, 2)), np.ones(100000), sigma=1, memory_limit=1000)
    ... except MemoryError as error:
    ...     print(error.limit)
    1000
    """

    needed: float
    limit: int


class TimeLimitError(Error):
    """The work is predicted to take longer than `most_seconds`. `seconds` is the prediction on one thread, `method` its method.

    >>> import numpy as np, fgtd
    >>> try:
    ...     fgtd.Plan(np.zeros((100000, 2)), np.ones(100000), sigma=1, method="direct", most_seconds=1e-3)
    ... except fgtd.TimeLimitError as error:
    ...     print(error.method)
    direct
    """

    seconds: float
    method: str


class Grid:
    """A tensor grid: the points (x, y, ...) with x from the first axis, y from the second, and so on.

    Values on it have the shape of the grid: `values[i, k]` is at `(axes[0][i], axes[1][k])`.

    >>> import fgtd
    >>> fgtd.Grid([0, 1, 2], [0, 1]).shape
    (3, 2)
    """

    def __init__(self, *axes: Any) -> None:
        #: Nodes of every axis, ascending.
        self.axes: tuple[Array, ...] = tuple(np.asarray(axis, dtype=np.float64) for axis in axes)
        for number, axis in enumerate(self.axes):
            if axis.ndim != 1:
                raise InvalidArgument(f"fgtd: axis {number} of a grid must be a list of numbers; its shape is {axis.shape}")

    @property
    def shape(self) -> tuple[int, ...]:
        """Number of nodes of each axis."""
        return tuple(len(axis) for axis in self.axes)

    def points(self) -> Array:
        """All points as rows, the last axis fastest, as `values.ravel()`.

        >>> import fgtd
        >>> fgtd.Grid([0, 1], [5, 6]).points().tolist()
        [[0.0, 5.0], [0.0, 6.0], [1.0, 5.0], [1.0, 6.0]]
        """
        points: Array = np.stack(np.meshgrid(*self.axes, indexing="ij"), axis=-1).reshape(-1, len(self.axes))
        return points

    def _lists(self) -> list[list[float]]:
        return [axis.tolist() for axis in self.axes]


Targets = Union[Grid, Any]


@dataclass(frozen=True)
class Choice:
    """The method that a plan has chosen, and what it promises and predicts.

    >>> import fgtd
    >>> fgtd.Plan([[0.0, 0.0]], [1.0], sigma=1).choice.method
    'direct'
    """

    method: str  #: "direct", "hermite", "cells", "outer", "chebyshev" or "spread"
    tolerance: float  #: that was asked for
    bound: Optional[float]  #: proven error of one term, relative to |weight| and the largest value of the derivative
    seconds: float  #: predicted, on one thread
    sources: int  #: their number
    targets: int  #: that the prediction is for
    parameters: dict[str, Union[float, int, str]]  #: of the method
    text: str  #: all of that in a line


class _Evaluated:
    """What plans of fgtd and rbf have in common: targets, derivatives, shapes of results."""

    _sums: Any
    _columns: Optional[int]  # of the weights; None: a list of numbers

    @property
    def dimension(self) -> int:
        """Number of coordinates of a point."""
        return int(self._sums.dimension)

    def evaluate(self, targets: Targets, derivative: Optional[MultiIndex] = None) -> Array:
        """The sum, or a derivative of it, at points or on a grid.

        targets: M x d, a point a row, in the units of the sources; M numbers where d = 1; or a Grid.
        derivative: a multi-index, (1, 0) for d/dx in the plane; its sum must not exceed `derivatives` of the plan.

        Returns M values, or M x c for N x c weights. On a grid its shape takes the place of M.
        Raises InvalidArgument (a ValueError) and MemoryLimitError (a MemoryError).

        >>> import numpy as np, fgtd
        >>> plan = fgtd.Plan([[0.0, 0.0]], [1.0], sigma=0.5, derivatives=1)
        >>> plan.evaluate([[0.0, 0.0], [1.0, 0.0]]).round(6).tolist()
        [1.0, 0.606531]
        >>> plan.evaluate(fgtd.Grid([0, 1], [0]), derivative=(1, 0)).round(6).tolist()
        [[0.0], [-0.606531]]
        """
        index = [0] * self.dimension if derivative is None else list(derivative)
        return self._combined(targets, [[(index, 1.0)]])[0]

    def combinations(self, targets: Targets, operators: Sequence[Operator]) -> list[Array]:
        """Several combinations of derivatives in one pass: an array for each, as of evaluate().

        >>> import fgtd
        >>> plan = fgtd.Plan([[0.0, 0.0]], [1.0], sigma=0.5, derivatives=2)
        >>> value, laplacian = plan.combinations([[1.0, 0.0]], [{(0, 0): 1}, {(2, 0): 1, (0, 2): 1}])
        >>> value.round(6).tolist(), laplacian.round(6).tolist()
        ([0.606531], [-0.606531])
        """
        return self._combined(targets, [[(list(index), float(factor)) for index, factor in operator.items()]
                                        for operator in operators])

    def gradient(self, targets: Targets) -> Array:
        """All first derivatives in one pass, along a last axis of length d. Needs `derivatives` >= 1 in the plan.

        >>> import fgtd
        >>> plan = fgtd.Plan([[0.0, 0.0]], [1.0], sigma=0.5, derivatives=1)
        >>> plan.gradient([[1.0, 0.0]]).round(6).tolist()
        [[-0.606531, 0.0]]
        """
        axes = range(self.dimension)
        return np.stack(self._combined(targets, [[([int(k == axis) for k in axes], 1.0)] for axis in axes]), axis=-1)

    def _combined(self, targets: Targets, operators: list[list[tuple[list[int], float]]]) -> list[Array]:
        if isinstance(targets, Grid):
            sums = self._sums.on_grid(targets._lists(), operators)
            shape = targets.shape
        else:
            sums = self._sums.at(targets, operators)
            shape = (sums.shape[0],)
        columns = 1 if self._columns is None else self._columns
        end = shape if self._columns is None else (*shape, columns)
        # Columns are contiguous and the first axis is the fastest, so these are views.
        return [sums[:, k * columns:(k + 1) * columns].reshape(end, order="F") for k in range(len(operators))]


def _columns_of(weights: Any) -> Optional[int]:
    shape = np.shape(weights)
    return shape[1] if len(shape) == 2 else None


class Plan(_Evaluated):
    """A prepared sum. It chooses the method that is predicted to be the fastest for the tolerance.

    sources: N x d, a point a row, d = 1 to 4; or N numbers, for points on a line.
    weights: N numbers; or N x c for c sums that share the sources.
    sigma: > 0, in 1/length^2 of the sources. For a Gaussian of standard deviation s it is 1 / (2 s^2).
    tolerance: allowed error of every single term, relative to |weight| and the largest value of the Gaussian (or of its
        derivative). From `smallest_tolerance` to below 1.
    derivatives: the highest order of derivatives that evaluate() may be asked for.
    method: "auto", "direct", "hermite", "cells", "outer", "chebyshev" or "spread". Where a named one cannot serve,
        "direct" takes its place.
    threads: 0 for all. Results do not depend on it.
    memory_limit: bytes that plan and evaluation may hold together.
    most_seconds: that may be predicted, on one thread.
    expected: how many targets will be evaluated, or the Grid; for the choice of the method. Otherwise as many as sources.

    Raises InvalidArgument and ToleranceError (both ValueErrors), MemoryLimitError (a MemoryError), TimeLimitError.
    Several threads may evaluate a plan at a time.

    >>> import numpy as np, fgtd
    >>> points = np.random.default_rng(1).random((1000, 3))
    >>> plan = fgtd.Plan(points, np.ones(1000), sigma=10, tolerance=1e-6, derivatives=1)
    >>> plan.evaluate(points).shape, plan.gradient(points).shape
    ((1000,), (1000, 3))
    """

    def __init__(self, sources: Any, weights: Any, sigma: float, *, tolerance: float = 1e-6, derivatives: int = 0,
                 method: str = "auto", threads: int = 0, memory_limit: int = 8 << 30,
                 most_seconds: float = float("inf"), expected: Union[int, Grid] = 0) -> None:
        grid = expected._lists() if isinstance(expected, Grid) else []
        count = 0 if isinstance(expected, Grid) else expected
        self._columns = _columns_of(weights)
        self._sums = _core.plan(sources, weights, sigma, tolerance, derivatives, method, threads, memory_limit,
                                most_seconds, count, grid)

    def set_weights(self, weights: Any) -> None:
        """Keeps the sources and takes other weights, N or N x c. It waits for evaluations of other threads.

        >>> import fgtd
        >>> plan = fgtd.Plan([0.0], [1.0], sigma=1)
        >>> plan.set_weights([2.0])
        >>> plan.evaluate([0.0]).tolist()
        [2.0]
        """
        self._sums.set_weights(weights)
        self._columns = _columns_of(weights)

    @property
    def choice(self) -> Choice:
        """What was chosen, and what it promises and predicts.

        >>> import numpy as np, fgtd
        >>> plan = fgtd.Plan(np.linspace(0, 1, 100), np.ones(100), sigma=1)
        >>> plan.choice.sources, plan.choice.bound is None or plan.choice.bound <= 1e-6
        (100, True)
        """
        return Choice(**self._sums.choice())

    def __repr__(self) -> str:
        return f"<fgtd.Plan: {self.choice.text}>"


def transform(sources: Any, weights: Any, sigma: float, *, targets: Optional[Targets] = None, tolerance: float = 1e-6,
              derivative: Optional[MultiIndex] = None, **options: Any) -> Array:
    """One sum: a Plan, made for these targets, and one evaluation of it.

    targets: as of Plan.evaluate(); the sources if there are none.
    derivative: as of Plan.evaluate().
    options: others of Plan, by name.

    >>> import fgtd
    >>> fgtd.transform([0.0, 1.0], [1.0, 1.0], sigma=1, targets=[0.5]).round(6).tolist()
    [1.557602]
    """
    at = sources if targets is None else targets
    options.setdefault("expected", at if isinstance(at, Grid) else len(at))
    options.setdefault("derivatives", 0 if derivative is None else sum(derivative))
    return Plan(sources, weights, sigma, tolerance=tolerance, **options).evaluate(at, derivative)
