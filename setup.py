"""The Python packages, built by CMake in build/pip, which the next call uses again. pip is told about them in pyproject.toml.

Two variables of the environment change that:
GAUSSDRIFT_CMAKE_ARGS has further options for CMake. "-D GAUSSDRIFT_BUILD_SIMULATOR=OFF" leaves the simulator out, and what it needs.
GAUSSDRIFT_PYTHON_PACKAGES is a folder with packages that are built already, such as build/release/python. Nothing is built then.
"""
import os
import re
import shlex
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

root = Path(__file__).resolve().parent
build = root / "build" / "pip"
built = os.environ.get("GAUSSDRIFT_PYTHON_PACKAGES")
packages_folder = Path(built).resolve() if built else build / "python"


def call(*command):
    try:
        subprocess.run(command, check=True)
    except FileNotFoundError:
        sys.exit(f"{command[0]} was not found; docs/install.md names the packages that the build needs")
    except subprocess.CalledProcessError as error:
        sys.exit(f"{shlex.join(command)} ended with exit code {error.returncode}; docs/install.md names the packages that the build needs")


class BuildWithCMake(build_ext):
    """Builds all packages at once, and puts them where setuptools looks for them."""

    def run(self):
        if self.inplace:
            sys.exit("pip install -e has no use here: put build/release/python on PYTHONPATH")
        if not built:
            self.build_packages()
        packages = self.packages()
        if not packages:
            sys.exit(f"{packages_folder} has no packages for Python {sysconfig.get_python_version()}")
        for package in packages:
            shutil.copytree(package, Path(self.build_lib) / package.name, dirs_exist_ok=True,
                            ignore=shutil.ignore_patterns("__pycache__"))

    def build_packages(self):
        generator = ["-G", "Ninja"] if shutil.which("ninja") and not (build / "CMakeCache.txt").exists() else []
        call("cmake", "-S", str(root), "-B", str(build), *generator, "-D", "CMAKE_BUILD_TYPE=Release", "-D", "BUILD_TESTING=OFF",
             "-D", "GAUSSDRIFT_OSMESA=OFF", "-D", "GAUSSDRIFT_MPI=OFF", "-D", f"Python_EXECUTABLE={sys.executable}",
             *shlex.split(os.environ.get("GAUSSDRIFT_CMAKE_ARGS", "")))
        call("cmake", "--build", str(build), "--target", "python_packages", "--parallel", str(os.cpu_count() or 1))

    def packages(self):
        """Of the module that was built for this Python."""
        suffix = sysconfig.get_config_var("EXT_SUFFIX")
        return sorted(path.parent for path in packages_folder.glob(f"*/_core{suffix}"))

    def get_outputs(self):
        return [str(Path(self.build_lib) / file.relative_to(packages_folder))
                for package in self.packages() for file in package.iterdir() if file.is_file()]


version = re.search(r"^project\(gaussdrift VERSION ([0-9.]+)", (root / "CMakeLists.txt").read_text(), re.M)[1]
# The one extension stands for all, so that setuptools makes a wheel for this Python.
setup(version=version, packages=[], ext_modules=[Extension("gaussdrift._core", sources=[])], cmdclass={"build_ext": BuildWithCMake})
