# SPDX-License-Identifier: MIT
"""HDF5 files written by python3-h5py: types, byte orders, chunks, filters, and the layouts that other programs write."""
import itertools
import os

os.environ.setdefault("HDF5_PLUGIN_PATH", "/usr/lib/x86_64-linux-gnu/hdf5/serial/plugins")

import h5py  # noqa: E402
import numpy  # noqa: E402

from zarr_stores import numbers  # noqa: E402

LZ4, BLOSC = 32004, 32001


def plain(tally, path, random):
    """Data sets with three axes: types, orders, filters."""
    shape, chunks = (19, 23, 37), (8, 10, 16)
    options = {"contiguous": {}, "chunked": {"chunks": chunks}, "gzip": {"chunks": chunks, "compression": "gzip"},
               "gzip shuffle": {"chunks": chunks, "compression": "gzip", "shuffle": True, "fletcher32": True},
               "lzf": {"chunks": chunks, "compression": "lzf"}, "planes": {"chunks": (1, 23, 37), "compression": "gzip"}}
    if h5py.h5z.filter_avail(LZ4):
        options["lz4"] = {"chunks": chunks, "compression": LZ4}
    if h5py.h5z.filter_avail(BLOSC):
        for codec in range(6):
            for shuffle in range(3):
                options[f"blosc {codec} {shuffle}"] = {"chunks": chunks, "compression": BLOSC, "compression_opts": (0, 0, 0, 0, 5, shuffle, codec)}
    for dtype, (name, option) in itertools.product(["u1", "i1", "<u2", ">u2", ">i4", "<u8", "<f2", ">f4", "<f8"], options.items()):
        with h5py.File(path, "w") as file:
            try:
                values = numbers(random, shape, dtype)
                data = file.create_dataset("group/a", data=values, **option)
            except (OSError, ValueError):
                continue  # a codec that this build of blosc has not
            assert data.shape == shape
        if name == "lzf":
            continue  # h5py's own filter, which is refused
        tally.compare("HDF5", f"{dtype} {name}", path, values, "group/a")
    with h5py.File(path, "w") as file:
        data = file.create_dataset("a", shape, "<i2", chunks=chunks, fillvalue=-7)
        data[8:16, 10:20, 16:32] = numbers(random, (8, 10, 16), "<i2")
        values = data[:]
    tally.compare("HDF5", "missing chunks", path, values)


def nexus(tally, path, random):
    """NXdata by `default` and `signal`."""
    with h5py.File(path, "w") as file:
        file.attrs["default"] = "entry"
        entry = file.create_group("entry")
        entry.attrs.update({"NX_class": "NXentry", "default": "scan"})
        scan = entry.create_group("scan")
        scan.attrs.update({"NX_class": "NXdata", "signal": "counts", "axes": ["z", "y", "x"]})
        values = numbers(random, (9, 11, 13), "f4")
        scan["counts"] = values
        for axis, n in zip("zyx", values.shape):
            scan[axis] = numpy.arange(n) * 0.5 + 2
            scan[axis].attrs["units"] = "mm"
        file.create_dataset("entry/other", data=numpy.zeros((4, 4, 4)))
    tally.compare("NXdata", "default", path, values)


def vtkhdf(tally, path, random):
    """Images of VTK."""
    with h5py.File(path, "w") as file:
        group = file.create_group("VTKHDF")
        group.attrs.update({"Version": [1, 0], "Type": numpy.bytes_("ImageData"), "WholeExtent": [0, 12, 0, 10, 0, 8], "Origin": [1.0, 2.0, 3.0],
                            "Spacing": [0.5, 0.5, 2.0], "Direction": [1.0, 0, 0, 0, 1, 0, 0, 0, 1]})
        values = numbers(random, (9, 11, 13), "f4")
        vectors = numbers(random, (9, 11, 13, 3), "f4")
        group.create_dataset("PointData/p", data=values, chunks=(4, 4, 4))
        group.create_dataset("PointData/v", data=vectors)
    tally.compare("VTKHDF", "scalars", path, values, "p")
    for c in range(3):
        tally.compare("VTKHDF", "vectors", path, vectors[..., c], f"v {c}")


