# SPDX-License-Identifier: MIT
"""Feels a Zarr store that does not fit into memory, and the same store in memory: ticks on the coarse level, times of ticks, forces.

usage: feel_store.py CATENA FOLDER [EDGE] [VOXELS_PER_SECOND]      (defaults 1024 and 5000; needs python3-zarr)
"""
import csv
import json
import math
import os
import subprocess
import sys

import numcodecs
import numpy
import zarr

CATENA, FOLDER = sys.argv[1:3]
EDGE = int(sys.argv[3]) if len(sys.argv) > 3 else 1024
SPEED = float(sys.argv[4]) if len(sys.argv) > 4 else 5000
TICKS = 60_000
STORE, SCENE, PATH = (os.path.join(FOLDER, name) for name in (f"ball{EDGE}.zarr", "ball.json", "path.csv"))
RADIUS = 0.35 * EDGE


def slab(size, step, z0, z1):
    """Returns slices of a bumpy ball at a level; the level 30000 is at the radius."""
    at = (numpy.arange(size, dtype=numpy.float32) + 0.5) * step - 0.5
    x, y, z = at[None, None, :], at[None, :, None], at[z0:z1, None, None]
    r = numpy.sqrt((x - EDGE / 2) ** 2 + (y - EDGE / 2) ** 2 + (z - EDGE / 2) ** 2)
    bumps = 60 * numpy.sin(0.21 * x) * numpy.sin(0.17 * y) * numpy.sin(0.19 * z)
    return numpy.clip(30000 + 40 * (RADIUS - r) + bumps, 0, 65535).astype("<u2")


def write_store():
    group = zarr.open_group(STORE, mode="w", zarr_version=2)
    datasets, level, size = [], 0, EDGE
    while True:
        array = group.create_dataset(str(level), shape=(size,) * 3, chunks=(64,) * 3, dtype="<u2", dimension_separator="/",
                                     compressor=numcodecs.Blosc(cname="lz4", clevel=1))
        for z in range(0, size, 64):
            array[z:z + 64] = slab(size, 2 ** level, z, min(z + 64, size))
        shift = (2 ** level - 1) / 2
        datasets.append({"path": str(level), "coordinateTransformations": [
            {"type": "scale", "scale": [2.0 ** level] * 3}, {"type": "translation", "translation": [shift] * 3}]})
        if size <= 64:
            break
        level, size = level + 1, size // 2
    axes = [{"name": name, "type": "space"} for name in "zyx"]
    group.attrs["multiscales"] = [{"version": "0.4", "name": "ball", "axes": axes, "datasets": datasets}]


def write_scene_and_path():
    links = [{"name": "surface", "type": "isosurface", "field": "f", "level": 30000, "free": "below"},
             {"name": "friction", "type": "drag", "surface": "f", "level": 30000, "threshold": 0.5},
             {"name": "pull", "type": "gradient_force", "field": "f", "displacement": 1, "direction": "up_gradient"}]
    scene = {"fields": {"f": {"file": STORE}}, "chain": links, "coupling": {"max_force": 8}}
    with open(SCENE, "w") as out:
        json.dump(scene, out)
    with open(PATH, "w") as out:
        out.write("t,x,y,z\n")
        for k in range(TICKS):
            a = SPEED * k / 1000 / RADIUS
            b = 0.7 * math.sin(0.13 * a)
            r = RADIUS - 1.5 - math.sin(0.01 * k)
            out.write(f"{k / 1000},{EDGE / 2 + r * math.cos(a) * math.cos(b)},{EDGE / 2 + r * math.sin(a) * math.cos(b)},"
                      f"{EDGE / 2 + r * math.sin(b)}\n")


def drop_pages():
    for folder, _, names in os.walk(STORE):
        for name in names:
            with open(os.path.join(folder, name), "rb") as file:
                os.posix_fadvise(file.fileno(), 0, 0, os.POSIX_FADV_DONTNEED)


def feel(memory, name):
    """Runs the hand, with a recording; returns its statistics and ticks."""
    drop_pages()
    log, stats, table = (os.path.join(FOLDER, name + end) for end in (".catlog", ".stats.json", ".csv"))
    subprocess.run([CATENA, "feel", SCENE, "--device", "recorded:" + PATH, "--seconds", str(TICKS / 1000), "--memory", str(memory),
                    "--record", log, "--stats", stats, "--forces", "on"], check=True, capture_output=True)
    replay = subprocess.run([CATENA, "replay", "--log", log, "--memory", str(memory)], capture_output=True, text=True)
    print(f"{name}: replay of the recording: code {replay.returncode},", replay.stdout.strip().splitlines()[-1:])
    subprocess.run([CATENA, "export", log, "-o", table], check=True, capture_output=True)
    with open(table) as file:
        return json.load(open(stats)), list(csv.DictReader(file))


def in_memory(ticks):
    """Runs the same poses with the whole grid in memory."""
    probe, table = os.path.join(FOLDER, "probe.csv"), os.path.join(FOLDER, "replayed.csv")
    with open(probe, "w") as out:
        out.write("t,x,y,z\n")
        for tick in ticks:
            out.write(",".join(tick[key] for key in ("t", "probe_x", "probe_y", "probe_z")) + "\n")
    subprocess.run([CATENA, "replay", SCENE, "--probe", probe, "-o", table, "--memory", "12000"], check=True, capture_output=True)
    with open(table) as file:
        return list(csv.DictReader(file))


def main():
    os.makedirs(FOLDER, exist_ok=True)
    if not os.path.exists(os.path.join(STORE, ".zattrs")):
        write_store()
    write_scene_and_path()
    stats, ticks = feel(512, "paged")
    whole_stats, _ = feel(12000, "whole")
    for what in ("p50", "p99", "p999", "max"):
        paged, whole = stats["compute_us"][what], whole_stats["compute_us"][what]
        print(f"time of a tick, {what}: {paged:.1f} us, in memory {whole:.1f} us, ratio {paged / whole:.2f}")
    links = [key[:-7] for key in ticks[0] if key.endswith("_status")]
    first = 1 + max((k for k, tick in enumerate(ticks[:1000]) if any(tick[link + "_status"] == "COARSE" for link in links)), default=-1)
    print(f"first bricks after {first} ticks")
    for link in links:
        coarse = sum(tick[link + "_status"] == "COARSE" for tick in ticks[first:])
        print(f"{link}: then {coarse} of {len(ticks) - first} ticks on the coarse level")
    proxies = [f"{link}_{axis}" for link in links for axis in "xyz"]
    differing = [k for k, (a, b) in enumerate(zip(ticks, in_memory(ticks))) if any(a[key] != b[key] for key in proxies)]
    print(f"{len(differing)} of {len(ticks)} ticks have other proxies than in memory, the last is tick {differing[-1] if differing else None}")
    force = ("force_x", "force_y", "force_z")
    worst = max(math.dist([float(a[key]) for key in force], [float(b[key]) for key in force]) for a, b in zip(ticks[first:], ticks[first + 1:]))
    print(f"largest change of the force in a tick: {100 * worst / 8:.1f} % of max_force")


main()
