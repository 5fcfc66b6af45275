"""The package fgtd: is what it returns the sum that NumPy writes out, without hidden copies, and may others run meanwhile?"""
import os
import signal
import subprocess
import sys
import threading
import unittest

import numpy as np

import fgtd


def pairs(sources, weights, sigma, targets):
    """The sum, written out."""
    squares = ((targets[:, None, :] - sources[None, :, :]) ** 2).sum(axis=2)
    return np.exp(-sigma * squares) @ weights


def cloud(count, dimension, seed=1):
    generator = np.random.default_rng(seed)
    return generator.random((count, dimension)), generator.standard_normal(count)


class Values(unittest.TestCase):
    def test_sums_in_every_dimension_are_those_of_all_pairs(self):
        for dimension in (1, 2, 3, 4):
            sources, weights = cloud(300, dimension)
            targets, _ = cloud(70, dimension, seed=2)
            for tolerance in (1e-4, 1e-12):
                exact = pairs(sources, weights, 20, targets)
                sums = fgtd.transform(sources, weights, 20, targets=targets, tolerance=tolerance)
                self.assertLessEqual(np.abs(sums - exact).max(), (tolerance + 3e-14) * np.abs(weights).sum())

    def test_gradient_and_laplacian_are_those_of_the_formula(self):
        sources, weights = cloud(200, 2)
        targets, _ = cloud(50, 2, seed=2)
        sigma = 5.0
        plan = fgtd.Plan(sources, weights, sigma, tolerance=1e-12, derivatives=2)
        apart = targets[:, None, :] - sources[None, :, :]
        gaussians = np.exp(-sigma * (apart ** 2).sum(axis=2)) * weights
        gradient = (-2 * sigma * apart * gaussians[:, :, None]).sum(axis=1)
        np.testing.assert_allclose(plan.gradient(targets), gradient, atol=1e-9)
        laplacian = ((4 * sigma ** 2 * (apart ** 2).sum(axis=2) - 4 * sigma) * gaussians).sum(axis=1)
        found, = plan.combinations(targets, [{(2, 0): 1, (0, 2): 1}])
        np.testing.assert_allclose(found, laplacian, atol=1e-8)

    def test_grid_has_its_shape_and_columns_follow(self):
        sources, weights = cloud(100, 3)
        both = np.column_stack([weights, 2 * weights])
        grid = fgtd.Grid([0, 0.5, 1], [0.1, 0.2], [0.3, 0.4, 0.5, 0.6])
        plan = fgtd.Plan(sources, both, 3, tolerance=1e-12, expected=grid)
        values = plan.evaluate(grid)
        self.assertEqual(values.shape, (3, 2, 4, 2))
        exact = pairs(sources, weights, 3, grid.points()).reshape(grid.shape)
        np.testing.assert_allclose(values[..., 0], exact, atol=1e-9)
        np.testing.assert_allclose(values[..., 1], 2 * exact, atol=1e-9)
        plan.set_weights(weights)
        np.testing.assert_allclose(plan.evaluate(grid), exact, atol=1e-9)

    def test_layout_and_type_of_arrays_do_not_matter(self):
        sources, weights = cloud(500, 3)
        expected = fgtd.transform(sources, weights, 4)
        wide = np.zeros((1000, 7))
        wide[::2, 2:5] = sources
        backwards = sources[::-1].copy()[::-1]
        odd = np.frombuffer(b"x" + sources.tobytes(), dtype=np.float64, offset=1).reshape(sources.shape)
        for same in (np.asfortranarray(sources), wide[::2, 2:5], backwards, odd, sources.tolist()):
            np.testing.assert_array_equal(fgtd.transform(same, weights, 4), expected)
        spread = np.zeros((500, 2))
        spread[:, 0] = weights
        np.testing.assert_array_equal(fgtd.transform(sources, spread[:, 0], 4), expected)
        np.testing.assert_array_equal(fgtd.transform(sources, spread, 4),
                                      fgtd.transform(sources, np.asfortranarray(spread), 4))
        whole = np.arange(6).reshape(3, 2)
        np.testing.assert_array_equal(fgtd.transform(whole, [1, 2, 3], 1),
                                      fgtd.transform(whole.astype(float), [1.0, 2.0, 3.0], 1))

    def test_nothing_and_one_point(self):
        self.assertEqual(fgtd.transform(np.zeros((0, 2)), [], 1, targets=[[0.0, 0.0]]).tolist(), [0])
        self.assertEqual(fgtd.transform([[0.0, 0.0]], [3.0], 1, targets=np.zeros((0, 2))).shape, (0,))
        self.assertEqual(fgtd.transform([[0.0, 0.0]], [3.0], 1).tolist(), [3])


