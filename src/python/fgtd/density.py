"""Densities estimated from points: a Gaussian around each, summed by a fast Gauss transform."""
from __future__ import annotations

from typing import Any, Optional, Union

import numpy as np

from . import _core
from ._plan import Array, Grid, InvalidArgument, Plan, Targets

Bandwidth = Union[str, float, Any]


def bandwidth_matrix(points: Any, weights: Any = None, bandwidth: Bandwidth = "scott") -> Array:
    """The covariance d x d of the Gaussian that density_estimate() puts around every point.

    points, weights, bandwidth: as of density_estimate().

    >>> import numpy as np, fgtd
    >>> fgtd.bandwidth_matrix(np.zeros((5, 2)), bandwidth=0.1).round(12).tolist()
    [[0.01, 0.0], [0.0, 0.01]]
    >>> points = np.random.default_rng(1).standard_normal((1000, 1))
    >>> scott = 1000 ** (-1 / 5)
    >>> bool(np.isclose(fgtd.bandwidth_matrix(points)[0, 0], scott ** 2 * np.var(points, ddof=1)))
    True
    """
    rows, factors = _checked(points, weights)
    return _covariance(rows, factors, bandwidth)


def density_estimate(points: Any, weights: Any = None, bandwidth: Bandwidth = "scott", *, at: Optional[Targets] = None,
                     tolerance: float = 1e-9, **options: Any) -> Array:
    """The density of which the points are a sample: the mean of Gaussians around them, whose integral is 1.

    points: N x d, a point a row, d = 1 to 4; or N numbers.
    weights: N numbers, not negative; equal ones if there are none. Their sum does not matter.
    bandwidth: "scott" or "silverman": their factor times the covariance of the points, as scipy.stats.gaussian_kde does;
        a number: the standard deviation along every axis, in the units of the points;
        a matrix d x d: the covariance of the Gaussian.
    at: where the density is wanted, M x d or a Grid; the points themselves if there are none.
    tolerance: allowed error relative to the density of a single point at its place, the highest that there can be. Small
        densities in the tails are as wrong as large ones.
    options: those of Plan, by name.

    Returns M densities in 1/length^d; on a grid they have its shape.
    Raises InvalidArgument (a ValueError), also where the points lie on a line or in a plane and have no density.

    >>> import numpy as np, fgtd
    >>> points = np.random.default_rng(1).standard_normal((20000, 2))
    >>> grid = fgtd.Grid(np.linspace(-5, 5, 101), np.linspace(-5, 5, 101))
    >>> density = fgtd.density_estimate(points, at=grid)
    >>> round(float(density.sum()) * 0.1 ** 2, 4)              # its integral
    1.0
    >>> bool(abs(density[50, 50] - 1 / (2 * np.pi)) < 0.02)    # of the true density at its middle
    True
    """
    rows, factors = _checked(points, weights)
    shares = _core.normalised_weights(factors)[:, 0]
    covariance = _covariance(rows, factors, bandwidth)
    # In coordinates L^-1 x the Gaussian is exp(-|x|^2 / 2) for L L^T = covariance.
    root, peak = _core.whitening(covariance)
    targets = _whitened_targets(rows if at is None else at, covariance, root)
    options.setdefault("expected", targets if isinstance(targets, Grid) else len(targets))
    plan = Plan(_whitened(rows, covariance), peak * shares, 0.5, tolerance=tolerance, **options)
    density = plan.evaluate(targets)
    return density.reshape(at.shape) if isinstance(at, Grid) else density


def _checked(points: Any, weights: Any) -> tuple[Array, Array]:
    rows = np.asarray(points, dtype=np.float64)
    if rows.ndim == 1:
        rows = rows[:, None]
    if rows.ndim != 2 or not len(rows):
        raise InvalidArgument(f"fgtd: points must be N x d, a point a row, N > 0; their shape is {np.shape(points)}")
    factors = np.ones(len(rows)) if weights is None else np.asarray(weights, dtype=np.float64)
    if factors.shape != (len(rows),):
        raise InvalidArgument(f"fgtd: weights must be {len(rows)} numbers, one a point; their shape is {factors.shape}")
    return rows, factors


def _covariance(rows: Array, factors: Array, bandwidth: Bandwidth) -> Array:
    dimension = rows.shape[1]
    if not isinstance(bandwidth, str):
        bandwidth = np.asarray(bandwidth, dtype=np.float64)
        if bandwidth.ndim and bandwidth.shape != (dimension, dimension):
            raise InvalidArgument(f"fgtd: a matrix as bandwidth must be finite, symmetric and {dimension} x {dimension}; "
                                  f"its shape is {bandwidth.shape}")
    return _core.bandwidth_matrix(rows, factors, bandwidth)


def _whitened(rows: Array, covariance: Array) -> Array:
    if rows.shape[1] != len(covariance):
        raise InvalidArgument(f"fgtd: the places of the density have {rows.shape[1]} coordinates, the points "
                              f"{len(covariance)}")
    return _core.whitened(rows, covariance)


def _whitened_targets(at: Targets, covariance: Array, root: Array) -> Targets:
    """A grid stays one where no axes mix."""
    if isinstance(at, Grid):
        if len(at.axes) == len(root) and not np.any(root - np.diag(np.diag(root))):
            return Grid(*(axis / scale for axis, scale in zip(at.axes, np.diag(root))))
        return _whitened(at.points(), covariance)
    rows = np.asarray(at, dtype=np.float64)
    return _whitened(rows[:, None] if rows.ndim == 1 else rows, covariance)
