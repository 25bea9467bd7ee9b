#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Streamlines compared with vtkStreamTracer, in one run on one machine: steps per second and the error of both against an independent
reference (numpy, double precision, RK4 in arc length at a hundredth of a voxel on the same trilinear field).
needs: python3-vtk9 numpy
usage: streamlines_vs_vtk.py CATENA [N] [ROUNDS]     the program, nodes per axis (128), alternating rounds (5)
Times are CPU times of the tracing alone, without files, as measured by each program; ours counts all threads. Errors are distances to
the reference line, in voxels, over the first 50 voxels of 60 lines."""
import json, os, statistics, subprocess, sys, tempfile, time
import numpy as np
import vtk
from vtk.util import numpy_support

program, n, rounds = sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 128, int(sys.argv[3]) if len(sys.argv) > 3 else 5
LENGTH, CHECKED, CHECKED_LENGTH, FINE = 250.0, 60, 50.0, 0.01

g = np.arange(n) * np.pi / (n - 1)
z, y, x = np.meshgrid(g, g, g, indexing="ij")
v = np.stack([np.sin(x) * np.cos(y) * np.cos(z), np.cos(x) * np.sin(y) * np.cos(z), -2 * np.cos(x) * np.cos(y) * np.sin(z)], -1).astype(np.float32)
seeds = np.random.default_rng(3).uniform(.2 * n, .8 * n, (1000, 3)).astype(np.float32).astype(float)


def velocity(p):
    base = np.clip(np.floor(p).astype(int), 0, n - 2)
    f = p - base
    out = np.zeros_like(p)
    for c in range(8):
        i, j, k = c & 1, c >> 1 & 1, c >> 2
        w = (f[:, 0] if i else 1 - f[:, 0]) * (f[:, 1] if j else 1 - f[:, 1]) * (f[:, 2] if k else 1 - f[:, 2])
        out += w[:, None] * v[base[:, 2] + k, base[:, 1] + j, base[:, 0] + i]
    return out


def reference(p):
    unit = lambda q: (lambda w: w / np.linalg.norm(w, axis=1)[:, None])(velocity(q))
    lines = [p]
    for _ in range(int((CHECKED_LENGTH + 2) / FINE)):
        a = unit(p); b = unit(p + .5 * FINE * a); c = unit(p + .5 * FINE * b); d = unit(p + FINE * c)
        p = p + FINE / 6 * (a + 2 * b + 2 * c + d)
        lines.append(p)
    return np.stack(lines, 1)


def errors(lines, fine):
    """Squared distances of the points of each line (seed first) to its reference."""
    found = []
    for line, ref in zip(lines, fine):
        s = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))])
        for p, at in zip(line[1:], s[1:]):
            if at > CHECKED_LENGTH: break
            i = int(at / FINE)
            a, b = ref[max(0, i - 100):i + 100], ref[max(0, i - 100) + 1:i + 101]
            a = a[:len(b)]
            t = np.clip(((p - a) * (b - a)).sum(1) / ((b - a) ** 2).sum(1), 0, 1)
            found.append((((a + t[:, None] * (b - a)) - p) ** 2).sum(1).min())
    return np.sqrt(np.mean(found)), np.sqrt(np.max(found))


image = vtk.vtkImageData(); image.SetDimensions(n, n, n)
array = numpy_support.numpy_to_vtk(v.reshape(-1, 3)); array.SetName("v")
image.GetPointData().SetVectors(array); image.GetPointData().SetActiveVectors("v")
points = vtk.vtkPoints(); points.SetDataTypeToDouble(); points.SetData(numpy_support.numpy_to_vtk(seeds))
source = vtk.vtkPolyData(); source.SetPoints(points)


def vtk_tracer(method, step):
    t = vtk.vtkStreamTracer(); t.SetInputData(image); t.SetSourceData(source); t.SetIntegrationDirectionToForward()
    {"RK4": t.SetIntegratorTypeToRungeKutta4, "RK45": t.SetIntegratorTypeToRungeKutta45}[method]()
    t.SetIntegrationStepUnit(vtk.vtkStreamTracer.CELL_LENGTH_UNIT); t.SetInitialIntegrationStep(step); t.SetMinimumIntegrationStep(.01)
    t.SetMaximumIntegrationStep(1.0); t.SetMaximumError(1e-6); t.SetMaximumPropagation(LENGTH); t.SetMaximumNumberOfSteps(100000)
    t.SetTerminalSpeed(1e-9); t.SetComputeVorticity(False)
    return t


def lines_of(data):
    xyz = numpy_support.vtk_to_numpy(data.GetPoints().GetData()).astype(float)
    offsets = numpy_support.vtk_to_numpy(data.GetLines().GetOffsetsArray())
    connectivity = numpy_support.vtk_to_numpy(data.GetLines().GetConnectivityArray())
    return [xyz[connectivity[a:b]] for a, b in zip(offsets[:-1], offsets[1:])]


def voxels(data):
    """Total length of all lines."""
    xyz = numpy_support.vtk_to_numpy(data.GetPoints().GetData()).astype(float)
    offsets = numpy_support.vtk_to_numpy(data.GetLines().GetOffsetsArray())
    connectivity = numpy_support.vtk_to_numpy(data.GetLines().GetConnectivityArray())
    pieces = np.linalg.norm(np.diff(xyz[connectivity], axis=0), axis=1)
    pieces[offsets[1:-1] - 1] = 0
    return float(pieces.sum())


def by_seed(lines):
    starts = np.stack([line[0] for line in lines])
    return [lines[int(((starts - s) ** 2).sum(1).argmin())] for s in seeds[:CHECKED]]


fine = reference(seeds[:CHECKED])
with tempfile.TemporaryDirectory() as folder:
    v.tofile(f"{folder}/v.raw")
    with open(f"{folder}/s.json", "w") as f:
        json.dump({"fields": {"v": {"file": "v.raw", "shape": [n, n, n], "spacing": [1, 1, 1], "origin": [0, 0, 0], "type": "float32x3"}}}, f)
    np.savetxt(f"{folder}/seeds.csv", seeds, fmt="%.17g", delimiter=",", header="x,y,z", comments="")

    def ours(step, tolerance):
        subprocess.run([program, "trace", f"{folder}/s.json", "--field", "v", "--seeds", f"{folder}/seeds.csv", "--length", str(LENGTH), "--tolerance",
                        str(tolerance), "--step", str(step), "--repeat", "3", "-o", f"{folder}/l.vtp", "--stats", f"{folder}/stats.json"], check=True, stdout=subprocess.DEVNULL)
        stats = json.load(open(f"{folder}/stats.json"))
        return stats["trace_cpu_ms"] / 1e3, stats["trace_ms"] / 1e3, stats["knots"], voxels(all_lines(f"{folder}/l.vtp"))

    def all_lines(path):
        reader = vtk.vtkXMLPolyDataReader(); reader.SetFileName(path); reader.Update()
        return reader.GetOutput()

    def ours_lines():
        reader = vtk.vtkXMLPolyDataReader(); reader.SetFileName(f"{folder}/l.vtp"); reader.Update()
        data = reader.GetOutput()
        s = numpy_support.vtk_to_numpy(data.GetPointData().GetArray("s"))
        offsets = numpy_support.vtk_to_numpy(data.GetLines().GetOffsetsArray())
        xyz = numpy_support.vtk_to_numpy(data.GetPoints().GetData())
        return [xyz[a:b][s[a:b] >= 0] for a, b in list(zip(offsets[:-1], offsets[1:]))[:CHECKED]]

    # VTK's steps count cell lengths, which are diagonals: .25 of them is .433 voxel
    rows = {("vtk", "RK4", .25): [], ("vtk", "RK4", .5): [], ("vtk", "RK45", .25): [], ("catena", 1e-4, .433): [], ("catena", 1e-4, .866): [],
            ("catena", 1e-7, .5): [], ("catena", 1e-7, 1.0): []}
    error = {}
    tracers = {key: vtk_tracer(key[1], key[2]) for key in rows if key[0] == "vtk"}
    for turn in range(rounds):
        for key, times in rows.items():
            if key[0] == "vtk":
                tracers[key].Modified()
                cpu, wall = time.process_time(), time.perf_counter()
                tracers[key].Update()
                times.append((time.process_time() - cpu, time.perf_counter() - wall, tracers[key].GetOutput().GetNumberOfPoints(), voxels(tracers[key].GetOutput())))
            else:
                times.append(ours(key[2], key[1]))
            if turn == 0:
                error[key] = errors(by_seed(lines_of(tracers[key].GetOutput())) if key[0] == "vtk" else ours_lines(), fine)

cores = os.cpu_count()


def rates(key):
    """Steps and voxels of line per CPU second, times the number of cores of the tracer."""
    used = 1 if key[0] == "vtk" else cores
    return [used * statistics.median(t[i] / t[0] for t in rows[key]) for i in (2, 3)]


base = rates(("vtk", "RK4", .25))
for key, times in rows.items():
    steps, way = rates(key)
    print(json.dumps({"tracer": key[0], "method_or_tolerance": key[1], "step_voxels": round(key[2] * (3 ** .5 if key[0] == "vtk" else 1), 3), "points": times[0][2], "cpu_us_a_step": round(1e6 * statistics.median(t[0] / t[2] for t in times), 4),
                      "wall_us_a_step": round(1e6 * statistics.median(t[1] / t[2] for t in times), 4), "error_rms_voxels": float(f"{error[key][0]:.3g}"),
                      "error_max_voxels": float(f"{error[key][1]:.3g}"), "steps_a_second_vs_vtk_rk4": round(steps / base[0], 2), "length_a_second_vs_vtk_rk4": round(way / base[1], 2)}))
