#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Loads stores of one level that do not fit into memory, and compares the levels and the index in the cache with NumPy.

CATENA=build/release/catena tests/stores/check_levels.py
"""
import glob
import io
import json
import os
import random
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import time

import h5py
import numpy
import tifffile
import zarr

from check_import import CATENA, differing, means

SHAPE, MEMORY_MB, BRICK = (141, 150, 131), 6, 64  # z, y, x


def volume(dtype):
    """Returns blobs and noise."""
    z, y, x = numpy.indices(SHAPE)
    smooth = 100 + 80 * numpy.sin(0.1 * x) * numpy.cos(0.07 * y) * numpy.sin(0.05 * z)
    return (smooth + numpy.random.default_rng(1).integers(0, 20, SHAPE)).astype(dtype)


def run(folder, source, kill_after_s=None):
    """Loads the field of a store; returns the process."""
    scene = os.path.join(folder, "scene.json")
    with open(scene, "w", encoding="utf-8") as file:
        json.dump({"fields": {"f": {"file": source}}}, file)
    command = [CATENA, "info", scene, "--memory", str(MEMORY_MB)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        if kill_after_s is not None:
            time.sleep(kill_after_s)
            process.send_signal(signal.SIGKILL)
        process.out, process.err = process.communicate(timeout=120)
    return process


def entry_of(cache, source):
    """Returns the folder of the cache for a file."""
    stem = os.path.splitext(os.path.basename(source))[0]
    return glob.glob(os.path.join(cache, "catena/levels", stem + "-*"))[0]


def read_index(path):
    """Returns the fill value and per level the counts (x, y, z), the bits and the entries (engine/io/levels/index_file.cpp)."""
    with open(path, "rb") as file:
        stream = io.BytesIO(file.read())
    stream.seek(len("catena brick index 1\n"))

    def words():
        return stream.read(struct.unpack("<Q", stream.read(8))[0])

    words()
    _, fill, count = struct.unpack("<idQ", stream.read(20))
    levels = []
    for _ in range(count):
        counts = struct.unpack("<3i", stream.read(12))
        bits = numpy.unpackbits(numpy.frombuffer(words(), "u1"), bitorder="little")
        levels.append((counts, bits, numpy.frombuffer(words(), [("min", "f4"), ("max", "f4")])))
        words()
    return fill, levels


def wrong_ranges(data, level, fill):
    """Returns the number of bricks of a level whose range in the index is not that of its finite values."""
    counts, bits, entries = level
    wrong, place = int(list(counts) != [(n - 1) // BRICK + 1 for n in data.shape[::-1]]), 0
    for number in range(counts[0] * counts[1] * counts[2]):
        x, y, z = number % counts[0], number // counts[0] % counts[1], number // counts[0] // counts[1]
        brick = data[z * BRICK:(z + 1) * BRICK, y * BRICK:(y + 1) * BRICK, x * BRICK:(x + 1) * BRICK]
        finite = brick[numpy.isfinite(brick)].astype("f8")
        if not bits[number]:
            wrong += bool(differing(brick, numpy.full_like(brick, fill)))
            continue
        entry = entries[place]
        place += 1
        if finite.size == 0:
            wrong += not entry["min"] > entry["max"]
            continue
        tolerance = 1.2e-7 * max(abs(finite.min()), abs(finite.max()))
        wrong += not (finite.min() - tolerance <= entry["min"] <= finite.min() and finite.max() <= entry["max"] <= finite.max() + tolerance)
    return wrong + (place != len(entries))


def check(folder, cache, name, source, data):
    """Loads a store; returns the number of wrong voxels of the levels, and of wrong ranges."""
    process = run(folder, source)
    if process.returncode != 0:
        print(f"{name}: {process.err.strip()}")
        return data.size
    entry = entry_of(cache, source)
    group = zarr.open(entry + "/levels.zarr", "r")
    fill, index = read_index(entry + "/index")
    wrong = wrong_ranges(data, index[0], fill)
    for number, level in enumerate(index[1:]):
        data = means(data)
        wrong += differing(group[str(number)][:], data) + wrong_ranges(data, level, fill)
    wrong += max(data.shape) > BRICK
    print(f"{name}: {data.dtype}, {len(index) - 1} levels, {wrong} wrong")
    return wrong


def files_below(folder):
    """Returns the files with their contents."""
    paths = [os.path.join(at, name) for at, _, names in os.walk(folder) for name in names]
    contents = {}
    for path in paths:
        with open(path, "rb") as file:
            contents[os.path.relpath(path, folder)] = file.read()
    return contents


def wrong_first_level(entry, source):
    """Returns the number of wrong voxels of the first level in the cache, which the program has just loaded; 0: python3-zarr refuses it."""
    try:
        first = zarr.open(entry + "/levels.zarr/0", "r")[:]
    except (ValueError, OSError, RuntimeError, zarr.errors.MetadataError):
        return 0
    with h5py.File(source, "r") as file:
        return differing(first, means(file["data"][:]))


def check_kills(folder, cache, source):
    """Kills the program at random times, then lets it end; returns whether the cache differs from that of an uninterrupted run."""
    run(folder, source)
    entry = entry_of(cache, source)
    expected = files_below(entry)
    shutil.rmtree(entry)
    kills = 0
    for number in range(12):
        kills += run(folder, source, 0.01 * (2 + number)).returncode == -signal.SIGKILL
    process = run(folder, source)
    same = files_below(entry) == expected
    print(f"killed {kills} times: {'the same' if same else 'differs'}")
    return int(not same or process.returncode != 0)


def damage(entry, choice):
    """Changes one file of the cache; returns what was done."""
    path = choice.choice(sorted(files_below(entry)))
    full = os.path.join(entry, path)
    size = os.path.getsize(full)
    kind = choice.choice(("flip", "cut", "remove", "empty"))
    if kind == "flip" and size > 0:
        with open(full, "r+b") as file:
            file.seek(choice.randrange(size))
            file.write(bytes([choice.randrange(256)]))
    elif kind == "remove":
        os.remove(full)
    else:
        os.truncate(full, choice.randrange(size) if kind == "cut" and size > 0 else 0)
    return f"{kind} {path}"


def check_unfinished_damage(folder, cache, source, data, rounds):
    """Kills the program, changes what it has left, and lets it end; returns the number of wrong caches."""
    choice, wrong = random.Random(2), 0
    for _ in range(rounds):
        entry = entry_of(cache, source)
        shutil.rmtree(entry)
        run(folder, source, choice.uniform(0.05, 0.3))
        what = damage(entry, choice) if os.path.exists(entry) and files_below(entry) else "nothing"
        os.makedirs(entry, exist_ok=True)
        wrong += bool(check(folder, cache, f"killed, then {what}", source, data))
    return wrong


def check_damage(folder, cache, source, rounds):
    """Changes bytes of the cache; returns how often the program fails, or reports another field than before."""
    expected = run(folder, source).out
    entry = entry_of(cache, source)
    choice, wrong = random.Random(1), 0
    for _ in range(rounds):
        what = damage(entry, choice)
        process = run(folder, source)
        if process.returncode != 0 or process.out != expected or wrong_first_level(entry, source):
            wrong += 1
            print(f"{what}: code {process.returncode}, {process.err.strip()}")
    print(f"{rounds} changes of the cache, {wrong} wrong")
    return wrong


def main():
    """Checks stores of each kind."""
    wrong = 0
    rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 20
    with tempfile.TemporaryDirectory() as folder:
        cache = os.path.join(folder, "cache")
        os.environ["XDG_CACHE_HOME"] = cache

        def path(name):
            return os.path.join(folder, name)

        for dtype in ("u1", "i2", "u2", "i4", "u4", "f4", "f8"):
            data = volume(dtype)
            if dtype[0] == "f":
                data[3:9, 10:12] = numpy.nan
                data[:64, :64, :64] = numpy.nan
            with h5py.File(path("a.h5"), "w") as file:
                file.create_dataset("data", data=data, chunks=(64, 64, 64), compression="gzip")
            wrong += check(folder, cache, "hdf5-" + dtype, path("a.h5"), data)
        data = volume("u2")
        for chunks in ((1, 150, 131), (100, 33, 47), (128, 128, 128), (141, 1, 131), (20, 20, 20)):
            name = "hdf5-" + "-".join(map(str, chunks))
            with h5py.File(path(name + ".h5"), "w") as file:
                file.create_dataset("data", data=data, chunks=chunks, compression="gzip")
            wrong += check(folder, cache, name, path(name + ".h5"), data)
        tifffile.imwrite(path("stack.tif"), data, photometric="minisblack")
        wrong += check(folder, cache, "tiff", path("stack.tif"), data)
        for name, dtype, fill in (("fill7", "u2", 7), ("fillnan", "f4", "NaN"), ("fillinf", "f4", "Infinity")):
            array = zarr.open(path(name + ".zarr"), "w", shape=SHAPE, chunks=(32, 64, 64), dtype=dtype, fill_value=float(fill))
            array[70:141, 0:64, 64:131] = volume(dtype)[70:141, 0:64, 64:131]
            wrong += check(folder, cache, name, path(name + ".zarr"), array[:])
        wrong += check_kills(folder, cache, path("hdf5-1-150-131.h5"))
        wrong += check_damage(folder, cache, path("hdf5-1-150-131.h5"), rounds)
        wrong += check_unfinished_damage(folder, cache, path("hdf5-20-20-20.h5"), data, rounds)
    print(f"{wrong} wrong")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
