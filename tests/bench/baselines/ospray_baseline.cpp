// SPDX-License-Identifier: MIT
/// OSPRay's renderer `scivis` as a peer of volume_peers.py (protocol.h). Not part of Catena's build; with OSPRay 3.1 in PREFIX and Catena's
/// preset release built:
///   g++ -std=c++20 -O2 -I. -IPREFIX/include tests/bench/baselines/ospray_baseline.cpp -LPREFIX/lib -Wl,-rpath,PREFIX/lib -lospray
///     build/release/libcatena_engine_base.a -ljsoncpp -lfmt -ltbb -o ospray_peer
/// mode: samplingRate=R pixelSamples=N [minContribution=C] [lights=1|2]      rays through the pixels' centres (filter `point`), two threads
/// The volume is `structuredRegular`; its values are scaled to 0 .. kScale, because scivis does not shade gradients below 1e-3. Ambient
/// light 0.2; a directional light of 0.7 along the view axis and, with lights=2, an opposite one, because scivis shades one side only (the
/// second takes 4 to 7 % of a shaded image's time). Volumes have no highlight.
#include <ospray/ospray_cpp.h>
#include <ospray/ospray_cpp/ext/rkcommon.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <numbers>
#include <sstream>

#include "tests/bench/baselines/protocol.h"

namespace {

using namespace catena;
using rkcommon::math::vec2f;
using rkcommon::math::vec3f;
using rkcommon::math::vec3i;
using rkcommon::math::vec3ul;

constexpr float kScale = 1e4f;

vec3f vec(const Vec3& v) { return {float(v.x), float(v.y), float(v.z)}; }

/// Smallest number of uniform nodes from lo to hi, up to `maximum`, that match all points within a thousandth of the node distance.
int nodes_for(const std::vector<std::vector<double>>& points, double lo, double hi, int minimum, int maximum) {
  for (int n = minimum; n < maximum; ++n)
    if (std::all_of(points.begin(), points.end(), [&](const auto& p) {
          const double at = (p[0] - lo) / (hi - lo) * (n - 1);
          return std::abs(at - std::round(at)) < 1e-3;
        }))
      return n;
  return maximum;
}

class OsprayPeer : public peers::Baseline {
 public:
  explicit OsprayPeer(const peers::Case& given) : given_(given), renderer_("scivis"), camera_("perspective") {
    const auto [minimum, maximum] = std::minmax_element(given.values.begin(), given.values.end());
    // the table ends at the last point and is constant beyond it
    double lo = std::min(given.opacity.front()[0], given.color.front()[0]), hi = std::max(given.opacity.back()[0], given.color.back()[0]);
    const double scale = double(kScale) / (double(*maximum) - double(*minimum));
    values_ = given.values;
    for (float& v : values_) v = float((double(v) - double(*minimum)) * scale);

    ospray::cpp::Volume volume("structuredRegular");
    const vec3ul dims(std::size_t(given.dims[0]), std::size_t(given.dims[1]), std::size_t(given.dims[2]));
    volume.setParam("data", ospray::cpp::SharedData(values_.data(), dims));
    volume.setParam("gridOrigin", vec3f(0.f));
    volume.setParam("gridSpacing", vec3f(1.f));
    volume.commit();

    std::vector<vec3f> colours;
    const int colour_nodes = nodes_for(given.color, lo, hi, 2, 1024), opacity_nodes = nodes_for(given.opacity, lo, hi, 256, 4096);
    for (int i = 0; i < colour_nodes; ++i) {
      const double value = std::lerp(lo, hi, double(i) / (colour_nodes - 1));
      std::size_t k = 1;
      while (k + 1 < given.color.size() && given.color[k][0] <= value) ++k;
      const auto &a = given.color[k - 1], &b = given.color[k];
      const double f = std::clamp((value - a[0]) / (b[0] - a[0]), 0.0, 1.0);
      colours.emplace_back(float(std::lerp(a[1], b[1], f)), float(std::lerp(a[2], b[2], f)), float(std::lerp(a[3], b[3], f)));
    }
    std::vector<float> extinctions;
    for (int i = 0; i < opacity_nodes; ++i)
      extinctions.push_back(float(given.extinction(std::lerp(lo, hi, double(i) / (opacity_nodes - 1)))));
    const float densest = std::max(1e-6f, *std::max_element(extinctions.begin(), extinctions.end()));
    for (float& e : extinctions) e /= densest;  // scales opacities to 0..1
    ospray::cpp::TransferFunction transfer("piecewiseLinear");
    transfer.setParam("color", ospray::cpp::CopiedData(colours));
    transfer.setParam("opacity", ospray::cpp::CopiedData(extinctions));
    transfer.setParam("value", rkcommon::math::range1f(float((lo - double(*minimum)) * scale), float((hi - double(*minimum)) * scale)));
    transfer.commit();

    ospray::cpp::VolumetricModel model(volume);
    model.setParam("transferFunction", transfer);
    model.setParam("densityScale", densest);
    model.setParam("gradientShadingScale", given.is_shaded ? 1.f : 0.f);
    model.commit();
    ospray::cpp::Group group;
    group.setParam("volume", ospray::cpp::CopiedData(model));
    group.commit();
    ospray::cpp::Instance instance(group);
    instance.commit();
    world_.setParam("instance", ospray::cpp::CopiedData(instance));

    camera_.setParam("aspect", float(given.width) / float(given.height));
    camera_.setParam("fovy", float(given.fovy_deg));
    camera_.setParam("up", vec3f(0, 0, 1));
    frame_ = ospray::cpp::FrameBuffer(given.width, given.height, OSP_FB_RGBA32F, OSP_FB_COLOR);
    frame_.commit();
  }

