#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""VTK as a peer of volume_peers.py (protocol: protocol.h):   vtk_peer.py CASE.json
needs: python3-vtk9, python3-numpy, an X display (xvfb-run -a) and LIBGL_ALWAYS_SOFTWARE=1
mode: MAPPER STEP IMAGE_DISTANCE, MAPPER being gpu (vtkOpenGLGPUVolumeRayCastMapper) or cpu (vtkFixedPointVolumeRayCastMapper, two threads);
step in voxels, distance of rays in pixels. No jitter: step and distance are fixed."""
import json, os, resource, sys, time
import numpy as np
import vtk
from vtk.util import numpy_support


class Scene:
    def __init__(self, path):
        self.case = json.load(open(path))
        self.dims = self.case["dims"]
        raw = np.fromfile(os.path.join(os.path.dirname(path), self.case["raw"]), np.float32)
        self.image = vtk.vtkImageData()
        self.image.SetDimensions(*self.dims)
        self.values = numpy_support.numpy_to_vtk(raw)
        self.image.GetPointData().SetScalars(self.values)
        colour, alpha, self.property = vtk.vtkColorTransferFunction(), vtk.vtkPiecewiseFunction(), vtk.vtkVolumeProperty()
        for p in self.case["colour"]:
            colour.AddRGBPoint(*p)
        for p in self.case["opacity"]:
            alpha.AddPoint(*p)
        self.property.SetColor(colour)
        self.property.SetScalarOpacity(alpha)
        self.property.SetInterpolationTypeToLinear()
        self.property.SetScalarOpacityUnitDistance(self.case["unit"])
        self.property.SetShade(self.case["shade"])
        self.property.SetAmbient(.2)
        self.property.SetDiffuse(.7)
        self.property.SetSpecular(.2)
        self.property.SetSpecularPower(80)  # power of the half vector, equivalent to 20 of the reflected ray
        self.renderer, self.window = vtk.vtkRenderer(), vtk.vtkRenderWindow()
        self.renderer.SetBackground(0, 0, 0)
        self.renderer.SetBackgroundAlpha(0)
        self.window.SetOffScreenRendering(1)
        self.window.SetAlphaBitPlanes(1)
        self.window.SetMultiSamples(0)
        self.window.SetSize(*self.case["size"])
        self.window.AddRenderer(self.renderer)
        # the fixed-point mapper multiplies ambient by the light's ambient colour, which is black by default; the GPU mapper does not
        self.renderer.CreateLight()
        self.renderer.GetLights().GetItemAsObject(0).SetAmbientColor(1, 1, 1)

    def set_mode(self, mode):
        kind, step, distance = mode.split()
        step, distance = float(step), float(distance)
        if kind == "cpu":
            mapper = vtk.vtkFixedPointVolumeRayCastMapper()
            mapper.SetNumberOfThreads(2)
            mapper.SetMinimumImageSampleDistance(distance)
            mapper.SetMaximumImageSampleDistance(distance)
            mapper.SetInteractiveSampleDistance(step)
        elif kind == "gpu":
            mapper = vtk.vtkOpenGLGPUVolumeRayCastMapper()
            mapper.SetUseJittering(0)
            mapper.SetMaxMemoryInBytes(8 << 30)
            mapper.SetMaxMemoryFraction(1)
        else:
            raise ValueError(f"{mode}: expected gpu or cpu, a step and a distance")
        mapper.SetImageSampleDistance(distance)
        mapper.SetAutoAdjustSampleDistances(0)
        mapper.SetLockSampleDistanceToInputSpacing(0)
        mapper.SetSampleDistance(step)
        mapper.SetInputData(self.image)
        volume = vtk.vtkVolume()
        volume.SetMapper(mapper)
        volume.SetProperty(self.property)
        self.renderer.RemoveAllViewProps()
        self.renderer.AddVolume(volume)

    def draw(self, azimuth):
        camera, view, longest = self.renderer.GetActiveCamera(), self.case["view"], max(self.dims)
        x, y, z = ((n - 1) / 2 for n in self.dims)
        camera.SetViewAngle(view["fovy_deg"])
        camera.SetFocalPoint(x, y, z)
        camera.SetPosition(x, y - view["distance"] * longest, z)
        camera.SetViewUp(0, 0, 1)
        camera.Azimuth(azimuth)
        camera.Elevation(view["elevation"])
        camera.OrthogonalizeViewUp()
        camera.SetClippingRange(.1 * longest, 10 * longest)
        self.window.Render()
        self.window.WaitForCompletion()

    def picture(self):
        shot = vtk.vtkWindowToImageFilter()
        shot.SetInput(self.window)
        shot.SetInputBufferTypeToRGBA()
        shot.ReadFrontBufferOff()
        shot.Update()
        width, height = self.case["size"]
        return numpy_support.vtk_to_numpy(shot.GetOutput().GetPointData().GetScalars()).reshape(height, width, 4)[::-1]


def processor_ms():
    use = resource.getrusage(resource.RUSAGE_SELF)
    return 1e3 * (use.ru_utime + use.ru_stime)


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    scene, mode = Scene(sys.argv[1]), None
    for line in sys.stdin:
        try:
            request, cpu, wall = json.loads(line), [], []
            if request["mode"] != mode:
                mode = None
                scene.set_mode(request["mode"])
                mode = request["mode"]
            for _ in range(request.get("warm", 1)):
                scene.draw(request["azimuths"][0] - 3)
            for azimuth in request["azimuths"]:
                used, start = processor_ms(), time.perf_counter()
                scene.draw(azimuth)
                wall.append(1e3 * (time.perf_counter() - start))
                cpu.append(processor_ms() - used)
            np.save(request["picture"], scene.picture())
            answer = {"cpu_ms": cpu, "wall_ms": wall, "picture": request["picture"], "note": ""}
        except (KeyError, ValueError, OSError) as error:
            answer = {"error": str(error)}
        print(json.dumps(answer), flush=True)


if __name__ == "__main__":
    main()
