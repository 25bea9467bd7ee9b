#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Growth of time and memory of one image: the whole program, file to PNG, 1024x768, over grids of 64^3 to 512^3 (--most) and a sparse one
of 1024^3, as a volume and as an isosurface, and over 1 to 100,000 streamlines (--lines).
needs: python3-numpy
usage: growth.py --catena PROGRAM -o DIR [--most N] [--sparse] [--lines N] [--rounds N]
The fields are created in DIR: a ball with waves, float32; the sparse one has spherical shells, imported as .vdb; the lines are of an ABC
flow on 64^3 with random seeds and default tubes. One row per image: seconds of load, upload, choose, draw and write as in --stats, wall
and processor seconds of the whole program, its maximum memory, also divided by the grid's bytes; minima over the rounds. Then the growth
exponent of each from row to row, in voxels or lines."""
import argparse, json, math, os, subprocess, time
import numpy as np

COLUMNS = ("load", "upload", "choose", "draw", "write", "wall", "processor", "MB")


def waves(n, path):
    if os.path.exists(path):
        return
    at = np.linspace(-1, 1, n, dtype=np.float32)
    with open(path, "wb") as file:
        for z in at:
            y, x = at[:, None], at[None, :]
            file.write((np.sqrt(x * x + y * y + z * z) + .05 * np.sin(20 * x + 9 * z) * np.sin(23 * y) * np.sin(17 * z)).astype(np.float32).tobytes())


def shells(n, path):
    """110 spherical shells, five voxels thick; 0 elsewhere."""
    if os.path.exists(path):
        return
    rng = np.random.default_rng(3)
    balls = [(rng.uniform(.15, .85, 3) * n, rng.uniform(.03, .12) * n) for _ in range(110)]
    with open(path, "wb") as file:
        for z in range(n):
            layer = np.zeros((n, n), np.uint8)
            for (cx, cy, cz), r in balls:
                if abs(z - cz) > r + 3:
                    continue
                lo, hi = np.maximum(0, (np.array([cy, cx]) - r - 4).astype(int)), np.minimum(n, (np.array([cy, cx]) + r + 5).astype(int))
                y, x = np.arange(lo[0], hi[0])[:, None], np.arange(lo[1], hi[1])[None, :]
                off = np.abs(np.sqrt((x - cx) ** 2 + (y - cy) ** 2 + (z - cz) ** 2) - r)
                part = layer[lo[0]:hi[0], lo[1]:hi[1]]
                np.maximum(part, np.clip(200 * (1 - off / 2.5), 0, 200).astype(np.uint8), out=part)
            file.write(layer.tobytes())


def flow(path):
    a = np.linspace(0, 2 * np.pi, 64)
    z, y, x = np.meshgrid(a, a, a, indexing="ij")
    np.stack([np.sin(z) + np.cos(y), .8 * np.sin(x) + np.cos(z), .6 * np.sin(y) + .8 * np.cos(x)], -1).astype(np.float32).tofile(path)


def run(catena, folder, scene):
    with open(f"{folder}/s.json", "w") as file:
        json.dump(scene, file)
    start = time.perf_counter()
    child = subprocess.Popen([catena, "render", f"{folder}/s.json", "-o", f"{folder}/o.png", "--size", "1024x768", "--stats", f"{folder}/stats.json"],
                             stdout=subprocess.DEVNULL)
    _, status, use = os.wait4(child.pid, 0)
    if status:
        raise SystemExit("catena failed")
    wall, stats = time.perf_counter() - start, json.load(open(f"{folder}/stats.json"))
    row = [stats["load_ms"], stats["mirror_ms"], stats["choose_ms"], stats["frame_ms"]["median"], stats["encode_ms"]]
    return [ms / 1e3 for ms in row] + [wall, use.ru_utime + use.ru_stime, use.ru_maxrss / 1024]


def table(title, rows, unit):
    print(f"\n{title}\n{unit:>14} " + "".join(f"{c:>10}" for c in COLUMNS))
    for name, size, row, own in rows:
        print(f"{name:>14} " + "".join(f"{v:10.2f}" for v in row) + (f"   {row[-1] / own:.2f}x the grid" if own else ""))
    for (_, a, before, _), (name, b, after, _) in zip(rows, rows[1:]):
        powers = [math.log(max(q, 1e-3) / max(p, 1e-3)) / math.log(b / a) for p, q in zip(before, after)]
        print(f"{'to ' + name:>14} " + "".join(f"{p:10.2f}" for p in powers) + "   exponent", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--catena", required=True)
    parser.add_argument("-o", dest="folder", required=True)
    parser.add_argument("--most", type=int, default=512)
    parser.add_argument("--sparse", action="store_true")
    parser.add_argument("--lines", type=int, default=0)
    parser.add_argument("--rounds", type=int, default=2)
    args = parser.parse_args()
    os.makedirs(args.folder, exist_ok=True)
    least = lambda scene: [min(column) for column in zip(*(run(args.catena, args.folder, scene) for _ in range(args.rounds)))]
    looks = {"volume": {"volumes": [{"field": "f", "opacity": [[.5, .2], [.7, .01], [1, 0]]}]}, "isosurface": {"isosurfaces": [{"field": "f", "level": .6}]}}
    for kind, look in looks.items():
        rows, n = [], 64
        while n <= args.most:
            path = os.path.abspath(f"{args.folder}/{n}.raw")
            waves(n, path)
            scene = {"fields": {"f": {"file": path, "shape": [n, n, n], "spacing": [2 / n] * 3, "origin": [-1] * 3, "type": "float32"}}, **look}
            rows.append((f"{n}^3", n**3, least(scene), 4 * n**3 / 2**20))
            n *= 2
        table(f"{kind}, dense", rows, "grid")
    if args.sparse:
        rows = []
        for n in (256, 512, 1024):
            raw, path = f"{args.folder}/shells{n}.raw", os.path.abspath(f"{args.folder}/shells{n}.vdb")
            if not os.path.exists(path):
                shells(n, raw)
                subprocess.run([args.catena, "import", raw, "-o", path, "--shape", str(n), str(n), str(n), "--type", "uint8"], check=True)
                os.remove(raw)
            rows.append((f"{n}^3", n**3, least({"fields": {"f": {"file": path}}, "volumes": [{"field": "f", "opacity": [[0, 0], [100, .5]], "shade": True}]}), 0))
        table("shells, sparse, shaded", rows, "grid")
    if args.lines:
        path, rows, n = os.path.abspath(f"{args.folder}/flow.raw"), [], 1
        flow(path)
        while n <= args.lines:
            scene = {"fields": {"v": {"file": path, "shape": [64, 64, 64], "spacing": [1, 1, 1], "origin": [0, 0, 0], "type": "float32x3"}},
                     "streamlines": [{"field": "v", "seeds": np.random.default_rng(4).uniform(2, 61, (n, 3)).round(3).tolist(), "length": 60}]}
            rows.append((str(n), n, least(scene), 0))
            n *= 10
        table("streamlines", rows, "lines")


if __name__ == "__main__":
    main()
