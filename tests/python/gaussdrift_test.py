"""The package gaussdrift: are densities the sums of the blobs, errors those of the arrays, and does a run stay silent?"""
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import threading
import unittest

import numpy as np

import gaussdrift

CONE = """gaussdrift = 1
[domain]
min = [-1, -1]
max = [1, 1]
[velocity]
u = ["-y", "x"]
[density]
shape = "wendland"
center = [0.5, 0]
radius = 0.25
[particles]
per_axis = 80
[time]
end = 1
step = 0.05
[evaluate]
per_axis = 41
tolerance = 1e-9
[output]
times = [0, 0.5, 1]
[reference]
kind = "characteristics"
"""


class Runs(unittest.TestCase):
    def test_densities_are_the_sums_of_the_blobs_and_errors_those_of_the_arrays(self):
        result = gaussdrift.run(CONE)
        width = result.summary["core_radius"]
        self.assertEqual([frame.time for frame in result.frames], [0, 0.5, 1])
        for number, frame in enumerate(result.frames):
            places = np.stack(np.meshgrid(*frame.axes, indexing="ij"), axis=-1)
            squares = ((places[:, :, None, :] - frame.positions[None, None]) ** 2).sum(axis=-1)
            blobs = np.exp(-squares / width ** 2) @ frame.weights / (np.pi * width ** 2)
            np.testing.assert_allclose(frame.density, blobs, atol=1e-8 * blobs.max())
            error = np.abs(frame.density - frame.exact)
            self.assertAlmostEqual(result.series["Linf"][number], error.max() / np.abs(frame.exact).max(), places=12)
            self.assertAlmostEqual(result.series["L1"][number], error.sum() / np.abs(frame.exact).sum(), places=12)
            self.assertAlmostEqual(result.series["mass"][number], frame.weights.sum(), places=12)
            turned = np.array([0.5 * np.cos(frame.time), 0.5 * np.sin(frame.time)])
            np.testing.assert_allclose(frame.weights @ frame.positions / frame.weights.sum(), turned, atol=1e-5)

    def test_text_file_dictionary_and_overrides_are_the_same_run(self):
        expected = gaussdrift.run(CONE).frames[-1].density
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "cone.toml"
            file.write_text(CONE)
            for case in (file, str(file), gaussdrift.Case(file)):
                np.testing.assert_array_equal(gaussdrift.run(case).frames[-1].density, expected)
        tables = {"gaussdrift": 1, "domain": {"min": np.array([-1, -1]), "max": (1, 1)}, "velocity": {"u": ["-y", "x"]},
                  "density": {"shape": "wendland", "center": [0.5, 0], "radius": 0.25}, "particles": {"per_axis": 10},
                  "time": {"end": 1, "step": 0.05}, "evaluate": {"per_axis": 41, "tolerance": 1e-9},
                  "output": {"times": [0, 0.5, 1]}, "reference": {"kind": "characteristics"}}
        np.testing.assert_array_equal(gaussdrift.run(tables, particles__per_axis=80).frames[-1].density, expected)

    def test_a_run_prints_nothing_and_writes_no_file(self):
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run([sys.executable, "-c", f"import gaussdrift; gaussdrift.run({CONE!r})"], cwd=folder,
                                  check=True, capture_output=True)
            self.assertEqual((done.stdout, done.stderr, os.listdir(folder)), (b"", b"", []))

    def test_check_predicts_without_running(self):
        self.assertGreater(len(gaussdrift.check(CONE)), 5)


class Ends(unittest.TestCase):
    def test_observer_stops_a_run_by_false_and_by_what_it_raises(self):
        result = gaussdrift.run(CONE, observer=lambda frame: frame.time < 0.5)
        self.assertFalse(result.summary["complete"])
        self.assertEqual([frame.time for frame in result.frames], [0, 0.5])

        def fails(frame):
            raise KeyError("mine")

        with self.assertRaisesRegex(KeyError, "mine"):
            gaussdrift.run(CONE, observer=fails)
        self.assertTrue(gaussdrift.run(CONE).summary["complete"])

    def test_interrupt_of_another_thread_ends_a_run(self):
        timer = threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT))
        timer.start()
        with self.assertRaises(KeyboardInterrupt):
            gaussdrift.run(CONE, time__step=1e-6, particles__per_axis=300)  # hours
        timer.join()

    def test_wrong_cases_have_the_texts_of_the_program(self):
        with self.assertRaisesRegex(gaussdrift.CaseError, r"z exists only in 3D(.|\n)*case\.toml:6:8") as caught:
            gaussdrift.run(CONE.replace('"-y"', '"-z*q"'))
        self.assertEqual(caught.exception.count, 1)
        with self.assertRaises(ValueError):
            gaussdrift.run(CONE, evaluate__per_axis=-3)
        with self.assertRaises(OSError):
            gaussdrift.run("no/such/case.toml")
        with self.assertRaisesRegex(TypeError, "no set"):
            gaussdrift.Case({"gaussdrift": {1}})


if __name__ == "__main__":
    unittest.main()
