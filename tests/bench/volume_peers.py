#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Comparison of volume renderers: time of an image at equal error against each renderer's own converged image.
needs: python3-numpy, python3-scipy, the peers' requirements; cases by volume_cases.py
usage: volume_peers.py --peer NAME=COMMAND ... --cases DIR -o OUT [--only CASE ...] [--rounds N] [--views N] [--modes NAME='MODE; MODE'] [--flicker]
A peer is a program that draws images on request (baselines/protocol.h); NAME is ours, vtk-gpu, vtk-cpu or ospray and selects its settings
below. The settings of all peers alternate; every round draws an orbit of `views` images of each (and an untimed one before).
Times are medians: processor milliseconds divided by two (two threads: the ideal wall time) and wall milliseconds. Errors are taken at
azimuth 30 against the peer's own converged image (baselines/picture_error.py): steps are halved until an image is within an RMSE of 0.3
of the previous one or takes longer than a minute; the last difference is reported as `left`.
The time at an error is interpolated on the lower envelope of a peer's settings, linearly in both logarithms; `<` means that the fastest
setting is already better, `-` that none is as good. The converged images of two peers should agree within an RMSE of 1; otherwise the
table has `differs` and the cause. For ratios, `<` and `>` mark that one of the times is that of a fastest setting, `~` that both are.
Settings that take more than two seconds per image are drawn in one round only.
Writes OUT/table.md and OUT/table.json, and OUT/CASE/ with the images and results of that case: an interrupted run is continued, and a
case with changed file, peers or settings is repeated."""
import argparse, hashlib, json, math, os, shlex, statistics, subprocess, sys, time
import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "baselines"))
from picture_error import flicker, picture_error, rmse

VIEW, LEVELS, AGREE = 30, (1, 2, 4), 1
LEFT, SLOW_MS, LONG_MS = .3, 2000, 60000
# peer -> converging settings, each about twice as accurate as the previous one; compared settings
MODES = {
    "ours": ("reference=0.2; reference=0.1; reference=0.05; reference=0.025; reference=0.0125",
             "draft; balanced; error=8; error=4; error=2; error=1; error=0.5; exact=1; exact=0.5; "
             "fast=0.5,1,0,-1,smooth; fast=0.25,1,0,-1,smooth"),
    "vtk-gpu": ("gpu 0.2 1; gpu 0.1 1; gpu 0.05 1; gpu 0.025 1",
                "gpu 4 2; gpu 2 2; gpu 1 2; gpu 0.5 2; gpu 4 1; gpu 2 1; gpu 1 1; gpu 0.5 1; gpu 0.25 1"),
    # its fixed-point numbers lose precision at every step, so that below 0.5 voxels the error increases
    "vtk-cpu": ("cpu 0.7 1; cpu 0.5 1", "cpu 4 2; cpu 2 2; cpu 1 2; cpu 0.5 2; cpu 4 1; cpu 2 1; cpu 1.4 1; cpu 1 1"),
    "ospray": ("samplingRate=4 pixelSamples=4 minContribution=0.0001; samplingRate=8 pixelSamples=4 minContribution=0.0001; "
               "samplingRate=16 pixelSamples=4 minContribution=0.0001; samplingRate=32 pixelSamples=4 minContribution=0.0001",
               "samplingRate=0.25 pixelSamples=1; samplingRate=0.5 pixelSamples=1; samplingRate=1 pixelSamples=1; "
               "samplingRate=2 pixelSamples=1; samplingRate=4 pixelSamples=1; samplingRate=8 pixelSamples=1; "
               "samplingRate=16 pixelSamples=1; samplingRate=1 pixelSamples=4"),
}
FLICKER = {"ours": ("reference=0.1", ("balanced", "error=2"))}
# causes of differences between a peer's converged images and ours: (peer, shaded)
CAUSES = {
    ("ospray", False): "the last part of a way through what is seen, shorter than a step, is left out",
    ("ospray", True): "no highlight on volumes, the gradient of the cell for central differences, light from one direction for the whole picture",
    ("vtk-gpu", False): "rays begin a step behind the face of the box",
    ("vtk-gpu", True): "rays begin a step behind the face of the box",
    ("vtk-cpu", False): "its picture is stretched by 0.1 %, up to 0.4 pixels off; fixed-point sums, brighter the smaller the step",
    ("vtk-cpu", True): "light from one direction for the whole picture, interpolated from corners of cells; stretched by 0.1 %; fixed-point sums",
}


class PeerError(Exception):
    pass


class Peer:
    """A peer's process for one case."""
    def __init__(self, name, command, case, log):
        env = dict(os.environ, LIBGL_ALWAYS_SOFTWARE="1", LP_NUM_THREADS="2", OSPRAY_NUM_THREADS="2")
        self.name, self.log = name, log
        self.process = subprocess.Popen([*shlex.split(command), case], env=env, stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                        stderr=open(log, "w"), text=True)

    def draw(self, mode, azimuths, path, warm=1):
        try:
            self.process.stdin.write(json.dumps({"mode": mode, "azimuths": azimuths, "picture": path, "warm": warm}) + "\n")
            self.process.stdin.flush()
        except BrokenPipeError:
            pass
        line = self.process.stdout.readline()
        answer = json.loads(line) if line else {"error": f"ended, see {self.log}"}
        if "error" in answer:
            raise PeerError(f"{self.name}: {mode}: {answer['error']}")
        return answer

    def close(self):
        try:
            self.process.stdin.close()
        except BrokenPipeError:
            pass
        self.process.wait()


