#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Catena's stated error of an image against the true one, over random views of the cases of volume_cases.py.
needs: python3-numpy, python3-pil
usage: stated_error.py --catena PROGRAM --cases DIR [--views N] [--goals 1,2,4] [--size WxH] [--seed S]
Each view takes the next case and the next goal, and a random direction, distance and field of view; its true error is against exact
rays with steps of a tenth of a voxel (picture_error.py: covered pixels; over black and over white, the larger). Prints the number of
views whose stated error is at least the true one, and the quantiles of the true error divided by the stated one."""
import argparse, json, os, re, subprocess, sys, tempfile
import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "baselines"))
sys.path.insert(0, HERE)
from one_picture import over, scene_of
from picture_error import rmse


def draw(catena, scene, out, size, quality):
    done = subprocess.run([catena, "render", scene, "-o", out, "--size", size, "--quality", quality], capture_output=True, text=True)
    if done.returncode:
        sys.exit(done.stderr)
    return done.stdout


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--catena", required=True)
    parser.add_argument("--cases", required=True)
    parser.add_argument("--views", type=int, default=100)
    parser.add_argument("--goals", default="1,2,4")
    parser.add_argument("--size", default="512x384")
    parser.add_argument("--seed", type=int, default=1)
    args = parser.parse_args()
    names, goals = sorted(f[:-5] for f in os.listdir(args.cases) if f.endswith(".json")), args.goals.split(",")
    random, shares = np.random.default_rng(args.seed), []
    with tempfile.TemporaryDirectory() as folder:
        for k in range(args.views):
            name, goal = names[k % len(names)], goals[k % len(goals)]
            scene = scene_of(args.cases, name)
            camera, way = scene["camera"], random.normal(size=3)
            far = np.linalg.norm(np.subtract(camera["position"], camera["target"])) * random.uniform(.6, 1.3)
            camera["position"] = list(np.add(camera["target"], far * way / np.linalg.norm(way)))
            camera["fovy_deg"] *= random.uniform(.5, 1.2)
            json.dump(scene, open(f"{folder}/s.json", "w"))
            words = draw(args.catena, f"{folder}/s.json", f"{folder}/a.png", args.size, f"error={goal}")
            draw(args.catena, f"{folder}/s.json", f"{folder}/b.png", args.size, "step=0.1")
            stated = float(re.search(r"error about ([0-9.]+)/255", words).group(1))
            truth = max(rmse(over(f"{folder}/a.png", ground), over(f"{folder}/b.png", ground)) for ground in (0, 255))
            shares.append(truth / stated)
            print(f"{name:18} goal {goal}: stated {stated:.2f}, true {truth:.2f}: {shares[-1]:.2f}; {words.splitlines()[0]}", flush=True)
    print(f"{sum(s <= 1 for s in shares)} of {len(shares)} state at least the truth; true by stated: median {np.median(shares):.2f}, "
          f"{min(shares):.2f} to {max(shares):.2f}")


if __name__ == "__main__":
    main()
