"""The page of a run in a real browser: it opens alone, plays, and tells the values that the files have.
Usage: player_test.py <gaussdrift>. Ends with 77, which means skipped, where there is no Chromium."""
import base64
import os
import re
import struct
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import browser

PROGRAM = os.path.abspath(sys.argv[1])
CHROMIUM = browser.find()

CONE = """
gaussdrift = 1
[case]
title = "</script><script>window.hacked = 1</script><img src=x onerror='window.hacked = 2'>"
label = "<b>dye</b>"
[domain]
min = [-1, -1]
max = [1, 0.5]
[[velocity]]
u = ["-y", "x"]
[[density]]
shape = "gaussian"
center = [0.5, 0]
radius = 0.2
[particles]
per_axis = 60
[time]
end = 3
step = 0.1
[evaluate]
per_axis = 41
[output]
times = [0, 1, 2, 3]
vtk = ["density", "particles"]
[reference]
kind = "characteristics"
"""

SPACE = """
gaussdrift = 1
[case]
title = "Blob in space"
[domain]
min = [-1, -1, -1]
max = [1, 1, 1]
[[velocity]]
u = ["-y", "x", "0"]
[[density]]
shape = "gaussian"
center = [0.4, 0, 0.1]
radius = 0.4
[particles]
per_axis = 25
[time]
end = 1
step = 0.25
[evaluate]
per_axis = 21
[output]
times = [0, 1]
vtk = ["density"]
images = []
"""


def grid_of(file):
    """Points, origin and spacing of a .vti, and a function that returns the values of an array."""
    with open(file, encoding="ascii") as text:
        vti = text.read()
    extent = [int(word) for word in re.search(r'WholeExtent="([^"]*)"', vti)[1].split()]
    points = [extent[2 * k + 1] + 1 for k in range(3)]
    origin, spacing = ([float(word) for word in re.search(rf'{name}="([^"]*)"', vti)[1].split()] for name in ["Origin", "Spacing"])

    def values(name):
        body = re.search(rf'Name="{name}"[^>]*>(.*?)</DataArray>', vti, re.S)[1]
        raw = base64.b64decode(body.split(">")[-1])
        count = points[0] * points[1] * points[2]
        return struct.unpack(f"<{count}d", raw[-8 * count:])

    return points, origin, spacing, values


