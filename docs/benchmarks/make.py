#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes the tables and plots of docs/benchmarks from data/*.csv.   make.py [--check]

A page is written by hand, except the block between "<!-- benchmarks: NAME -->" and "<!-- end -->". The block contains the rows of
data/NAME.csv: a section for each measurement, a row for each case, a column for each statistic, and one number per cell. The block of
index.md contains the list of pages and data/machines.csv. --check writes nothing and exits with 1 if a page or a plot is not current.
"""
import csv
import math
import re
import sys
from pathlib import Path
from xml.sax.saxutils import escape

HERE = Path(__file__).resolve().parent
PAGES = ["haptics", "servo", "vortex_cores", "headset", "images", "peers", "gpu", "tuning", "library"]
# file, table, measurement, text that the case contains, statistics, title, axis label, scale
PLOTS = [
    ("haptics.svg", "haptics", "Time of a tick", "", ["median", "p99.9"], "Time of a tick", "time, us", "linear"),
    ("vortex_cores.svg", "vortex_cores", "Root-mean-square distance of the lines from the core", "linear cells; 2 % noise",
     ["sujudi-haimes", "parallel-vectors", "vorticity"], "Distance from the core, linear cells, 2 % noise", "distance, voxels", "log"),
    ("headset.svg", "headset", "Controller with a sampling rate below that of the servo, hand motion of at most 0.65 mm per tick", "",
     ["mean lag"], "Controller lag by sampling rate", "mean lag, ms", "linear"),
    ("images.svg", "images", "Time of an image of a sparse grid, shaded", "", ["error=2", "exact rays"],
     "Time of an image of a sparse grid", "time, ms", "log"),
    ("peers.svg", "peers", "Processor time of an image at an error of 2", "", ["Catena", "OSPRay 3.1", "VTK 9.1, GPU mapper on llvmpipe"],
     "Processor time at an error of 2, two cores", "processor time of an image, ms", "log"),
    ("gpu.svg", "gpu", "Wall time of an image at an error of 2", "", ["Catena", "VTK 9.1, GPU mapper"],
     "Wall time at an error of 2, NVIDIA H200", "wall time of an image, ms", "log"),
]
COLORS = ["#2b6cb0", "#dd6b20", "#718096"]


def read(name):
    with open(HERE / "data" / f"{name}.csv", newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def check(name, rows):
    """Ends the program unless each value is one number or has the bound "never", each machine is known, and no row is repeated."""
    machines, seen = {m["id"] for m in read("machines")}, set()
    for row in rows:
        key = (row["measurement"], row["case"], row["statistic"])
        number = re.fullmatch(r"-?\d+(\.\d+)?(e-?\d+)?", row["value"]) or (row["value"], row["bound"]) == ("", "never")
        if not number or row["bound"] not in ("", "<", "<=", ">", "never") or row["machine"] not in machines | {""} or key in seen:
            sys.exit(f"data/{name}.csv: wrong or repeated row {row}")
        seen.add(key)


def number(row):
    return f"{row['bound']} {row['value']}{'x' if row['unit'] == 'x' else ''}".strip()


def table(rows):
    """Table of cases and statistics with units in the column headings; one row per number if most cells would be empty or units differ."""
    cases, statistics = (list(dict.fromkeys(row[key] for row in rows)) for key in ("case", "statistic"))
    units = {(row["statistic"], row["unit"]) for row in rows}
    if len(units) > len(statistics) or 3 * len(rows) < 2 * len(cases) * len(statistics):
        lines = [["case", "statistic", "value", "unit"]]
        lines += [[row["case"], row["statistic"], number(row), row["unit"].removeprefix("x")] for row in rows]
    else:
        at = {(row["case"], row["statistic"]): number(row) for row in rows}
        lines = [["case"] + [", ".join(filter(None, (s, u.removeprefix("x")))) for s in statistics for t, u in units if t == s]]
        lines += [[case] + [at.get((case, s), "") for s in statistics] for case in cases]
    lines.insert(1, ["---"] * len(lines[0]))
    return ["|" + "|".join(line) + "|" if line[0] == "---" else "| " + " | ".join(line) + " |" for line in lines]


def sections(name, rows):
    out = []
    for measurement in dict.fromkeys(row["measurement"] for row in rows):
        mine = [row for row in rows if row["measurement"] == measurement]
        out += [f"## {measurement}", ""]
        for file, at, which, _, _, title, _, _ in PLOTS:
            out += [f"![{title}]({file})", ""] if (at, which) == (name, measurement) else []
        out += [*table(mine), ""]
        for command in dict.fromkeys(row["command"] for row in mine):
            out += ["```sh", command, "```", ""] if command else ["There is no command that repeats this measurement.", ""]
        where = ", ".join(dict.fromkeys(f"`{row['machine']}`" + (f" ({row['driver']})" if row["driver"] else "") for row in mine))
        when = ", ".join(dict.fromkeys(f"{row['date']} (`{row['commit']}`)" for row in sorted(mine, key=lambda row: row["date"])))
        out += [f"Machine: {where}. Recorded: {when}.", ""]
    return out[:-1]


def contents():
    out = ["| page | numbers | last change |", "|---|---|---|"]
    for name in PAGES:
        rows = read(name)
        title = (HERE / f"{name}.md").read_text(encoding="utf-8").splitlines()[0][2:]
        out.append(f"| [{title}]({name}.md) | {len(rows)} | {max(row['date'] for row in rows)} |")
    out += ["", "| machine | processor | cores | GPU | system |", "|---|---|---|---|---|"]
    return out + [f"| `{m['id']}` | {m['processor']} | {m['cores']} | {m['gpu']} | {m['system']} |" for m in read("machines")]


def plot(rows, measurement, part, series, title, label, scale):
    """Horizontal bars with numbers. A pale bar is a bound ("< 18" ends at 18); a value with the bound "never" has no bar."""
    rows = [row for row in rows if row["measurement"] == measurement and part in row["case"] and row["statistic"] in series]
    cases, at = list(dict.fromkeys(row["case"] for row in rows)), {(row["case"], row["statistic"]): row for row in rows}
    values = [float(row["value"]) for row in rows if row["value"]]
    if scale == "log":
        lo, hi = math.floor(math.log10(min(values))), math.ceil(math.log10(max(values)))
        ticks, share = [10.0 ** d for d in range(lo, hi + 1)], lambda v: (math.log10(v) - lo) / (hi - lo)
    else:
        step = 10.0 ** math.floor(math.log10(max(values)))
        step = step if max(values) / step > 3 else step / 2
        ticks, share = [step * k for k in range(math.ceil(max(values) / step) + 1)], lambda v: v / ticks[-1]
    left, right, bar, gap = 20 + 6 * max(len(c.replace(part, "").strip("; ")) for c in cases), 560, 11, 8
    pitch, top = bar * len(series) + gap, 52
    bottom = top + len(cases) * pitch
    x = lambda v: left + (right - left) * share(v)
    text = lambda px, py, words, more="": f'<text x="{px:.1f}" y="{py:.1f}"{more}>{escape(words)}</text>'
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="620" height="{bottom + 40}" font-family="sans-serif" font-size="11">',
           f'<rect width="620" height="{bottom + 40}" fill="white"/>', text(10, 18, title, ' font-size="14"')]
    for k, name in enumerate(series if len(series) > 1 else []):
        out += [f'<rect x="{10 + 130 * k}" y="29" width="10" height="10" fill="{COLORS[k]}"/>', text(24 + 130 * k, 38, name)]
    for tick in ticks:
        out += [f'<line x1="{x(tick):.1f}" x2="{x(tick):.1f}" y1="{top - 4}" y2="{bottom}" stroke="#ddd"/>',
                text(x(tick), bottom + 14, f"{tick:g}", ' text-anchor="middle"')]
    out.append(text((left + right) / 2, bottom + 31, label, ' text-anchor="middle"'))
    for n, case in enumerate(cases):
        y = top + n * pitch
        out.append(text(left - 6, y + bar * len(series) / 2 + 4, case.replace(part, "").strip("; "), ' text-anchor="end"'))
        for k, row in enumerate(at[case, s] for s in series if (case, s) in at):
            end = x(float(row["value"])) if row["value"] else left
            out.append(f'<rect x="{left}" y="{y + k * bar}" width="{end - left:.1f}" height="{bar - 1}" fill="{COLORS[k]}"'
                       + (' fill-opacity="0.5"/>' if row["bound"] else "/>"))
            out.append(text(end + 3, y + k * bar + 9, number(row), ' font-size="9"'))
    return "\n".join(out + ["</svg>"]) + "\n"


def main():
    made = {}
    for name in [*PAGES, "index"]:
        rows = read(name) if name != "index" else []
        check(name, rows)
        lines = "\n".join(sections(name, rows) if rows else contents())
        head, rest = (HERE / f"{name}.md").read_text(encoding="utf-8").split(f"<!-- benchmarks: {name} -->\n", 1)
        made[f"{name}.md"] = f"{head}<!-- benchmarks: {name} -->\n\n{lines}\n\n<!-- end -->{rest.split('<!-- end -->', 1)[1]}"
        made.update({file: plot(rows, *how) for file, at, *how in PLOTS if at == name})
    differ = [file for file, text in made.items() if not (HERE / file).exists() or (HERE / file).read_text(encoding="utf-8") != text]
    for file in differ:
        if "--check" in sys.argv[1:]:
            print(f"docs/benchmarks/{file} is not current; docs/benchmarks/make.py writes it")
        else:
            (HERE / file).write_text(made[file], encoding="utf-8")
    sys.exit(1 if "--check" in sys.argv[1:] and differ else 0)


if __name__ == "__main__":
    main()
