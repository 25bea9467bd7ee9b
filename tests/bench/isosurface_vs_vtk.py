#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""An opaque isosurface compared with VTK's isosurface mode (vtkGPUVolumeRayCastMapper, sample distance 0.5 voxel), in one run on one
machine, in alternating rounds: processor and wall time per image, and depth errors of both against an independent intersection (numpy,
double precision: the trilinear field every 0.05 voxel along the pixel's ray, bisection of the first change of sign; see `reference`).
For context: vtkFlyingEdges3D once, and drawing of its triangles (without depth errors).
needs: python3-vtk9 numpy, an X display (xvfb-run -a, LIBGL_ALWAYS_SOFTWARE=1); fields of raw float32
usage: isosurface_vs_vtk.py ISOSURFACE_TABLE RAW N LEVEL [ROUNDS [VIEWS]]
1024x768, vertical field of view 30 degrees, an orbit of VIEWS at elevation 20; errors at azimuth 30 over every 23rd pixel, in voxels
along the view axis. Prints one JSON line each, the ratios last."""
import json, resource, statistics, subprocess, sys, tempfile, time
import numpy as np
import vtk
from vtk.util import numpy_support

table, raw, n, level = sys.argv[1], sys.argv[2], int(sys.argv[3]), float(sys.argv[4])
rounds = int(sys.argv[5]) if len(sys.argv) > 5 else 3
views = int(sys.argv[6]) if len(sys.argv) > 6 else 5
W, H, SKIP, STEP = 1024, 768, 23, 0.5
field = np.fromfile(raw, np.float32)
centre, distance = (n - 1) / 2.0, 2.7 * n


def cpu_s():
    r = resource.getrusage(resource.RUSAGE_SELF)
    return r.ru_utime + r.ru_stime


image = vtk.vtkImageData(); image.SetDimensions(n, n, n)
image.GetPointData().SetScalars(numpy_support.numpy_to_vtk(field))
encode = """
  if (!catena_found && g_fragColor.a > 0.0)
  {
    catena_found = true;
    catena_depth = -(in_modelViewMatrix * in_volumeMatrix[0] * in_textureDatasetMatrix[0] * vec4(g_dataPos, 1.0)).z;
  }
"""
write = """
  if (catena_found)
  {
    int code = int((catena_depth - %.9g) / %.9g * 16777215.0 + 0.5);
    gl_FragData[0] = vec4(float(code & 255), float(code >> 8 & 255), float(code >> 16), 255.0) / 255.0;
  }
""" % (distance - n, 2.0 * n)


def window_of(prop):
    renderer = vtk.vtkRenderer(); renderer.SetBackground(0, 0, 0); renderer.AddViewProp(prop)
    window = vtk.vtkRenderWindow(); window.SetOffScreenRendering(1); window.SetMultiSamples(0); window.SetSize(W, H); window.SetAlphaBitPlanes(1); window.AddRenderer(renderer)
    camera = renderer.GetActiveCamera(); camera.SetViewAngle(30)

    def draw(azimuth):
        camera.SetFocalPoint(centre, centre, centre); camera.SetPosition(centre, centre - distance, centre); camera.SetViewUp(0, 0, 1)
        camera.Azimuth(azimuth); camera.Elevation(20); camera.OrthogonalizeViewUp(); camera.SetClippingRange(n, 5 * n)
        window.Render(); window.WaitForCompletion()
    return window, draw


def isosurface(coded):
    colour, opacity, prop = vtk.vtkColorTransferFunction(), vtk.vtkPiecewiseFunction(), vtk.vtkVolumeProperty()
    colour.AddRGBPoint(0, .8, .8, .9); opacity.AddPoint(0, 1); opacity.AddPoint(1, 1)
    prop.SetColor(colour); prop.SetScalarOpacity(opacity); prop.SetInterpolationTypeToLinear()
    prop.SetShade(1); prop.SetAmbient(.2); prop.SetDiffuse(.7); prop.SetSpecular(.2); prop.SetSpecularPower(20)
    prop.GetIsoSurfaceValues().SetValue(0, level)
    mapper = vtk.vtkOpenGLGPUVolumeRayCastMapper(); mapper.SetUseJittering(0); mapper.SetMaxMemoryInBytes(8 << 30); mapper.SetMaxMemoryFraction(1)
    mapper.SetAutoAdjustSampleDistances(0); mapper.SetLockSampleDistanceToInputSpacing(0); mapper.SetSampleDistance(STEP); mapper.SetInputData(image)
    mapper.SetBlendModeToIsoSurface()
    volume = vtk.vtkVolume(); volume.SetMapper(mapper); volume.SetProperty(prop)
    if coded:
        shader = volume.GetShaderProperty()
        shader.AddFragmentShaderReplacement("//VTK::Base::Dec", True, "//VTK::Base::Dec\nbool catena_found = false; float catena_depth = 0.0;\n", False)
        shader.AddFragmentShaderReplacement("//VTK::RenderToImage::Impl", True, encode + "//VTK::RenderToImage::Impl\n", False)
        shader.AddFragmentShaderReplacement("//VTK::RenderToImage::Exit", True, "//VTK::RenderToImage::Exit\n" + write, False)
    return volume


def grabbed(window):
    grab = vtk.vtkWindowToImageFilter(); grab.SetInput(window); grab.SetInputBufferTypeToRGBA(); grab.ReadFrontBufferOff(); grab.Update()
    return numpy_support.vtk_to_numpy(grab.GetOutput().GetPointData().GetScalars()).reshape(H, W, 4)[::-1]


def timed(draw):
    draw(0); draw(3)
    wall, cpu = [], []
    for k in range(views):
        t, c = time.perf_counter(), cpu_s(); draw(360 / views * k + 7); wall.append(1e3 * (time.perf_counter() - t)); cpu.append(1e3 * (cpu_s() - c))
    return {"wall_ms": statistics.median(wall), "cpu_ms": statistics.median(cpu)}


def rays():
    """Pixels (rows, columns) and their rays: eye, direction per unit of view depth, entry and exit of the grid."""
    a, e = np.radians(30), np.radians(20)
    towards = np.array([np.sin(a) * np.cos(e), -np.cos(a) * np.cos(e), np.sin(e)])
    right = np.cross([0, 0, 1], towards); right /= np.linalg.norm(right)
    up = np.cross(towards, right)
    index = np.arange(7, W * H, SKIP)
    rows, columns = index // W, index % W
    half = np.tan(np.radians(15))
    x, y = (columns + .5 - W / 2) / (H / 2) * half, (H / 2 - rows - .5) / (H / 2) * half
    d = x[:, None] * right + y[:, None] * up - towards  # one unit of view depth
    o = centre + distance * towards
    with np.errstate(divide="ignore"): s, t = (0 - o) / d, (n - 1 - o) / d
    return rows, columns, o, d, np.minimum(s, t).max(1), np.maximum(s, t).min(1)


def value(p):
    base = np.clip(p.astype(np.int64), 0, n - 2)
    f = p - base
    at = base[:, 0] + n * (base[:, 1] + n * base[:, 2])
    along = lambda k: field[at + k] * (1 - f[:, 0]) + field[at + k + 1] * f[:, 0]
    plane = lambda k: along(k) * (1 - f[:, 1]) + along(k + n) * f[:, 1]
    return plane(0) * (1 - f[:, 2]) + plane(n * n) * f[:, 2] - level


def first_crossings(o, d, enter, leave, voxels):
    """View depths of the first sign changes between samples `voxels` apart; infinite if there is none."""
    depth = np.full(len(d), np.inf)
    live = np.flatnonzero(enter < leave)
    at, step = enter[live], voxels / np.linalg.norm(d[live], axis=1)
    before = value(np.clip(o + at[:, None] * d[live], 0, n - 1))
    while len(live):
        beyond = np.minimum(at + step, leave[live])
        now = value(np.clip(o + beyond[:, None] * d[live], 0, n - 1))
        crossed = (before >= 0) != (now >= 0)
        if crossed.any():
            lo, hi, sign, rays = at[crossed], beyond[crossed], before[crossed] >= 0, d[live[crossed]]
            for _ in range(45):
                middle = .5 * (lo + hi)
                same = (value(o + middle[:, None] * rays) >= 0) == sign
                lo, hi = np.where(same, middle, lo), np.where(same, hi, middle)
            depth[live[crossed]] = .5 * (lo + hi)
        keep = ~crossed & (beyond < leave[live])
        live, at, before, step = live[keep], beyond[keep], now[keep], step[keep]
    return depth


def reference(ours):
    """Reference depths of the chosen pixels. If ours is nearer, or only ours has a hit, the samples may have missed two crossings: then the
    last half voxel before our depth is sampled every 0.0005 voxel. A crossing that is still not found counts as our error."""
    rows, columns, o, d, enter, leave = rays()
    depth = first_crossings(o, d, enter, leave, .05)
    found = ours[rows, columns]
    again = np.flatnonzero(found < depth - 1e-3)
    if len(again):
        fine = first_crossings(o, d[again], np.maximum(enter[again], found[again] - .5), np.minimum(leave[again], found[again] + .01), .0005)
        depth[again] = np.minimum(depth[again], fine)
    return rows, columns, depth, len(again)


def errors(depth, truth):
    rows, columns, expected, _ = truth
    found = depth[rows, columns]
    both = np.isfinite(found) & np.isfinite(expected)
    off = np.abs(found[both] - expected[both])
    return {"pixels": int(both.sum()), "one_misses": int((np.isfinite(found) != np.isfinite(expected)).sum()), "error_rms": float(f"{np.sqrt((off ** 2).mean()):.3g}"),
            "error_median": float(f"{np.median(off):.3g}"), "error_99": float(f"{np.quantile(off, .99):.3g}"), "error_max": float(f"{off.max():.3g}"), "above_0.001": int((off > 1e-3).sum())}


window, draw = window_of(isosurface(False))
ours, theirs = [], []
with tempfile.TemporaryDirectory() as folder:
    for _ in range(rounds):
        out = subprocess.run([table, raw, str(n), str(level), str(views), f"{folder}/depth"], check=True, capture_output=True, text=True).stdout
        ours.append(json.loads(out.splitlines()[-1]))
        theirs.append(timed(draw))
    our_depth = np.fromfile(f"{folder}/depth", np.float32).reshape(H, W).astype(float)

coded_window, coded_draw = window_of(isosurface(True))
coded_draw(30)
code = grabbed(coded_window).astype(np.int64)
their_depth = np.where(code[..., 3] > 0, distance - n + 2.0 * n * (code[..., 0] + 256 * code[..., 1] + 65536 * code[..., 2]) / 16777215, np.inf)
truth = reference(our_depth)

edges = vtk.vtkFlyingEdges3D(); edges.SetInputData(image); edges.SetValue(0, level); edges.ComputeNormalsOn()
t, c = time.perf_counter(), cpu_s(); edges.Update()
contour = {"wall_ms": 1e3 * (time.perf_counter() - t), "cpu_ms": 1e3 * (cpu_s() - c)}
triangles = vtk.vtkPolyDataMapper(); triangles.SetInputConnection(edges.GetOutputPort()); triangles.ScalarVisibilityOff()
actor = vtk.vtkActor(); actor.SetMapper(triangles)
_, triangle_draw = window_of(actor)
drawn = timed(triangle_draw)

median = lambda runs, key: statistics.median(r[key] for r in runs)
name = raw.split("/")[-1]
print(json.dumps({"renderer": "catena", "field": name, "cpu_ms": median(ours, "cpu_ms"), "wall_ms": median(ours, "wall_ms"), "new_level_cpu_ms": median(ours, "level_cpu_ms"), "gpu_mib": ours[0]["gpu_mib"], "reference_asked_again": truth[3], **errors(our_depth, truth)}))
print(json.dumps({"renderer": "vtk isosurface mode", "step_voxels": STEP, "field": name, "cpu_ms": round(median(theirs, "cpu_ms"), 1), "wall_ms": round(median(theirs, "wall_ms"), 1), **errors(their_depth, truth)}))
print(json.dumps({"renderer": "vtk triangles", "field": name, "contour_cpu_ms": round(contour["cpu_ms"], 1), "triangles": edges.GetOutput().GetNumberOfPolys(), "cpu_ms": round(drawn["cpu_ms"], 1), "wall_ms": round(drawn["wall_ms"], 1)}))
print(json.dumps({"times_less_cpu": [round(b["cpu_ms"] / a["cpu_ms"], 1) for a, b in zip(ours, theirs)], "median": round(median(theirs, "cpu_ms") / median(ours, "cpu_ms"), 1), "wall": round(median(theirs, "wall_ms") / median(ours, "wall_ms"), 1)}))
