"""pip installs the packages that are built already into a fresh environment, they run there, and pip removes them again. Ends with 77
where venv, pip or wheel is missing.
Usage: pip_test.py <source folder> <build folder>/python <scratch folder>"""
import importlib.util
import os
import pathlib
import shutil
import subprocess
import sys

source, packages, scratch = map(pathlib.Path, sys.argv[1:])
for module, package in (("ensurepip", "python3-venv"), ("wheel", "python3-wheel"), ("setuptools", "python3-setuptools")):
    if importlib.util.find_spec(module) is None:
        print(f"skipped: {module} was not found (Debian: {package})")
        sys.exit(77)

shutil.rmtree(scratch, ignore_errors=True)
tree, environment = scratch / "tree", scratch / "environment"
tree.mkdir(parents=True)
for name in ("pyproject.toml", "setup.py", "README.md", "LICENSE", "CMakeLists.txt"):  # pip writes beside them
    shutil.copy(source / name, tree)
own_pip = [] if importlib.util.find_spec("pip") is None else ["--without-pip"]  # that of the system is there in 6 seconds less
subprocess.run([sys.executable, "-m", "venv", "--system-site-packages", *own_pip, environment], check=True)
python = environment / "bin" / "python"
variables = {name: value for name, value in os.environ.items() if name not in ("PYTHONPATH", "PYTHONDONTWRITEBYTECODE")}
variables["GAUSSDRIFT_PYTHON_PACKAGES"] = str(packages)


def call(*words):
    return subprocess.run([python, *words], check=True, env=variables, cwd=scratch, stdout=subprocess.PIPE, text=True).stdout


call("-m", "pip", "install", "--quiet", "--no-index", "--no-build-isolation", tree)
said = call("-c", "import fgtd, farfield, rbf, gaussdrift; print(gaussdrift.__file__, *fgtd.transform([[0.0, 0]], [2.0], sigma=1, targets=[[0.0, 0]]))")
file, value = said.split()
assert file.startswith(str(environment)), file
assert abs(float(value) - 2) <= 2e-6, value  # the default tolerance, 1e-6, times the weight
call("-m", "pip", "uninstall", "--quiet", "--yes", "gaussdrift")
left = [path for name in ("fgtd", "farfield", "rbf", "gaussdrift*") for path in environment.glob(f"lib/*/site-packages/{name}")]
assert not left, left
