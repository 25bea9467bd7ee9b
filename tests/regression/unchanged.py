#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Whether two builds of catena do the same: pictures, CSV, exit codes, messages and recordings, byte for byte.

  unchanged.py BEFORE AFTER [--assets FOLDER] [--generated 200] [--bad 50] [--only WORD] [--reworded] [--exceptions FILE] [--keep FOLDER]

BEFORE and AFTER are programs. Both run on every scene of the assets (those of BEFORE: --assets), on generated and on bad scenes (scenes.py,
always the same, with the names of version 0.2), and on recordings that BEFORE made. Each program first upgrades its own copy of a file, if
it has `upgrade`: new names are then no difference. A column of a CSV is compared by its values where its name was changed on purpose
(COLUMNS). Durations in what they print, notes ("catena: note: ...") and progress lines, which depend on time, are left out of the
comparison, nothing else. With --reworded a sentence may have other words: of stdout the numbers are compared, of stderr whether there is a
message, and the file and line it names. The exceptions: lines "CASE: why", CASE a shell pattern; they are counted and listed. Exit code 1
where anything else differs.
"""
import argparse
import fnmatch
import glob
import json
import math
import os
import re
import shutil
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor

import scenes

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
DURATION = re.compile(rb"\d+(\.\d+)?(e[-+]?\d+)? ?(us|ms|s|min)\b")
NOTE = re.compile(rb"catena: note: .*\n|.*: \d+ %\n|reading .* so far\n")
NUMBER = re.compile(rb"(?<![\w.])[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")
PLACE = re.compile(rb"[\w./-]+\.\w+:\d+(?::\d+)?")
COLUMNS = {b"_leaving": b"_release_ratio", b"_left": b"_released", b"_booked": b"_accounted"}
CUBE = """v -0.6 -0.6 -0.6\nv 0.6 -0.6 -0.6\nv 0.6 0.6 -0.6\nv -0.6 0.6 -0.6\nv -0.6 -0.6 0.6\nv 0.6 -0.6 0.6\nv 0.6 0.6 0.6\nv -0.6 0.6 0.6
f 1 3 2\nf 1 4 3\nf 5 6 7\nf 5 7 8\nf 1 2 6\nf 1 6 5\nf 2 3 7\nf 2 7 6\nf 3 4 8\nf 3 8 7\nf 4 1 5\nf 4 5 8\n"""


def run(program, words, folder):
    done = subprocess.run([program] + words, cwd=folder, capture_output=True, timeout=600, env=dict(os.environ, LC_ALL="C"))
    return done.returncode, DURATION.sub(b"#", done.stdout), DURATION.sub(b"#", NOTE.sub(b"", done.stderr))


def contents(path):
    with open(path, "rb") as file:
        return file.read()


def upgrade(program, name, folder):
    """Replaces old names in a file, where the program can; a file that it cannot read stays."""
    run(program, ["upgrade", "--no-backup", name], folder)


def with_new_columns(table):
    """A table whose header has the new names of its columns."""
    head, end, rows = table.partition(b"\n")
    for old, new in COLUMNS.items():
        head = re.sub(old + rb"(?=,|$)", new, head)
    return head + end + rows


def outcome(program, words, folder, outputs):
    """What a command did: exit code, words, and the bytes of its outputs (None: no file)."""
    for name in outputs:
        if os.path.exists(os.path.join(folder, name)):
            os.remove(os.path.join(folder, name))
    code, out, err = run(program, words, folder)
    files = [contents(os.path.join(folder, n)) if os.path.exists(os.path.join(folder, n)) else None for n in outputs]
    files = [with_new_columns(f) if f and n.endswith(".csv") else f for n, f in zip(outputs, files)]
    return {"exit code": code, "stdout": out, "stderr": err, **dict(zip(outputs, files))}


def path_csv(box, ticks=1200):
    """A hand's smooth way through a box, with its button down for a while."""
    rows = ["t,x,y,z,buttons"]
    for i in range(ticks):
        t = i * 1e-3
        share = [0.5 + 0.45 * math.sin(2 * math.pi * f * t + p) for f, p in ((0.7, 0.1), (0.5, 1.3), (0.9, 2.6))]
        rows.append("%.3f,%s,%d" % (t, ",".join(repr(lo + s * (hi - lo)) for (lo, hi), s in zip(box, share)), 1 if 500 < i < 800 else 0))
    return "\n".join(rows) + "\n"


def box_of(program, scene_path, folder):
    """The world box of a scene's first grid in a file; else the cube of the formulas."""
    _, out, _ = run(program, ["info", scene_path], folder)
    file = re.search(rb"(\S+\.vdb)", out)
    if file:
        _, out, _ = run(program, ["info", file.group(1).decode()], folder)
        box = re.search(rb"world box +(\S+) (\S+) (\S+) \.\. (\S+) (\S+) (\S+)", out)
        if box:
            v = [float(x) for x in box.groups()]
            return [(v[i], v[i + 3]) for i in range(3)]
    return [(-1.2, 1.2)] * 3


def commands(scene, index, is_example):
    """[(what, words, outputs)] of a scene."""
    size = "160x120" if is_example else "96x72"
    yield "info", ["info", scene], []
    yield "render", ["render", scene, "-o", "p.png", "--size", size] + (["--ids", "i.png"] if index % 3 == 0 else []), \
        ["p.png"] + (["i.png"] if index % 3 == 0 else [])
    yield "replay", ["replay", scene, "--probe", "probe.csv", "-o", "t.csv", "--details", "d.csv", "--widgets", "w.csv"], \
        ["t.csv", "d.csv", "w.csv"]


