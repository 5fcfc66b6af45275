#!/usr/bin/env python3
"""The tutorial of docs/data.md does what it says: tutorial_of_data_test.py SOURCE_FOLDER PROGRAM"""
import pathlib
import re
import subprocess
import sys
import tempfile

source, program = pathlib.Path(sys.argv[1]), sys.argv[2]
page = (source / "docs/data.md").read_text()
tutorial = page[page.index("## Tutorial"):page.index("## NetCDF\n")]
case = re.search(r"```toml\n(.*?)```", tutorial, re.S).group(1)
with tempfile.TemporaryDirectory() as folder:
    pathlib.Path(folder, "drift.toml").write_text(case)
    subprocess.run([sys.executable, str(source / "tools/tutorial_currents"), "currents.nc"], cwd=folder, check=True)
    said = ""
    for command in (["check", "drift.toml"], ["run", "drift.toml", "--set", "output.images=[]"]):
        said += subprocess.run([program, *command], cwd=folder, check=True, capture_output=True, text=True).stdout
wrong = []
velocity = re.search(r"velocity +(u = .*)", tutorial).group(1)
if velocity not in said:
    wrong.append(velocity)
# Numbers of a page hold to a few per cent on other processors.
for name in ("Linf", "smoothing", "interpolation of the data"):
    promised, found = (re.search(name + r" ([0-9.e+-]+)", text[text.index("budget smoothing") - 400:]) for text in (tutorial, said))
    if not found or abs(float(found.group(1)) / float(promised.group(1)) - 1) > 0.05:
        wrong.append(f"{name}: the page has {promised.group(1)}, the program {found and found.group(1)}")
if wrong:
    sys.exit("\n".join(wrong) + "\n\n" + said)
