"""Runs a notebook from top to bottom, and compares what its cells print with what stands in the file. Pictures must come where there
were some. Ends with 77 where nbconvert, a kernel or matplotlib is missing.
Usage: notebook_test.py <notebook> <folder for the copy that was run>"""
import importlib.util
import json
import subprocess
import sys

notebook, folder = sys.argv[1:]
for module, package in (("nbconvert", "jupyter-nbconvert"), ("ipykernel", "python3-ipykernel"), ("matplotlib", "python3-matplotlib")):
    if importlib.util.find_spec(module) is None:
        print(f"skipped: {module} was not found (Debian: {package})")
        sys.exit(77)


def told(path):
    """What each cell prints, and how many pictures it shows."""
    with open(path, encoding="utf-8") as file:
        cells = json.load(file)["cells"]
    for cell in cells:
        outputs = cell.get("outputs", [])
        yield ("".join(cell["source"]), "".join("".join(output.get("text", "")) for output in outputs),
               sum("image/png" in output.get("data", {}) for output in outputs))


subprocess.run([sys.executable, "-m", "nbconvert", "--to", "notebook", "--execute", "--output-dir", folder, notebook], check=True)
expected, found = list(told(notebook)), list(told(f"{folder}/{notebook.rsplit('/', 1)[-1]}"))
assert len(expected) == len(found) > 20, (len(expected), len(found))
assert sum(pictures for _, _, pictures in expected) == 3
for (source, text, pictures), (_, text_found, pictures_found) in zip(expected, found):
    assert (text, pictures) == (text_found, pictures_found), f"the cell\n{source}\nsays\n{text_found}\nand the file has\n{text}"
