// SPDX-License-Identifier: MIT
/// VTK's GPU mapper on a GPU without a display, as a peer of volume_peers.py (protocol.h). Not part of Catena's build; with Debian's
/// libvtk9-dev, libegl-dev and Catena's preset release built:
///   g++ -std=c++20 -O2 -I. -I/usr/include/vtk-9.1 tests/bench/baselines/vtk_egl_baseline.cpp build/release/libcatena_engine_base.a
///   -rdynamic -lEGL -lGLEW
///     -ljsoncpp -lfmt -ltbb -lvtkRenderingVolumeOpenGL2-9.1 -lvtkRenderingVolume-9.1 -lvtkRenderingOpenGL2-9.1 -lvtkRenderingCore-9.1
///     -lvtkCommonExecutionModel-9.1 -lvtkCommonDataModel-9.1 -lvtkCommonCore-9.1 -lvtksys-9.1 -o vtk_egl_peer
/// mode: "gpu STEP IMAGE_DISTANCE", as vtk_peer.py: step in voxels, distance of rays in pixels, neither jittered nor adjusted.
/// The note names the device. An image is finished after glFinish.
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <dlfcn.h>
#include <vtkAutoInit.h>
#include <vtkCamera.h>
#include <vtkColorTransferFunction.h>
#include <vtkCommand.h>
#include <vtkFloatArray.h>
#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkImageData.h>
#include <vtkLight.h>
#include <vtkLightCollection.h>
#include <vtkNew.h>
#include <vtkOpenGLGPUVolumeRayCastMapper.h>
#include <vtkPiecewiseFunction.h>
#include <vtkPointData.h>
#include <vtkRenderer.h>
#include <vtkUnsignedCharArray.h>
#include <vtkVolume.h>
#include <vtkVolumeProperty.h>

#include <cstdio>

#include "tests/bench/baselines/protocol.h"

VTK_MODULE_INIT(vtkRenderingOpenGL2);
VTK_MODULE_INIT(vtkRenderingVolumeOpenGL2);

// Debian's VTK loads OpenGL by GLEW's glewInit, which needs an X display. This replacement, found before it, does not.
extern "C" unsigned glewInit() {
  constexpr unsigned kNoDisplay = 4;
  const auto all = reinterpret_cast<unsigned (*)()>(dlsym(RTLD_NEXT, "glewInit"));
  const unsigned result = all ? all() : 1;
  return result == kNoDisplay ? 0 : result;
}

namespace {

using namespace catena;

/// Makes an OpenGL context without a window current, on the first device that supports it.
Outcome make_context() {
  std::vector<EGLDisplay> displays;
  const auto list = reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(eglGetProcAddress("eglQueryDevicesEXT"));
  const auto of = reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(eglGetProcAddress("eglGetPlatformDisplayEXT"));
  EGLDeviceEXT devices[16];
  EGLint count = 0;
  if (list && of && list(16, devices, &count))
    for (EGLint i = 0; i < count; ++i) displays.push_back(of(EGL_PLATFORM_DEVICE_EXT, devices[i], nullptr));
  displays.push_back(eglGetDisplay(EGL_DEFAULT_DISPLAY));
  for (const EGLDisplay display : displays) {
    if (display == EGL_NO_DISPLAY || !eglInitialize(display, nullptr, nullptr) || !eglBindAPI(EGL_OPENGL_API)) continue;
    const EGLint wanted[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_ALPHA_SIZE, 8, EGL_NONE};
    EGLConfig config;
    EGLint found = 0;
    if (!eglChooseConfig(display, wanted, &config, 1, &found) || found == 0) continue;
    const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_CONTEXT_MINOR_VERSION, 2, EGL_NONE},
                 size[] = {EGL_WIDTH, 16, EGL_HEIGHT, 16, EGL_NONE};
    const EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, version);
    const EGLSurface surface = eglCreatePbufferSurface(display, config, size);
    if (context != EGL_NO_CONTEXT && eglMakeCurrent(display, surface, surface, context)) return Done{};
  }
  return Error{"no device makes a context of OpenGL 3.2"};
}

