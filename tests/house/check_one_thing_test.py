#!/usr/bin/env python3
"""Shows that tools/check_one_thing notices what it is for: check_one_thing_test.py ROOT SCRATCH"""
import os
import shutil
import subprocess
import sys

root, scratch = sys.argv[1:3]
shutil.rmtree(scratch, ignore_errors=True)
for folder in ("src", "include", "cmake", "cases", "tests"):
    shutil.copytree(os.path.join(root, folder), os.path.join(scratch, folder), ignore=shutil.ignore_patterns("corpus"))
for file in ("CMakeLists.txt", "CONTRIBUTING.md"):
    shutil.copy(os.path.join(root, file), scratch)


def check():
    return subprocess.run([sys.executable, os.path.join(root, "tools/check_one_thing"), scratch], capture_output=True, text=True)


FAULTS = [  # (file, what it has, what it gets, what is said)
    ("src/accuracy/warnings.cpp", "namespace gaussdrift", "const char* told = \"gauss6\";\nnamespace gaussdrift",
     "warnings.cpp names gauss6 too, so one more takes more than 2"),
    ("src/field/CMakeLists.txt", "gaussdrift_module(", "set(more named/double_gyre.cpp)\ngaussdrift_module(",
     "src/field/CMakeLists.txt names double_gyre too"),
    ("CONTRIBUTING.md", "| an effect | 4 |", "| an effect | 3 |", "an effect: the row says 3 and lists 4"),
    ("CONTRIBUTING.md", "`src/render/styles.cpp`", "`src/render/stiles.cpp`", "there is no src/render/stiles.cpp"),
    ("tests/unit/cutoff_test.cpp", "gauss6", "gauss66", "cutoff_test.cpp does not name gauss6"),
    ("CONTRIBUTING.md", "| to add |", "| to have |", "there is no table"),
]
if check().returncode != 0:
    sys.exit("the tree fails the check: " + check().stdout)
for name, old, new, said in FAULTS:
    path = os.path.join(scratch, name)
    with open(path) as file:
        before = file.read()
    if old not in before:
        sys.exit(f"{name} has no longer: {old}")
    with open(path, "w") as file:
        file.write(before.replace(old, new))
    result = check()
    if result.returncode == 0 or said not in result.stdout:
        sys.exit(f"{name}: \"{said}\" is not noticed\n{result.stdout}")
    with open(path, "w") as file:
        file.write(before)
