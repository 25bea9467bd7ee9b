"""See and feel scientific fields from Python.

    import numpy as np, catena
    ball = catena.field(np.fromfunction(lambda z, y, x: np.hypot(np.hypot(x - 16, y - 16), z - 16), (33, 33, 33)))
    picture = catena.render(ball)                       # picture.color: (H, W, 4) of uint8
    chain = catena.Chain({"fields": {}, "chain": [{"name": "skin", "type": "isosurface", "field": "ball", "level": 10}]},
                         fields={"ball": ball})
    ticks = chain.run([[16, 16, 30], [16, 16, 27]])     # ticks.forces: (N, 3), newtons

Lengths are world units, forces newtons, times seconds. What cannot be used raises catena.Error with the one line that the program
`catena` would print. Nothing here changes a NumPy array that it is given.
"""
import json as _json
import os as _os
import shutil as _shutil
import struct as _struct
import subprocess as _subprocess
import tempfile as _tempfile
import zlib as _zlib

import numpy as _np

from ._catena import (Chain, Curve, Error, Field, MachineError, STATUSES, Ticks, __version__, _from_array, _from_file, _recording, _render,
                      _study_table, analytic, analytic_names, trace)

__all__ = ["Chain", "Curve", "Error", "Field", "MachineError", "Picture", "STATUSES", "Ticks", "analytic", "analytic_names", "field",
           "recording", "render", "show", "study_table", "trace", "trade_report"]


def field(data, *, axes="zyx", affine=None, name="field", interpolation="linear", grid="", step=0):
    """A field of an array, or of any data file that catena reads.

    data: an array of three dimensions, or of four with 3 components last (vectors along the world's axes), of any real type; or a path.
    axes: "zyx": data[k, j, i], the last index is x (as a C-ordered volume); "xyz": data[i, j, k] (as nibabel has it).
    affine: (4, 4), from voxel (i, j, k, 1) to world; None: voxel (i, j, k) lies at world (i, j, k).
    interpolation: between voxels: "linear", "nearest" (label maps) or "cubic".
    grid, step: of a file: which grid, which step in time.

    An array is read once, where it lies; the field keeps a grid of 32-bit floats of its own.
    """
    if isinstance(data, (str, _os.PathLike)):
        return _from_file(_os.fspath(data), grid, step, interpolation)
    return _from_array(_np.asarray(data), axes, affine, name, interpolation)


class Picture:
    """A picture as arrays; row 0 is at the top.

    color: (H, W, 4) of uint8, red, green, blue and straight alpha, display values.
    depth: (H, W) of float32, distance of the nearest opaque surface along the view, world units; inf where there is none.
    ids: (H, W) of uint32, which object that is; 0: none.
    objects: {id: (kind, name)}.
    """

    def __init__(self, color, depth, ids, objects):
        self.color, self.depth, self.ids, self.objects = color, depth, ids, objects

    def save(self, path):
        """Writes the colours as a PNG file, whole or not at all."""
        part = f"{_os.fspath(path)}.part{_os.getpid()}"
        try:
            with open(part, "wb") as file:
                file.write(self._repr_png_())
            _os.replace(part, path)
        except OSError as error:
            if _os.path.exists(part):
                _os.remove(part)
            raise Error(f"{_os.fspath(path)}: cannot be written: {error.strerror}") from None

    def _repr_png_(self):
        def chunk(kind, data):
            return _struct.pack(">I", len(data)) + kind + data + _struct.pack(">I", _zlib.crc32(kind + data))

        height, width = self.color.shape[:2]
        rows = _np.zeros((height, 1 + 4 * width), _np.uint8)
        rows[:, 1:] = self.color.reshape(height, 4 * width)
        return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", _struct.pack(">IIBBBBB", width, height, 8, 6, 0, 0, 0)) +
                chunk(b"IDAT", _zlib.compress(rows.tobytes())) + chunk(b"IEND", b""))


def render(scene, width=640, height=480, *, fields=None):
    """Draws a scene and returns a Picture.

    scene: a Field or an array (shown as its kind of data is best seen), a path of a scene or data file, or a dict as a scene file has it.
    width, height: pixels. fields: names and the Fields or arrays (z, y, x) that stand for them in the scene.
    """
    return Picture(*_render(scene, width, height, fields or {}))


