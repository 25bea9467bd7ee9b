// SPDX-License-Identifier: MIT
#include "render/raycast/fast_volume_resources.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "engine/base/clock.h"
#include "engine/field/field_display_range.h"
#include "render/vk/commands.h"

namespace catena::render {

namespace {

bool same_look(const VolumeItem& a, const VolumeItem& b) {
  return a.transfer.colors == b.transfer.colors && a.transfer.extinctions == b.transfer.extinctions && a.is_shaded == b.is_shaded;
}

/// Returns the interval from the first to the last point of a transfer function, and of `values`.
ValueInterval transfer_span(const TransferTable& transfer, ValueInterval values) {
  for (const auto& row : transfer.extinctions) values = {std::min(values.min, row[0]), std::max(values.max, row[0])};
  for (const auto& row : transfer.colors) values = {std::min(values.min, row[0]), std::max(values.max, row[0])};
  return values;
}

ValueInterval active_values(const VolumeItem& item) {
  const double background = item.grid->background();
  const field::GridStats& stats = item.grid->stats();
  ValueInterval values{std::min(stats.min, background), std::max(stats.max, background)};
  // voxels of finer levels may lie far beyond the means that `grid` has of them
  if (item.paged) return active_interval(item.transfer, transfer_span(item.transfer, values), item.is_shaded);
  // outliers look like the end of the display range, unless the transfer function varies among them
  const DisplayRange& shown = display_range(*item.grid);
  const auto changing = [&](double from, double to) { return active_interval(item.transfer, {from, to}, false); };
  if (shown.below.count > 0) {
    const ValueInterval part = changing(values.min, shown.lo);
    values.min = part.min < part.max ? part.min : shown.lo;
  }
  if (shown.above.count > 0) {
    const ValueInterval part = changing(shown.hi, values.max);
    values.max = part.min < part.max ? part.max : shown.hi;
  }
  return active_interval(item.transfer, values, item.is_shaded);
}

constexpr double kMaxChange = 0.03;  // maximum mean change by quantization to codes (quantization_change)

bool shows_values(const VolumeItem& item) {
  struct Answer {
    std::uint64_t version = 0;
    TransferTable transfer;
    bool shade = false, shows = false;
  };
  thread_local Answer last;
  if (last.version == item.grid->version() && last.transfer == item.transfer && last.shade == item.is_shaded) return last.shows;
  const double changed = quantization_change(item.transfer, active_values(item), sample_values(*item.grid), item.grid->domain_length());
  last = {item.grid->version(), item.transfer, item.is_shaded, changed <= kMaxChange};
  return last.shows;
}

}  // namespace

bool FastVolumeResources::can_pack(const vk::Device& device, const field::ScalarGrid& grid) {
  return can_pack_dense(device, grid) || can_pack_as_bricks(grid);
}

bool FastVolumeResources::can_quantize(const VolumeItem& item) {
  return resolves_transfer_function(item.transfer, active_values(item)) && (item.paged || shows_values(item));
}

Outcome FastVolumeResources::prepare(std::span<const VolumeItem> items, const FastSettings& settings, std::uint64_t left, bool loads) {
  const VolumeItem& item = items.front();
  if (item.paged) return prepare_pages(items, std::min(settings.max_bytes, page_pool_bytes(*device_, left, 1)), loads);
  if (pages_) table_ = {};
  pages_.reset();
  const std::int64_t start = now_ns();
  const bool other_grid = !table_ || version_ != item.grid->version();
  const bool other_look = other_grid || !same_look(items_.front(), item);
  if (other_grid) table_ = {};
  items_ = {item};
  const bool gradients = item.is_shaded && settings.smooth_gradients, whole = can_pack_dense(*device_, *item.grid);
  const std::uint64_t bytes = whole ? packed_bytes(*item.grid, gradients) : bricks_ && !other_grid ? bricks_->atlas.bytes() : 0;
  if (bytes > settings.max_bytes) return memory_limit_error(bytes, settings.max_bytes);
  if (!other_look && (!gradients || this->gradients())) return Done{};
  const ValueInterval active = active_values(item);
  const bool other_range = other_grid || !(active == active_);
  active_ = active;
  version_ = item.grid->version();
  ++appearance_version_;
  const std::uint64_t room = left + (bricks_ ? bricks_->atlas.bytes() : 0);
  CATENA_CHECK(whole ? pack_dense(gradients, other_range) : pack_bricks(other_range, std::min(settings.max_bytes, room - room / 16)));
  build_ms_ += ms_since(start);
  return Done{};
}

Outcome FastVolumeResources::pack_dense(bool gradients, bool other_range) {
  bricks_.reset();
  if (other_range) {
    gradients_ = {};
    packed_ = {};
    CATENA_TRY(packed_, make_packed_volume(*device_, *item().grid, active_));
  }
  if (gradients && !gradients_) {
    CATENA_TRY(gradients_, make_gradient_volume(*device_, *item().grid, packed_.codes.per_code));
  }
  const PreintegratedTable table = make_preintegrated(item().transfer, packed_.codes.lo, packed_.codes.per_code, item().is_shaded);
  CATENA_TRY(map_, make_homogeneous_map(*device_, packed_, table.appearance));
  return upload_tables({&table, 1});
}

Outcome FastVolumeResources::pack_bricks(bool other_range, std::uint64_t permitted_bytes) {
  packed_ = {};
  map_ = {};
  gradients_ = {};
  // gradients of bricks are small, so that every shaded volume has them
  const bool gradients = item().is_shaded, scans = !bricks_ || other_range || (gradients && !this->gradients());
  if (scans) {
    bricks_.reset();
    bricks_.emplace();
    bricks_->scan = scan_bricks(*item().grid, active_, gradients);
  }
  BrickScan& scan = bricks_->scan;
  PackedAtlas& atlas = bricks_->atlas;
  const CodeScale codes(scan.range, false);
  const PreintegratedTable table = make_preintegrated(item().transfer, codes.lo, codes.per_code, item().is_shaded);
  bool remapped = false;
  if (!scans) {
    CATENA_TRY(remapped, remap_atlas(*device_, atlas, scan, table.appearance));
  }
  if (!remapped) {
    atlas = {};
    CATENA_TRY(atlas, make_packed_atlas(*device_, *item().grid, scan, codes, table.appearance, permitted_bytes));
  }
  return upload_tables({&table, 1});
}

Outcome FastVolumeResources::prepare_pages(std::span<const VolumeItem> items, std::uint64_t permitted_bytes, bool loads) {
  const auto shows = [](const std::shared_ptr<const field::PagedGrid>& grid, const VolumeItem& item) {
    return grid->version() == item.paged->version();
  };
  const bool other_grid = !pages_ || !std::ranges::equal(pages_->grids(), items, shows);
  if (other_grid) {
    const std::int64_t start = now_ns();
    bricks_.reset();
    pages_.reset();
    packed_ = {};
    map_ = {};
    gradients_ = {};
    ChannelGrids grids;
    for (const VolumeItem& item : items) grids.push_back(item.paged);
    CATENA_TRY(pages_, PagedVolume::create(*device_, std::move(grids), PageFormat::codes, permitted_bytes));
    build_ms_ += ms_since(start);
  }
  const bool other_look = other_grid || !std::ranges::equal(items_, items, same_look);
  items_.assign(items.begin(), items.end());
  if (other_look) {
    ChannelCodes codes;
    std::vector<PreintegratedTable> tables;
    std::vector<CodeAppearance> appearances;
    for (const VolumeItem& item : items) {
      const ValueInterval active = active_values(item);
      const bool has_holes = item.paged->source().type().name.starts_with("float");
      // cells of the finest level at the ends of the active interval may reach to any value
      const field::GridStats& stats = item.grid->stats();
      const ValueInterval all{std::min(active.min, double(stats.min)), std::max(active.max, double(stats.max))};
      codes.emplace_back(clip_outliers(all, *item.grid, active), has_holes);
      codes.back().is_dithered = !item.is_shaded && !shows_values(item);
      tables.push_back(make_preintegrated(item.transfer, codes.back().lo, codes.back().per_code, item.is_shaded));
      appearances.push_back(tables.back().appearance);
    }
    CATENA_CHECK(pages_->set_codes(std::move(codes), std::move(appearances)));
    CATENA_CHECK(upload_tables(tables));
  }
  if (loads) CATENA_CHECK(pages_->update());
  return Done{};
}

Outcome FastVolumeResources::upload_tables(std::span<const PreintegratedTable> tables) {
  vk::ImageInfo info;
  info.format = VK_FORMAT_R32G32_UINT;
  info.extent = {256, 256 * std::uint32_t(tables.size()), 1};
  info.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  CATENA_TRY(table_, vk::Image::create(*device_, info));
  return vk::upload_planes(*device_, table_, 1, [&](std::uint32_t, std::uint32_t, std::byte* out) {
    for (const PreintegratedTable& table : tables) {
      const auto bytes = std::as_bytes(std::span(table.entries));
      out = std::ranges::copy(bytes, out).out;
    }
  });
}

float FastVolumeResources::gradient_nodes() const { return bricks_ ? float(bricks_->atlas.gradient_nodes) : 0.0f; }

ResidentGrid FastVolumeResources::local_geometry() const {
  const auto wide = [](const field::Index3& i) { return Vec3(i.x, i.y, i.z); };
  if (pages_) return pages_->local_geometry();
  ResidentGrid layout;
  layout.origin = bricks_ ? bricks_->scan.origin : packed_.origin;
  if (bricks_) layout.box_lo = wide(bricks_->scan.box_lo);
  layout.box_hi = bricks_ ? wide(bricks_->scan.box_hi) : wide(packed_.size) - Vec3(1.0);
  return layout;
}

}  // namespace catena::render