def modes_of(name, changed):
    """Converging settings, and compared settings."""
    best, modes = MODES[name]
    return [[m.strip() for m in text.split(";")] for text in (best, changed.get(name) or modes)]


def curve(settings, key):
    """Pareto front of (time, error), from the fastest on."""
    out = []
    for s in sorted(settings, key=lambda s: s[key]):
        if not out or s["rmse"] < out[-1][1]:
            out.append((s[key], s["rmse"]))
    return out


def time_at(points, error):
    """Time in milliseconds at an error, and its mark."""
    if points[0][1] <= error:
        return points[0][0], "<"
    for (t0, e0), (t1, e1) in zip(points, points[1:]):
        if e1 <= error:
            f = (math.log(e0) - math.log(error)) / (math.log(e0) - math.log(max(e1, 1e-3)))
            return math.exp(math.log(t0) + f * (math.log(t1) - math.log(t0))), ""
    return None, "-"


def fingerprint(case, names, args):
    digest = hashlib.sha256(open(case, "rb").read())
    with open(os.path.join(os.path.dirname(case), json.load(open(case))["raw"]), "rb") as raw:
        for block in iter(lambda: raw.read(1 << 24), b""):
            digest.update(block)
    programs = [[w, os.stat(w).st_mtime_ns] for c in args.commands.values() for w in shlex.split(c) if os.path.isfile(w)]
    digest.update(json.dumps([names, [modes_of(n, args.changed) for n in names], programs, args.rounds, args.views]).encode())
    return digest.hexdigest()


def converge(peer, ladder, folder):
    """Draws increasingly accurate images until one equals the previous one or takes too long."""
    last, tried = None, []
    for mode in ladder:
        tried.append({"mode": mode, "ms": peer.draw(mode, [VIEW], f"{folder}/{peer.name}.npy", 0)["wall_ms"][0]})
        picture = np.load(f"{folder}/{peer.name}.npy")
        tried[-1]["left"] = rmse(last, picture) if last is not None else 255.
        if tried[-1]["left"] <= LEFT or tried[-1]["ms"] > LONG_MS:
            break
        last = picture
    return picture, tried[-1]