def recording(path):
    """The ticks of a recording (.catlog) as a dict of arrays.

    tick, t (N,); probe, forces (N, 3); buttons (N,); proxies (N, L, 3); statuses (N, L), indices into STATUSES; period_us, compute_us (N,).
    Beside them links (L names), gaps (sentences about ticks that are not there), ending, device, version and the scene's text.
    """
    return _recording(_os.fspath(path))


def study_table(folder):
    """All finished trials of a study's data folder, as a dict of arrays with a row for each: subject, task, condition, time_s, error_mm, ...
    end_mm is (N, 3). Rows of training are there too (training). "simulated" is one truth value: a model of a person did
    the trials; "notes" are lines about what of the folder was not taken."""
    return _study_table(_os.fspath(folder))


def trade_report(folder):
    """What `catena tradeoff -o FOLDER` wrote: {NAME: a structured array of NAME.csv, with its columns' names, ...}, and, of a report of a
    scene, {"tradeoff": the object of tradeoff.json}."""
    folder = _os.fspath(folder)
    if not _os.path.isdir(folder):
        raise Error(f"{folder}: is no folder; what `catena tradeoff -o` wrote was expected")
    found = {}
    for entry in sorted(_os.listdir(folder)):
        path = _os.path.join(folder, entry)
        if entry.endswith(".csv"):
            found[entry[:-4]] = _np.genfromtxt(path, delimiter=",", names=True, dtype=None, encoding="utf-8", comments=None, deletechars="",
                                              replace_space=" ")
        elif entry.endswith(".json"):
            with open(path, encoding="utf-8") as file:
                found[entry[:-5]] = _json.load(file)
    if not found:
        raise Error(f"{folder}: holds no table; what `catena tradeoff -o` wrote was expected")
    return found


def _program():
    """The program `catena` that belongs to this module, or the one that is found by PATH."""
    here = _os.path.dirname(_os.path.abspath(__file__))
    for up in range(5):
        path = _os.path.join(here, *[".."] * up, "bin", "catena")
        if _os.access(path, _os.X_OK):
            return _os.path.normpath(path)
    found = _shutil.which("catena")
    if found is None:
        raise MachineError("the program catena is not found; it was expected beside this module's library or by PATH")
    return found


def show(scene, *, fields=None, seconds=None, options=()):
    """Opens a scene in the window and waits until it is closed. Returns what the user did.

    scene: a Field or an array, a path, or a dict as a scene file has it; fields: names and Fields or arrays of it (grids).
    seconds: the window closes by itself after so long. options: more options of `catena view`.
    Returns a dict: "scene", the scene's text as the user left it (saved with Ctrl-S), and "changed", whether that is another one.
    A path is opened as it is and saved in its place; all else lies in a folder that is removed at the end.
    """
    with _tempfile.TemporaryDirectory(prefix="catena-") as folder:
        arguments = []
        given = dict(fields or {})
        if isinstance(scene, (str, _os.PathLike)):
            path = _os.fspath(scene)
        elif isinstance(scene, dict):
            path = _os.path.join(folder, "scene.json")
            text = dict(scene)
            text["fields"] = dict(text.get("fields", {}))
            for name in given:
                text["fields"].setdefault(name, {"file": f"{name}.vdb"})
            with open(path, "w", encoding="utf-8") as file:
                _json.dump(text, file, indent=1)
        else:
            path = _os.path.join(folder, "field.vdb")
            (scene if isinstance(scene, Field) else field(scene)).save(path)
        for name, value in given.items():
            file = _os.path.join(folder, f"{name}.vdb")
            (value if isinstance(value, Field) else field(value, name=name)).save(file)
            arguments += ["--field", f"{name}={file}"]
        saved = path if path.endswith(".json") else path + ".json"
        before = _text_of(saved)
        command = [_program(), "view", path, *arguments, *options]
        if seconds is not None:
            command += ["--seconds", str(seconds)]
        done = _subprocess.run(command, stdout=_subprocess.DEVNULL, stderr=_subprocess.PIPE, text=True, check=False)
        if done.returncode != 0:
            lines = done.stderr.strip().splitlines() or [f"catena view ended with {done.returncode}"]
            raise (Error if done.returncode == 2 else MachineError)(lines[-1].removeprefix("catena: "))
        after = _text_of(saved)
        return {"scene": after, "changed": after != before}


def _text_of(path):
    try:
        with open(path, encoding="utf-8") as file:
            return file.read()
    except OSError:
        return None