  Outcome set_mode(const std::string& mode, double) override {
    std::map<std::string, double> wanted{{"samplingRate", 1}, {"pixelSamples", 1}, {"minContribution", 0.001}, {"lights", 2}};
    std::istringstream words(mode);
    for (std::string word; words >> word;) {
      const auto equals = word.find('=');
      const auto key = wanted.find(word.substr(0, equals));
      if (equals == std::string::npos || key == wanted.end())
        return Error{mode + ": expected samplingRate=R pixelSamples=N [minContribution=C] [lights=1|2]"};
      key->second = std::atof(word.c_str() + equals + 1);
    }
    renderer_.setParam("volumeSamplingRate", float(wanted["samplingRate"]));
    renderer_.setParam("pixelSamples", int(wanted["pixelSamples"]));
    renderer_.setParam("minContribution", float(wanted["minContribution"]));
    renderer_.setParam("pixelFilter", std::uint32_t(OSP_PIXELFILTER_POINT));
    renderer_.setParam("backgroundColor", rkcommon::math::vec4f(0.f));
    renderer_.commit();
    lights_ = int(wanted["lights"]);
    return Done{};
  }

  Outcome draw(double azimuth_deg) override {
    const Vec3 eye = given_.camera_position(azimuth_deg), ahead = given_.center() - eye;
    camera_.setParam("position", vec(eye));
    camera_.setParam("direction", vec(ahead));
    camera_.commit();
    if (given_.is_shaded || !committed_) {
      std::vector<ospray::cpp::Light> lights;
      lights.emplace_back("ambient");
      lights.back().setParam("intensity", 0.2f);
      for (int k = 0; k < (given_.is_shaded ? lights_ : 0); ++k) {
        lights.emplace_back("distant");
        lights.back().setParam("direction", vec(k == 0 ? ahead : -ahead));
        lights.back().setParam("intensity", float(0.7 * std::numbers::pi));
      }
      for (auto& light : lights) light.commit();
      world_.setParam("light", ospray::cpp::CopiedData(lights));
      world_.commit();
      committed_ = true;
    }
    frame_.renderFrame(renderer_, camera_, world_).wait();
    return Done{};
  }

  Result<std::vector<std::uint8_t>> read_image() override {
    const auto row = std::size_t(given_.width) * 4;
    std::vector<std::uint8_t> out(row * std::size_t(given_.height));
    auto* pixels = static_cast<float*>(frame_.map(OSP_FB_COLOR));
    for (std::size_t y = 0; y < std::size_t(given_.height); ++y)
      std::transform(pixels + (std::size_t(given_.height) - 1 - y) * row, pixels + (std::size_t(given_.height) - y) * row,
                     out.data() + y * row, [](float v) { return std::uint8_t(std::lround(255 * std::clamp(v, 0.f, 1.f))); });
    frame_.unmap(pixels);
    return out;
  }

 private:
  const peers::Case& given_;
  std::vector<float> values_;
  ospray::cpp::Renderer renderer_;
  ospray::cpp::Camera camera_;
  ospray::cpp::World world_;
  ospray::cpp::FrameBuffer frame_;
  int lights_ = 2;
  bool committed_ = false;
};

}  // namespace

int main(int argc, char** argv) {
  if (ospLoadModule("cpu") != OSP_NO_ERROR) {
    fmt::print(stderr, "OSPRay: its module cpu cannot be loaded\n");
    return 1;
  }
  std::string failure;  // error message of OSPRay's callback
  int code = 0;
  {
    ospray::cpp::Device device("cpu");
    device.setParam("numThreads", 2);
    ospDeviceSetErrorCallback(
        device.handle(), [](void* to, OSPError, const char* text) { *static_cast<std::string*>(to) = text; }, &failure);
    device.commit();
    device.setCurrent();
    code = peers::run_baseline(argc, argv, [&](const peers::Case& given) -> Result<std::unique_ptr<peers::Baseline>> {
      std::unique_ptr<peers::Baseline> peer = std::make_unique<OsprayPeer>(given);
      if (!failure.empty()) return Error{"OSPRay: " + failure};
      return peer;
    });
  }
  ospShutdown();
  return code;
}