def bigdataviewer(tally, path, random):
    """Two setups, two times, two levels."""
    expected = {}
    with h5py.File(path, "w") as file:
        for setup in range(2):
            file[f"s{setup:02}/resolutions"] = numpy.array([[1.0, 1, 1], [2, 2, 1]])
            file[f"s{setup:02}/subdivisions"] = numpy.array([[16, 16, 8], [16, 16, 8]])
            for step in range(2):
                values = numbers(random, (10, 32, 48), "<u2")
                expected[setup, step] = values
                group = f"t{step:05}/s{setup:02}"
                file.create_dataset(f"{group}/0/cells", data=values.view("i2"), chunks=(8, 16, 16), compression="gzip")
                file.create_dataset(f"{group}/1/cells", data=values[:, ::2, ::2].view("i2"), chunks=(8, 16, 16))
    for (setup, step), values in expected.items():
        tally.compare("BigDataViewer", ".h5", path, values, f"setup {setup}", step)
    xml = path[:-3] + ".xml"
    with open(xml, "w") as file:
        file.write(f"""<?xml version="1.0" encoding="UTF-8"?><SpimData version="0.2"><BasePath type="relative">.</BasePath>
<SequenceDescription><ImageLoader format="bdv.hdf5"><hdf5 type="relative">{os.path.basename(path)}</hdf5></ImageLoader><ViewSetups>
<ViewSetup><id>0</id><name>left</name><voxelSize><unit>um</unit><size>0.5 0.5 2</size></voxelSize></ViewSetup>
<ViewSetup><id>1</id><name>right</name></ViewSetup></ViewSetups></SequenceDescription><ViewRegistrations>
<ViewRegistration timepoint="0" setup="0"><ViewTransform type="affine"><affine>0.5 0 0 1 0 0.5 0 2 0 0 2 3</affine></ViewTransform>
</ViewRegistration></ViewRegistrations></SpimData>""")
    for (setup, step), values in expected.items():
        tally.compare("BigDataViewer", ".xml", xml, values, ["left", "right"][setup], step)
    os.remove(xml)


def imaris(tally, path, random):
    """Two channels, two times, padded chunks."""
    def characters(text):
        return numpy.array([c.encode() for c in str(text)], "S1")
    expected = {}
    with h5py.File(path, "w") as file:
        info = file.create_group("DataSetInfo/Image")
        for key, value in {"X": 40, "Y": 30, "Z": 9, "Unit": "um", "ExtMin0": 0, "ExtMin1": 0, "ExtMin2": 0, "ExtMax0": 20, "ExtMax1": 15,
                           "ExtMax2": 18}.items():
            info.attrs[key] = characters(value)
        for channel in range(2):
            own = file.create_group(f"DataSetInfo/Channel {channel}")
            for key, value in {"Name": ["DAPI", "GFP"][channel], "Color": "0 1 0", "ColorRange": "10 4000"}.items():
                own.attrs[key] = characters(value)
            for step, level in itertools.product(range(2), range(2)):
                size = (9, 30 >> level, 40 >> level)
                group = file.create_group(f"DataSet/ResolutionLevel {level}/TimePoint {step}/Channel {channel}")
                for axis, n in zip("ZYX", size):
                    group.attrs[f"ImageSize{axis}"] = characters(n)
                padded = numbers(random, (16, 32 >> level, 48 >> level), "<u2")
                group.create_dataset("Data", data=padded, chunks=(8, 16, 8), compression="gzip")
                if level == 0:
                    expected[channel, step] = padded[:9, :30, :40]
    for (channel, step), values in expected.items():
        tally.compare("Imaris", "", path, values, ["DAPI", "GFP"][channel], step)


def write(tally, folder):
    """Writes and compares every file."""
    random = numpy.random.default_rng(5)
    plain(tally, os.path.join(folder, "plain.h5"), random)
    nexus(tally, os.path.join(folder, "a.nxs"), random)
    vtkhdf(tally, os.path.join(folder, "a.vtkhdf"), random)
    bigdataviewer(tally, os.path.join(folder, "bdv.h5"), random)
    imaris(tally, os.path.join(folder, "a.ims"), random)
