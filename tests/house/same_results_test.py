"""tools/same_results finds one bit that is not the same, in every kind of file, and is quiet about times and places.
Usage: same_results_test.py <source folder> <program> <scratch folder>"""
import os
import shutil
import subprocess
import sys

root, program, scratch = sys.argv[1:]
tool = os.path.join(root, "tools/same_results")
shutil.rmtree(scratch, ignore_errors=True)
os.makedirs(scratch)
only = ["--only", "case/charged_ball|sum/log-1d-tree-1e-3|reproduce/claims"]
listed = os.path.join(scratch, "list.txt")

# A program that does what the other does, then turns the last bit of one byte of files: in the middle, or of the first number of a table.
TURNS = """#!{python}
import os, subprocess, sys
result = subprocess.run([{program!r}, *sys.argv[1:]], stdout=subprocess.PIPE)
out = result.stdout
for name in {files!r}:
    if os.path.exists(name):
        with open(name, "r+b") as file:
            at = len(file.readline()) if name.endswith(".csv") else os.path.getsize(name) // 2
            file.seek(at)
            byte = file.read(1)[0]
            file.seek(at)
            file.write(bytes([byte ^ 1]))
if "claims" in sys.argv:
    out = out.replace(b"77.0", b"77.00000000000001")
sys.stdout.buffer.write(out)
sys.exit(result.returncode)
"""


def turning(files):
    path = os.path.join(scratch, "turning")
    with open(path, "w", encoding="utf-8") as script:
        script.write(TURNS.format(python=sys.executable, program=program, files=files))
    os.chmod(path, 0o755)
    return path


def same_results(*arguments, code):
    result = subprocess.run([sys.executable, tool, *only, *arguments], capture_output=True, text=True)
    if result.returncode != code:
        sys.exit(f"same_results {' '.join(arguments)}: exit code {result.returncode}, not {code}\n{result.stdout}{result.stderr}")
    return result.stdout.splitlines()


same_results("--write", listed, program, code=0)

# Another run has other times, and report.html and log.txt, which have them too, may be anything.
files = ["out/density/density_0002.vti", "out/particles/particles_0000.vtp", "out/images/slices_0001.png", "out/density.pvd",
         "out/summary.png", "out/run.toml",
         "out/series.csv", "values.csv"]
said = same_results(listed, turning([*files, "out/report.html", "out/log.txt"]), code=1)
wanted = {f"different  case/charged_ball/{file}" for file in files[:-1]}
wanted |= {"different  sum/log-1d-tree-1e-3/values.csv", "different  reproduce/claims/stdout.json"}
if set(said[:-1]) != wanted:
    sys.exit("\n".join(["these must be told, no others:", *sorted(wanted), "told was:", *said]))

# A program that writes nothing has lost everything. It is refused as the old one.
nothing = os.path.join(scratch, "nothing")
with open(nothing, "w", encoding="utf-8") as script:
    script.write("#!/bin/sh\n[ $1 = sum ] && exec \"%s\" \"$@\"\nexit 0\n" % program)
os.chmod(nothing, 0o755)
said = same_results(listed, nothing, code=1)
if not any(line.startswith("only old   case/charged_ball/out/density/") for line in said):
    sys.exit("a density that is not there is not missed:\n" + "\n".join(said))
same_results(nothing, program, code=2)

# Of two programs, what differs is shown.
only = ["--only", "sum/log-1d-tree-1e-3|reproduce/claims"]
said = "\n".join(same_results(program, turning(["values.csv"]), code=1))
for wanted in ("claims[0].computed: 77.0\n", "claims[0].computed: 77.00000000000001\n", "different  sum/log-1d-tree-1e-3/values.csv\n             line 2: "):
    if wanted not in said:
        sys.exit(f"{wanted!r} is not shown:\n{said}")