class Errors(unittest.TestCase):
    def says(self, kind, words, *arguments, **options):
        with self.assertRaisesRegex(kind, words) as caught:
            fgtd.transform(*arguments, **options)
        self.assertIsInstance(caught.exception, fgtd.Error)

    def test_are_python_s_and_have_the_texts_of_the_library(self):
        points = np.zeros((3, 2))
        self.says(ValueError, "sigma = 0, must be positive", points, [1, 1, 1], 0)
        self.says(ValueError, "weights", points, [1, 1], 1)
        self.says(ValueError, "weight 1, column 0 is nan", points, [1, np.nan, 1], 1)
        self.says(ValueError, "sources must have 1 to 4 coordinates.*they have 5", np.zeros((3, 5)), [1, 1, 1], 1)
        self.says(ValueError, r"sources must be an array N x d.*\(1, 3, 2\)", [points], [1, 1, 1], 1)
        self.says(ValueError, "sources must hold real numbers.*complex", points * 1j, [1, 1, 1], 1)
        self.says(ValueError, "targets have 1 coordinates, the sources 2", points, [1, 1, 1], 1, targets=[1.0])
        self.says(ValueError, 'no method "fast".*direct', points, [1, 1, 1], 1, method="fast")
        self.says(ValueError, "a multi-index has 2 numbers", points, [1, 1, 1], 1, derivative=(1, 0, 0))
        self.says(fgtd.ToleranceError, "tolerance", points, [1, 1, 1], 1, tolerance=1e-15)
        self.says(MemoryError, "memory", np.zeros((10000, 2)), np.ones(10000), 1, memory_limit=10)


class Others(unittest.TestCase):
    def test_two_threads_sum_at_once(self):
        jobs = [(cloud(3000, 2, seed), 10.0 * seed) for seed in (1, 2, 3, 4)]
        expected = [fgtd.transform(*points, sigma) for points, sigma in jobs]
        found = [None] * len(jobs)
        shared = fgtd.Plan(*jobs[0][0], 10.0)

        def work(number):
            for _ in range(5):
                points, sigma = jobs[number]
                found[number] = fgtd.transform(*points, sigma)
                found[number] = found[number] if number else shared.evaluate(points[0])

        threads = [threading.Thread(target=work, args=(number,)) for number in range(len(jobs))]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for one, other in zip(found, expected):
            np.testing.assert_array_equal(one, other)

    def test_interrupt_of_another_thread_ends_a_long_sum(self):
        # The other thread can only run if the sum has released Python's lock.
        sources, weights = cloud(400_000, 3)
        plan = fgtd.Plan(sources, weights, 1e-3, method="direct")
        timer = threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT))
        timer.start()
        with self.assertRaises(KeyboardInterrupt):
            plan.evaluate(sources)  # minutes
        timer.join()
        self.assertEqual(plan.evaluate(sources[:2]).shape, (2,))


GROWTH = """
import resource, sys
import numpy as np, fgtd
count = 4_000_000
points = np.linspace(0, 1, count * 2).reshape(count, 2, order=sys.argv[1])
plan = fgtd.Plan([[0.5, 0.5]], [1.0], 1.0, method="direct", threads=1)
plan.evaluate(points[:1000])
before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
values = plan.evaluate(points)
assert values.shape == (count,) and not values.flags.owndata
print((resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before) * 1024 / (8 * count))
"""


class Memory(unittest.TestCase):
    def growth(self, order):
        """Numbers a target by which the largest memory of a process grows in one evaluation."""
        return float(subprocess.run([sys.executable, "-c", GROWTH, order], check=True, capture_output=True).stdout)

    def test_rows_are_read_where_they_are_and_results_are_handed_over(self):
        # A result is one number a target. A copy of the targets would be two more, one of the result one more.
        self.assertLess(self.growth("C"), 1.5)
        self.assertGreater(self.growth("F"), 2.5)  # and such a copy would be seen


if __name__ == "__main__":
    unittest.main()
