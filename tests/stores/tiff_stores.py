# SPDX-License-Identifier: MIT
"""TIFF files written by python3-tifffile: types, byte orders, tiles and strips, compression, BigTIFF, OME, ImageJ, levels, folders."""
import itertools
import os
import shutil
import subprocess

import numpy
import tifffile

from zarr_stores import numbers


def write(tally, folder):
    """Writes and compares every file."""
    random = numpy.random.default_rng(3)
    path = os.path.join(folder, "a.tif")
    shape = (7, 45, 61)
    types = ["u1", "i1", "u2", "i2", "u4", "i4", "u8", "i8", "f4", "f8"]
    layouts = {"strip": {}, "rows": {"rowsperstrip": 7}, "tile": {"tile": (16, 32)}}
    for dtype, order, (name, layout), big in itertools.product(types, "<>", layouts.items(), [False, True]):
        values = numbers(random, shape, dtype)
        tifffile.imwrite(path, values, byteorder=order, bigtiff=big, photometric="minisblack", **layout)
        tally.compare("TIFF", f"{dtype} {order} {name} big {big}", path, values)
    for compression, predictor, dtype in itertools.product(["zlib", "lzw", "zstd", "lzma", "packbits"], [False, True], ["u1", "u2", "f4"]):
        if predictor and (compression == "packbits" or dtype == "f4"):
            continue
        for name, layout in layouts.items():
            values = numbers(random, shape, dtype)
            try:
                tifffile.imwrite(path, values, compression=compression, predictor=predictor, photometric="minisblack", **layout)
            except (ImportError, KeyError, ValueError, RuntimeError):
                continue  # without imagecodecs tifffile does not write it
            tally.compare("TIFF", f"{compression} {predictor} {dtype} {name}", path, values)
    # what tifffile does not write without imagecodecs, by libtiff's program
    if shutil.which("tiffcp"):
        packed = os.path.join(folder, "packed.tif")
        for codec, dtype, layout in itertools.product(["lzw:1", "lzw:2", "zstd", "packbits", "zip:2"], ["u1", "u2"], [[], ["-t"]]):
            values = numbers(random, shape, dtype)
            tifffile.imwrite(path, values, photometric="minisblack")
            subprocess.run(["tiffcp", "-c", codec, *layout, path, packed], check=True, capture_output=True)
            tally.compare("TIFF", f"tiffcp {codec} {dtype}", packed, values)
    # samples of a pixel
    for planar in ["contig", "separate"]:
        values = numbers(random, (5, 3, 20, 30) if planar == "separate" else (5, 20, 30, 3), "u2")
        tifffile.imwrite(path, values, photometric="rgb", planarconfig=planar)
        for c, color in enumerate(["red", "green", "blue"]):
            tally.compare("TIFF", f"rgb {planar}", path, values[:, c] if planar == "separate" else values[..., c], color)
    # OME-TIFF
    ome = os.path.join(folder, "a.ome.tif")
    for axes in ["ZYX", "CZYX", "TCZYX", "TZCYX", "ZCTYX", "CTZYX", "CYX", "TYX", "YX"]:
        sizes = {"T": 3, "C": 2, "Z": 5, "Y": 33, "X": 47}
        values = numbers(random, tuple(sizes[a] for a in axes), "u2")
        tifffile.imwrite(ome, values, photometric="minisblack", metadata={
            "axes": axes, "PhysicalSizeX": 0.25, "PhysicalSizeXUnit": "µm", "PhysicalSizeY": 0.25, "PhysicalSizeYUnit": "µm",
            "PhysicalSizeZ": 1000, "PhysicalSizeZUnit": "nm", "TimeIncrement": 2, "TimeIncrementUnit": "s",
            "Channel": {"Name": ["DAPI", "GFP"][:2 if "C" in axes else 1]}})
        for step in range(3 if "T" in axes else 1):
            for channel in range(2 if "C" in axes else 1):
                picked = values[tuple(step if a == "T" else channel if a == "C" else slice(None) for a in axes)]
                if "Z" not in axes:
                    picked = picked[None]
                tally.compare("OME-TIFF", axes, ome, picked, ["DAPI", "GFP"][channel], step)
    # a pyramid in sub-directories
    with tifffile.TiffWriter(ome, bigtiff=True) as writer:
        full = numbers(random, (4, 64, 96), "u2")
        writer.write(full, subifds=1, tile=(32, 32), photometric="minisblack", metadata={"axes": "ZYX"})
        writer.write(full[:, ::2, ::2], subfiletype=1, tile=(32, 32), photometric="minisblack")
    tally.compare("OME-TIFF", "pyramid", ome, full)
    # ImageJ
    for axes in ["ZYX", "ZCYX", "TZCYX", "TZYX"]:
        sizes = {"T": 2, "C": 2, "Z": 5, "Y": 33, "X": 47}
        values = numbers(random, tuple(sizes[a] for a in axes), "u2")
        tifffile.imwrite(path, values, imagej=True, resolution=(4, 4), metadata={"axes": axes, "spacing": 2, "unit": "um", "finterval": 3})
        for step in range(2 if "T" in axes else 1):
            for channel in range(2 if "C" in axes else 1):
                picked = values[tuple(step if a == "T" else channel if a == "C" else slice(None) for a in axes)]
                tally.compare("ImageJ TIFF", axes, path, picked, f"channel {channel}" if "C" in axes else None, step)
    # a folder of numbered files
    stack = os.path.join(folder, "stack")
    for layout in layouts.values():
        shutil.rmtree(stack, ignore_errors=True)
        os.makedirs(stack)
        values = numbers(random, (12, 40, 50), "u2")
        for i, image in enumerate(values):
            tifffile.imwrite(os.path.join(stack, f"slice{i + 1}.tif"), image, photometric="minisblack", **layout)
        tally.compare("folder of TIFF", "", stack, values)
