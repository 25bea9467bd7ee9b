// SPDX-License-Identifier: MIT
/// Catena as a peer of volume_peers.py (tests/bench/baselines/protocol.h):   volume_baseline CASE.json
///   mode: error=E | time=MS | draft | balanced | reference[=STEP] | exact=STEP |
///   fast=STEP,SPACING,REFINE_HALF,REFINE_FULL[,smooth][,end=T] (1/255; < 0: nowhere)
/// The settings of error=E and time=MS are chosen once, at the azimuth of the saved image. The note of a reply has the settings, their
/// expected time and error, and the device memory.
#include <cstdio>
#include <cstdlib>

#include "engine/field/grid/grid.h"
#include "render/image/image_error.h"
#include "render/quality/quality.h"
#include "tests/bench/baselines/protocol.h"

namespace {

using namespace catena;

constexpr int kFinePoints = 64;  // points between two opacity points, where opacity is linear and extinction is not

render::FramePacket packet_of(const peers::Case& given) {
  render::VolumeItem item;
  item.grid = field::make_scalar_grid("density", {}, {given.dims[0], given.dims[1], given.dims[2]}, given.values);
  for (const auto& p : given.color) item.transfer.colors.push_back({p[0], p[1], p[2], p[3]});
  for (std::size_t i = 0; i < given.opacity.size(); ++i)
    for (int k = 0; k < (i + 1 < given.opacity.size() ? kFinePoints : 1); ++k) {
      const double value = k == 0 ? given.opacity[i][0] : std::lerp(given.opacity[i][0], given.opacity[i + 1][0], double(k) / kFinePoints);
      item.transfer.extinctions.push_back({value, given.extinction(value)});
    }
  item.is_shaded = given.is_shaded;
  render::FramePacket packet;
  packet.volumes.push_back(item);
  packet.background[3] = 0;
  packet.width = std::uint32_t(given.width);
  packet.height = std::uint32_t(given.height);
  packet.view.fovy_deg = given.fovy_deg;
  packet.view.target = given.center();
  return packet;
}

class Ours : public peers::Baseline {
 public:
  Ours(const peers::Case& given, std::unique_ptr<render::Renderer> renderer)
      : given_(given), renderer_(std::move(renderer)), packet_(packet_of(given)) {}

  Outcome set_mode(const std::string& mode, double azimuth_deg) override {
    note_.clear();
    settings_ = {};
    if (mode.starts_with("error=") || mode.starts_with("time=")) return choose(mode, azimuth_deg);
    if (mode == "draft") {
      settings_ = render::draft_settings();
    } else if (mode == "balanced") {
      settings_ = render::balanced_settings();
    } else if (mode.starts_with("reference")) {
      settings_ = render::reference_settings();
      std::sscanf(mode.c_str(), "reference=%lf", &settings_.step_voxels);
    } else if (std::sscanf(mode.c_str(), "exact=%lf", &settings_.step_voxels) != 1) {
      render::FastSettings f;
      if (std::sscanf(mode.c_str(), "fast=%lf,%u,%lf,%lf", &f.step_voxels, &f.spacing, &f.refine_half_255, &f.refine_full_255) != 4)
        return Error{
            mode +
            ": expected error=E, time=MS, draft, balanced, reference[=STEP], exact=STEP or fast=STEP,SPACING,REFINE_HALF,REFINE_FULL"};
      f.smooth_gradients = mode.find(",smooth") != std::string::npos;
      if (const std::size_t at = mode.find(",end="); at != std::string::npos) f.termination = std::atof(mode.c_str() + at + 5);
      settings_.fast = f;
    }
    return Done{};
  }

  Outcome draw(double azimuth_deg) override {
    packet_.view.position = given_.camera_position(azimuth_deg);
    return renderer_->draw(packet_, settings_);
  }

  Result<std::vector<std::uint8_t>> read_image() override {
    CATENA_TRY(const render::Image8 picture, renderer_->read_back());
    return render::composite_over(picture, {}).rgba;
  }

  std::string note() override {
    const auto counted = renderer_->refined_ray_counts();
    const auto refined = counted ? *counted : std::array<std::uint64_t, 2>{};
    return fmt::format("{}{}, {} and {} rays refined, {:.0f} MiB", note_, render::describe(settings_), refined[0], refined[1],
                       double(renderer_->stats().gpu_bytes) / (1 << 20));
  }

 private:
  Outcome choose(const std::string& mode, double azimuth_deg) {
    using Kind = render::QualityGoal::Kind;
    const Kind kind = mode.starts_with("error=") ? Kind::error : Kind::time;
    packet_.view.position = given_.camera_position(azimuth_deg);
    render::FramePacket seen = packet_;
    seen.background = {0, 0, 0, 1};  // background of the stated errors
    const std::int64_t start = now_ns();
    CATENA_TRY(const render::QualityChoice choice,
               render::choose_quality(*renderer_, seen, {kind, std::atof(mode.c_str() + mode.find('=') + 1)}));
    settings_ = choice.settings;
    note_ = fmt::format("chosen in {:.0f} ms, estimated {:.2f}: ", ms_since(start), choice.estimated_rmse);
    return Done{};
  }

  const peers::Case& given_;
  std::unique_ptr<render::Renderer> renderer_;
  render::FramePacket packet_;
  render::RenderSettings settings_;
  std::string note_;
};

}  // namespace

int main(int argc, char** argv) {
  return peers::run_baseline(argc, argv, [](const peers::Case& given) -> Result<std::unique_ptr<peers::Baseline>> {
    CATENA_TRY(auto renderer, render::Renderer::create({}));
    return std::unique_ptr<peers::Baseline>(std::make_unique<Ours>(given, std::move(renderer)));
  });
}