class VtkPeer : public peers::Baseline {
 public:
  explicit VtkPeer(const peers::Case& given) : given_(given) {
    values_->SetArray(const_cast<float*>(given.values.data()), vtkIdType(given.values.size()), 1);
    image_->SetDimensions(given.dims.data());
    image_->GetPointData()->SetScalars(values_);
    vtkNew<vtkColorTransferFunction> colour;
    vtkNew<vtkPiecewiseFunction> alpha;
    for (const auto& p : given.color) colour->AddRGBPoint(p[0], p[1], p[2], p[3]);
    for (const auto& p : given.opacity) alpha->AddPoint(p[0], p[1]);
    property_->SetColor(colour);
    property_->SetScalarOpacity(alpha);
    property_->SetInterpolationTypeToLinear();
    property_->SetScalarOpacityUnitDistance(given.unit);
    property_->SetShade(given.is_shaded);
    property_->SetAmbient(0.2);
    property_->SetDiffuse(0.7);
    property_->SetSpecular(0.2);
    property_->SetSpecularPower(80);  // power of the half vector, equivalent to 20 of the reflected ray
    renderer_->SetBackground(0, 0, 0);
    renderer_->SetBackgroundAlpha(0);
    // without a window, these callbacks report the context as current
    window_->SetReadyForRendering(true);
    window_->AddObserver(vtkCommand::WindowIsCurrentEvent, this, &VtkPeer::is_current);
    window_->SetOffScreenRendering(1);
    window_->SetFrameBlitModeToNoBlit();
    window_->SetAlphaBitPlanes(1);
    window_->SetMultiSamples(0);
    window_->SetSize(given.width, given.height);
    window_->AddRenderer(renderer_);
    window_->SetIsCurrent(true);
    window_->OpenGLInit();
    renderer_->CreateLight();
    vtkLight::SafeDownCast(renderer_->GetLights()->GetItemAsObject(0))->SetAmbientColor(1, 1, 1);
  }

  Outcome set_mode(const std::string& mode, double) override {
    double step = 0, distance = 0;
    if (std::sscanf(mode.c_str(), "gpu %lf %lf", &step, &distance) != 2) return Error{mode + ": expected gpu, a step and a distance"};
    vtkNew<vtkOpenGLGPUVolumeRayCastMapper> mapper;
    mapper->SetUseJittering(0);
    mapper->SetMaxMemoryInBytes(vtkIdType(8) << 30);
    mapper->SetMaxMemoryFraction(1);
    mapper->SetImageSampleDistance(float(distance));
    mapper->SetAutoAdjustSampleDistances(0);
    mapper->SetLockSampleDistanceToInputSpacing(0);
    mapper->SetSampleDistance(float(step));
    mapper->SetInputData(image_);
    vtkNew<vtkVolume> volume;
    volume->SetMapper(mapper);
    volume->SetProperty(property_);
    renderer_->RemoveAllViewProps();
    renderer_->AddVolume(volume);
    return Done{};
  }

  Outcome draw(double azimuth_deg) override {
    vtkCamera* camera = renderer_->GetActiveCamera();
    const double longest = std::max({given_.dims[0], given_.dims[1], given_.dims[2]});
    const Vec3 middle = given_.center(), eye = given_.camera_position(azimuth_deg);
    camera->SetViewAngle(given_.fovy_deg);
    camera->SetFocalPoint(middle.x, middle.y, middle.z);
    camera->SetPosition(eye.x, eye.y, eye.z);
    camera->SetViewUp(0, 0, 1);
    camera->OrthogonalizeViewUp();
    camera->SetClippingRange(0.1 * longest, 10 * longest);
    window_->Render();
    window_->WaitForCompletion();
    return Done{};
  }

  Result<std::vector<std::uint8_t>> read_image() override {
    vtkNew<vtkUnsignedCharArray> pixels;
    window_->GetRGBACharPixelData(0, 0, given_.width - 1, given_.height - 1, 0, pixels);
    const std::size_t row = 4 * std::size_t(given_.width), height = std::size_t(given_.height);
    std::vector<std::uint8_t> out(row * height);
    for (std::size_t y = 0; y < height; ++y) std::copy_n(pixels->GetPointer(0) + row * (height - 1 - y), row, out.data() + row * y);
    return out;
  }

  std::string note() override {
    const std::string all = window_->ReportCapabilities();
    const std::size_t at = all.find("renderer string:");
    return at == std::string::npos ? "" : all.substr(at + 16, all.find('\n', at) - at - 16);
  }

 private:
  void is_current(vtkObject*, unsigned long, void* answer) { *static_cast<bool*>(answer) = true; }

  const peers::Case& given_;
  vtkNew<vtkFloatArray> values_;
  vtkNew<vtkImageData> image_;
  vtkNew<vtkVolumeProperty> property_;
  vtkNew<vtkRenderer> renderer_;
  vtkNew<vtkGenericOpenGLRenderWindow> window_;
};

}  // namespace

int main(int argc, char** argv) {
  return peers::run_baseline(argc, argv, [](const peers::Case& given) -> Result<std::unique_ptr<peers::Baseline>> {
    CATENA_CHECK(make_context());
    return std::unique_ptr<peers::Baseline>(std::make_unique<VtkPeer>(given));
  });
}
