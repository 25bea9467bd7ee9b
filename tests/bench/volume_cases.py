#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Writes the cases of volume_peers.py: DIR/NAME.raw (float32, x fastest), DIR/NAME.json and DIR/NAME-shaded.json.
needs: python3-numpy, python3-scipy; head: package mricron-data; bone: package invesalius-examples, or its file after --ct
usage: volume_cases.py -o DIR [--size N] [--ct Cranium.inv3] [NAME ...]
  noise, rough   band-limited noise, 0 to 1: 3 to 22 and 3 to 80 waves in 256 voxels
  spike          the same noise, seen where its value is within 0.02 of 0.5
  fog            smooth noise, 95 % of it cut away
  head           T1 image (ch2), value / 160, at most 1
  bone           CT of a skull, Hounsfield units, made isotropic
                 (both with two empty voxels around, because renderers start at different depths where the box cuts opaque regions)
  angiogram      vessels of 1 to 4 voxels and measurement noise
  embryo, heart  thin membranes around soft bodies
The files of every case are reproducible byte by byte."""
import argparse, gzip, json, os, plistlib, sys, tarfile
import numpy as np
from scipy import ndimage

COLOUR = [[0, .1, .1, .4], [.35, .1, .6, .8], [.6, .9, .8, .3], [1, .9, .2, .1]]
FLESH = [[0, .2, .1, .08], [.25, .6, .4, .3], [.56, .9, .75, .6], [1, 1, .97, .9]]
HEAD = "/usr/share/mricron/templates/ch2.nii.gz"
CRANIUM = "/usr/share/doc/invesalius-examples/examples/Cranium.inv3"


def waves(n, least, most, seed):
    """Gaussian noise with wave numbers least..most per edge."""
    k = np.fft.fftfreq(n) * n
    size = np.sqrt(k[:, None, None] ** 2 + k[None, :, None] ** 2 + np.arange(n // 2 + 1)[None, None, :] ** 2)
    spectrum = np.fft.rfftn(np.random.default_rng(seed).normal(size=(n, n, n)))
    spectrum[(size < least) | (size > most)] = 0
    return np.fft.irfftn(spectrum, s=(n, n, n))


def unit_range(v):
    return (v - v.min()) / (v.max() - v.min())


def noise(n):
    return unit_range(waves(n, 3 * n / 256, 22 * n / 256, 5))


def rough(n):
    return unit_range(waves(n, 3 * n / 256, 80 * n / 256, 6))


def fog(n):
    v = waves(n, 2, 12, 11)
    v = np.clip(v - np.quantile(v, .95), 0, None)
    return v / v.max()


def angiogram(n):
    rng, field = np.random.default_rng(7), np.zeros((n, n, n), np.float32)
    for _ in range(40):
        place, way, radius = rng.uniform(n / 8, n * 7 / 8, 3), rng.normal(size=3), rng.uniform(.6, 2.2)
        for _ in range(220):
            way = way / np.linalg.norm(way) + .15 * rng.normal(size=3)
            place = place + .8 * way / np.linalg.norm(way)
            if (place < 8).any() or (place > n - 9).any():
                break
            part = tuple(slice(a, a + 15) for a in (place - 7).astype(int))
            square = sum((g - p) ** 2 for g, p in zip(np.mgrid[part], place))
            field[part] = np.maximum(field[part], np.exp(-square / (2 * radius * radius)))
    return 20 + 200 * field + rng.normal(size=field.shape) * 6


def grid_of(n):
    """Coordinates x, y, z from -1 to 1, indexed z, y, x."""
    axis = np.linspace(-1, 1, n, dtype=np.float32)
    z, y, x = np.meshgrid(axis, axis, axis, indexing="ij", sparse=True)
    return x, y, z


def soft(distance, width):
    """A smooth step from 1 inside to 0 outside over `width`."""
    return 1 / (1 + np.exp(np.clip(4 * distance / width, -30, 30)))


def embryo(n):
    x, y, z = grid_of(n)
    wrinkles = waves(n, 4, 16, 21)
    wrinkles = .02 * wrinkles / np.abs(wrinkles).max()
    shell = np.sqrt((x / .92) ** 2 + (y / .75) ** 2 + (z / .8) ** 2) - 1
    out = .35 * np.exp(-(shell / .012) ** 2)
    ring, angle = np.sqrt(x * x + z * z), np.arctan2(z, x)
    body = np.sqrt((ring - .45) ** 2 + (1.4 * y) ** 2) - .13 - .02 * np.cos(28 * angle) + wrinkles
    out = np.maximum(out, .55 * soft(body, .06) * soft(-angle - 2.2, .3))
    for (cx, cy, cz), r, value in (((-.28, 0, -.42), .24, .6), ((-.4, -.2, -.45), .07, 1), ((-.4, .2, -.45), .07, 1), ((.1, 0, .05), .13, .85)):
        distance = np.sqrt((x - cx) ** 2 + (y - cy) ** 2 + (z - cz) ** 2) - r + wrinkles
        out = np.maximum(out, value * soft(distance, .04))
    return np.clip(out + .5 * wrinkles, 0, 1)


def heart(n):
    x, y, z = grid_of(n)
    folds = waves(n, 5, 20, 22)
    folds = .05 * folds / np.abs(folds).max()

    def chamber(cx, cy, sx, sy, sz, thick):
        inner = np.sqrt(((x - cx) / sx) ** 2 + ((y - cy) / sy) ** 2 + ((z + .05) / sz) ** 2)
        wall = np.maximum(inner * sx - sx - thick, sx - inner * sx + 1.5 * folds)
        return np.maximum(wall, z - .35)

    muscle = np.minimum(chamber(-.18, 0, .3, .3, .62, .12), chamber(.26, .05, .3, .36, .5, .05))
    out = .6 * soft(muscle, .03)
    for cx, cy, r, bend in ((-.12, .02, .12, .25), (.16, -.06, .13, -.3)):
        tube = np.sqrt((x - cx - bend * np.maximum(z - .3, 0)) ** 2 + (y - cy) ** 2) - r
        out = np.maximum(out, .9 * soft(np.maximum(np.abs(tube) - .015, .25 - z), .02))
    sac = np.sqrt(((x - .02) / .78) ** 2 + (y / .62) ** 2 + ((z + .02) / .85) ** 2) - 1
    return np.clip(np.maximum(out, .25 * np.exp(-(sac / .015) ** 2)) + .2 * folds * soft(muscle, .03), 0, 1)


def head():
    with gzip.open(HEAD) as file:
        data = file.read()
    # the header of NIfTI-1: sizes at byte 42, type at 70, where the voxels begin at 108
    size, kind, begin = np.frombuffer(data, "<i2", 3, 42).astype(int), np.frombuffer(data, "<i2", 1, 70)[0], np.frombuffer(data, "<f4", 1, 108)[0]
    if kind != 2:
        sys.exit(f"{HEAD}: expected unsigned bytes")
    return np.pad(np.minimum(np.frombuffer(data, np.uint8, size.prod(), int(begin)).reshape(size[::-1]) / 160, 1), 2)


def bone(path):
    with tarfile.open(path) as tar:
        member = {os.path.basename(m.name): m for m in tar.getmembers()}
        about = plistlib.load(tar.extractfile(member["main.plist"]))
        raw = np.frombuffer(tar.extractfile(member["matrix.dat"]).read(), np.dtype(about["matrix"]["dtype"]))
    sx, _, sz = about["spacing"]
    values = ndimage.zoom(raw.reshape(about["matrix"]["shape"]).astype(np.float32), (sz / sx, 1, 1), order=1)
    return np.pad(values, 2, constant_values=values.min())


# name -> (field, colour, opacity, unit in voxels; 0: a 128th of the edge)
CASES = {
    "noise": (noise, COLOUR, [[.3, 0], [1, .1]], 0),
    "rough": (rough, COLOUR, [[.4, 0], [1, .2]], 0),
    "spike": (noise, COLOUR, [[.48, 0], [.5, .5], [.52, 0]], 0),
    "fog": (fog, COLOUR, [[0, 0], [.01, .005], [1, .3]], 0),
    "head": (head, FLESH, [[.1875, 0], [.375, .309], [.94, .686]], 2),
    "bone": (bone, [[100, .8, .5, .4], [300, .95, .9, .8], [1500, 1, 1, .95]], [[150, 0], [350, .6], [1000, .95]], 1),
    "angiogram": (angiogram, [[0, 1, .6, .5], [200, 1, .95, .9]], [[70, 0], [140, .6], [220, .9]], 1),
    "embryo": (embryo, FLESH, [[.08, 0], [.35, .03], [.5, .12], [.9, .5]], 0),
    "heart": (heart, [[0, .5, .1, .1], [.3, .8, .4, .35], [.6, .75, .2, .15], [.9, .9, .85, .7]], [[.05, 0], [.25, .02], [.5, .1], [.9, .3]], 0),
}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-o", "--out", required=True)
    parser.add_argument("--size", type=int, default=256, help="voxels an edge of the fields that are made")
    parser.add_argument("--ct", default=CRANIUM)
    parser.add_argument("names", nargs="*", metavar="NAME")
    args = parser.parse_args()
    os.makedirs(args.out, exist_ok=True)
    for name in args.names or CASES:
        if name not in CASES:
            sys.exit(f"{name}: expected one of {', '.join(CASES)}")
        field, colour, opacity, unit = CASES[name]
        file = {head: HEAD, bone: args.ct}.get(field)
        if file and not os.path.exists(file):
            print(f"{name}: left out, {file} is not there")
            continue
        values = field() if field is head else field(args.ct) if field is bone else field(args.size)
        values = np.ascontiguousarray(values, np.float32)
        values.tofile(f"{args.out}/{name}.raw")
        for shade in (False, True):
            case = {"raw": f"{name}.raw", "dims": values.shape[::-1], "colour": colour, "opacity": opacity, "unit": unit or args.size / 128,
                    "shade": shade, "view": {"elevation": 20, "distance": 2.7, "fovy_deg": 30}, "size": [1024, 768]}
            with open(f"{args.out}/{name}{'-shaded' if shade else ''}.json", "w") as file:
                json.dump(case, file, indent=1)
        print(f"{name}: {values.shape[::-1]}, {values.min():.3g} to {values.max():.3g}", flush=True)


if __name__ == "__main__":
    main()
