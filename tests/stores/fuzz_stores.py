#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Reads mutated stores through catena: each ends with success, or with exit code 2 and one sentence, in bounded time and memory.

CATENA=build/release/catena tests/stores/fuzz_stores.py [COUNT] [render] [zarr] [ome] [tiff] [hdf5] [bdv] [imaris]

Stores are imported; with `render` they are drawn, with so little memory that some are drawn from bricks. SEED chooses other mutations.
"""
import os
import random
import re
import shutil
import sys
import tempfile
import time

import numpy

import compare
import hdf5_stores
import tiff_stores
import zarr_stores

MAX_SECONDS, MAX_KILOBYTES = 60, 1_000_000
TOKENS = [b"0", b"-1", b"1e9", b"99999999999999999999", b"null", b"[]", b"{}", b'"x"', b"true", b"NaN", b"1000000000", b"../", b"3", b"64", b"1e-300"]


class Keep:
    """Takes the place of compare.Tally: keeps a copy of the first stores that are written."""

    def __init__(self, folder, wanted):
        self.folder, self.wanted, self.stores = folder, wanted, []

    def compare(self, kind, name, store, _expected, grid=None, step=0):
        """Copies the store where its kind and name are wanted."""
        if not any(kind == k and name.startswith(n) for k, n in self.wanted):
            return
        self.wanted = [(k, n) for k, n in self.wanted if not (kind == k and name.startswith(n))]
        copy = os.path.join(self.folder, f"{len(self.stores)}-" + os.path.basename(store))
        (shutil.copytree if os.path.isdir(store) else shutil.copy)(store, copy)
        self.stores.append((copy, grid, step))


def make_stores(folder, kind):
    """Returns stores to mutate: path, grid, step."""
    wanted = {
        "zarr": [("Zarr 2", "zlib C <u2"), ("Zarr 2", "blosc-lz4-1 F"), ("Zarr 2", "lz4 C"), ("Zarr 2", "zstd C"), ("Zarr 2", "delta <i4 C")],
        "ome": [("OME-Zarr 0.4", "tczyx"), ("OME-Zarr 0.4", "labels")],
        "tiff": [("TIFF", "u2 < tile big False"), ("TIFF", "u2 > strip big True"), ("TIFF", "zlib"), ("OME-TIFF", "TCZYX"), ("OME-TIFF", "pyramid"),
                 ("ImageJ TIFF", "TZCYX"), ("folder of TIFF", "")],
        "hdf5": [("HDF5", "<u2 gzip"), ("HDF5", "<u2 lz4"), ("HDF5", "<u2 blosc 1 1"), ("NXdata", ""), ("VTKHDF", "scalars")],
        "bdv": [("BigDataViewer", ".h5")],
        "imaris": [("Imaris", "")],
    }[kind]
    keep = Keep(folder, wanted)
    work = os.path.join(folder, "work")
    os.makedirs(work)
    module = {"zarr": zarr_stores, "ome": zarr_stores, "tiff": tiff_stores}.get(kind, hdf5_stores)
    module.write(keep, work)
    return keep.stores


def files_of(store):
    """Returns the files of a store, those with metadata several times."""
    if os.path.isfile(store):
        return [store]
    found = []
    for folder, _, names in os.walk(store):
        for name in names:
            found += [os.path.join(folder, name)] * (20 if name.startswith(".z") else 1)
    return found


def mutate(path, rng):
    """Changes one file: bytes, numbers in a text, its length, or removes it."""
    with open(path, "rb") as file:
        data = bytearray(file.read())
    is_text = os.path.basename(path).startswith(".z")
    way = rng.randrange(8)
    if way == 0:
        os.remove(path)
        return
    if way == 1:
        data = data[:rng.randrange(len(data) + 1)]
    elif way == 2 and not is_text:
        at = rng.randrange(len(data) + 1)
        data[at:at] = rng.randbytes(rng.randrange(1, 64))
    elif is_text and way < 7:
        places = [m.span() for m in re.finditer(rb'-?\d+\.?\d*|"[^"]*"|null', data)] or [(0, 0)]
        for _ in range(rng.randrange(1, 3)):
            begin, end = rng.choice(places)
            data[begin:end] = rng.choice(TOKENS)
            places = [m.span() for m in re.finditer(rb'-?\d+\.?\d*|"[^"]*"|null', data)] or [(0, 0)]
    else:
        # headers are hit more often than values
        limit = rng.choice([64, 512, 4096, len(data)])
        for _ in range(rng.choice([1, 1, 2, 4, 16])):
            if data:
                data[rng.randrange(min(limit, len(data)))] = rng.choice([0, 1, 255, 127, 128, rng.randrange(256)])
    with open(path, "wb") as file:
        file.write(data)


def run(command, errors):
    """Runs catena; returns exit code, seconds, kilobytes."""
    begin = time.monotonic()
    out = os.open(errors, os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
    null = os.open(os.devnull, os.O_RDWR)
    pid = os.posix_spawn(command[0], command, os.environ, file_actions=[(os.POSIX_SPAWN_DUP2, null, 0), (os.POSIX_SPAWN_DUP2, null, 1),
                                                                        (os.POSIX_SPAWN_DUP2, out, 2)])
    os.close(out)
    os.close(null)
    _, status, used = os.wait4(pid, 0)
    return os.waitstatus_to_exitcode(status), time.monotonic() - begin, used.ru_maxrss


def main():
    """Mutates COUNT stores of each kind; prints a line per kind; returns 1 after any wrong end."""
    arguments = sys.argv[1:]
    count = int(arguments.pop(0)) if arguments and arguments[0].isdigit() else 300
    draws = "render" in arguments
    arguments = [kind for kind in arguments if kind != "render"]
    failed = False
    for kind in arguments or ["zarr", "ome", "tiff", "hdf5", "bdv", "imaris"]:
        with tempfile.TemporaryDirectory() as folder:
            rng = random.Random(kind + os.environ.get("SEED", ""))
            stores = make_stores(folder, kind)
            os.environ["XDG_CACHE_HOME"] = os.path.join(folder, "cache")
            numpy.random.seed(0)
            slowest, largest, ends, sentences = 0.0, 0, {}, set()
            for i in range(count):
                store, grid, step = stores[i % len(stores)]
                copy = os.path.join(folder, "mutated" + os.path.basename(store))
                shutil.rmtree(copy, ignore_errors=True)
                (shutil.copytree if os.path.isdir(store) else shutil.copy)(store, copy)
                for _ in range(rng.choice([1, 1, 2])):
                    path = rng.choice(files_of(copy) or [None])
                    if path is not None:
                        mutate(path, rng)
                command = [compare.CATENA, "import", copy, "-o", os.path.join(folder, "out.nrrd"), "--memory", "200"]
                if draws:
                    command = [compare.CATENA, "render", copy, "-o", os.path.join(folder, "out.png"), "--size", "200x150", "--quality", "draft",
                               "--memory", str(rng.choice([3, 200]))]
                if grid is not None:
                    command += ["--grid", grid] + ([] if draws else ["--step", str(step)])
                code, seconds, kilobytes = run(command, os.path.join(folder, "errors"))
                with open(os.path.join(folder, "errors"), encoding="utf-8", errors="replace") as file:
                    lines = [line for line in file.read().splitlines() if not line.startswith(("catena: note:", "coarser levels of "))]
                ends[code] = ends.get(code, 0) + 1
                slowest, largest = max(slowest, seconds), max(largest, kilobytes)
                is_right = (code == 0 and not lines) or (code == 2 and len(lines) == 1 and lines[0].startswith("catena: "))
                if code == 2 and lines:
                    sentences.add(re.sub(r"\d+", "N", lines[0].replace(folder, "")))
                if not is_right or seconds > MAX_SECONDS or kilobytes > MAX_KILOBYTES:
                    failed = True
                    kept = os.path.join(tempfile.gettempdir(), f"catena-fuzz-{kind}-{i}-" + os.path.basename(store))
                    shutil.rmtree(kept, ignore_errors=True)
                    if os.path.exists(copy):
                        (shutil.copytree if os.path.isdir(copy) else shutil.copy)(copy, kept)
                    print(f"{kind} {i}: code {code}, {seconds:.1f} s, {kilobytes} KB, kept as {kept}: {lines}")
            print(f"{kind}: {count} stores, ends by exit code {dict(sorted(ends.items()))}, at most {slowest:.1f} s and {largest} KB; "
                  f"{len(sentences)} different sentences")
            if os.environ.get("SENTENCES"):
                print("\n".join("  " + s for s in sorted(sentences)))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
