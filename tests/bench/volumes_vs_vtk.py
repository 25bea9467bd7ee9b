#!/usr/bin/python3
"""Volumes against VTK, side by side: processor time a picture at equal error to each renderer's own converged picture.
needs: python3-vtk9, python3-numpy, xvfb; volume_table of the preset release; noise256.raw fog256.raw rough256.raw in FIELDS
usage: volumes_vs_vtk.py VOLUME_TABLE FIELDS WORK [CASE ...]      CASE: noise noise-shaded fog fog-shaded rough spike (default: all), or one of
these and :gpu or :cpu for one mapper alone (converged pictures of the slower one take minutes on a busy machine)
Both mappers of VTK at image sample distances 1 and 2, alternating with ours; converged pictures are kept in WORK between runs.
Prints, for each of VTK's pictures: its error, its time, the cheapest of ours with no larger error, and the ratio. Errors are RMSE of
8-bit RGB over covered pixels (either picture not black), in 1/255; times are medians of summed CPU milliseconds over threads."""
import json, os, resource, subprocess, sys, time

N, WIDTH, HEIGHT, VIEWS = 256, 1024, 768, 3
COLOUR = ((0, .1, .1, .4), (.35, .1, .6, .8), (.6, .9, .8, .3), (1, .9, .2, .1))
RAMP = ((0, 0), (.02, 0), (1, .1))
SPIKE = ((0, 0), (.38, 0), (.4, .5), (.42, 0), (1, 0))
# field, opacity, shaded, steps tried of VTK, modes of ours
CASES = {
    "noise": ("noise", RAMP, 0, (1,), "fast=4,4,-1,-1 fast=3,4,1.1,-1 fast=3,4,.7,-1 fast=2,4,.5,-1 fast=2,2,0,-1"),
    "noise-shaded": ("noise", RAMP, 1, (1,), "fast=4,4,-1,-1 fast=3,4,1,-1 fast=3,2,0,-1 fast=2,2,0,-1 fast=2,2,0,-1,smooth fast=2,4,.5,-1,smooth"),
    "fog": ("fog", ((0, 0), (.01, .005), (1, .3)), 0, (1, 2), "fast=5,4,-1,-1 fast=4,4,-1,-1 fast=4,4,.8,-1 fast=3,4,.6,-1 fast=3,2,0,-1"),
    "fog-shaded": ("fog", ((0, 0), (.01, .005), (1, .3)), 1, (1, 2), "fast=4,4,-1,-1 fast=3,4,1,-1 fast=3,4,.6,-1 fast=2,4,.5,-1 fast=2,2,0,-1"),
    "rough": ("rough", RAMP, 0, (1,), "fast=2,4,1,-1 fast=2,4,.7,-1 fast=1.5,4,.5,-1 fast=1,4,.5,-1 fast=1,2,0,-1"),
    "spike": ("noise", SPIKE, 0, (.5,), "fast=2,4,2,6 fast=1,4,1.3,3.9 fast=.5,4,1,3"),
}


