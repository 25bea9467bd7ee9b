#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Writes stores with python3-zarr, python3-tifffile and python3-h5py, reads them through catena, and counts wrong voxels: 0 is expected.

CATENA=build/release/catena tests/stores/check_stores.py [zarr] [tiff] [hdf5]
"""
import importlib
import sys
import tempfile

import compare


def main():
    """Runs the kinds that were named, or all."""
    kinds = sys.argv[1:] or ["zarr", "tiff", "hdf5"]
    with tempfile.TemporaryDirectory() as folder:
        tally = compare.Tally(folder)
        for kind in kinds:
            importlib.import_module(kind + "_stores").write(tally, folder)
        return 1 if tally.report() else 0


if __name__ == "__main__":
    sys.exit(main())
