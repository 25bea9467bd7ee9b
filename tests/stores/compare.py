# SPDX-License-Identifier: MIT
"""Reads stores through `catena import` and counts the voxels that differ from the array that was written."""
import os
import re
import subprocess

import numpy

CATENA = os.environ.get("CATENA", "build/release/catena")


def read_nrrd(path):
    """Returns the array of a NRRD file that catena wrote, z first."""
    with open(path, "rb") as file:
        data = file.read()
    end = data.index(b"\n\n")
    sizes = [int(n) for n in re.search(rb"sizes: (.*)", data[:end]).group(1).split()]
    return numpy.frombuffer(data, "<f4", offset=end + 2).reshape(sizes[::-1])


class Tally:
    """Wrong voxels and compared grids, by kind of store."""

    def __init__(self, folder):
        self.folder = folder
        self.kinds = {}

    def compare(self, kind, name, store, expected, grid=None, step=0):
        """Compares one grid; `expected`: an array z, y, x."""
        out = os.path.join(self.folder, "out.nrrd")
        command = [CATENA, "import", store, "-o", out]
        if grid is not None:
            command += ["--grid", grid]
        if step:
            command += ["--step", str(step)]
        run = subprocess.run(command, capture_output=True, text=True, timeout=120)
        counts = self.kinds.setdefault(kind, {"grids": 0, "voxels": 0, "wrong": 0})
        counts["grids"] += 1
        counts["voxels"] += expected.size
        wrong = expected.size
        if run.returncode == 0:
            values = read_nrrd(out)
            # an axis of one voxel is loaded with two
            values = values[tuple(slice(0, n) for n in expected.shape)]
            with numpy.errstate(over="ignore"):
                wanted = numpy.asarray(expected).astype("f4")
            if values.shape == wanted.shape:
                wrong = int(numpy.count_nonzero(~((values == wanted) | (numpy.isnan(values) & numpy.isnan(wanted)))))
        counts["wrong"] += wrong
        if wrong:
            print(f"{kind}: {name} {grid or ''}: {wrong} of {expected.size} wrong; {run.stderr.strip()}")

    def report(self):
        """Prints a line per kind; returns the number of wrong voxels."""
        for kind, counts in self.kinds.items():
            print(f"{kind}: {counts['grids']} grids, {counts['voxels']} voxels, {counts['wrong']} wrong")
        return sum(counts["wrong"] for counts in self.kinds.values())
