"""The package farfield: potentials and fields against sums that NumPy writes out."""
import unittest

import numpy as np

import farfield


def apart(sources, targets):
    """Differences M x N x d and distances, with infinity for 0, so that such pairs add nothing to a field."""
    between = targets[:, None, :] - sources[None, :, :]
    distance = np.sqrt((between ** 2).sum(axis=2))
    return between, np.where(distance == 0, np.inf, distance)


def cloud(count, dimension, seed=1):
    generator = np.random.default_rng(seed)
    return generator.random((count, dimension)), generator.standard_normal(count)


class Values(unittest.TestCase):
    def test_coulomb_in_space_and_in_the_plane(self):
        for dimension in (2, 3):
            points, charges = cloud(400, dimension)
            between, distance = apart(points, points)
            field = (charges[:, None] * between / distance[:, :, None] ** dimension).sum(axis=1)
            part = 1 / distance if dimension == 3 else -np.where(np.isinf(distance), 0, np.log(distance))
            for method in ("direct", "tree", "symmetric"):
                values = farfield.Plan("coulomb", points, tolerance=1e-8, method=method).evaluate(charges)
                allowed = 1e-8 * (np.abs(charges) / distance ** (dimension - 1)).sum(axis=1) + 1e-11
                self.assertTrue((np.linalg.norm(values.field - field, axis=1) <= allowed).all())
                weight = np.abs(charges) * (1 / distance if dimension == 3 else 1 + np.abs(part))
                self.assertTrue((np.abs(values.potential - part @ charges) <= 1e-8 * weight.sum(axis=1) + 1e-11).all())

    def test_vortex_blobs_have_a_field_alone(self):
        sources, circulations = cloud(200, 2)
        targets, _ = cloud(50, 2, seed=2)
        between, distance = apart(sources, targets)
        factor = circulations * (1 - np.exp(-distance ** 2 / 0.01)) / (2 * np.pi * distance ** 2)
        field = np.stack([(-between[:, :, 1] * factor).sum(axis=1), (between[:, :, 0] * factor).sum(axis=1)], axis=1)
        values = farfield.Plan("vortex-blob", sources, targets, core_radius=0.1, tolerance=1e-9).evaluate(circulations)
        self.assertIsNone(values.potential)
        np.testing.assert_allclose(values.field, field, atol=1e-7)
        np.testing.assert_array_equal(
            farfield.Plan("vortex-blob", np.asfortranarray(sources), targets, core_radius=0.1, tolerance=1e-9)
            .evaluate(circulations).field, values.field)

    def test_line_without_the_potential(self):
        points, charges = cloud(100, 1)
        values = farfield.Plan("log", points[:, 0], potential=False).evaluate(charges)
        self.assertIsNone(values.potential)
        self.assertEqual(values.field.shape, (100, 1))


class Errors(unittest.TestCase):
    def test_are_python_s(self):
        points = np.zeros((3, 2))
        for words, call in (
                ("core_radius", lambda: farfield.Plan("vortex-blob", points)),
                ("charges", lambda: farfield.Plan("log", points).evaluate([1.0])),
                ("charges must be N numbers", lambda: farfield.Plan("log", points).evaluate(np.ones((3, 2)))),
                ("targets have 3 coordinates, the sources 2", lambda: farfield.Plan("log", points, np.zeros((1, 3)))),
                ("1 to 3 coordinates", lambda: farfield.Plan("log", np.zeros((3, 4))))):
            with self.assertRaisesRegex(ValueError, words) as caught:
                call()
            self.assertIsInstance(caught.exception, farfield.Error)


if __name__ == "__main__":
    unittest.main()
