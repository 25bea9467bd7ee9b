// SPDX-License-Identifier: MIT
#include "render/frame/tiles.h"

#include <algorithm>
#include <numeric>

#include "engine/base/result.h"

namespace catena::render {
namespace {

// wide and low, so that the row of tiles assembled on the host stays small
constexpr std::uint32_t kTileWidth = 2048, kTileHeight = 512;

}  // namespace

TileArea TilePlan::area(std::uint32_t column, std::uint32_t row) const {
  TileArea a;
  a.x = column * tile_width;
  a.y = row * tile_height;
  a.width = std::min(tile_width, samples_x() - a.x);
  a.height = std::min(tile_height, samples_y() - a.y);
  a.render_x = a.x - std::min(a.x, margin);
  a.render_y = a.y - std::min(a.y, margin);
  a.render_width = std::min(a.x + a.width + margin, samples_x()) - a.render_x;
  a.render_height = std::min(a.y + a.height + margin, samples_y()) - a.render_y;
  return a;
}

TilePlan plan_tiles(std::uint32_t width, std::uint32_t height, std::uint32_t antialias, std::uint32_t tile, bool needs_ray_grids,
                    std::uint32_t max_side) {
  CATENA_ASSERT(width > 0 && height > 0 && antialias > 0 && max_side >= 2048);
  TilePlan plan{width, height, antialias, 0, 0, needs_ray_grids ? kRayGridMargin : 0};
  const std::uint64_t samples = std::uint64_t(plan.samples_x()) * plan.samples_y();
  if (tile == 0 && samples <= kMaxUntiledSamples && plan.samples_x() <= max_side && plan.samples_y() <= max_side) {
    plan.tile_width = plan.samples_x();
    plan.tile_height = plan.samples_y();
    plan.margin = 0;
    return plan;
  }
  const std::uint32_t step = std::lcm(kTileAlignment, antialias);
  const auto side = [&](std::uint32_t wanted) {
    const std::uint32_t largest = max_side - 2 * plan.margin;
    return std::max(step, std::min(wanted, largest) / step * step);
  };
  plan.tile_width = side(tile ? tile : kTileWidth);
  plan.tile_height = side(tile ? tile : kTileHeight);
  return plan;
}

FramePacket make_tile_packet(const FramePacket& packet, const TilePlan& plan, const TileArea& area) {
  FramePacket part = packet;
  part.width = area.render_width;
  part.height = area.render_height;
  const FrustumWindow& whole = packet.view.window;
  const double x = (whole.right - whole.left) / plan.samples_x(), y = (whole.top - whole.bottom) / plan.samples_y();
  part.view.window.left = whole.left + x * area.render_x;
  part.view.window.right = whole.left + x * (area.render_x + area.render_width);
  part.view.window.top = whole.top - y * area.render_y;
  part.view.window.bottom = whole.top - y * (area.render_y + area.render_height);
  part.overlay.frame = {double(area.render_x), double(area.render_y), double(plan.samples_x()), double(plan.samples_y())};
  return part;
}

}  // namespace catena::render
