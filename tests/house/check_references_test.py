"""The check of references finds what it should: each of these faults, put into a copy of the tree, must fail it.
Usage: check_references_test.py <source folder> <scratch folder>"""
import os
import shutil
import subprocess
import sys

root, scratch = sys.argv[1:]
shutil.rmtree(scratch, ignore_errors=True)
for folder in ("docs", "src", "include", "tests", "tools", "cases", "cmake", "examples"):
    if os.path.isdir(os.path.join(root, folder)):
        shutil.copytree(os.path.join(root, folder), os.path.join(scratch, folder), ignore=shutil.ignore_patterns("build"))
for name in os.listdir(root):
    if os.path.isfile(os.path.join(root, name)):
        shutil.copy(os.path.join(root, name), scratch)


def check():
    return subprocess.run([sys.executable, os.path.join(root, "tools/check_references"), scratch],
                          capture_output=True, text=True)


def read(name):
    with open(os.path.join(scratch, name), encoding="utf-8") as file:
        return file.read()


def write(name, text):
    with open(os.path.join(scratch, name), "w", encoding="utf-8") as file:
        file.write(text)


good = check()
if good.returncode != 0:
    sys.exit("the tree as it is fails the check:\n" + good.stdout + good.stderr)

SOURCE = "src/time/tableau.cpp"
# File, what is replaced (empty: put at the end), by what, what the check says.
FAULTS = [
    ("docs/method.md", "", "\nAs in [Nob99, 3] and elsewhere.\n", "[Nob99] is not in docs/references.md"),
    (SOURCE, "", "// after [Nob99]\n", "[Nob99] is not in docs/references.md"),
    (SOURCE, "", "// r = 1. [CASES, 11]\n", "[CASES, ...] reads like a key"),
    ("docs/references.md", "| [GS91]", "| [GS92]", "nobody refers to [GS92]"),
    ("docs/references.md", "| [GS91]", "| [Sch06] | again |\n| [GS91]", "[Sch06] is there already"),
    ("docs/usage.md", "", "\nSee [this](nowhere.md).\n", "the link nowhere.md leads nowhere"),
    ("docs/usage.md", "", "\nSee [this](method.md#nothing-of-it).\n", "has no heading #nothing-of-it"),
    ("README.md", "docs/gallery/swirl.png", "docs/gallery/whirl.png", "the link docs/gallery/whirl.png leads nowhere"),
    (SOURCE, "", "// method.md, sections 8 and 8.9\n", "docs/method.md has no section 8.9"),
    (SOURCE, "", "// method.md, equation (40)\n", "docs/method.md has no equation 40"),
    ("docs/method.md", "    (2)   X_j'", "    (1)   X_j'", "equation 1 is there 2 times"),
    ("README.md", "| [decay]", "\n| [decay]", "the table of cases has 0 rows of cases/decay.toml"),
    ("docs/reproduce.md", "N = 8000    |      1e4 4.5e4", "N = 8000    |      1e3 4.5e4", "Table 4.1, 8000: 1e3 is not"),
    ("docs/reproduce.md", "N = 8000   |    141", "N = 8001   |    141", "Table 6.1 has no row 8001"),
    ("docs/usage.md", "", "\nSee tests/nowhere/ for more.\n", "there is no tests/nowhere"),
    ("docs/usage.md", "", "\n```\ntools/run cases/nothing.toml\n```\n", "there is no cases/nothing.toml"),
    ("docs/usage.md", "", "\nTables 4.1 to 4.10 and Figure 5.3b are there.\n", "there is no Table 4.10"),
    (SOURCE, "", "// as in Figures 3.6 and 3.8\n", "there is no Figure 3.8"),
    ("examples/gauss_transform.cpp", "count = 20000", "count = 30000", "what it quotes of examples/gauss_transform.cpp"),
    ("docs/library.md", "// examples/observed_run.cpp", "// observed_run", "examples/observed_run.cpp: no page quotes it"),
    (SOURCE, "", "// see time/tabelau.hpp\n", "there is no time/tabelau.hpp"),
    (SOURCE, "", "// see tabelau.hpp\n", "no folder has a tabelau.hpp"),
    (SOURCE, "", "// tests/reference/schroeder-tab*.csv, tests/{unit,unti}/\n", "there is no tests/{unit,unti}"),
    (SOURCE, "", "// docs/fgtd.md, \"The promises\"\n", "docs/fgtd.md has no heading The promises"),
    (SOURCE, "", "// method.md, 4\n", "does not say whether it is a section"),
    (SOURCE, "", "// docs/decisions/0099-nothing.md\n", "there is no docs/decisions/0099-nothing.md"),
    (SOURCE, "", "constexpr auto told = \"see docs/nothing.md\";\n", "there is no docs/nothing.md"),
    (SOURCE, "", "// method.md, equations 4 and 4c\n", "docs/method.md has no equation 4c"),
    ("docs/testing.md", "`house.clang`", "`house.klang`", "has no test house.klang"),
    ("tests/CMakeLists.txt", "", "# see tools/nothing\n", "there is no tools/nothing"),
    ("docs/decisions/0001-modules-and-libraries.md", "# 0001: ", "# ", "does not begin with \"# 0001: \""),
    ("docs/changes/0096-particles-in-pieces.md", "# 0096: ", "# 0090: ", "does not begin with \"# 0096: \""),
    ("CONTRIBUTING.md", "`remesh_kernel.cpp`", "`remesh_kernels.cpp`", "no folder has a remesh_kernels.cpp"),
    ("README.md", "| [decay](cases/decay.toml)", "| [decay](cases/swirl.toml)", "0 rows of cases/decay.toml"),
]
# Many at a time, as reading the tree takes a while, but of those that replace something one a file.
left = FAULTS
while left:
    together, later, before = [], [], {}
    for fault in left:
        name, old, new, said = fault
        if old and any(name == other[0] for other in together):
            later.append(fault)
            continue
        together.append(fault)
        text = read(name)
        before.setdefault(name, text)
        if old not in text:
            sys.exit(f"{name} has no longer: {old}")
        write(name, text.replace(old, new, 1) if old else text + new)
    result = check()
    for name, old, new, said in together:
        if result.returncode == 0 or not any(said in line for line in result.stdout.splitlines()):
            sys.exit(f"{name}: \"{said}\" is not noticed\n{result.stdout}")
    for name, text in before.items():
        write(name, text)
    left = later

changes = os.path.join(scratch, "docs/changes")
first = sorted(os.listdir(changes))[0]
shutil.copy(os.path.join(changes, first), os.path.join(changes, first[:4] + "-another.md"))
result = check()
if result.returncode == 0 or "has this number" not in result.stdout:
    sys.exit("two pages with one number are not noticed")
os.remove(os.path.join(changes, first[:4] + "-another.md"))
if check().returncode != 0:
    sys.exit("the tree again fails the check")
