#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Imports files of other programs to .zarr and reads the result with python3-zarr: 0 wrong voxels are expected, in any level.

CATENA=build/release/catena tests/stores/check_import.py
"""
import os
import subprocess
import sys
import tempfile

import h5py
import numpy
import tifffile
import zarr

CATENA = os.environ.get("CATENA", "build/release/catena")
SHAPE, SCALE, ORIGIN = (70, 150, 131), (2.0, 0.5, 0.25), (3.0, -1.0, 10.0)  # z, y, x


def volume(dtype):
    """Returns blobs and noise."""
    z, y, x = numpy.indices(SHAPE)
    smooth = 100 + 80 * numpy.sin(0.1 * x) * numpy.cos(0.07 * y) * numpy.sin(0.05 * z)
    return (smooth + numpy.random.default_rng(1).integers(0, 20, SHAPE)).astype(dtype)


def means(fine):
    """Returns the mean of the finite ones of 2 x 2 x 2 voxels; integers rounded, halves up."""
    real = fine.dtype.kind == "f"
    total = numpy.zeros([(n + 1) // 2 for n in fine.shape], numpy.longdouble if real else "i8")
    count = numpy.zeros(total.shape, "i8")
    for k, j, i in numpy.ndindex(2, 2, 2):
        part = fine[k::2, j::2, i::2]
        at = tuple(slice(0, n) for n in part.shape)
        valid = numpy.isfinite(part)
        total[at] += numpy.where(valid, part, 0).astype(total.dtype)
        count[at] += valid
    with numpy.errstate(invalid="ignore"):
        return (total / count if real else (2 * total + count) // (2 * count)).astype(fine.dtype)


def differing(a, b):
    """Returns the number of voxels that differ; not-a-number equals itself."""
    return b.size if a.shape != b.shape else int(numpy.count_nonzero(~((a == b) | ((a != a) & (b != b)))))


def check(folder, name, source, expected, options=(), scale=SCALE, origin=ORIGIN):
    """Imports one file; returns the number of wrong voxels of all levels, or of wrong metadata."""
    out = os.path.join(folder, name + ".zarr")
    run = subprocess.run([CATENA, "import", source, *options, "-o", out], capture_output=True, text=True, timeout=120)
    if run.returncode != 0:
        print(f"{name}: {run.stderr.strip()}")
        return expected.size
    group = zarr.open(out, "r")
    image = group.attrs["multiscales"][0]
    wrong = differing(group["0"][:], expected) + (group["0"].dtype != expected.dtype)
    for level, data in enumerate(image["datasets"]):
        array = group[data["path"]]
        wrong += array.chunks != (64, 64, 64)
        if level > 0:
            wrong += differing(array[:], means(group[str(level - 1)][:]))
        moves = data["coordinateTransformations"]
        for axis in range(3):
            wrong += not numpy.isclose(moves[0]["scale"][axis], scale[axis] * 2**level)
            wrong += not numpy.isclose(moves[1]["translation"][axis], origin[axis] + scale[axis] * (2**level - 1) / 2)
    wrong += max(group[image["datasets"][-1]["path"]].shape) > 64
    wrong += [axis["name"] for axis in image["axes"]] != ["z", "y", "x"]
    window = group.attrs["omero"]["channels"][0]["window"]
    wrong += window["min"] != numpy.nanmin(expected) or window["max"] != numpy.nanmax(expected)
    print(f"{name}: {expected.dtype}, {len(image['datasets'])} levels, {wrong} wrong")
    return wrong


def write_zarr(path, data, chunks, order):
    """Writes an OME-Zarr image of one level."""
    group = zarr.open_group(path, mode="w")
    group.create_dataset("0", data=data, chunks=chunks, order=order)
    moves = [{"type": "scale", "scale": SCALE}, {"type": "translation", "translation": ORIGIN}]
    axes = [{"name": n, "type": "space", "unit": "micrometer"} for n in "zyx"]
    group.attrs["multiscales"] = [{"version": "0.4", "axes": axes, "datasets": [{"path": "0", "coordinateTransformations": moves}]}]


def main():
    """Imports a file of each kind."""
    wrong = 0
    unit, zero = (1, 1, 1), (0, 0, 0)
    with tempfile.TemporaryDirectory() as folder:
        def path(name):
            return os.path.join(folder, name)

        for dtype in ("u1", "i2", "u2", "i4", "u4", "f4", "f8"):
            data = volume(dtype)
            if dtype[0] == "f":
                data[3:9, 10:12] = numpy.nan
            data.tofile(path("a.raw"))
            names = {"u": "uint", "i": "int", "f": "float"}
            options = ["--shape", *map(str, SHAPE[::-1]), "--type", names[dtype[0]] + str(8 * int(dtype[1]))]
            options += ["--spacing", *map(str, SCALE[::-1]), "--origin", *map(str, ORIGIN[::-1])]
            wrong += check(folder, "raw-" + dtype, path("a.raw"), data, options)
        data = volume("u2")
        for chunks in ((64, 64, 64), (1, 150, 131), (100, 33, 47)):
            write_zarr(path("in.zarr"), data, chunks, "F" if chunks[0] == 1 else "C")
            wrong += check(folder, f"zarr-{chunks[0]}", path("in.zarr"), data)
            with h5py.File(path("a.h5"), "w") as file:
                file.create_dataset("data", data=data, chunks=tuple(map(min, chunks, SHAPE)), compression="gzip")
            wrong += check(folder, f"hdf5-{chunks[0]}", path("a.h5"), data, scale=unit, origin=zero)
        tifffile.imwrite(path("a.tif"), data, photometric="minisblack")
        wrong += check(folder, "tiff", path("a.tif"), data, scale=unit, origin=zero)
        with open(path("a.nrrd"), "wb") as file:
            file.write(
                b"NRRD0004\ntype: float\ndimension: 3\nspace dimension: 3\nsizes: 131 150 70\nencoding: raw\nendian: little\n"
                b"space directions: (0.25,0,0) (0,0.5,0) (0,0,2)\nspace origin: (10,-1,3)\n\n" + data.astype("<f4").tobytes())
        wrong += check(folder, "nrrd", path("a.nrrd"), data.astype("f4"))
    print(f"{wrong} wrong")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
