# SPDX-License-Identifier: MIT
"""What `pip install --no-build-isolation --no-deps .` does, without the compiler: setup.py builds the wheel with a `cmake` that configures and
installs as it is asked to, and where it should compile takes what this build has made. Run by ctest with BUILD, SOURCE and CMAKE."""
import os
import pathlib
import re
import shutil
import stat
import subprocess
import sys
import tempfile
import unittest
import zipfile

BUILD, SOURCE, CMAKE = pathlib.Path(os.environ["BUILD"]), pathlib.Path(os.environ["SOURCE"]), os.environ["CMAKE"]


def stand_in(arguments):
    """Is the `cmake` that setup.py finds."""
    if arguments[0] != "--build":
        return subprocess.run([CMAKE, *arguments, *(["-DCMAKE_BUILD_RPATH_USE_ORIGIN=ON"] if "-S" in arguments else [])], check=False).returncode
    made = pathlib.Path(arguments[1])
    for path in BUILD.iterdir():
        if path.is_file() and (path.name == "catena" or re.match(r"catena-(read|write|watchdog|device)|libcatena\.so", path.name)):
            shutil.copy(path, made / path.name, follow_symlinks=False)
    for folder in "python", "manual":
        shutil.copytree(BUILD / folder, made / folder, dirs_exist_ok=True)
    # the module finds the library as that build's would: what is installed must find it by itself
    old, new = (re.search(r'_catena[^"]*\.so"\s*OLD_RPATH "(.*)"', (root / "cmake_install.cmake").read_text(encoding="utf-8")).group(1) for root in (BUILD, made))
    module = next((made / "python/catena").glob("_catena*.so"))
    script = made / "rpath.cmake"
    script.write_text(f'file(RPATH_CHANGE FILE "{module}" OLD_RPATH "{old}" NEW_RPATH "{new}")\n', encoding="utf-8")
    return subprocess.run([CMAKE, "-P", script], check=False).returncode


class Pip(unittest.TestCase):
    def test_the_wheel_has_all_that_the_module_needs(self):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            (root / "tree").mkdir()
            for name in "setup.py", "pyproject.toml":  # setuptools writes beside them
                (root / "tree" / name).symlink_to(SOURCE / name)
            (root / "bin").mkdir()
            cmake = root / "bin/cmake"
            cmake.write_text(f'#!/bin/sh\nexec "{sys.executable}" -B "{pathlib.Path(__file__).resolve()}" stand-in "$@"\n', encoding="utf-8")
            cmake.chmod(cmake.stat().st_mode | stat.S_IXUSR)
            built = subprocess.run([sys.executable, "-c", "import setuptools.build_meta as b; print(b.build_wheel('../wheel'))"], cwd=root / "tree",
                                   env={**os.environ, "PATH": f"{root}/bin:{os.environ['PATH']}", "CATENA_BUILD": f"{root}/build",
                                        "DEBFULLNAME": "Ada", "DEBEMAIL": "ada@example.org"},
                                   capture_output=True, text=True, check=False)
            self.assertEqual(built.returncode, 0, built.stdout[-2000:] + built.stderr[-2000:])
            installed = root / "installed"
            wheel, = (root / "wheel").glob("catena-*.whl")
            with zipfile.ZipFile(wheel) as file:
                file.extractall(installed)
                for entry in file.infolist():  # as pip does
                    if entry.external_attr >> 16 & 0o111:
                        (installed / entry.filename).chmod(0o755)
            packages = (root / "build/CPackConfig.cmake").read_text(encoding="utf-8")  # who builds Debian's packages answers for them
            self.assertIn('set(CPACK_PACKAGE_CONTACT "Ada <ada@example.org>")', packages)
            shutil.rmtree(root / "build")
            version = re.search(r'kVersion = "(.*)"', (SOURCE / "engine/base/version.h").read_text(encoding="utf-8")).group(1)
            metadata = next(installed.glob("catena-*.dist-info/METADATA")).read_text(encoding="utf-8")
            self.assertIn(f"\nName: catena\nVersion: {version}\n", metadata)
            self.assertIn("Requires-Dist: numpy", metadata)
            self.assertEqual([p.name for p in installed.iterdir() if not p.name.endswith(".dist-info")], ["catena"])
            scenes = installed / "catena/share/catena/scenes"
            self.assertTrue((scenes / "hand.json").exists())
            self.assertFalse((scenes / "data").exists())

            # it runs from there, by nothing of this build: its library, its program, the helpers that read and write files
            code = ("import catena, numpy as np, os, re, subprocess\n"
                    "f = catena.field(np.mgrid[:9, :9, :9][0]); f.save('f.vdb'); print(catena.field('f.vdb').sample([[1, 2, 3.5]]))\n"
                    "print(set(re.findall(r'/\\S*libcatena\\S*', open('/proc/self/maps').read())))\n"
                    "print(catena._program(), subprocess.run([catena._program(), '--version'], capture_output=True, text=True).stdout)\n")
            ran = subprocess.run([sys.executable, "-B", "-c", code], cwd=root, env={"PATH": "/usr/bin:/bin", "PYTHONPATH": str(installed)},
                                 capture_output=True, text=True, check=False)
            self.assertEqual(ran.returncode, 0, ran.stderr)
            lines = ran.stdout.splitlines()
            self.assertEqual(lines[0], "[3.5]")
            library, = (installed / "catena/lib").iterdir()  # once
            self.assertEqual(lines[1], f"{{'{library}'}}")
            self.assertIn(f"{installed}/catena/bin/catena ", lines[2])
            self.assertIn(version, lines[2])


if __name__ == "__main__":
    if sys.argv[1:2] == ["stand-in"]:
        sys.exit(stand_in(sys.argv[2:]))
    unittest.main()