def facts(key, text):
    """What of a printed text does not depend on its words."""
    return sorted(NUMBER.findall(text)) if key == "stdout" else (text != b"", PLACE.findall(text))


def compare(name, a, b, told, reworded):
    for key in a:
        if reworded and key in ("stdout", "stderr") and facts(key, a[key]) == facts(key, b[key]):
            continue
        if a[key] != b[key]:
            told.append((name, key, a[key], b[key]))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("before")
    parser.add_argument("after")
    parser.add_argument("--assets", default=os.path.join(ROOT, "assets"))
    parser.add_argument("--generated", type=int, default=200)
    parser.add_argument("--bad", type=int, default=50)
    parser.add_argument("--only", default="")
    parser.add_argument("--reworded", action="store_true")
    parser.add_argument("--exceptions")
    parser.add_argument("--keep")
    options = parser.parse_args()
    programs = [os.path.abspath(options.before), os.path.abspath(options.after)]
    top = options.keep or tempfile.mkdtemp(prefix="unchanged-")
    folders = [os.path.join(top, side, "catena") for side in ("before", "after")]
    for folder in folders:
        os.makedirs(os.path.join(folder, "data"), exist_ok=True)
        shutil.copytree(options.assets, os.path.join(folder, "assets"), dirs_exist_ok=True)
        shared = os.path.join(os.path.dirname(ROOT), "shared")
        if os.path.exists(shared) and not os.path.exists(os.path.join(folder, "..", "shared")):
            os.symlink(shared, os.path.join(folder, "..", "shared"))
        with open(os.path.join(folder, "data", "cube.obj"), "w") as file:
            file.write(CUBE)
        for field in ("torus", "abc"):
            run(programs[0], ["generate", field, "-o", "data/%s.vdb" % field, "--resolution", "24"], folder)

    chain_schema = json.loads(run(programs[0], ["info", "--schema"], folders[0])[1])
    if "items" not in chain_schema:  # a schema of whole scenes
        chain_schema = chain_schema["properties"]["chain"]
    cases = [(name, None) for name in sorted(glob.glob("assets/scenes/**/*.json", root_dir=os.path.dirname(os.path.abspath(options.assets)), recursive=True))]
    cases += [(name + ".json", text) for name, text in scenes.all_of(chain_schema, options.generated, options.bad)]
    cases = [case for case in cases if options.only in case[0]]

    told, fine, runs = [], 0, 0
    pool = ThreadPoolExecutor(2)

    def both(words, outputs):
        return list(pool.map(lambda i: outcome(programs[i], words, folders[i], outputs), range(2)))

    for index, (name, text) in enumerate(cases):
        for folder in folders:
            if text is not None:
                with open(os.path.join(folder, name), "w") as file:
                    file.write(text)
            upgrade(programs[folders.index(folder)], name, folder)
        box = box_of(programs[0], name, folders[0]) if text is None else [(-1.2, 1.2)] * 3
        for folder in folders:
            with open(os.path.join(folder, "probe.csv"), "w") as file:
                file.write(path_csv(box))
        for what, words, outputs in commands(name, index, text is None):
            a, b = both(words, outputs)
            compare("%s %s" % (name, what), a, b, told, options.reworded)
            runs += 1
            fine += a["exit code"] == 0
        # a recording that the old program makes, run again by both
        if text is None or index % 10 == 0:
            if os.path.exists(os.path.join(folders[0], "r.catlog")):
                os.remove(os.path.join(folders[0], "r.catlog"))
            run(programs[0], ["feel", name, "--device", "recorded:probe.csv", "--seconds", "0.5", "--record", "r.catlog"], folders[0])
            if os.path.exists(os.path.join(folders[0], "r.catlog")):
                shutil.copyfile(os.path.join(folders[0], "r.catlog"), os.path.join(folders[1], "r.catlog"))
                upgrade(programs[1], "r.catlog", folders[1])
                for what, words, outputs in (("log", ["replay", "--log", "r.catlog"], []), ("export", ["export", "r.catlog", "-o", "e.csv"], ["e.csv"])):
                    a, b = both(words, outputs)
                    compare("%s %s" % (name, what), a, b, told, options.reworded)
                    runs += 1
                    fine += a["exit code"] == 0
        if sys.stderr.isatty():
            print("\r%d of %d, %d differences " % (index + 1, len(cases), len(told)), end="", file=sys.stderr)

    patterns = []
    if options.exceptions:
        patterns = [line.split(": ", 1) for line in contents(options.exceptions).decode().splitlines() if line and not line.startswith("#")]
    unexplained = 0
    for name, key, a, b in told:
        why = [reason for pattern, reason in patterns if fnmatch.fnmatch(name + " " + key, pattern)]
        unexplained += not why
        print("%s: %s%s" % (name, key, " (%s)" % why[0] if why else ""))
        if key in ("exit code", "stdout", "stderr") and not why:
            print("    before: %s\n    after:  %s" % (str(a)[:600], str(b)[:600]))
    print("%d cases, %d runs (%d of them succeed), %d differences, %d unexplained" % (len(cases), runs, fine, len(told), unexplained))
    if not options.keep:
        shutil.rmtree(top)
    return 1 if unexplained else 0


if __name__ == "__main__":
    sys.exit(main())
