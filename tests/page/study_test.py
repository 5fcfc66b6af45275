"""What a study leaves to be looked at: charts as SVG and PDF, and its page in a real browser.
Usage: study_test.py <gaussdrift> files|browser. Ends with 77, which means skipped, where there is no Chromium."""
import os
import re
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree as xml

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import browser

PROGRAM = os.path.abspath(sys.argv[1])
CHROMIUM = browser.find()
SVG = "{http://www.w3.org/2000/svg}"

CASE = """
gaussdrift = 1
[case]
title = "</title></svg><script>window.hacked = 1</script> & <img src=x onerror='window.hacked = 2'>"
[domain]
min = [-1, -1]
max = [1, 1]
[[velocity]]
u = ["-y", "x"]
[[density]]
shape = "gaussian"
center = [0.5, 0]
radius = 0.2
[particles]
per_axis = 40
[time]
end = 0.5
step = 0.1
[evaluate]
per_axis = 31
[output]
times = [0.5]
[reference]
kind = "characteristics"
"""


def study(folder, *options):
    with open(os.path.join(folder, "case.toml"), "w", encoding="ascii") as case:
        case.write(CASE)
    subprocess.run([PROGRAM, "study", "case.toml", "--repeats", "1", "--out", "st", *options], cwd=folder, check=True,
                   stdout=subprocess.DEVNULL)
    return os.path.join(folder, "st")


def setUpModule():
    global SCRATCH, VARIED, STANDARD
    SCRATCH = tempfile.TemporaryDirectory()
    for name in ["varied", "standard"]:
        os.mkdir(os.path.join(SCRATCH.name, name))
    VARIED = study(os.path.join(SCRATCH.name, "varied"), "--vary", "particles.cutoff=gauss2,gauss4", "--vary",
                   "particles.per_axis=30,40,60")
    STANDARD = study(os.path.join(SCRATCH.name, "standard"), "--seconds", "4")


def tearDownModule():
    SCRATCH.cleanup()


def text_of(element):
    return "".join(element.itertext())


class Files(unittest.TestCase):
    def test_svg_is_xml_with_titles_and_text(self):
        for name in ["transform", "steps", "lattice", "whole"]:
            root = xml.parse(os.path.join(STANDARD, name + ".svg")).getroot()
            self.assertEqual(root.tag, SVG + "svg")
            self.assertTrue(root.find(SVG + "title").text)
            self.assertTrue(root.find(SVG + "desc").text)
            words = [text_of(text) for text in root.iter(SVG + "text")]
            self.assertTrue(any(word.startswith("seconds ") for word in words), "the axis has a name with its unit")
            marks = [mark for mark in root.iter(SVG + "polygon") if mark.find(SVG + "title") is not None]
            self.assertGreater(len(marks), 2)
            for mark in marks:
                self.assertRegex(mark.find(SVG + "title").text, r"error .* in .* s")
            for element in root.iter():
                self.assertNotIn("script", element.tag)
                self.assertNotIn("href", " ".join(element.attrib))

    def test_chart_of_whole_runs_names_front_current_recommended_predicted_and_measured(self):
        root = xml.parse(os.path.join(STANDARD, "whole.svg")).getroot()
        words = " ".join(text_of(text) for text in root.iter(SVG + "text"))
        for name in ["nothing faster is as accurate", "measured", "predicted", "current: "]:
            self.assertIn(name, words)
        with open(os.path.join(STANDARD, "study.json"), encoding="utf-8") as file:
            roles = re.findall(r'"role": "(\w+)"', file.read())
        self.assertIn("current", roles)
        if "recommended" in roles:
            self.assertRegex(words + " ".join(roles), "recommended")

    def test_pdf_has_its_objects_where_it_says(self):
        with open(os.path.join(VARIED, "study.pdf"), "rb") as file:
            pdf = file.read()
        self.assertTrue(pdf.startswith(b"%PDF-1.4\n"))
        start = int(re.search(rb"startxref\n(\d+)\n%%EOF\n$", pdf)[1])
        self.assertTrue(pdf[start:].startswith(b"xref\n0 8\n"))
        places = [int(place) for place in re.findall(rb"(\d{10}) 00000 n", pdf[start:])]
        for number, place in enumerate(places, 1):
            self.assertTrue(pdf[place:].startswith(b"%d 0 obj\n" % number))
        length = int(re.search(rb"/Length (\d+)", pdf)[1])
        begin = pdf.index(b"stream\n") + len(b"stream\n")
        self.assertTrue(pdf[begin + length:].startswith(b"endstream"))
        self.assertIn(b"(gauss4) Tj", pdf, "words are text")


