"""view.py of a run, executed with a stand-in for ParaView: what it opens and sets, and that it has no text of the case.
ParaView itself draws it in tools/open_in_paraview. Usage: view_script_test.py <gaussdrift>"""
import ast
import json
import os
import runpy
import subprocess
import sys
import tempfile
import types
import unittest
from unittest import mock

PROGRAM = os.path.abspath(sys.argv[1])
TITLE = "')\\nimport os; os.system('touch hacked') #"

CASE = """
gaussdrift = 1
[case]
title = "%s"
label = "%s $x$"
[domain]
min = %s
max = %s
[[velocity]]
u = %s
[[density]]
shape = "gaussian"
center = %s
radius = 0.3
[particles]
per_axis = 12
[time]
end = 0.2
step = 0.1
[evaluate]
per_axis = 9
[output]
times = [0, 0.2]
vtk = %s
images = []
report = "none"
"""
PLANE = ["[-1, -1]", "[1, 1]", '["-y", "x"]', "[0.3, 0]"]
SPACE = ["[-1, -1, -1]", "[1, 1, 1]", '["-y", "x", "0"]', "[0.3, 0, 0]"]


def stand_in(calls):
    """Modules that note what is called and hand out objects on which anything can be set."""
    simple = types.ModuleType("paraview.simple")
    for name in ["GetAnimationScene", "GetColorTransferFunction", "GetOpacityTransferFunction", "GetScalarBar", "ColorBy",
                 "AnnotateTimeFilter", "Glyph", "Threshold", "Show", "Hide", "SetActiveView", "AssignViewToLayout", "GetLayout",
                 "AddCameraLink", "ResetCamera", "RenderAllViews", "SaveScreenshot", "XMLPolyDataReader"]:
        calls[name] = mock.MagicMock(name=name)
        calls[name].return_value.CameraPosition = [0, 0, 1]
        setattr(simple, name, calls[name])

    def view(*_):
        made = mock.MagicMock(CameraPosition=[0, 0, 3], CameraFocalPoint=[0, 0, 0], CameraParallelScale=1.0)
        calls.setdefault("views", []).append(made)
        return made

    def reader(**given):
        made = mock.MagicMock()
        made.PointData.__getitem__.return_value.GetRange.return_value = (0.0, 2.0)
        made.PointData.keys.return_value = ["rho"] if "density" in given["registrationName"] else ["alpha", "u", "core_radius"]
        calls.setdefault("read", []).append(given["FileName"])
        return made

    shown = calls["shown"] = []
    calls["Show"].side_effect = lambda *_: shown.append(mock.MagicMock()) or shown[-1]
    simple.GetActiveViewOrCreate = simple.CreateView = view
    simple.PVDReader = reader
    simple.__all__ = [name for name in dir(simple) if not name.startswith("_")]
    package = types.ModuleType("paraview")
    package.simple = simple
    return {"paraview": package, "paraview.simple": simple}


class ViewScript(unittest.TestCase):
    def run_and_view(self, place, vtk, *options):
        folder = self.enterContext(tempfile.TemporaryDirectory())
        with open(os.path.join(folder, "case.toml"), "w", encoding="ascii") as case:
            case.write(CASE % (TITLE, TITLE, *place, vtk))
        subprocess.run([PROGRAM, "run", "case.toml", "--out", "run", *options], cwd=folder, check=True,
                       stdout=subprocess.DEVNULL)
        script = os.path.join(folder, "run", "view.py")
        with open(script, encoding="utf-8") as file:
            text = file.read()
        self.assertNotIn("hacked", text)
        ast.parse(text)
        calls = {}
        with mock.patch.dict(sys.modules, stand_in(calls)), mock.patch.dict(os.environ, VIEW_PNG="there.png"):
            runpy.run_path(script)
        self.assertFalse(os.path.exists("hacked"))
        return os.path.join(folder, "run"), calls

    def test_opens_density_and_particles_side_by_side(self):
        folder, calls = self.run_and_view(PLANE, '["density", "particles"]')
        self.assertEqual(calls["read"], [os.path.join(folder, name) for name in ["density.pvd", "particles.pvd"]])
        self.assertEqual(len(calls["views"]), 2)
        self.assertEqual(calls["views"][0].InteractionMode, "2D")
        styles = [shown.SetRepresentationType.call_args.args[0] for shown in calls["shown"]
                  if shown.SetRepresentationType.called]
        self.assertEqual(styles, ["Surface", "Point Gaussian"])
        blobs = next(shown for shown in calls["shown"] if shown.SetScaleArray == ["POINTS", "core_radius"])
        self.assertAlmostEqual(blobs.GaussianRadius, 0.5 ** 0.5)
        self.assertEqual(calls["Glyph"].return_value.OrientationArray, ["POINTS", "u"])
        self.assertEqual(calls["Glyph"].return_value.ScaleFactor, 2 / 16 / 2, "the longest is a sixteenth of the domain")
        self.assertEqual(calls["SaveScreenshot"].call_args.args[0], "there.png")

    def test_shows_a_volume_in_space(self):
        _, calls = self.run_and_view(SPACE, '["density", "particles"]')
        styles = [shown.SetRepresentationType.call_args.args[0] for shown in calls["shown"]
                  if shown.SetRepresentationType.called]
        self.assertEqual(styles, ["Volume", "Point Gaussian"])
        self.assertEqual(calls["views"][0].CameraViewUp, [0.0, 0.0, 1.0])

    def test_has_the_range_of_all_outputs(self):
        folder, calls = self.run_and_view(PLANE, '["density"]')
        with open(os.path.join(folder, "summary.json"), encoding="utf-8") as file:
            highest = max(frame["maximum"] for frame in json.load(file)["frames"])
        self.assertEqual(calls["GetColorTransferFunction"].return_value.RescaleTransferFunction.call_args.args, (0.0, highest))
        self.assertEqual(len(calls["views"]), 1)
        self.assertTrue(calls["GetScalarBar"].return_value.Title.endswith(r" \$x\$"), "a label is no formula")

    def test_pieces_name_the_core_radius(self):
        folder, _ = self.run_and_view(PLANE, '["particles"]', "--set", "output.piece_particles=100", "--set",
                                      "particles.per_axis=40")
        with open(os.path.join(folder, "particles", "particles_0001.pvtp"), encoding="ascii") as file:
            self.assertIn('Name="core_radius"', file.read())
        with open(os.path.join(folder, "particles", "particles_0001", "0000.vtp"), encoding="ascii") as file:
            self.assertIn('Name="core_radius"', file.read())


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0]])
