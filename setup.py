# SPDX-License-Identifier: MIT
"""pip install --no-build-isolation --no-deps .: builds Catena with CMake and installs the module with its library and the programs that it
starts, all inside of the package's folder. CATENA_BUILD names another build folder than build/pip, CATENA_PRESET another preset than
release."""
import os
import pathlib
import re
import shutil
import subprocess
import sys

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

SOURCE = pathlib.Path(__file__).resolve().parent
VERSION = re.search(r'kVersion = "(.*)"', (SOURCE / "engine/base/version.h").read_text(encoding="utf-8")).group(1)
FOLDERS = {"LIB": "lib", "BIN": "bin", "LIBEXEC": "libexec", "DATAROOT": "share", "INCLUDE": "include"}


class CMakeBuild(build_ext):
    def run(self):
        build = pathlib.Path(os.environ.get("CATENA_BUILD", SOURCE / "build/pip"))
        prefix = pathlib.Path(self.build_lib).resolve()
        if self.editable_mode:
            raise SystemExit("catena: an editable install is not made; build/PRESET/python can be put into PYTHONPATH")
        if not shutil.which("cmake"):
            raise SystemExit("catena: cmake is not found; `./run packages` lists what a build needs")
        subprocess.run(["cmake", "--preset", os.environ.get("CATENA_PRESET", "release"), "-S", str(SOURCE), "-B", str(build),
                        "-DCATENA_BENCH=OFF", "-DCATENA_TESTS=OFF", f"-DPython3_EXECUTABLE={sys.executable}", "-DCATENA_PYTHON_FOLDER=.",
                        *(f"-DCMAKE_INSTALL_{key}DIR=catena/{value}" for key, value in FOLDERS.items())],
                       cwd=SOURCE, check=True)
        subprocess.run(["cmake", "--build", str(build)], check=True)
        shutil.rmtree(prefix / "catena", ignore_errors=True)  # of an earlier version
        for component in ("python", "library", "catena"):
            subprocess.run(["cmake", "--install", str(build), "--prefix", str(prefix), "--component", component, "--strip"], check=True)
        for link in prefix.glob("catena/lib/*"):  # a wheel keeps no links: one file, by the name that the module asks for
            if link.is_symlink():
                link.resolve().replace(link)
        if not list(prefix.glob("catena/_catena*.so")):
            raise SystemExit("catena: the module was not built: pybind11-dev or python3-dev is missing")


setup(version=VERSION, packages=[], ext_modules=[Extension("catena._catena", [])], cmdclass={"build_ext": CMakeBuild})
