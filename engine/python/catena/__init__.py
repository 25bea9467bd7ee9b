# SPDX-License-Identifier: MIT
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
import fcntl as _fcntl
import glob as _glob
import html as _html
import json as _json
import operator as _operator
import os as _os
import shutil as _shutil
import struct as _struct
import subprocess as _subprocess
import tempfile as _tempfile
import time as _time
import urllib.parse as _urls
import warnings as _warnings
import weakref as _weakref
import zlib as _zlib

import numpy as _np

from ._catena import (Chain, Curve, Error, Field, MachineError, STATUSES, Ticks, __version__, _from_array, _from_file, _histogram, _measure_labels,
                      _measure_parts, _profile, _recording, _render, _study_table, _values_at, analytic, analytic_names, memory_limit, trace,
                      trace_unsteady)

_FILES = "file", "firmware", "transfer", "itk", "fsl", "reference"  # keys of a scene whose words name files

__all__ = ["Chain", "Curve", "Error", "Field", "MachineError", "Picture", "STATUSES", "Served", "Ticks", "analytic", "analytic_names",
           "field", "histogram", "measure_labels", "measure_parts", "memory_limit", "profile", "recording", "render", "serve", "show",
           "study_table", "trace", "trace_unsteady", "trade_report", "values_at"]


