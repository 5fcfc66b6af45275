"""The package rbf: sums against those that NumPy writes out, and interpolants against their values."""
import unittest

import numpy as np

import rbf

KERNELS = {"gaussian": lambda r, c: np.exp(-(r / c) ** 2), "multiquadric": lambda r, c: np.sqrt(r ** 2 + c ** 2),
           "inverse-multiquadric": lambda r, c: 1 / np.sqrt(r ** 2 + c ** 2),
           "inverse-quadratic": lambda r, c: 1 / (r ** 2 + c ** 2),
           "matern32": lambda r, c: (1 + np.sqrt(3) * r / c) * np.exp(-np.sqrt(3) * r / c)}


def cloud(count, dimension, seed=1):
    generator = np.random.default_rng(seed)
    return generator.random((count, dimension)), generator.standard_normal(count)


class Sums(unittest.TestCase):
    def test_are_those_of_all_pairs(self):
        centres, weights = cloud(300, 2)
        targets, _ = cloud(40, 2, seed=2)
        distance = np.linalg.norm(targets[:, None, :] - centres[None, :, :], axis=2)
        for name, kernel in KERNELS.items():
            for method in ("direct", "gaussians"):
                plan = rbf.Plan(name, centres, weights, shape=0.3, tolerance=1e-8, method=method,
                                range=rbf.range_of(centres, targets))
                allowed = 1.1e-8 * plan.choice.largest * np.abs(weights).sum()
                self.assertLessEqual(np.abs(plan.evaluate(targets) - kernel(distance, 0.3) @ weights).max(), allowed)

    def test_wrong_arguments_are_value_errors(self):
        for words, call in (
                ("shape", lambda: rbf.Plan("multiquadric", [[0.0, 0.0]], [1.0])),
                ("1 to 3 coordinates", lambda: rbf.Plan("thin-plate", np.zeros((2, 4)), [1.0, 1.0])),
                ("no solver", lambda: rbf.Interpolant([0.0, 1.0], [0.0, 1.0], solver="lu"))):
            with self.assertRaisesRegex(ValueError, words) as caught:
                call()
            self.assertIsInstance(caught.exception, rbf.Error)


class Interpolants(unittest.TestCase):
    def test_take_the_values_and_reproduce_linear_functions(self):
        points, _ = cloud(200, 2)
        both = np.column_stack([np.sin(4 * points[:, 0]), 3 * points[:, 0] - points[:, 1] + 1])
        for solver in ("dense", "krylov"):
            fit = rbf.Interpolant(points, both, kernel="thin-plate", solver=solver)
            self.assertEqual(fit.report.solver, solver)
            np.testing.assert_allclose(fit.evaluate(points), both, atol=1e-6)
            grid = rbf.Grid([0.2, 0.5], [0.1, 0.3, 0.9])
            at = grid.points()
            np.testing.assert_allclose(fit.evaluate(grid)[..., 1].ravel(), 3 * at[:, 0] - at[:, 1] + 1, atol=1e-5)
        self.assertEqual(fit.weights.shape, both.shape)

    def test_the_same_points_twice_are_refused(self):
        with self.assertRaises((rbf.IllConditioned, rbf.InvalidArgument)):
            rbf.Interpolant([0.0, 1.0, 1.0], [0.0, 1.0, 2.0], kernel="gaussian", shape=1)


if __name__ == "__main__":
    unittest.main()
