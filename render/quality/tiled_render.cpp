// SPDX-License-Identifier: MIT
#include "render/quality/tiled_render.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>

#include "engine/base/clock.h"
#include "engine/base/result.h"
#include "render/quality/quality.h"

namespace catena::render {
namespace {

constexpr std::uint32_t kMinPiece = 8;  // side of the smallest part of a tile, pixels

/// Samples of one rendered tile.
struct Samples {
  Image8 bytes;
  ImageF32 floats;
  DepthImage depth;
  IdImage ids;
};

std::uint8_t to_byte(float x) { return std::uint8_t(std::lround(255 * std::clamp(x, 0.0f, 1.0f))); }

/// Copies a tile's pixels to their place in the band, for one sample per pixel. `first`: first row of the band, pixels.
void copy_tile(const Samples& from, const TileArea& area, std::uint32_t first, const BandChannels& requested, Band& to) {
  const std::uint32_t dx = area.x - area.render_x, dy = area.y - area.render_y;
  for (std::uint32_t y = 0; y < area.height; ++y) {
    const std::size_t source = std::size_t(y + dy) * area.render_width + dx, target = std::size_t(area.y - first + y) * to.width + area.x;
    const auto copy = [&](const auto& values, auto& out, std::size_t channels) {
      std::copy_n(values.begin() + std::ptrdiff_t(channels * source), channels * area.width,
                  out.begin() + std::ptrdiff_t(channels * target));
    };
    if (requested.bytes) copy(from.bytes.rgba, to.bytes, 4);
    if (requested.floats) copy(from.floats.rgba, to.floats, 4);
    if (requested.depth) copy(from.depth.depth, to.depth, 1);
    if (requested.ids) copy(from.ids.ids, to.ids, 1);
  }
}

/// Returns the mean of n x n straight-alpha samples, averaged with premultiplied alpha.
std::array<float, 4> mean_of(const ImageF32& image, std::uint32_t x, std::uint32_t y, std::uint32_t n) {
  double sum[4] = {};
  for (std::uint32_t j = 0; j < n; ++j)
    for (std::uint32_t i = 0; i < n; ++i) {
      const float* p = image.pixel(x + i, y + j);
      for (int c = 0; c < 3; ++c) sum[c] += double(p[c]) * double(p[3]);
      sum[3] += double(p[3]);
    }
  if (!(sum[3] > 0)) return {};
  return {float(sum[0] / sum[3]), float(sum[1] / sum[3]), float(sum[2] / sum[3]), float(sum[3] / (n * n))};
}

/// Filters a tile's n x n samples per pixel into the band.
void filter(const Samples& from, const TileArea& area, std::uint32_t n, std::uint32_t first, const BandChannels& requested, Band& to) {
  for (std::uint32_t y = 0; y < area.height / n; ++y)
    for (std::uint32_t x = 0; x < area.width / n; ++x) {
      const std::uint32_t sx = x * n + area.x - area.render_x, sy = y * n + area.y - area.render_y;
      const std::size_t target = std::size_t(area.y / n - first + y) * to.width + area.x / n + x;
      if (requested.bytes || requested.floats) {
        const std::array<float, 4> mean = mean_of(from.floats, sx, sy, n);
        for (std::size_t c = 0; c < 4; ++c) {
          if (requested.floats) to.floats[4 * target + c] = mean[c];
          if (requested.bytes) to.bytes[4 * target + c] = to_byte(mean[c]);
        }
      }
      if (!requested.depth && !requested.ids) continue;
      float nearest = std::numeric_limits<float>::infinity();
      std::size_t at = std::size_t(sy) * area.render_width + sx;
      for (std::uint32_t j = 0; j < n; ++j)
        for (std::uint32_t i = 0; i < n; ++i) {
          const std::size_t sample = std::size_t(sy + j) * area.render_width + sx + i;
          if (!(from.depth.depth[sample] < nearest)) continue;
          nearest = from.depth.depth[sample];
          at = sample;
        }
      if (requested.depth) to.depth[target] = nearest;
      if (requested.ids) to.ids[target] = from.ids.ids[at];
    }
}

/// Returns both halves of an area, cut across its longer side at a multiple of n samples, without margins.
std::array<TileArea, 2> halves(const TileArea& area, std::uint32_t n) {
  std::array<TileArea, 2> both{area, area};
  const bool along_x = area.width >= area.height;
  const std::uint32_t size = along_x ? area.width : area.height, first = size / n / 2 * n;
  (along_x ? both[0].width : both[0].height) = first;
  (along_x ? both[1].width : both[1].height) = size - first;
  (along_x ? both[1].x : both[1].y) += first;
  for (TileArea& half : both) {
    half.render_x = half.x;
    half.render_y = half.y;
    half.render_width = half.width;
    half.render_height = half.height;
  }
  return both;
}

void resize(Band& band, const BandChannels& requested) {
  const std::size_t pixels = std::size_t(band.width) * band.height;
  if (requested.bytes) band.bytes.resize(4 * pixels);
  if (requested.floats) band.floats.resize(4 * pixels);
  if (requested.depth) band.depth.resize(pixels);
  if (requested.ids) band.ids.resize(pixels);
}

Result<Samples> read(Renderer& renderer, const BandChannels& requested, bool floats, bool filtered) {
  Samples samples;
  if (floats) {
    CATENA_TRY(samples.floats, renderer.read_back_float());
    if (requested.bytes && !filtered) {
      samples.bytes.rgba.resize(samples.floats.rgba.size());
      std::transform(samples.floats.rgba.begin(), samples.floats.rgba.end(), samples.bytes.rgba.begin(), to_byte);
    }
  } else if (requested.bytes) {
    CATENA_TRY(samples.bytes, renderer.read_back());
  }
  if (requested.depth || (requested.ids && filtered)) {
    CATENA_TRY(samples.depth, renderer.read_depth());
  }
  if (requested.ids) {
    CATENA_TRY(samples.ids, renderer.read_ids());
  }
  return samples;
}

Outcome draw_timed(Renderer& renderer, const FramePacket& packet, const RenderSettings& settings, RenderTimes& times) {
  const RenderTimer clock(renderer);
  const std::int64_t start = now_ns();
  CATENA_CHECK(renderer.draw(packet, settings));
  times.wall_ms += ms_since(start);
  times.render_ms += clock.elapsed_ms();
  return Done{};
}

/// Renders the packed image of several eyes in one piece, as one band.
Result<RenderTimes> draw_packed(Renderer& renderer, const FramePacket& packet, const RenderSettings& base_settings,
                                const BandChannels& requested, const std::function<Outcome(const Band&)>& on_band) {
  CATENA_ASSERT(!requested.depth && !requested.ids);
  RenderSettings settings = base_settings;
  settings.float_image = requested.floats;
  settings.waits_for_pages = true;
  RenderTimes times;
  CATENA_CHECK(draw_timed(renderer, packet, settings, times));
  if (!on_band) return times;
  CATENA_TRY(Samples samples, read(renderer, requested, settings.float_image, false));
  const PackedSize size = packed_size(packet.packing, packet.view_count(), packet.width, packet.height);
  Band band{
      std::uint32_t(size.width), 0, std::uint32_t(size.height), std::move(samples.bytes.rgba), std::move(samples.floats.rgba), {}, {}};
  CATENA_CHECK(on_band({band.width, 0, 0, {}, {}, {}, {}}));
  CATENA_CHECK(on_band(band));
  return times;
}

}  // namespace

Result<RenderTimes> render_tiled(Renderer& renderer, const FramePacket& whole, const RenderSettings& base_settings, const TilePlan& plan,
                                 const BandChannels& requested, const std::function<Outcome(const Band&)>& on_band) {
  if (whole.view_count() > 0 && whole.packing != Packing::single) {
    CATENA_ASSERT(plan.count() == 1 && plan.antialias == 1);
    return draw_packed(renderer, whole, base_settings, requested, on_band);
  }
  // a single eye is rendered as an ordinary view
  std::optional<FramePacket> one;
  if (!whole.eyes.empty()) one = whole.first_view();
  const FramePacket& packet = one ? *one : whole;
  CATENA_ASSERT(packet.width == plan.width && packet.height == plan.height);
  const std::uint32_t n = plan.antialias;
  RenderSettings settings = base_settings;
  settings.float_image = requested.floats || (requested.bytes && n > 1);
  settings.waits_for_pages = true;
  RenderTimes times;
  Band band;
  band.width = plan.width;
  // Renders an area, in pieces if the pages of a volume do not fit into the device's memory. Those have no margin: every pixel is marched.
  const std::function<Outcome(const TileArea&, RenderSettings)> draw_area = [&](const TileArea& area, RenderSettings how) -> Outcome {
    const bool is_whole = plan.count() == 1 && n == 1 && area.width == plan.width && area.height == plan.height;
    const std::uint32_t longer = std::max(area.width, area.height);
    how.divides_for_pages = longer >= 2 * kMinPiece * n;
    CATENA_CHECK(draw_timed(renderer, is_whole ? packet : make_tile_packet(packet, plan, area), how, times));
    if (how.divides_for_pages && renderer.paging().finest_level > 0) {
      if (how.fast) how.fast->spacing = 1;
      for (const TileArea& half : halves(area, n)) CATENA_CHECK(draw_area(half, how));
      return Done{};
    }
    if (!on_band) return Done{};
    CATENA_TRY(const Samples samples, read(renderer, requested, how.float_image, n > 1));
    if (n == 1) {
      copy_tile(samples, area, band.y, requested, band);
    } else {
      filter(samples, area, n, band.y, requested, band);
    }
    return Done{};
  };
  for (std::uint32_t row = 0; row < plan.rows(); ++row) {
    band.y = plan.area(0, row).y / n;
    band.height = plan.area(0, row).height / n;
    if (on_band) resize(band, requested);
    for (std::uint32_t column = 0; column < plan.columns(); ++column) {
      CATENA_CHECK(draw_area(plan.area(column, row), settings));
      if (!on_band) continue;
      CATENA_CHECK(on_band({band.width, band.y, 0, {}, {}, {}, {}}));
    }
    if (on_band) CATENA_CHECK(on_band(band));
  }
  return times;
}

}  // namespace catena::render
