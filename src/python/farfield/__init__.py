"""Sums over all pairs of points for kernels that do not decay: Coulomb, the logarithm and vortex blobs.

>>> import numpy as np, farfield
>>> points = np.random.default_rng(1).random((3000, 3))     # a row is a point
>>> charges = np.ones(3000)
>>> potential, field = farfield.Plan("coulomb", points, tolerance=1e-6).evaluate(charges)
>>> potential.shape, field.shape
((3000,), (3000, 3))
>>> apart = np.linalg.norm(points[1:] - points[0], axis=1)
>>> bool(abs(potential[0] - (1 / apart).sum()) <= 1e-6 * (1 / apart).sum())
True

Arrays of float64 whose rows are contiguous are read where they are, others are copied once. Other threads run during
long calls, and Ctrl-C ends these. docs/farfield.md has the kernels, the promise and the costs.
"""
from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple, Optional

import numpy as np

from . import _core

__all__ = ["Choice", "Error", "InvalidArgument", "MemoryLimitError", "Plan", "RangeError", "TimeLimitError",
           "ToleranceError", "Values", "smallest_tolerance"]

Array = np.ndarray[Any, np.dtype[np.float64]]

#: Tolerances below are not promised by "tree" and "symmetric".
smallest_tolerance = _core.smallest_tolerance


class Error(Exception):
    """Base of the errors of this package.

    >>> import farfield
    >>> issubclass(farfield.InvalidArgument, farfield.Error)
    True
    """


class InvalidArgument(Error, ValueError):
    """An argument breaks a rule. The text names the argument, its value and the rule.

    >>> import farfield
    >>> try:
    ...     farfield.Plan("gravity", [[0.0, 0.0]])
    ... except ValueError as error:
    ...     print(error)
    farfield: there is no kernel "gravity". There are: coulomb, log, vortex-blob
    """


class ToleranceError(Error, ValueError):
    """The tolerance cannot be promised by the method that was named.

    >>> import farfield
    >>> try:
    ...     farfield.Plan("coulomb", [[0.0, 0.0]], tolerance=1e-13, method="tree")
    ... except farfield.ToleranceError:
    ...     print("below", farfield.smallest_tolerance)
    below 1e-11
    """


class MemoryLimitError(Error, MemoryError):
    """The work would need more than `memory_limit`. `needed` and `limit` are bytes.

    >>> import numpy as np, farfield
    >>> try:
    ...     farfield.Plan("log", np.zeros((100000, 2)), memory_limit=1000)
    ... except MemoryError as error:
    ...     print(error.limit)
    1000
    """

    needed: float
    limit: int


class TimeLimitError(Error):
    """The work is predicted to take longer than `most_seconds`. `seconds` is the prediction on one thread, `method` its method.

    >>> import numpy as np, farfield
    >>> try:
    ...     farfield.Plan("log", np.zeros((100000, 2)), method="direct", most_seconds=1e-3)
    ... except farfield.TimeLimitError as error:
    ...     print(error.method)
    direct
    """

    seconds: float
    method: str


class RangeError(Error, OverflowError):
    """A sum exceeds the range of float64. `quantity` is "potential" or "field", `target` its number.

    >>> import farfield
    >>> try:
    ...     farfield.Plan("coulomb", [[0.0, 0.0, 0.0], [1e-160, 0.0, 0.0]]).evaluate([1e300, 1e300])
    ... except OverflowError as error:
    ...     print(error.target)
    0
    """

    quantity: str
    target: int


@dataclass(frozen=True)
class Choice:
    """The method that a plan has chosen, and what it promises and predicts.

    >>> import farfield
    >>> farfield.Plan("log", [[0.0, 0.0]]).choice.method
    'direct'
    """

    kernel: str  #: that was asked for
    method: str  #: "direct", "tree" or "symmetric"
    tolerance: float  #: that was asked for
    bound: float  #: that the promise holds with
    seconds: float  #: predicted for one evaluation, on one thread
    sources: int  #: their number
    targets: int  #: their number
    text: str  #: all of that in a line


class Values(NamedTuple):
    """What an evaluation returns: potentials of M targets, or None; and their fields, M x d.

    >>> import farfield
    >>> values = farfield.Plan("coulomb", [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0]]).evaluate([1.0, 1.0])
    >>> values.potential.tolist(), values.field[0].tolist()
    ([0.5, 0.5], [-0.25, 0.0, 0.0])
    """

    potential: Optional[Array]
    field: Array


class Plan:
    """Sums for fixed points and any charges, r = |x - y| of a target x and a source y. Pairs at distance 0 are left out.

    kernel: "coulomb", potential sum q/r in 3D and -sum q ln r in 2D, field sum q (x-y)/r^d;
        "log" in 1D and 2D, potential sum q ln r, field sum q (x-y)/r^2;
        "vortex-blob" in 2D, field sum q (1 - exp(-r^2/core_radius^2)) / (2 pi r^2) (-dy, dx), no potential.
    sources: N x d, a point a row; or N numbers, for points on a line.
    targets: M x d in the same units; the sources if there are none.
    tolerance: allowed error of every pair, relative to its largest possible part of field and potential.
    method: "auto", "direct", "tree" or "symmetric".
    threads: 0 for all. Results do not depend on it.
    core_radius: of "vortex-blob", > 0 there, in the units of the points.
    potential: False for the field alone, which is faster in 1D and 2D.
    memory_limit: bytes that plan and evaluation may hold together.
    most_seconds: that may be predicted, on one thread.

    Raises InvalidArgument and ToleranceError (both ValueErrors), MemoryLimitError (a MemoryError), TimeLimitError.
    Several threads may evaluate a plan at a time.

    >>> import farfield
    >>> plan = farfield.Plan("log", [[0.0, 0.0]], [[2.0, 0.0]])
    >>> plan.evaluate([3.0]).field.tolist()
    [[1.5, 0.0]]
    """

    def __init__(self, kernel: str, sources: Any, targets: Any = None, *, tolerance: float = 1e-6, method: str = "auto",
                 threads: int = 0, core_radius: float = 0.0, potential: bool = True, memory_limit: int = 8 << 30,
                 most_seconds: float = float("inf")) -> None:
        self._pairs = _core.plan(kernel, sources, targets, tolerance, method, threads, core_radius, potential,
                                 memory_limit, most_seconds)

    def evaluate(self, charges: Any) -> Values:
        """Potential and field of N charges, or circulations, at every target.

        Raises InvalidArgument, MemoryLimitError, and RangeError where a sum exceeds float64.

        >>> import farfield
        >>> plan = farfield.Plan("coulomb", [[0.0, 0.0], [1.0, 0.0]])
        >>> plan.evaluate([1.0, -1.0]).field.tolist()
        [[1.0, 0.0], [1.0, 0.0]]
        """
        potential, field = self._pairs.evaluate(charges)
        return Values(potential[:, 0] if len(potential) or not len(field) else None, field)

    @property
    def choice(self) -> Choice:
        """What was chosen, and what it promises and predicts."""
        return Choice(**self._pairs.choice())

    def __repr__(self) -> str:
        return f"<farfield.Plan: {self.choice.text}>"