def run_case(peers, args, folder):
    out, pictures, plan = {}, {}, []
    for peer in peers:
        ladder, modes = modes_of(peer.name, args.changed)
        pictures[peer.name], converged = converge(peer, ladder, folder)
        out[peer.name] = {"converged": converged, "settings": [{"mode": m, "cpu": [], "wall": []} for m in modes]}
        plan += [((k + .5) / len(modes), peer, s) for k, s in enumerate(out[peer.name]["settings"])]
    azimuths = [(360 * k / args.views + 7) % 360 for k in range(args.views - 1)] + [VIEW]
    for turn in range(args.rounds):
        for _, peer, setting in sorted(plan, key=lambda p: p[0]):
            if setting["wall"] and min(setting["wall"]) > SLOW_MS:
                continue
            path = f"{folder}/{peer.name} {setting['mode'].replace('/', '_')}.npy"
            answer = peer.draw(setting["mode"], azimuths, path)
            setting["cpu"] += answer["cpu_ms"]
            setting["wall"] += answer["wall_ms"]
            if turn == 0:
                setting.update(picture_error(np.load(path), pictures[peer.name]), note=answer.get("note", ""))
    for name, result in out.items():
        for s in result["settings"]:
            s["cpu_ms"], s["wall_ms"] = statistics.median(s["cpu"]) / 2, statistics.median(s["wall"])
        for key in ("cpu_ms", "wall_ms"):
            result[key] = {str(level): time_at(curve(result["settings"], key), level) for level in LEVELS}
    for name in out:
        out[name]["apart"] = {other: rmse(pictures[name], pictures[other]) for other in out if other != name}
    if args.flicker:
        for peer in peers:
            if peer.name in FLICKER:
                out[peer.name]["flicker"] = measure_flicker(peer, *FLICKER[peer.name], folder)
    return out


def measure_flicker(peer, truth, modes, folder):
    """Flicker over 20 frames of 0.2 degrees."""
    def frames(mode):
        out = []
        for k in range(20):
            peer.draw(mode, [VIEW + .2 * k], f"{folder}/frame.npy", 0)
            out.append(np.load(f"{folder}/frame.npy"))
        return out

    converged = frames(truth)
    measured = {mode: flicker(frames(mode), converged) for mode in modes}
    os.remove(f"{folder}/frame.npy")
    return measured


def judged(name, first, result, shaded):
    """Text about a peer's converged image compared with the first peer's."""
    left = result["converged"]["left"]
    words = [f"left {left:.2f}"] if left > .5 else []
    apart = result["apart"].get(first)
    if apart is not None and apart > AGREE:
        words.append(f"differs by {apart:.1f}: " + CAUSES.get((name, shaded), "unknown"))
    return "; ".join(words) or "agrees"


def show(time_mark):
    ms, mark = time_mark
    return mark if ms is None else f"{mark}{ms:.0f}"


def ratio(theirs, first):
    """Ratio of two times, which may be upper bounds."""
    if not theirs[0] or not first[0]:
        return "-"
    return {"": "", "<": "<", ">": ">", "<>": "~"}[theirs[1] + first[1].replace("<", ">")] + f"{theirs[0] / first[0]:.2g}"


def table_of_ratios(results, names):
    first = names[0]
    lines = ["", f"Processor time by that of {first}, at the same errors; converged pictures against that of {first}.", "",
              "| case | " + " | ".join(f"{n} | converged" for n in names[1:]) + " |", "|---|" + "---|---|" * (len(names) - 1)]
    for case, result in results.items():
        cells = []
        for n in names[1:]:
            pairs = [(result[n]["cpu_ms"][str(e)], result[first]["cpu_ms"][str(e)]) for e in LEVELS] if n in result else []
            cells.append(", ".join(ratio(a, b) for a, b in pairs))
            cells.append(judged(n, first, result[n], case.endswith("-shaded")) if n in result else "")
        lines.append(f"| {case} | " + " | ".join(cells) + " |")
    return lines