def run(folder, text, *more):
    with open(os.path.join(folder, "a.toml"), "w", encoding="utf8") as case:
        case.write(text)
    done = subprocess.run([PROGRAM, "run", "a.toml", "--force", *more], cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return os.path.join(folder, "output/a")


def numbers_in(readout):
    """The numbers behind "x =", "density" and so on."""
    text = readout.replace("\u2212", "-")
    return {name.strip(): float(value) for name, value in re.findall(r"([a-zA-Z<>/ ]+?)(?: =)? (-?\d[\d.e-]*)", text)}


READY = "document.documentElement.dataset.player === 'ready'"
TEXT = "document.getElementById('{}').textContent"


class Page(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        cls.folder = run(cls.scratch.name, CONE)
        cls.browser = browser.Browser(CHROMIUM)

    @classmethod
    def tearDownClass(cls):
        cls.browser.close()
        cls.scratch.cleanup()

    def opened(self, file="report.html"):
        seconds = self.browser.open(os.path.join(self.folder, file))
        self.browser.wait_for(READY)
        return seconds

    def text(self, element):
        return self.browser.evaluate(TEXT.format(element))

    def check_quiet(self):
        """Nobody was asked for anything but the page, and nothing was complained about."""
        self.assertEqual([url for url in self.browser.requests if not url.endswith("/report.html") and not url.startswith("data:")], [])
        self.assertEqual(self.browser.complaints, [])

    def check_readout(self, frame):
        """What the page tells of a point is what the file has there, but for rounding."""
        points, origin, spacing, values = grid_of(os.path.join(self.folder, f"density/density_{frame:04}.vti"))
        told = numbers_in(self.text("readout"))
        index = [round((told[axis] - origin[k]) / spacing[0]) for k, axis in enumerate("xy")]
        for k, axis in enumerate("xy"):
            self.assertAlmostEqual(told[axis], origin[k] + index[k] * spacing[0], delta=1e-5)  # six digits are told
        at = index[1] * points[0] + index[0]
        for name, array in [("<b>dye</b>", "rho"), ("exact <b>dye</b>", "rho_exact"), ("error", "error")]:
            exact = values(array)
            # 65534 steps between the ends, half a step wrong at most; the exact density is that of two arrays; six digits.
            steps = sum(max(values(one)) - min(values(one)) for one in (["rho", "error"] if array == "rho_exact" else [array]))
            self.assertAlmostEqual(told[name], exact[at], delta=steps / 131068 + 1e-6 * abs(exact[at]))
            self.assertLess(steps / 131068, (max(exact) - min(exact)) / 500)
        return index

    def test_opens_alone_and_tells_the_values_of_the_files(self):
        seconds = self.opened()
        print(f"the page opened in {seconds:.2f} s")
        self.assertEqual(self.text("time-text"), "t = 0")
        self.check_readout(0)
        self.browser.evaluate("document.getElementById('time').focus()")
        for _ in range(2):
            self.browser.key("ArrowRight")
        self.browser.wait_for(TEXT.format("time-text") + " === 't = 2'")
        box = self.browser.evaluate("(({x, y, width, height}) => [x, y, width, height])(document.getElementById('map').getBoundingClientRect())")
        self.browser.evaluate("document.getElementById('map').scrollIntoView()")
        top = self.browser.evaluate("document.getElementById('map').getBoundingClientRect().y")
        found = set()
        for part in [0.3, 0.45, 0.6]:
            self.browser.move(box[0] + part * box[2], top + 0.4 * box[3])
            self.browser.wait_for("!" + TEXT.format("readout") + ".startsWith('Largest')")
            self.browser.evaluate("new Promise(requestAnimationFrame)")
            found.add(tuple(self.check_readout(2)))
        self.assertEqual(len(found), 3)  # points of the grid, not one of them thrice
        self.check_quiet()

    def test_fields_overlays_and_zoom_draw_without_complaint(self):
        self.opened()
        drawn = "document.getElementById('map').toDataURL()"
        pictures = {self.browser.evaluate(drawn)}
        fields = self.browser.evaluate("[...document.getElementById('field').options].map(option => option.textContent)")
        self.assertEqual(fields, ["<b>dye</b>", "exact <b>dye</b>", "error", "slope of the <b>dye</b>"])
        change = "(e => {{ e.{} = {}; e.dispatchEvent(new Event('change')); }})(document.getElementById('{}'))"
        steps = [("value", "3", "field"), ("value", "2", "field"), ("value", "'viridis'", "colours"), ("checked", "true", "zoom"),
                 ("checked", "true", "particles"), ("checked", "true", "arrows")]
        for number, (what, value, element) in enumerate(steps):
            self.browser.evaluate(change.format(what, value, element))
            for _ in range(200):
                pictures.add(self.browser.evaluate(drawn))
                if len(pictures) == number + 2:
                    break
            self.assertEqual(len(pictures), number + 2, f"{element} changed nothing")
        self.check_quiet()

    def test_space_plays_and_keys_hold_a_point(self):
        self.opened()
        self.browser.evaluate("document.getElementById('map').focus()")
        self.browser.key(" ")
        self.browser.wait_for(TEXT.format("time-text") + " !== 't = 0'")
        self.assertEqual(self.text("play"), "Pause")
        self.browser.key(" ")
        self.assertEqual(self.text("play"), "Play")
        self.browser.evaluate("(e => { e.value = 0; e.dispatchEvent(new Event('input')); })(document.getElementById('time'))")
        self.browser.wait_for(TEXT.format("readout") + ".startsWith('Largest')")
        before = self.check_readout(0)
        self.browser.key("ArrowUp")
        self.browser.wait_for("!" + TEXT.format("readout") + ".startsWith('Largest')")
        self.assertEqual(self.check_readout(0), [before[0], before[1] + 1])
        self.browser.key("Escape")
        self.browser.wait_for(TEXT.format("readout") + ".startsWith('Largest')")
        self.check_quiet()

    def test_words_of_a_case_are_words(self):
        self.opened()
        self.assertIsNone(self.browser.evaluate("window.hacked"))
        self.assertIn("<script>window.hacked", self.browser.evaluate("document.title"))
        self.assertEqual(self.browser.evaluate("[...document.querySelectorAll('b')].filter(b => b.textContent === 'dye').length"), 0)
        self.assertIn("Right to", self.text("verdict"))
        self.assertIn("of the highest <b>dye</b>", self.text("verdict"))

    def test_print_has_the_picture_and_telephones_have_room(self):
        self.opened()
        with browser.Browser(CHROMIUM, width=390, height=844) as small:
            small.open(os.path.join(self.folder, "report.html"))
            small.wait_for(READY)
            self.assertLessEqual(small.evaluate("document.documentElement.scrollWidth"), 390)
        self.browser.call("Emulation.setEmulatedMedia", media="print")
        try:
            self.assertEqual(self.browser.evaluate("getComputedStyle(document.getElementById('player')).display"), "none")
        finally:
            self.browser.call("Emulation.setEmulatedMedia", media="")

    def test_the_page_can_be_made_again_and_without_what_plays(self):
        page = os.path.join(self.folder, "report.html")

        def frames():
            with open(page, encoding="utf8") as text:
                return re.search(r'id="frames">([^<]*)<', text.read())

        first = frames()[1]
        with open(os.path.join(self.folder, "report.frames"), "rb") as file:
            self.assertEqual(base64.b64decode(first), file.read())
        subprocess.run([PROGRAM, "report", self.folder], check=True, capture_output=True)
        self.assertEqual(frames()[1], first)
        os.rename(os.path.join(self.folder, "report.frames"), os.path.join(self.folder, "kept"))
        try:
            subprocess.run([PROGRAM, "report", self.folder], check=True, capture_output=True)
            self.opened()  # from the density files
            self.check_readout(0)
        finally:
            os.rename(os.path.join(self.folder, "kept"), os.path.join(self.folder, "report.frames"))
            subprocess.run([PROGRAM, "report", self.folder], check=True, capture_output=True)

    def test_in_space_planes_are_shown(self):
        with tempfile.TemporaryDirectory() as scratch:
            folder = run(scratch, SPACE)
            self.browser.open(os.path.join(folder, "report.html"))
            self.browser.wait_for(READY)
            points, origin, spacing, values = grid_of(os.path.join(folder, "density/density_0000.vti"))
            self.browser.evaluate("(e => { e.value = 1; e.dispatchEvent(new Event('change')); })(document.getElementById('plane'))")
            self.browser.evaluate("(e => { e.value = 12; e.dispatchEvent(new Event('input')); })(document.getElementById('depth'))")
            self.browser.wait_for(TEXT.format("readout") + ".includes('y = 0.2,')")
            told = numbers_in(self.text("readout"))
            index = [round((told[axis] - origin[k]) / spacing[0]) for k, axis in enumerate("xyz")]
            rho = values("rho")
            at = (index[2] * points[1] + index[1]) * points[0] + index[0]
            self.assertAlmostEqual(told["density"], rho[at], delta=(max(rho) - min(rho)) / 131068 + 1e-6 * abs(rho[at]))
            plane = [rho[(z * points[1] + index[1]) * points[0] + x] for z in range(points[2]) for x in range(points[0])]
            self.assertEqual(rho[at], max(plane))
            self.check_quiet()


if __name__ == "__main__":
    if not CHROMIUM:
        print("skipped: there is no Chromium here (Debian: apt-get install chromium)")
        sys.exit(77)
    unittest.main(argv=sys.argv[:1])