def vtk_side(raw, opacity, shade, work, tag):
    """In a process of its own: reads lines `mapper step distance views`, answers with one JSON line each."""
    import numpy as np
    import vtk
    from vtk.util import numpy_support
    image = vtk.vtkImageData()
    image.SetDimensions(N, N, N)
    values = numpy_support.numpy_to_vtk(np.fromfile(raw, np.float32))
    image.GetPointData().SetScalars(values)
    colour, alpha, prop = vtk.vtkColorTransferFunction(), vtk.vtkPiecewiseFunction(), vtk.vtkVolumeProperty()
    for p in COLOUR:
        colour.AddRGBPoint(*p)
    for p in opacity:
        alpha.AddPoint(*p)
    prop.SetColor(colour)
    prop.SetScalarOpacity(alpha)
    prop.SetInterpolationTypeToLinear()
    prop.SetScalarOpacityUnitDistance(N / 128)
    prop.SetShade(shade)
    prop.SetAmbient(.2)
    prop.SetDiffuse(.7)
    prop.SetSpecular(.2)
    prop.SetSpecularPower(20)
    scenes = {}

    def scene(kind, step, distance):
        if (kind, step, distance) in scenes:
            return scenes[kind, step, distance]
        scenes.clear()
        if kind == "cpu":
            mapper = vtk.vtkFixedPointVolumeRayCastMapper()
            mapper.SetNumberOfThreads(2)
            mapper.SetMinimumImageSampleDistance(distance)
            mapper.SetMaximumImageSampleDistance(distance)
            mapper.SetInteractiveSampleDistance(step)
        else:
            mapper = vtk.vtkOpenGLGPUVolumeRayCastMapper()
            mapper.SetUseJittering(0)
            mapper.SetMaxMemoryInBytes(8 << 30)
            mapper.SetMaxMemoryFraction(1)
        mapper.SetImageSampleDistance(distance)
        mapper.SetAutoAdjustSampleDistances(0)
        mapper.SetLockSampleDistanceToInputSpacing(0)
        mapper.SetSampleDistance(step)
        mapper.SetInputData(image)
        volume, renderer, window = vtk.vtkVolume(), vtk.vtkRenderer(), vtk.vtkRenderWindow()
        volume.SetMapper(mapper)
        volume.SetProperty(prop)
        renderer.SetBackground(0, 0, 0)
        renderer.AddVolume(volume)
        window.SetOffScreenRendering(1)
        window.SetMultiSamples(0)
        window.SetSize(WIDTH, HEIGHT)
        window.AddRenderer(renderer)
        scenes[kind, step, distance] = (renderer, window)
        return renderer, window

    def draw(renderer, window, azimuth):
        camera, c = renderer.GetActiveCamera(), (N - 1) / 2
        camera.SetViewAngle(30)
        camera.SetFocalPoint(c, c, c)
        camera.SetPosition(c, c - 2.7 * N, c)
        camera.SetViewUp(0, 0, 1)
        camera.Azimuth(azimuth)
        camera.Elevation(20)
        camera.OrthogonalizeViewUp()
        camera.SetClippingRange(N, 5 * N)
        window.Render()
        window.WaitForCompletion()

    def grab(window):
        shot = vtk.vtkWindowToImageFilter()
        shot.SetInput(window)
        shot.ReadFrontBufferOff()
        shot.Update()
        return numpy_support.vtk_to_numpy(shot.GetOutput().GetPointData().GetScalars()).astype(np.int16)

    def error(a, b):
        covered = ((a > 0) | (b > 0)).any(-1)
        return float(np.sqrt(((a[covered] - b[covered]).astype(float) ** 2).mean()))

    converged = {}

    def truth(kind):
        path = f"{work}/vtk-{tag}-{kind}.npy"
        if kind not in converged:
            if not os.path.exists(path):
                window = scene(kind, .1, 1.)
                draw(*window, 30)
                np.save(path, grab(window[1]))
            converged[kind] = np.load(path)
        return converged[kind]

    for line in sys.stdin:
        kind, step, distance = line.split()
        reference = truth(kind)
        renderer, window = scene(kind, float(step), float(distance))
        draw(renderer, window, 0)
        cpu = []
        for k in range(VIEWS):
            use = resource.getrusage(resource.RUSAGE_SELF)
            before = use.ru_utime + use.ru_stime
            draw(renderer, window, 360 / VIEWS * k + 7)
            use = resource.getrusage(resource.RUSAGE_SELF)
            cpu.append(1e3 * (use.ru_utime + use.ru_stime - before))
        draw(renderer, window, 30)
        print(json.dumps({"what": f"vtk-{kind} step {step} distance {distance}", "cpu_ms": sorted(cpu)[VIEWS // 2],
                          "rmse": error(grab(window), reference)}), flush=True)


def main(table, fields, work, names):
    os.makedirs(work, exist_ok=True)
    env = dict(os.environ, LIBGL_ALWAYS_SOFTWARE="1", LP_NUM_THREADS="2", CATENA_PICTURES=work, CATENA_VIEWS=str(VIEWS))
    for case in names:
        name, _, only = case.partition(":")
        field, opacity, shade, steps, modes = CASES[name]
        raw, begin = f"{fields}/{field}{N}.raw", time.time()
        vtk = subprocess.Popen(["xvfb-run", "-a", sys.executable, __file__, "--vtk", name, raw, work], env=env, stdin=subprocess.PIPE,
                               stdout=subprocess.PIPE, stderr=open(f"{work}/vtk-errors.txt", "w"), text=True)
        ours_env = dict(env, **({"CATENA_SPIKE": "1"} if name == "spike" else {}))
        jobs = [(k, s, d) for k in ("gpu", "cpu") if only in ("", k) for s in steps for d in (1, 2)]
        modes, theirs, ours = modes.split(), [], []
        # alternating: one of theirs, some of ours
        for i, (kind, step, distance) in enumerate(jobs):
            vtk.stdin.write(f"{kind} {step} {distance}\n")
            vtk.stdin.flush()
            answer = vtk.stdout.readline()
            if not answer:
                sys.exit(f"{case}: VTK gave no picture by its {kind} mapper, see {work}/vtk-errors.txt")
            theirs.append(json.loads(answer))
            mine = modes[i * len(modes) // len(jobs):(i + 1) * len(modes) // len(jobs)]
            if mine:
                out = subprocess.run([table, raw, str(N), str(shade), *mine], env=ours_env, capture_output=True, text=True, check=True).stdout
                ours += [{"what": o["what"], "cpu_ms": 2 * o["half_cpu_ms"], "rmse": o["rmse_covered"]} for o in map(json.loads, out.splitlines())]
        vtk.stdin.close()
        vtk.wait()
        print(f"## {case}   ({time.time() - begin:.0f} s)")
        for o in sorted(ours, key=lambda o: o["cpu_ms"]):
            print(f"  ours {o['cpu_ms']:8.0f} ms   {o['rmse']:.2f}   {o['what']}")
        for v in theirs:
            good = [o for o in ours if o["rmse"] <= v["rmse"]]
            best = min(good, key=lambda o: o["cpu_ms"]) if good else None
            line = f"{v['cpu_ms'] / best['cpu_ms']:.1f}x by {best['what']} ({best['rmse']:.2f})" if best else "none of ours is as good"
            print(f"  {v['what']:28s} {v['cpu_ms']:8.0f} ms   {v['rmse']:.2f}   {line}", flush=True)


if __name__ == "__main__":
    if len(sys.argv) > 1 and sys.argv[1] == "--vtk":
        case = CASES[sys.argv[2]]
        vtk_side(sys.argv[3], case[1], case[2], sys.argv[4], sys.argv[2])
    elif len(sys.argv) < 4 or any(c.partition(":")[0] not in CASES for c in sys.argv[4:]):
        sys.exit(__doc__)
    else:
        main(sys.argv[1], sys.argv[2], sys.argv[3], sys.argv[4:] or list(CASES))
