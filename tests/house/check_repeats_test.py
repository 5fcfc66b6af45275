#!/usr/bin/env python3
"""Shows that tools/check_repeats notices what it is for: check_repeats_test.py ROOT SCRATCH"""
import os
import shutil
import subprocess
import sys

root, scratch = sys.argv[1:3]
shutil.rmtree(scratch, ignore_errors=True)
os.makedirs(os.path.join(scratch, "include"))
for module in ("one", "other"):
    os.makedirs(os.path.join(scratch, "src", module))


def check(one, other, said):
    for module, text in (("one", one), ("other", other)):
        with open(os.path.join(scratch, "src", module, "file.cpp"), "w") as file:
            file.write(text)
    result = subprocess.run([sys.executable, os.path.join(root, "tools/check_repeats"), scratch], capture_output=True, text=True)
    if (result.returncode != 0) != bool(said) or said not in result.stdout:
        sys.exit(f"expected {said or 'nothing'}, but it says\n{result.stdout}")


lines = [f"int number_{i} = {i};" for i in range(10)]
same = "\n".join(lines)
check(same, same, "src/one/file.cpp:1 and src/other/file.cpp:1: 10 equal lines or more")
check(same, "\n\n// a comment\n" + same.replace("int ", "  int   "), "src/one/file.cpp:1 and src/other/file.cpp:4")
check(same, same.replace("number_4", "count_4"), "")
check(same + "\n" + same, "", "")