def field(data, *, axes="zyx", affine=None, name="field", interpolation="linear", grid="", step=0, vectors=None):
    """A field of an array, or of any data file that catena reads.

    data: an array of one to four dimensions, of any real type; or a path. Missing dimensions have one voxel, which is written twice.
    vectors: True: the last dimension holds 2 or 3 components along the world's axes (two get a third, 0); False: scalars. None: vectors if
    there are four dimensions, else scalars, with a warning where the last dimension of two or three has the size 2 or 3.
    axes: "zyx": data[k, j, i], the last index is x (as a C-ordered volume); "xyz": data[i, j, k] (as nibabel has it).
    affine: (4, 4), from voxel (i, j, k, 1) to world; None: voxel (i, j, k) lies at world (i, j, k).
    interpolation: between voxels: "linear", "nearest" (label maps) or "cubic".
    grid, step: of a file: which grid, which step in time.

    An array is read once, where it lies; the field keeps a grid of 32-bit floats of its own. What is masked, NaN or infinite is no voxel.
    """
    if isinstance(data, (str, _os.PathLike)):
        return _from_file(data, str(grid), _operator.index(step), str(interpolation))
    if isinstance(data, _np.ma.MaskedArray):  # what is masked has no value
        data = data.astype(_np.float32).filled(_np.nan)
    data = _np.asarray(data)
    if vectors is None:
        vectors = data.ndim == 4
        if data.ndim in (2, 3) and data.shape[-1] in (2, 3):
            _warnings.warn(f"{name}: the array of shape {data.shape} is read as scalars; vectors=True reads {data.shape[-1]} components, "
                           "vectors=False says that scalars are meant", stacklevel=2)
    return _from_array(data, str(axes), affine, str(name), str(interpolation), bool(vectors))


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
    width, height: pixels. fields: names and the Fields, arrays (z, y, x) or paths that stand for them in the scene.
    """
    most = 2 ** 31 - 1
    return Picture(*_render(scene, min(_operator.index(width), most), min(_operator.index(height), most), fields))


def _measured(data, spacing, name):
    """The field of what is measured: a Field, a path, or an array whose voxels have that spacing."""
    if spacing is None:
        return data if isinstance(data, Field) else field(data, name=name)
    if isinstance(data, (Field, str, _os.PathLike)):
        raise Error(f"{name}: a field or file has its own spacing; an array was expected with spacing=")
    edges = _np.asarray(spacing, float)
    if edges.shape != (3,) or not (_np.isfinite(edges).all() and (edges > 0).all()):
        raise Error("spacing: three positive lengths (x, y, z) were expected")
    return field(data, name=name, affine=_np.diag([*edges, 1.0]))


def measure_labels(labels, values=None, *, spacing=None):
    """The labels of a label map, as `catena measure LABELS [--values DATA]`: a dict of arrays with an entry for each label, ascending.

    labels: a Field, a path, or an array (z, y, x) of integers; 0 is no label. values: data of the same kinds, whose statistics are wanted.
    spacing: (3,), voxel edges of an array along x, y, z, world units.

    label, name (of the table beside a file, else ""), voxels, volume, surface, center (N, 3); with values also valued_voxels, mean,
    deviation, min, max. Beside them the numbers voxel_volume, unlabeled_voxels, masked_voxels and not_finite_voxels. Lengths are world
    units.
    """
    path = _os.fsencode(labels) if isinstance(labels, (str, _os.PathLike)) else b""
    return _measure_labels(_measured(labels, spacing, "labels"),
                           None if values is None else _measured(values, None if _has_voxels(values) else spacing, "values"), path)


def _has_voxels(data):
    """Whether data state the place of their voxels."""
    return isinstance(data, (Field, str, _os.PathLike))


def measure_parts(data, level, *, values=None, neighbors=26, parts=20, spacing=None):
    """The connected parts of the voxels at or above a level, and the isosurface, as `catena measure DATA --level`: a dict of arrays with an
    entry for each part, the largest first.

    data: a Field, a path, or an array (z, y, x). values: data of the same kinds for the statistics; None: data. neighbors: 6 or 26.
    parts: number of parts with their own entry; the last entry, of part 0, is for all others. spacing: (3,), voxel edges of an array.

    part (1, 2, ...), voxels, volume, surface, closed, valued_voxels, mean, deviation, min, max, center (N, 3). Beside them the numbers
    parts, voxels_above, volume_above, isosurface_area, enclosed_volume (NaN: the surface is open), open_edges, masked_voxels and
    not_finite_voxels.
    """
    return _measure_parts(_measured(data, spacing, "data"), float(level),
                          None if values is None else _measured(values, None if _has_voxels(values) else spacing, "values"),
                          _operator.index(neighbors), _operator.index(parts))


def histogram(data, bins, *, range=None):  # pylint: disable=redefined-builtin
    """The values of a grid in bins of equal width, those of numpy.histogram, as `catena measure DATA --histogram`: a dict.

    data: a Field, a path, or an array. range: (lowest, highest) edge; None: the range of the values.
    counts (N,), edges (N + 1,); below and above count the values outside of the range. Beside them voxels, mean, deviation, min, max,
    masked_voxels and not_finite_voxels.
    """
    return _histogram(_measured(data, None, "data"), _operator.index(bins), range)


def profile(data, start, end, samples=256, *, spacing=None):
    """Values along a line, as `catena measure DATA --line`: a dict of arrays.

    data: a Field, a path, or an array (z, y, x). start, end: (3,), world units. samples: number of equidistant points, the ends included.
    spacing: (3,), voxel edges of an array.
    length (N,) from the start, points (N, 3), values (N,), or (N, 3) of vectors; NaN outside, at masked voxels and beside values that are
    not finite.
    """
    return _profile(_measured(data, spacing, "data"), start, end, _operator.index(samples))


def values_at(data, points, *, spacing=None):
    """Values at points, as `catena measure DATA --point`.

    data: a Field, a path, or an array (z, y, x). points: (N, 3) or (3,), world units. spacing: (3,), voxel edges of an array.
    Returns (N,), or (N, 3) of vectors; NaN as of profile().
    """
    return _values_at(_measured(data, spacing, "data"), points)


def recording(path):
    """The ticks of a recording (.catlog) as a dict of arrays.

    tick, t (N,); probe, forces (N, 3); buttons (N,); proxies (N, L, 3); statuses (N, L), indices into STATUSES; period_us, compute_us (N,).
    Beside them links (L names), gaps (sentences about ticks that are not there), ending, device, version and the scene's text.
    """
    return _recording(_os.fsencode(path))


def study_table(folder):
    """All finished trials of a study's data folder, as a dict of arrays with a row for each: subject, task, condition, time_s, error_mm, ...
    end_mm is (N, 3). Rows of training are there too (training). "simulated" is one truth value: a model of a person did
    the trials; "notes" are lines about what of the folder was not taken."""
    return _study_table(_os.fsencode(folder))


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


def _text_of_scene(scene):
    """A dict as a scene file has it; NumPy's numbers and arrays, and paths, are as good as Python's."""
    def plain(value):
        if isinstance(value, _os.PathLike):
            return _os.fsdecode(value)
        if isinstance(value, (_np.generic, _np.ndarray)):
            return value.tolist()
        raise TypeError(f"a {type(value).__name__} has no place in a scene")

    try:
        return _json.dumps(scene, indent=1, default=plain, allow_nan=False)
    except (TypeError, ValueError, RecursionError) as error:
        raise Error(f"scene: {error}") from None


def _from_here(value):
    """A scene's object as it may lie anywhere: its files are named from the root, not from this program's folder."""
    if isinstance(value, dict):
        return {key: _os.path.abspath(item) if key in _FILES and isinstance(item, str) and item else _from_here(item)
                for key, item in value.items()}
    return [_from_here(item) for item in value] if isinstance(value, list) else value


class _Folder(_tempfile.TemporaryDirectory):
    """A temporary folder with a lock that goes with this program, however it ends. What others of them left by being killed is removed."""

    def __init__(self):
        super().__init__(prefix="catena-python-")
        self._held = self._lock(self.name)
        again = self._lock(self.name)
        if again is not None:  # no locks are known here
            again.close()
            return
        for old in _glob.glob(_os.path.join(_glob.escape(_os.path.dirname(self.name)), "catena-python-*")):
            try:
                state = _os.lstat(old)
                held = self._lock(old) if state.st_uid == _os.getuid() and _time.time() - state.st_mtime > 60 else None
            except OSError:
                continue
            if held is not None:
                _shutil.rmtree(old, ignore_errors=True)
                held.close()

    @staticmethod
    def _lock(folder):
        file = open(_os.path.join(folder, "lock"), "ab")  # pylint: disable=consider-using-with
        try:
            _fcntl.flock(file, _fcntl.LOCK_EX | _fcntl.LOCK_NB)
            return file
        except OSError:
            file.close()
            return None

    def cleanup(self):
        if self._held is not None:
            self._held.close()
        super().cleanup()


def _laid_out(folder, scene, fields):
    """A scene as the program takes it: its path, and options for its fields. What has no file gets one in that folder."""
    given = dict(fields or {})
    options = []
    if isinstance(scene, (str, _os.PathLike)):
        path = _os.fspath(scene)
    elif isinstance(scene, dict):
        path = _os.path.join(folder, "scene.json")
        text = _from_here(_json.loads(_text_of_scene(scene)))
        text["fields"] = dict(text.get("fields", {}))
        for name in given:
            text["fields"].setdefault(name, {"file": f"{name}.vdb"})
        with open(path, "w", encoding="utf-8") as file:
            file.write(_text_of_scene(text))
    else:
        path = _os.path.join(folder, "field.vdb")
        (scene if isinstance(scene, Field) else field(scene)).save(path)
    for number, (name, value) in enumerate(given.items()):
        file = _os.path.join(folder, f"given-{number}.vdb")  # a name may be no file's
        (value if isinstance(value, Field) else field(value, name=name)).save(file)
        options += ["--field", f"{name}={file}"]
    return path, options


def _failure(code, told, command):
    """What the program said as it ended."""
    lines = told.strip().splitlines() or [f"catena {command} ended with {code}"]
    return (Error if code == 2 else MachineError)(lines[-1].removeprefix("catena: "))


def show(scene, *, fields=None, seconds=None, options=()):
    """Opens a scene in the window and waits until it is closed. Returns what the user did.

    scene: a Field or an array, a path, or a dict as a scene file has it; fields: names and Fields (grids), arrays or paths of it.
    seconds: the window closes by itself after so long. options: more options of `catena view`.
    Returns a dict: "scene", the scene's text as the user left it (saved with Ctrl-S), and "changed", whether that is another one.
    A path is opened as it is and saved in its place; all else lies in a folder that is removed at the end.
    """
    with _Folder() as folder:
        path, arguments = _laid_out(folder, scene, fields)
        saved = path if path.endswith(".json") else path + ".json"
        before = _text_of(saved)
        command = [_program(), "view", path, *arguments, *options]
        if seconds is not None:
            command += ["--seconds", str(seconds)]
        done = _subprocess.run(command, stdout=_subprocess.DEVNULL, stderr=_subprocess.PIPE, text=True, check=False)
        if done.returncode != 0:
            raise _failure(done.returncode, done.stderr, "view")
        after = _text_of(saved)
        return {"scene": after, "changed": after != before}


def _text_of(path):
    try:
        with open(path, encoding="utf-8") as file:
            return file.read()
    except OSError:
        return None


class Served:
    """A scene that a browser shows, as serve() gives it: a notebook shows it as a frame. It ends with stop(), at the end of a `with`, when
    nothing refers to it any more, and with this program, however that ends.

    url: the address with its token, on this machine. size: (width, height) of the frame, pixels.
    """

    def __init__(self, url, size, child, folder):
        self.url, self.size, self._child = url, size, child
        self._end = _weakref.finalize(self, _end_serving, child, folder)

    def stop(self):
        """Ends it; once is enough."""
        self._end()

    @property
    def running(self):
        """Whether the page is served."""
        return self._child.poll() is None

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.stop()

    def __repr__(self):
        return f"<catena.Served {self.url}>" if self.running else "<catena.Served, ended>"

    def _repr_html_(self):
        if not self.running:
            return "<p>The scene is not served any more.</p>"
        (width, height), url = self.size, _html.escape(self.url)
        return (f'<iframe src="{url}" width="{width}" height="{height}" style="border: 0" title="Catena" '
                'referrerpolicy="no-referrer"></iframe><div style="font-size: small">Does it stay empty? It shows in a page at '
                f'http://{_urls.urlsplit(self.url).hostname} alone (page= says another one). '
                f'<a href="{url}" target="_blank" rel="noreferrer">By itself</a></div>')


def _end_serving(child, folder):
    child.stdin.close()  # it ends by itself then
    try:
        child.wait(10)
    except _subprocess.TimeoutExpired:
        child.kill()
        child.wait()
    child.stdout.close()
    folder.cleanup()


def serve(scene, *, fields=None, size=(960, 600), page=None, port=0, options=()):
    """Shows a scene in a browser, by `catena serve` on this machine alone, and returns at once: a Served, which a notebook shows as a frame.

    scene: a Field or an array, a path, or a dict as a scene file has it; fields: names and Fields (grids), arrays or paths of it.
    size: (width, height) of the frame, pixels. port: 0: any that is free. options: more options of `catena serve`.
    page: the address of the page that frames it, as the browser has it, such as "http://localhost:8888"; None: that of the Jupyter server
    that runs this, or no page. Nothing is written to the scene.
    """
    origin = _notebook() if page is None else page
    parts = _urls.urlsplit(origin or "")
    if origin and (parts.scheme not in ("http", "https") or not parts.hostname):
        raise Error(f"{origin}: expected the address of a page, such as http://localhost:8888")
    folder = _Folder()
    try:
        path, arguments = _laid_out(folder.name, scene, fields)
        command = [_program(), "serve", path, "--port", str(port), "--exit-with-stdin", *arguments, *options]
        if origin:
            command += ["--frame-ancestor", f"{parts.scheme}://{parts.netloc}"]
        told = _os.path.join(folder.name, "told")
        with open(told, "wb") as errors:
            child = _subprocess.Popen(command, stdin=_subprocess.PIPE, stdout=_subprocess.PIPE, stderr=errors, text=True,
                                      start_new_session=True)  # an interrupt of a cell is not meant for it
        url = child.stdout.readline().strip()
        if not url:
            child.stdin.close()
            code = child.wait()
            child.stdout.close()
            raise _failure(code, _text_of(told) or "", "serve")
    except BaseException:
        folder.cleanup()
        raise
    # a cookie counts only where frame and page have the same name
    if parts.hostname in ("localhost", "127.0.0.1"):
        url = url.replace("//127.0.0.1:", f"//{parts.hostname}:", 1)
    return Served(url, tuple(size), child, folder)


def _notebook():
    """Where the Jupyter server that has started this process is, by what it leaves for others to find; None: nowhere."""
    parent = _os.environ.get("JPY_PARENT_PID", "")
    places = [_os.environ.get("JUPYTER_RUNTIME_DIR", ""), _os.path.expanduser("~/.local/share/jupyter/runtime"),
              _os.path.join(_os.environ.get("JUPYTER_DATA_DIR", ""), "runtime")]
    for place in places if parent.isdigit() else []:
        for path in _glob.glob(_os.path.join(_glob.escape(place), f"*server-{parent}.json")):
            try:
                return _json.loads(_text_of(path) or "")["url"]
            except (ValueError, KeyError, TypeError):
                continue
    return None
