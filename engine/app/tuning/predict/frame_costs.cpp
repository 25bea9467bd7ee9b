// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <tuple>

#include "engine/app/tuning/predict/cost.h"
#include "engine/base/clock.h"
#include "engine/base/text.h"
#include "engine/field/analytic/analytic.h"
#include "render/frame/tiles.h"
#include "render/passes/pass.h"
#include "render/passes/renderer.h"
#include "render/residency/packed_volume.h"

namespace catena::app {
namespace {

constexpr int kRepeats = 7, kMirrors = 3;
constexpr std::uint32_t kStrips = 12, kLow = 1, kHigh = 8;  // strips per image; rows of a short and of a tall strip

/// Upload time in milliseconds per byte, for a grid of 128^3; the median of several, since newly allocated memory takes longer than memory
/// just freed.
Result<double> mirror_unit(render::vk::Device& device, bool float32) {
  CATENA_TRY(const field::AnyField formula, field::make_analytic("marschner-lobb"));
  CATENA_TRY(const field::AnyField grid, field::try_sample_on_grid(formula, 128, -1, 1));
  std::vector<render::ResidentGrid> held;
  std::vector<double> times;
  for (int k = 0; k < kMirrors; ++k) {
    const std::int64_t start = now_ns();
    CATENA_TRY(render::ResidentGrid mirror, render::make_resident_grid(device, *grid.scalar->grid(), {float32}));
    times.push_back(ms_since(start) / double(mirror.bytes()));
    held.push_back(std::move(mirror));
  }
  std::ranges::sort(times);
  return times[times.size() / 2];
}

/// The grids that the packet's rays, surfaces and slices will have on the device.
Outcome add_mirrors(render::Renderer& renderer, const render::FramePacket& packet, const render::RenderSettings& settings,
                    CostTable& table) {
  if (settings.fast && renderer.can_draw_fast(packet)) {
    const render::VolumeItem& volume = packet.volumes.front();
    CostRow row{"mirror", volume.grid->name(), "packed for the fast raycast", {}, {}};
    if (render::can_pack_dense(renderer.device(), *volume.grid))
      row.expected.bytes = double(render::packed_bytes(*volume.grid, volume.is_shaded && settings.fast->smooth_gradients));
    table.push_back(std::move(row));
  }
  std::set<std::tuple<std::uint64_t, bool>> seen;
  std::optional<double> units[2];  // for 16 and for 32 bits, measured at most one time each
  const auto add = [&](const field::ScalarGrid& grid) -> Outcome {
    const render::ResidencyOptions options = render::residency_options(packet, settings, grid);
    if (!seen.insert({grid.version(), options.use_float32}).second) return Done{};
    std::optional<double>& unit = units[options.use_float32];
    if (!unit) {
      CATENA_TRY(unit, mirror_unit(renderer.device(), options.use_float32));
    }
    CostRow row{"mirror", grid.name(), options.use_float32 ? "32 bits per voxel" : "16 bits per voxel", {}, {}};
    if (const auto bytes = render::resident_image_bytes(renderer.device(), grid, options))
      row.expected = {double(*bytes), *unit * double(*bytes)};
    table.push_back(std::move(row));
    return Done{};
  };
  const auto add_item = [&](const auto& item) -> Outcome {
    CATENA_CHECK(add(*item.grid));
    return item.color_by ? add(*item.color_by->grid) : Done{};
  };
  if (!settings.fast || !renderer.can_draw_fast(packet))
    for (const auto& item : packet.volumes) CATENA_CHECK(add_item(item));
  for (const auto& item : packet.isosurfaces)
    if (item.opacity > 0) CATENA_CHECK(add_item(item));
  for (const auto& item : packet.slices)
    if (item.opacity > 0) CATENA_CHECK(add(*item.grid));
  return Done{};
}

/// Time to render strips of `rows` rows distributed over the image, the faster of two rounds.
Result<double> strips_ms(render::Renderer& renderer, const render::FramePacket& packet, const render::RenderSettings& settings,
                         std::uint32_t rows) {
  const render::TilePlan plan{packet.width, packet.height, 1, packet.width, rows, 0};
  double quickest = 0;
  for (int round = 0; round < 3; ++round) {
    const std::int64_t start = now_ns();
    for (std::uint32_t k = 0; k < kStrips; ++k) {
      const std::uint32_t row = (2 * k + 1) * packet.height / (2 * kStrips) / rows;
      CATENA_CHECK(renderer.draw(render::make_tile_packet(packet, plan, plan.area(0, row)), settings));
    }
    const double ms = ms_since(start);
    // the first round creates pipelines and does not count
    if (round > 0) quickest = round == 1 ? ms : std::min(quickest, ms);
  }
  return quickest;
}

}  // namespace

Outcome add_frame_costs(const render::FramePacket& packet, bool measure, CostTable& table) {
  CATENA_TRY(const std::unique_ptr<render::Renderer> renderer, render::Renderer::create({}));
  const render::RenderSettings settings = render::balanced_settings();
  CATENA_CHECK(add_mirrors(*renderer, packet, settings, table));
  CATENA_TRY(const double high, strips_ms(*renderer, packet, settings, kHigh));
  CATENA_TRY(const double low, strips_ms(*renderer, packet, settings, kLow));
  const double a_row = std::max(0.0, high - low) / (double(kStrips) * (kHigh - kLow));
  const render::RenderStats made = renderer->stats();
  ResourceCost mirrors;
  if (measure) mirrors = {double(made.resident_bytes), made.residency_ms};
  ResourceCost expected{0.0, 0.0};
  for (const CostRow& row : table) {
    if (row.stage != "mirror") continue;
    const auto add = [](std::optional<double>& sum, const std::optional<double>& one) {
      sum = sum && one ? std::optional(*sum + *one) : std::nullopt;
    };
    add(expected.bytes, row.expected.bytes);
    add(expected.ms, row.expected.ms);
  }
  table.push_back({"mirror", "all", fmt::format("{} mirrors", made.resident_grids), expected, mirrors});
  table.push_back({"create", "passes", join_words({made.passes.begin(), made.passes.end()}, made.passes.size()), {}, {}});
  table.push_back({"create", "pipelines", std::to_string(made.pipelines), {}, {}});
  CostRow frame{"frame",
                "all",
                fmt::format("{} x {} pixels, balanced", packet.width, packet.height),
                {{}, low / kStrips + a_row * (packet.height - kLow)},
                {}};
  if (measure) {
    for (int k = 0; k <= kRepeats; ++k) {
      const std::int64_t start = now_ns();
      CATENA_CHECK(renderer->draw(packet, settings));
      const double ms = ms_since(start);
      if (k > 0) frame.measured.ms = frame.measured.ms ? std::min(*frame.measured.ms, ms) : ms;
    }
  }
  table.push_back(std::move(frame));
  return Done{};
}

}  // namespace catena::app