def write_tables(results, names, out):
    json.dump(results, open(f"{out}/table.json", "w"), indent=1)
    lines = [f"Milliseconds a picture at a covered RMSE of {', '.join(map(str, LEVELS))}: processor time by two (wall time).", "",
             "| case | " + " | ".join(f"{n} {e}" for n in names for e in LEVELS) + " |", "|---|" + "---|" * (len(names) * len(LEVELS))]
    for case, result in results.items():
        cells = [f"{show(result[n]['cpu_ms'][str(e)])} ({show(result[n]['wall_ms'][str(e)])})" if n in result else "" for n in names for e in LEVELS]
        lines.append(f"| {case} | " + " | ".join(cells) + " |")
    if names[1:]:
        lines += table_of_ratios(results, names)
    for case, result in results.items():
        lines += ["", f"## {case}", "", "| peer | setting | processor ms / 2 | wall ms | RMSE | p99.9 | thin kept | least | note |",
                  "|---|" + "---|" * 8]
        for n in (n for n in names if n in result):
            for s in sorted(result[n]["settings"], key=lambda s: s["cpu_ms"]):
                lines.append(f"| {n} | {s['mode']} | {s['cpu_ms']:.1f} | {s['wall_ms']:.1f} | {s['rmse']:.2f} | {s['p999']:.0f} | "
                             f"{s['thin_kept']:.3f} | {s['thin_least']:.3f} | {s['note']} |")
        for n in (n for n in names if n in result):
            c = result[n]["converged"]
            apart = ", ".join(f"{v:.2f} from {o}" for o, v in result[n]["apart"].items())
            shaking = "".join(f"; flicker of {m} {v:.2f}" for m, v in result[n].get("flicker", {}).items())
            lines.append(f"\n{n}: converged {c['mode']}, {c['ms']:.0f} ms, left {c['left']:.2f}; {apart}{shaking}")
    open(f"{out}/table.md", "w").write("\n".join(lines) + "\n")


def parsed():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--peer", action="append", required=True, metavar="NAME=COMMAND")
    parser.add_argument("--cases", required=True)
    parser.add_argument("-o", "--out", required=True)
    parser.add_argument("--only", nargs="+", default=[])
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--views", type=int, default=3)
    parser.add_argument("--modes", action="append", default=[], metavar="NAME='MODE; MODE'")
    parser.add_argument("--flicker", action="store_true")
    args = parser.parse_args()
    args.commands = dict(p.split("=", 1) for p in args.peer)
    args.changed = dict(m.split("=", 1) for m in args.modes)
    for name in [*args.commands, *args.changed]:
        if name not in MODES:
            sys.exit(f"{name}: expected a peer of {', '.join(MODES)}")
    return args


def main():
    args, results, failed = parsed(), {}, False
    names = list(args.commands)
    cases = args.only or sorted(f[:-5] for f in os.listdir(args.cases) if f.endswith(".json"))
    for case in cases:
        path, folder = os.path.join(args.cases, case + ".json"), os.path.join(args.out, case)
        if not os.path.exists(path):
            sys.exit(f"{path}: no such case; volume_cases.py makes them")
        os.makedirs(folder, exist_ok=True)
        kept, mark, begin = f"{folder}/result.json", fingerprint(path, names, args), time.time()
        old = json.load(open(kept)) if os.path.exists(kept) else {}
        if old.get("fingerprint") != mark or (args.flicker and not any("flicker" in r for r in old["peers"].values())):
            peers = [Peer(n, c, path, f"{folder}/{n}.txt") for n, c in args.commands.items()]
            try:
                old = {"fingerprint": mark, "peers": run_case(peers, args, folder)}
            except PeerError as error:
                print(f"{case}: left out: {error}", file=sys.stderr, flush=True)
                failed = True
                continue
            finally:
                for peer in peers:
                    peer.close()
            json.dump(old, open(kept + ".part", "w"), indent=1)
            os.replace(kept + ".part", kept)
        results[case] = old["peers"]
        write_tables(results, names, args.out)
        print(f"{case}: {time.time() - begin:.0f} s", flush=True)
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
