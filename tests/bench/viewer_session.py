#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""A simulated user at the window for SECONDS, by real X events: orbits, zooms, moves the cursor over the data, presses its button, changes
views, shows and hides the panels. Prints the memory of the process every ten seconds, then the histograms of images and ticks.

    xvfb-run -a -s '-screen 0 1280x900x24' python3 tests/bench/viewer_session.py build/release/catena SCENE [SECONDS]

Needs xdotool. Memory is compared from the tenth second on, when fields, shaders and images have been created."""
import json
import random
import subprocess
import sys
import tempfile
import time

WIDTH, HEIGHT = 1100, 760


def xdotool(*words):
    subprocess.run(["xdotool", *map(str, words)], check=False, stderr=subprocess.DEVNULL)


def resident_mb(pid):
    with open(f"/proc/{pid}/status") as status:
        for line in status:
            if line.startswith("VmRSS"):
                return int(line.split()[1]) / 1024
    return 0


def somewhere(rng):
    """A random position on the image, outside of the panels."""
    return rng.randrange(380, WIDTH - 60), rng.randrange(80, HEIGHT - 80)


def drag(rng, button, steps=12):
    x, y = somewhere(rng)
    xdotool("mousemove", x, y, "mousedown", button)
    dx, dy = rng.randrange(-12, 13), rng.randrange(-8, 9)
    for k in range(steps):
        xdotool("mousemove", min(max(x + k * dx, 340), WIDTH - 5), min(max(y + k * dy, 40), HEIGHT - 40))
        time.sleep(0.02)
    xdotool("mouseup", button)


def move_hand(rng):
    xdotool("key", "h")
    if rng.random() < 0.5:
        xdotool("keydown", "space")
    x, y = somewhere(rng)
    for _ in range(20):
        x = min(max(x + rng.randrange(-25, 26), 380), WIDTH - 60)
        y = min(max(y + rng.randrange(-25, 26), 80), HEIGHT - 80)
        xdotool("mousemove", x, y)
        if rng.random() < 0.2:
            xdotool("click", rng.choice([4, 5]))
        time.sleep(0.02)
    xdotool("keyup", "space", "key", "h")


def main():
    program, scene = sys.argv[1:3]
    seconds = float(sys.argv[3]) if len(sys.argv) > 3 else 60
    with tempfile.TemporaryDirectory() as folder:
        command = [program, "view", scene, "--size", f"{WIDTH}x{HEIGHT}", "--seconds", str(seconds), "--frame-stats", f"{folder}/frames.json",
                   "--servo-stats", f"{folder}/servo.json", "--screenshot-ui", "viewer-session.png"]
        window = subprocess.Popen(command)
        begin = time.time()
        rng = random.Random(1)
        next_sample, first = 10.0, None
        time.sleep(3)
        while window.poll() is None:
            act = rng.random()
            if act < 0.35:
                drag(rng, 1)
            elif act < 0.45:
                drag(rng, 2)
            elif act < 0.6:
                xdotool("mousemove", *somewhere(rng), "click", rng.choice([4, 5]))
            elif act < 0.9:
                move_hand(rng)
            elif act < 0.95:
                xdotool("key", rng.choice(["1", "2", "3", "Home", "r", "o"]))
            else:
                xdotool("key", "Tab")
            elapsed = time.time() - begin
            if elapsed >= next_sample and window.poll() is None:
                memory = resident_mb(window.pid)
                first = first or memory
                print(f"{elapsed:6.0f} s  {memory:8.1f} MB  ({memory - first:+.1f})", flush=True)
                next_sample += 10
        for name in ("frames", "servo"):
            with open(f"{folder}/{name}.json") as file:
                stats = json.load(file)
            for key, figures in stats.items():
                if isinstance(figures, dict) and "p50" in figures:
                    print(f"{name}.{key}: p50 {figures['p50']:.1f}, p99 {figures['p99']:.1f}, p99.9 {figures['p999']:.1f}, "
                          f"max {figures['max']:.1f}, {figures['count']} of them; bins from: "
                          + " ".join(f"{start:.3g}:{count}" for start, count in figures["bins"]))
                elif not isinstance(figures, (dict, list)):
                    print(f"{name}.{key}: {figures}")
        sys.exit(window.returncode)


if __name__ == "__main__":
    main()
