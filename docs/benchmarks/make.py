#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Makes the pages and plots of docs/benchmarks from data/*.csv.   make.py [--check]

One row of a table is one case, one column one statistic, one cell one number. --check writes nothing and exits with 1 if a page or a plot
differs from what the tables of data give.
"""
import csv
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent

# name of the table, title, introduction
PAGES = [
    ("haptics", "Haptics", "Accuracy of proxies and forces, stability, and the time of a tick."),
    ("servo", "The servo beside other work", "Deadlines and periods of the haptic thread while both cores are busy."),
    ("vortex_cores", "Vortex cores",
     "Flows whose cores are known, on 33 nodes an axis. Recall is the share of the core that a traced line passes within a voxel. Noise is"
     " independent at every node; its standard deviation is relative to the greatest speed.\n\n"
     "`sujudi-haimes` is the default because it alone finds every one of these cores whole without noise, to a quarter of a voxel. It draws"
     " nothing else with 2 % of noise. `vorticity` is as good or better where curl v lies along the core. Where the stream along the core is"
     " sheared it is 0.6 voxels off. `parallel-vectors` is nine times nearer on the bent core and loses that with 5 % of noise, because it"
     " takes one derivative more."),
    ("headset", "The headset", "Scripted trackers, machines and displays; no headset was measured."),
    ("images", "Images", "Accuracy and cost of images of 1024 x 768 pixels unless stated. Errors are the root mean square of 8-bit RGB over"
     " covered pixels."),
    ("peers", "Volumes beside other renderers",
     "Processor milliseconds of an image of 1024 x 768 at errors of 1, 2 and 4 against each renderer's own converged image, in turns in one"
     " run. `<` means that the quickest setting is already better, `never` that no setting reaches the error.\n\n"
     "OSPRay 3.1 was built for vectors of 512 bits, the widest of the machine; lavapipe 22.3 has 256. Converged images agree with those of"
     " one of both within an error of 1 in all cases but the shaded vessels. Where nothing is shaded they agree with both, except for VTK's"
     " vessels. OSPRay's shaded ones differ by 2 to 17, because its light is another."),
    ("gpu", "On a GPU", "Wall milliseconds of an image of 1024 x 768 at errors of 1, 2 and 4, in turns in one run on one GPU."
     " Only a small part of this kind of GPU runs fragment shaders, of which both renderers are made."),
    ("library", "The library", "What a program that links Catena sees."),
]
# file, table, title, unit, names of the series, statistic of each series
PLOTS = [
    ("peers.svg", "peers", "Processor time of an image at an error of 2", "ms",
     ["Catena, error 2", "OSPRay 3.1, error 2", "VTK 9.1, GPU mapper on llvmpipe, error 2"]),
    ("gpu.svg", "gpu", "Wall time of an image at an error of 2 on a GPU", "ms", ["Catena, error 2", "VTK 9.1, GPU mapper, error 2"]),
]
COLORS = ["#2b6cb0", "#dd6b20", "#718096"]


def rows_of(name):
    with open(HERE / "data" / f"{name}.csv", newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def cell(row):
    return f"{row['value']} {row['unit']}".strip().replace("|", "\\|")


def page(name, title, text):
    """One table for each command: rows are cases, columns statistics."""
    out = [f"# {title}", ""]
    for paragraph in text.split("\n\n"):
        out += [*wrap(paragraph), ""]
    for file, table, plot_title, _, _ in PLOTS:
        if table == name:
            out += [f"![{plot_title}]({file})", ""]
    rows = rows_of(name)
    commands = list(dict.fromkeys(row["command"] for row in rows))
    for command in commands:
        mine = [row for row in rows if row["command"] == command]
        statistics = list(dict.fromkeys(row["statistic"] for row in mine))
        wide = len(statistics) <= 14 and len(mine) > len({row["case"] for row in mine})
        out += ["Repeat with", "```", command, "```", ""]
        if wide:
            out += ["| case | " + " | ".join(statistics) + " |", "|---" * (len(statistics) + 1) + "|"]
            for case in dict.fromkeys(row["case"] for row in mine):
                cells = {row["statistic"]: cell(row) for row in mine if row["case"] == case}
                out.append(f"| {case} | " + " | ".join(cells.get(s, "") for s in statistics) + " |")
        else:
            out += ["| case | statistic | value |", "|---|---|---|"]
            out += [f"| {row['case']} | {row['statistic']} | {cell(row)} |" for row in mine]
        dates = sorted({row["date"] for row in mine})
        commits = ", ".join(f"`{c}`" for c in dict.fromkeys(row["commit"] for row in mine))
        span = dates[0] if len(dates) == 1 else f"{dates[0]} to {dates[-1]}"
        out += ["", f"Machine `{mine[0]['machine']}`, recorded {span} by {commits}.", ""]
    return "\n".join(out).rstrip() + "\n"


def index():
    """The list of pages and the machines."""
    out = ["# Benchmarks", "", *wrap("The pages and plots are made from the tables of `docs/benchmarks/data` by `docs/benchmarks/make.py`. Each"
           " number has its unit, machine, driver, the commit and the date of its record, and the command that repeats it. Compare ratios that"
           " were measured side by side in one run, never times of two machines. [running.md](running.md) describes how the comparisons run."),
           "", "| page | numbers |", "|---|---|"]
    out += [f"| [{title}]({name}.md) | {len(rows_of(name))} |" for name, title, _ in PAGES]
    machines = rows_of("machines")
    out += ["", "| machine | processor | cores | GPU | system |", "|---|---|---|---|---|"]
    out += [f"| `{m['id']}` | {m['processor']} | {m['cores']} | {m['gpu']} | {m['system']} |" for m in machines]
    return "\n".join(out) + "\n"


def wrap(text, width=140):
    lines = [""]
    for word in text.split():
        if len(lines[-1]) + len(word) + 1 > width:
            lines.append("")
        lines[-1] += (" " if lines[-1] else "") + word
    return lines


def plot(name, title, unit, series):
    """Horizontal bars on a logarithmic axis; a bound such as "< 18" is drawn to its number, what was never reached has no bar."""
    import math
    table = rows_of(name)
    cases = list(dict.fromkeys(row["case"] for row in table))
    values = {(row["case"], row["statistic"]): float(row["value"].strip("<> ")) for row in table
              if row["statistic"] in series and row["value"] != "never"}
    lo, hi = math.floor(math.log10(min(values.values()))), math.ceil(math.log10(max(values.values())))
    left, bar, gap, width = 260, 9, 8, 620
    height = 70 + len(cases) * (bar * len(series) + gap)
    x = lambda v: left + (width - left - 45) * (math.log10(v) - lo) / (hi - lo)
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" font-family="sans-serif" font-size="11">',
           f'<rect width="{width}" height="{height}" fill="white"/>', f'<text x="10" y="18" font-size="14">{title}</text>']
    for decade in range(lo, hi + 1):
        out += [f'<line x1="{x(10 ** decade):.1f}" x2="{x(10 ** decade):.1f}" y1="45" y2="{height - 22}" stroke="#ddd"/>',
                f'<text x="{x(10 ** decade):.1f}" y="{height - 8}" text-anchor="middle">{10 ** decade:g} {unit}</text>']
    for k, label in enumerate(series):
        at = 10 + 190 * k
        out += [f'<rect x="{at}" y="27" width="10" height="10" fill="{COLORS[k]}"/>',
                f'<text x="{at + 14}" y="36">{label.replace(", error 2", "")}</text>']
    for n, case in enumerate(cases):
        top = 48 + n * (bar * len(series) + gap)
        out.append(f'<text x="{left - 6}" y="{top + bar * len(series) / 2 + 4:.1f}" text-anchor="end">{case}</text>')
        for k, label in enumerate(series):
            if (case, label) in values:
                end = x(values[case, label])
                out.append(f'<rect x="{left}" y="{top + k * bar}" width="{max(end - left, 1):.1f}" height="{bar - 1}" fill="{COLORS[k]}"/>')
    return "\n".join(out + ["</svg>"]) + "\n"


def main():
    made = {f"{name}.md": page(name, title, text) for name, title, text in PAGES}
    made["index.md"] = index()
    made.update({file: plot(table, title, unit, series) for file, table, title, unit, series in PLOTS})
    check = "--check" in sys.argv[1:]
    stale = [file for file, text in made.items() if not (HERE / file).exists() or (HERE / file).read_text(encoding="utf-8") != text]
    for file in stale:
        if check:
            print(f"docs/benchmarks/{file} is not current; docs/benchmarks/make.py writes it")
        else:
            (HERE / file).write_text(made[file], encoding="utf-8")
    sys.exit(1 if check and stale else 0)


if __name__ == "__main__":
    main()
