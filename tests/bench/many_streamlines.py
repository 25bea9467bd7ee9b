#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Ten thousand streamlines in an image: the whole program, file to PNG, compared with VTK (vtkStreamTracer, vtkTubeFilter, off screen).
needs: python3-vtk9 numpy, an X server (xvfb-run -a)
usage: many_streamlines.py CATENA FIELD.vti [LINES] [LENGTH] [RADIUS] [ROUNDS]
FIELD.vti: point data, one vector array. Seeds: random positions with at least a tenth of the maximum speed. LENGTH: per direction, world
units (default: the box's diagonal); RADIUS: of the tubes (default: 0.0015 of it). VTK: RK45 with the same tolerance per step (1e-7 of the
box's longest edge), steps in cells, at most 2000, as in ParaView's defaults, and with ParaView's tolerance (1e-6); tubes of 6 sides.
Processor seconds, wall seconds and maximum memory of each process, medians of ROUNDS (3) alternating rounds."""
import json, os, statistics, subprocess, sys, tempfile, time

PEER = r'''
import sys, numpy as np, vtk
from vtk.util import numpy_support
path, seeds, length, radius, error, out = sys.argv[1], sys.argv[2], *map(float, sys.argv[3:6]), sys.argv[6]
reader = vtk.vtkXMLImageDataReader(); reader.SetFileName(path); reader.Update()
image = reader.GetOutput(); image.GetPointData().SetActiveVectors(image.GetPointData().GetArray(0).GetName())
points = vtk.vtkPoints(); points.SetDataTypeToDouble(); points.SetData(numpy_support.numpy_to_vtk(np.loadtxt(seeds, delimiter=",", skiprows=1)))
source = vtk.vtkPolyData(); source.SetPoints(points)
t = vtk.vtkStreamTracer(); t.SetInputData(image); t.SetSourceData(source); t.SetIntegrationDirectionToBoth(); t.SetIntegratorTypeToRungeKutta45()
t.SetIntegrationStepUnit(vtk.vtkStreamTracer.CELL_LENGTH_UNIT); t.SetInitialIntegrationStep(.2); t.SetMinimumIntegrationStep(.01)
t.SetMaximumIntegrationStep(.5); t.SetMaximumError(error); t.SetMaximumPropagation(length); t.SetMaximumNumberOfSteps(2000)
t.SetTerminalSpeed(1e-6); t.SetComputeVorticity(False)
tube = vtk.vtkTubeFilter(); tube.SetInputConnection(t.GetOutputPort()); tube.SetRadius(radius); tube.SetNumberOfSides(6)
mapper = vtk.vtkPolyDataMapper(); mapper.SetInputConnection(tube.GetOutputPort()); mapper.ScalarVisibilityOff()
actor = vtk.vtkActor(); actor.SetMapper(mapper)
renderer = vtk.vtkRenderer(); renderer.AddActor(actor)
window = vtk.vtkRenderWindow(); window.SetOffScreenRendering(1); window.SetSize(1024, 768); window.AddRenderer(renderer); window.Render()
grab = vtk.vtkWindowToImageFilter(); grab.SetInput(window)
writer = vtk.vtkPNGWriter(); writer.SetInputConnection(grab.GetOutputPort()); writer.SetFileName(out); writer.Write()
'''


def measured(command):
    start = time.perf_counter()
    child = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    error = child.stderr.read()
    _, status, use = os.wait4(child.pid, 0)
    if status != 0: sys.exit(f"{command[0]}: {error}")
    return use.ru_utime + use.ru_stime, time.perf_counter() - start, use.ru_maxrss / 1024


def main():
    import numpy as np, vtk
    from vtk.util import numpy_support
    program, path = sys.argv[1:3]
    reader = vtk.vtkXMLImageDataReader(); reader.SetFileName(path); reader.Update()
    image = reader.GetOutput()
    speed = np.linalg.norm(numpy_support.vtk_to_numpy(image.GetPointData().GetArray(0)), axis=1)
    box = np.array(image.GetBounds()).reshape(3, 2)
    diagonal = np.linalg.norm(box[:, 1] - box[:, 0])
    lines = int(sys.argv[3]) if len(sys.argv) > 3 else 10000
    length = float(sys.argv[4]) if len(sys.argv) > 4 else diagonal
    radius = float(sys.argv[5]) if len(sys.argv) > 5 else 0.0015 * diagonal
    rounds = int(sys.argv[6]) if len(sys.argv) > 6 else 3
    rng = np.random.default_rng(5)
    flowing = np.flatnonzero(speed > 0.1 * speed.max())
    places = np.array([image.GetPoint(int(i)) for i in rng.choice(flowing, lines)])
    places = np.clip(places + rng.uniform(-.3, .3, places.shape) * image.GetSpacing(), box[:, 0], box[:, 1])
    tolerance = 1e-7 * (box[:, 1] - box[:, 0]).max()
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        np.savetxt("seeds.csv", places, delimiter=",", header="x,y,z", comments="")
        with open("peer.py", "w") as file: file.write(PEER)
        with open("scene.json", "w") as file:
            json.dump({"fields": {"v": {"file": os.path.abspath(path)}},
                       "streamlines": [{"field": "v", "seeds": places.tolist(), "radius": radius, "length": length, "tolerance": 1e-7}]}, file)
        peer = [sys.executable, "peer.py", path, "seeds.csv", str(length), str(radius)]
        runs = {"catena": lambda k: [program, "render", "scene.json", "-o", f"{k}.png"],
                "VTK, the same tolerance": lambda k: peer + [str(tolerance), f"v{k}.png"],
                "VTK, ParaView's tolerance": lambda k: peer + ["1e-6", f"w{k}.png"]}
        found = {name: [] for name in runs}
        for k in range(rounds):
            for name, command in runs.items(): found[name].append(measured(command(k)))
        print(f"{lines} lines, {length:g} long each way, radius {radius:g}")
        for name, figures in found.items():
            cpu, wall, memory = (statistics.median(column) for column in zip(*figures))
            print(f"{name:28} {cpu:7.2f} s of processor, {wall:7.2f} s, {memory:6.0f} MB")


if len(sys.argv) < 3: sys.exit(__doc__)
sys.argv[1:3] = [os.path.abspath(p) for p in sys.argv[1:3]]
main()
