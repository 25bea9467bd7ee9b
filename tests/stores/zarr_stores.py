# SPDX-License-Identifier: MIT
"""Zarr stores written by python3-zarr, in all combinations that catena reads."""
import itertools
import os
import shutil

import numcodecs
import numpy
import zarr

TYPES = ["|u1", "|i1", "<u2", ">u2", "<i2", ">i2", "<u4", ">i4", "<i8", ">u8", "<f4", ">f4", "<f8", ">f8"]


def codecs():
    """Returns compressors by name."""
    found = {"none": None, "zlib": numcodecs.Zlib(1), "gzip": numcodecs.GZip(1), "zstd": numcodecs.Zstd(1), "lz4": numcodecs.LZ4()}
    for name in ["blosclz", "lz4", "lz4hc", "zlib", "zstd"]:
        for shuffle in [0, 1, 2]:
            found[f"blosc-{name}-{shuffle}"] = numcodecs.Blosc(cname=name, clevel=3, shuffle=shuffle)
    return found


def numbers(random, shape, dtype):
    """Returns smooth and random numbers over the range of a type."""
    kind = numpy.dtype(dtype)
    if kind.kind == "f":
        values = (random.standard_normal(shape) * 1e3).astype(kind)
        values[tuple(n // 2 for n in shape)] = numpy.nan
        return values
    limits = numpy.iinfo(kind)
    return random.integers(limits.min, limits.max, shape, kind.newbyteorder("="), endpoint=True).astype(kind)


def arrays(tally, folder, random):
    """Plain arrays: types, byte orders, memory orders, compressors, separators, delta, missing chunks."""
    path = os.path.join(folder, "a.zarr")
    shape, chunks = (19, 23, 37), (8, 10, 16)

    def one(name, dtype, order="C", codec=None, separator=".", filters=None, fill=0):
        shutil.rmtree(path, ignore_errors=True)
        array = zarr.open(path, mode="w", shape=shape, chunks=chunks, dtype=dtype, order=order, compressor=codec,
                          dimension_separator=separator, filters=filters, fill_value=fill)
        values = numbers(random, shape, dtype)
        array[:] = values
        chunk = os.path.join(path, separator.join("011"))
        os.remove(chunk)
        values = array[:]  # differences of floats are rounded: what zarr reads is compared
        if fill is None:
            values[0:8, 10:20, 16:32] = 0
        tally.compare("Zarr 2", name, path, values)

    for (codec_name, codec), order in itertools.product(codecs().items(), "CF"):
        for dtype in ["<u2", ">f4", "|u1"]:
            one(f"{codec_name} {order} {dtype}", dtype, order, codec)
    for dtype, order, separator in itertools.product(TYPES, "CF", "./"):
        one(f"{dtype} {order} {separator}", dtype, order, numcodecs.Blosc(), separator)
        one(f"{dtype} {order} {separator} fill", dtype, order, None, separator, fill=7)
    for dtype in ["<u2", ">u2", "<i4", ">i8", "<f4", ">f8"]:
        for order in "CF":
            one(f"delta {dtype} {order}", dtype, order, numcodecs.Zlib(1), filters=[numcodecs.Delta(dtype=dtype)])
    one("delta astype", "<i4", codec=numcodecs.Zstd(), filters=[numcodecs.Delta(dtype="<i4", astype="<i8")])
    one("fill NaN", "<f4", fill=float("nan"))
    one("fill null", "<u2", fill=None)


def images(tally, folder, random):
    """OME-Zarr 0.4: axes, channels, times, levels, labels."""
    path = os.path.join(folder, "image.zarr")
    for axes in ["tczyx", "czyx", "zyx", "yx", "tzyx", "cyx", "zcyx", "tyx", "xyz"]:
        shutil.rmtree(path, ignore_errors=True)
        sizes = {"t": 3, "c": 2, "z": 20, "y": 26, "x": 34}
        group = zarr.open_group(path, mode="w")
        datasets, levels = [], []
        for level in range(2):
            shape = [sizes[a] if a in "tc" else sizes[a] >> level for a in axes]
            values = numbers(random, shape, "<u2")
            group.create_dataset(str(level), data=values, chunks=tuple(min(n, 2 if a == "c" else 9) for n, a in zip(shape, axes)),
                                 dimension_separator="/")
            scale = [0.5 if a in "tc" else 0.25 * 2**level for a in axes]
            datasets.append({"path": str(level), "coordinateTransformations": [{"type": "scale", "scale": scale}]})
            levels.append(values)
        units = {"t": "second", "z": "micrometer", "y": "micrometer", "x": "micrometer"}
        kinds = {"t": "time", "c": "channel"}
        group.attrs["multiscales"] = [{"version": "0.4", "datasets": datasets,
                                       "axes": [{"name": a, "type": kinds.get(a, "space"), **({"unit": units[a]} if a in units else {})}
                                                for a in axes]}]
        group.attrs["omero"] = {"channels": [{"label": name, "color": "00FF00", "window": {"start": 10, "end": 3000}}
                                             for name in ["DAPI", "GFP"][:sizes["c"] if "c" in axes else 1]]}
        space = [a for a in axes if a not in "tc"]
        for step in range(3 if "t" in axes else 1):
            for channel in range(2 if "c" in axes else 1):
                picked = levels[0][tuple(step if a == "t" else channel if a == "c" else slice(None) for a in axes)]
                order = [space.index(a) for a in "zyx" if a in space]
                picked = numpy.transpose(picked, order)
                if picked.ndim == 2:
                    picked = picked[None]
                tally.compare("OME-Zarr 0.4", axes, path, picked, ["DAPI", "GFP"][channel], step)
    # label images
    labels = numbers(random, (20, 26, 34), "<i4")
    group = zarr.open_group(path, mode="a")
    made = group.require_group("labels")
    made.attrs["labels"] = ["cells"]
    cells = made.create_group("cells")
    cells.create_dataset("0", data=labels, chunks=(8, 8, 8))
    cells.attrs["image-label"] = {}
    cells.attrs["multiscales"] = [{"version": "0.4", "datasets": [{"path": "0"}], "axes": [{"name": a} for a in "zyx"]}]
    tally.compare("OME-Zarr 0.4", "labels", path, labels, "labels/cells")


def write(tally, folder):
    """Writes and compares every store."""
    random = numpy.random.default_rng(1)
    arrays(tally, folder, random)
    images(tally, folder, random)


def sparse(path, edge=8192, chunk=64, present=4096, levels=True):
    """Writes an edge^3 store in which a few chunks are present."""
    shutil.rmtree(path, ignore_errors=True)
    group = zarr.open_group(path, mode="w")
    random = numpy.random.default_rng(2)
    datasets = []
    size = edge
    level = 0
    while True:
        array = group.create_dataset(str(level), shape=(size,) * 3, chunks=(min(chunk, size),) * 3, dtype="<u2", compressor=numcodecs.Blosc())
        count = present if level == 0 else min(64, (size // chunk) ** 3 or 1)
        block = random.integers(0, 4000, (min(chunk, size),) * 3, "u2")
        encoded = array.compressor.encode(block)
        grid = max(1, size // chunk)
        for n in random.choice(grid**3, count, replace=False):
            name = f"{n // grid // grid}.{n // grid % grid}.{n % grid}"
            with open(os.path.join(path, str(level), name), "wb") as file:
                file.write(encoded)
        scale = [float(edge // size)] * 3
        datasets.append({"path": str(level), "coordinateTransformations": [{"type": "scale", "scale": scale}]})
        if not levels or size <= 64:
            break
        size //= 2
        level += 1
    group.attrs["multiscales"] = [{"version": "0.4", "datasets": datasets,
                                   "axes": [{"name": a, "type": "space", "unit": "micrometer"} for a in "zyx"]}]
