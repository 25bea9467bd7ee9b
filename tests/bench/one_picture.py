#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""One image by whole programs, from file to PNG: Catena's default and each of its settings, compared with VTK's mapper.
needs: python3-numpy, python3-scipy, python3-pil, python3-vtk9, xvfb-run; cases made by volume_cases.py
usage: xvfb-run -a one_picture.py --catena PROGRAM --cases DIR [--rounds N] [--goal E] [--no-vtk] [--processor] [CASE ...]
For each case: wall seconds (minimum over alternating rounds) and the error over covered pixels (baselines/picture_error.py) against that
program's own converged image, which is cached in DIR. Of each program, settings finer than the first that meets half of the goal or takes
twice the default's time are skipped. The last columns are the default's time divided by that of the cheapest setting that meets the goal,
and VTK's time divided by the default's: the cheapest of VTK's settings with an error of at most the default's, or the goal."""
import argparse, json, os, shutil, statistics, subprocess, sys, tempfile, time
import numpy as np
from PIL import Image

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "baselines"))
from picture_error import rmse

OURS = ("draft", "step=4", "step=2.8", "step=2", "step=1.4", "step=1", "step=0.7", "step=0.5", "step=0.35")
THEIRS = ("cpu 2 2", "cpu 1 2", "cpu 4 1", "cpu 2 1", "cpu 1.4 1", "cpu 1 1", "cpu 0.7 1")
PROCESSOR = False
CONVERGED, CONVERGED_VTK = "step=0.1", "cpu 0.5 1"
VTK = """import sys; sys.path.insert(0, sys.argv[1]); import vtk_peer; from PIL import Image
s = vtk_peer.Scene(sys.argv[2]); s.set_mode(sys.argv[3]); s.draw(30); Image.fromarray(s.picture().copy()).save(sys.argv[4])"""


def scene_of(folder, name):
    case = json.load(open(f"{folder}/{name}.json"))
    dims, view = case["dims"], case["view"]
    az, el, far = np.radians(30), np.radians(view["elevation"]), view["distance"] * max(dims)
    middle = [(n - 1) / 2 for n in dims]
    eye = [middle[0] + far * np.sin(az) * np.cos(el), middle[1] - far * np.cos(az) * np.cos(el), middle[2] + far * np.sin(el)]
    return {"fields": {"f": {"file": f"{os.path.abspath(folder)}/{case['raw']}", "shape": dims, "type": "float32"}},
            "background": "transparent", "camera": {"position": eye, "target": middle, "up": [0, 0, 1], "fovy_deg": view["fovy_deg"]},
            "volumes": [{"field": "f", "shade": case["shade"], "color": case["colour"], "opacity": case["opacity"], "opacity_unit": case["unit"]}]}


def over(path, ground):
    """An image over uniform grey, with its own alpha."""
    picture = np.asarray(Image.open(path).convert("RGBA")).astype(float)
    alpha = picture[..., 3:]
    return np.concatenate([(picture[..., :3] * alpha / 255 + ground * (255 - alpha) / 255 + .5).astype(np.uint8), alpha.astype(np.uint8)], -1)


def run(command, out):
    start, before = time.perf_counter(), os.times()
    done = subprocess.run(command, capture_output=True, text=True, env=dict(os.environ, LIBGL_ALWAYS_SOFTWARE="1"))
    if done.returncode:
        sys.exit(f"{command}: {done.stderr}")
    after = os.times()
    processor = after.children_user + after.children_system - before.children_user - before.children_system
    return (processor if PROCESSOR else time.perf_counter() - start), done.stdout, over(out, 0)


def converged_picture(command, kept, out):
    if not os.path.exists(kept):
        run(command, out)
        shutil.copy(out, kept)
    return over(kept, 0)


def best(times, errors, most):
    good = [name for name in times if name in errors and errors[name] <= most]
    return min(good, key=lambda name: times[name]) if good else None


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--catena", required=True)
    parser.add_argument("--cases", required=True)
    parser.add_argument("--rounds", type=int, default=2)
    parser.add_argument("--goal", type=float, default=2)
    parser.add_argument("--no-vtk", action="store_true")
    parser.add_argument("--processor", action="store_true", help="processor seconds instead of wall seconds")
    parser.add_argument("names", nargs="*", metavar="CASE")
    args = parser.parse_args()
    global PROCESSOR
    PROCESSOR = args.processor
    names = args.names or sorted(f[:-5] for f in os.listdir(args.cases) if f.endswith(".json"))
    shares, gains = [], []
    with tempfile.TemporaryDirectory() as folder:
        out = f"{folder}/o.png"
        for name in names:
            json.dump(scene_of(args.cases, name), open(f"{folder}/s.json", "w"))
            ours = lambda q: [args.catena, "render", f"{folder}/s.json", "-o", out, "--size", "1024x768", *(["--quality", q] if q else [])]
            theirs = lambda q: ["/usr/bin/python3", "-c", VTK, f"{HERE}/peers", f"{args.cases}/{name}.json", q, out]
            kinds, converged = [(ours, q) for q in (None, *OURS)], {ours: converged_picture(ours(CONVERGED), f"{args.cases}/{name}.ours.png", out)}
            if not args.no_vtk:
                converged[theirs] = converged_picture(theirs(CONVERGED_VTK), f"{args.cases}/{name}.vtk.png", out)
                kinds += [(theirs, q) for q in THEIRS]
            times, errors, told = {ours: {}, theirs: {}}, {ours: {}, theirs: {}}, ""
            for _ in range(args.rounds):
                for of, q in kinds:
                    slowest = max((took for setting, took in times[of].items() if setting), default=0)
                    coarser = (error for setting, error in errors[of].items() if setting)
                    if q and q not in times[of] and (min(coarser, default=np.inf) < args.goal / 2 or slowest > 2 * times[ours][None]):
                        continue
                    took, words, picture = run(of(q), out)
                    times[of][q] = min(took, times[of].get(q, np.inf))
                    errors[of][q] = rmse(picture, converged[of])
                    if q is None:
                        told = words.splitlines()[0]
            default, error = times[ours].pop(None), errors[ours].pop(None)
            cheapest = best(times[ours], errors[ours], args.goal)
            peer = best(times[theirs], errors[theirs], max(args.goal, error))
            if cheapest:
                shares.append(default / times[ours][cheapest])
            if peer:
                gains.append(times[theirs][peer] / default)
            print(f"{name:18} {default:6.2f} s, error {error:4.2f}; "
                  + (f"{cheapest} {times[ours][cheapest]:.2f} s, {errors[ours][cheapest]:.2f}: {shares[-1]:.2f}x; " if cheapest else "no setting meets the goal; ")
                  + (f"vtk {peer} {times[theirs][peer]:.2f} s: {gains[-1]:.2f}x; " if peer else "") + told, flush=True)
    for words, ratios in (("default by the cheapest setting that meets the goal", shares), ("VTK by the default", gains)):
        if ratios:
            print(f"{words}: median {statistics.median(ratios):.2f}x, {min(ratios):.2f}x to {max(ratios):.2f}x")


if __name__ == "__main__":
    main()
