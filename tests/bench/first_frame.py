#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""First frames and GPU memory of `catena render`, each in a new process: with an empty (cold) and a filled (warm) shader cache of the
driver, wall times in milliseconds, and GPU bytes per voxel of the grid's box compared with the NanoVDB's bytes on the host.
needs: python3 only; a driver that honours MESA_SHADER_CACHE_DIR (with others only warm times are meaningful)
usage: first_frame.py CATENA [N [ROUNDS]]            (N: grid, default 128; ROUNDS: processes per row, default 3, medians)
Fields: noise (dense), fog (a few balls, about 5 % of the voxels), mask (the left half of the noise is NaN). 512x384, one volume.
pipelines_ms: first_frame_ms without loading and upload: device, pipelines, the frame itself. Prints one JSON line each."""
import array, json, math, os, statistics, subprocess, sys, tempfile

catena = os.path.abspath(sys.argv[1])
n = int(sys.argv[2]) if len(sys.argv) > 2 else 128
rounds = int(sys.argv[3]) if len(sys.argv) > 3 else 3


def field(kind):
    balls = [(0.3, 0.3, 0.4, 0.14), (0.7, 0.6, 0.5, 0.16), (0.4, 0.75, 0.7, 0.12)]
    values = array.array("f")
    for z in range(n):
        for y in range(n):
            if kind == "fog":
                row = [0.0] * n
                for bx, by, bz, r in balls:
                    rest = r * r - (y / n - by) ** 2 - (z / n - bz) ** 2
                    if rest <= 0:
                        continue
                    for x in range(max(0, math.ceil(n * (bx - math.sqrt(rest)))), min(n, int(n * (bx + math.sqrt(rest))) + 1)):
                        row[x] = 0.5 + 0.3 * math.sin(0.9 * x) * math.cos(0.7 * y + z)
            else:
                a, b = math.sin(0.37 * y + 0.11 * z), math.cos(0.29 * z - 0.17 * y)
                row = [0.5 + 0.25 * (a * math.sin(0.41 * x) + b * math.cos(0.23 * x)) for x in range(n)]
                if kind == "mask":
                    row[: n // 2] = [math.nan] * (n // 2)
            values.extend(row)
    return values.tobytes()


def run(folder, scene, quality, cache):
    path = os.path.join(folder, "scene.json")
    with open(path, "w") as f:
        json.dump(scene, f)
    stats = os.path.join(folder, "stats.json")
    environment = dict(os.environ, MESA_SHADER_CACHE_DIR=cache)
    subprocess.run([catena, "render", path, "-o", os.path.join(folder, "o.png"), "--size", "512x384", "--quality", quality, "--stats", stats],
                   check=True, env=environment, stdout=subprocess.DEVNULL)
    with open(stats) as f:
        return json.load(f)


with tempfile.TemporaryDirectory() as folder:
    # baseline: an image with almost no voxels
    small = {"fields": {"d": {"analytic": "tanh", "resolution": 5}}, "volumes": [{"field": "d", "color": [[0, 1, 1, 1]], "opacity": [[0, 0.1]]}]}
    empty = {q: run(folder, small, q, os.path.join(folder, "cache"))["gpu_bytes"] for q in ("step=1", "balanced", "reference")}
    for kind in ("noise", "fog", "mask"):
        with open(os.path.join(folder, kind + ".raw"), "wb") as f:
            f.write(field(kind))
        scene = {"fields": {"d": {"file": kind + ".raw", "shape": [n, n, n], "spacing": [1, 1, 1], "origin": [0, 0, 0], "type": "float32"}},
                 "volumes": [{"field": "d", "color": [[0, 0.1, 0.2, 0.9], [1, 1, 0.6, 0.1]], "opacity": [[0.2, 0], [0.9, 0.1]]}]}
        for quality in ("step=1", "balanced", "reference"):
            rows = {"cold": [], "warm": []}
            for i in range(rounds):
                cache = os.path.join(folder, f"cache-{kind}-{quality}-{i}")
                for state in ("cold", "warm"):
                    rows[state].append(run(folder, scene, quality, cache))
            last = rows["warm"][-1]
            line = {"field": kind, "n": n, "quality": quality, "device": last["device"],
                    "gpu_bytes_a_voxel": round((last["gpu_bytes"] - empty[quality]) / n**3, 3), "vdb_bytes_a_voxel": round(last["cpu_bytes"] / n**3, 3)}
            for state, list_ in rows.items():
                line[state] = {"first_frame_ms": round(statistics.median(s["first_frame_ms"] for s in list_), 1),
                               "load_ms": round(statistics.median(s["load_ms"] for s in list_), 1),
                               "mirror_ms": round(statistics.median(s["mirror_ms"] for s in list_), 1),
                               "pipelines_ms": round(statistics.median(s["first_frame_ms"] - s["load_ms"] - s["mirror_ms"] for s in list_), 1)}
            print(json.dumps(line), flush=True)
