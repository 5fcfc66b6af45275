"""fgtd.density_estimate against scipy.stats.gaussian_kde, an independent program, within the tolerance."""
import unittest

import numpy as np
from scipy import stats

import fgtd


def sample(count, dimension, seed=1):
    """Correlated points far from the origin."""
    generator = np.random.default_rng(seed)
    mix = np.tril(generator.random((dimension, dimension))) + np.eye(dimension)
    return generator.standard_normal((count, dimension)) @ mix.T + 10, generator.random(count)


def peak_of(estimate):
    """Density of a single point of SciPy's estimate at its place: what the tolerance is relative to."""
    return 1 / np.sqrt(np.linalg.det(2 * np.pi * estimate.covariance))


class AgainstSciPy(unittest.TestCase):
    def test_rules_weights_and_dimensions(self):
        for dimension in (1, 2, 3, 4):
            points, weights = sample(1500, dimension)
            places, _ = sample(200, dimension, seed=2)
            for rule in ("scott", "silverman"):
                for given in (None, weights):
                    theirs = stats.gaussian_kde(points.T, bw_method=rule, weights=given)
                    np.testing.assert_allclose(fgtd.bandwidth_matrix(points, given, rule), theirs.covariance, rtol=1e-12)
                    for tolerance in (1e-5, 1e-11):
                        ours = fgtd.density_estimate(points, given, rule, at=places, tolerance=tolerance)
                        self.assertLessEqual(np.abs(ours - theirs(places.T)).max(),
                                             (tolerance + 1e-13) * peak_of(theirs))

    def test_grid_of_correlated_points(self):
        points, _ = sample(800, 2)
        grid = fgtd.Grid(np.linspace(5, 15, 21), np.linspace(4, 16, 17))
        theirs = stats.gaussian_kde(points.T)
        ours = fgtd.density_estimate(points, at=grid)
        self.assertEqual(ours.shape, grid.shape)
        self.assertLessEqual(np.abs(ours.ravel() - theirs(grid.points().T)).max(), 1.001e-9 * peak_of(theirs))

    def test_number_and_matrix_are_the_mean_of_normal_densities(self):
        points, weights = sample(300, 2)
        grid = fgtd.Grid(np.linspace(8, 12, 9), np.linspace(8, 13, 7))
        for bandwidth, covariance in ((0.4, 0.16 * np.eye(2)), ([[0.3, 0.1], [0.1, 0.2]], [[0.3, 0.1], [0.1, 0.2]])):
            exact = sum(weight * stats.multivariate_normal(point, covariance).pdf(grid.points())
                        for point, weight in zip(points, weights)) / weights.sum()
            ours = fgtd.density_estimate(points, weights, bandwidth, at=grid, tolerance=1e-11)
            peak = 1 / np.sqrt(np.linalg.det(2 * np.pi * np.array(covariance)))
            self.assertLessEqual(np.abs(ours.ravel() - exact).max(), 1.01e-11 * peak)


class Errors(unittest.TestCase):
    def test_name_the_rule(self):
        line = np.column_stack([np.arange(9.0), 2 * np.arange(9.0)])
        for words, arguments in (
                ("no bandwidth \"isj\"", (line, None, "isj")), ("bandwidth = 0", (line, None, 0.0)),
                ("symmetric and 2 x 2", (line, None, [[1.0, 0.5], [0.0, 1.0]])),
                ("not positive definite", (line,)), ("not positive definite", (line, None, [[1.0, 2.0], [2.0, 1.0]])),
                ("must not be negative", (line, -np.ones(9))), ("9 numbers", (line, np.ones(8))),
                ("two points at least", (line[:1],)), ("N > 0", (line[:0],))):
            with self.assertRaisesRegex(fgtd.InvalidArgument, words):
                fgtd.density_estimate(*arguments)
        with self.assertRaisesRegex(fgtd.InvalidArgument, "have 3 coordinates, the points 2"):
            fgtd.density_estimate(line, None, 1.0, at=np.zeros((2, 3)))


if __name__ == "__main__":
    unittest.main()