@unittest.skipUnless(CHROMIUM, "no Chromium")
class InABrowser(unittest.TestCase):
    def check_alone(self, chromium, file):
        self.assertEqual(chromium.complaints, [])
        self.assertEqual([url for url in chromium.requests if not url.startswith(("file://" + file, "data:"))], [])
        self.assertIsNone(chromium.evaluate("window.hacked ?? null"))

    def test_page_opens_alone_and_tells_the_numbers_of_the_table(self):
        file = os.path.join(VARIED, "study.html")
        with browser.Browser(CHROMIUM) as chromium:
            chromium.open(file)
            self.check_alone(chromium, file)
            place = chromium.evaluate("""(() => {
              const box = document.querySelector('.chart-wide .mark').getBoundingClientRect();
              return [box.x + box.width / 2, box.y + box.height / 2];
            })()""")
            chromium.move(place[0] + 3, place[1] + 2)
            told = chromium.evaluate("document.querySelector('.chart-value').textContent")
            self.assertIn("particles.cutoff = gauss2, particles.per_axis = 30", told)
            with open(os.path.join(VARIED, "study.csv"), encoding="utf-8") as table:
                header, row = [line.rstrip("\n").split(",") for line in list(table)[:2]]
            error = float(row[header.index("error")])
            self.assertAlmostEqual(float(re.search(r"error ([\d.]+) in", told)[1]) / error, 1, delta=0.01)
            chromium.evaluate("document.querySelector('.chart-wide svg').focus()")
            chromium.key("ArrowRight")
            self.assertIn("per_axis = ", chromium.evaluate("document.querySelector('.chart-value').textContent"))
            self.check_alone(chromium, file)

    def test_page_fits_a_phone_and_the_dark(self):
        file = os.path.join(STANDARD, "study.html")
        with browser.Browser(CHROMIUM, width=390, height=800,
                             features=[("prefers-color-scheme", "dark")]) as chromium:
            chromium.open(file)
            self.check_alone(chromium, file)
            self.assertLessEqual(chromium.evaluate("document.documentElement.scrollWidth"), 390)
            self.assertEqual(chromium.evaluate("getComputedStyle(document.querySelector('.chart-wide')).display"), "none")
            smallest = chromium.evaluate("""Math.min(...[...document.querySelectorAll('.chart-narrow text')].map(
              text => parseFloat(getComputedStyle(text).fontSize) * text.ownerSVGElement.getBoundingClientRect().width /
                      text.ownerSVGElement.viewBox.baseVal.width))""")
            self.assertGreater(smallest, 9, "letters can be read")
            ground, ink = (chromium.evaluate(f"getComputedStyle({what})") for what in
                           ["document.body).backgroundColor + (''", "document.querySelector('.chart text.text')).fill + (''"])
            self.assertLess(sum(map(int, re.findall(r"\d+", ground)[:3])), 150)
            self.assertGreater(sum(map(int, re.findall(r"\d+", ink)[:3])), 500)


if __name__ == "__main__":
    part = {"files": Files, "browser": InABrowser}[sys.argv[2]]
    if part is InABrowser and not CHROMIUM:
        print("skipped: there is no Chromium")
        sys.exit(77)
    unittest.main(argv=[sys.argv[0]], defaultTest=part.__name__)
