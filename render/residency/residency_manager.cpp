// SPDX-License-Identifier: MIT
#include "render/residency/residency_manager.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/base/clock.h"

namespace catena::render {
namespace {

std::string size_words(const field::ScalarGrid& grid) {
  const Vec3 n = grid.index_box().hi - grid.index_box().lo + Vec3(1.0);
  const std::array<long, 3> s{std::lround(n.x), std::lround(n.y), std::lround(n.z)};
  return s[0] == s[1] && s[1] == s[2] ? fmt::format("{}^3", s[0]) : fmt::format("{} x {} x {}", s[0], s[1], s[2]);
}

/// Formats bytes as "67 MB" or "0.4 MB".
std::string megabytes(std::uint64_t bytes) {
  const double mb = 1e-6 * double(bytes);
  return mb >= 10 || mb == 0 ? fmt::format("{:.0f} MB", mb) : fmt::format("{:.2g} MB", mb);
}

}  // namespace

std::string GridDownsampling::message() const {
  return fmt::format("{}: {} needs {} of GPU memory, {} are left: drawn at {} resolution", grid, size, megabytes(needed_bytes),
                     megabytes(available_bytes),
                     factor == 2   ? "half"
                     : factor == 4 ? "a quarter of its"
                                   : "an eighth of its");
}

void ResidencyManager::begin_frame(std::uint64_t reserved, std::size_t sharers) {
  ++frame_number_;
  reserved_bytes_ = reserved;
  remaining_sharers_ = std::max<std::size_t>(1, sharers);
  // drops downsampled grids whose full resolution fits now
  std::erase_if(entries_, [this](const auto& item) {
    return item.second.resident->downsample_factor > 1 && item.second.downsampling.needed_bytes <= available_bytes();
  });
}

std::uint64_t ResidencyManager::available_bytes() const {
  const std::uint64_t left = device_.memory_available();
  return left > reserved_bytes_ ? (left - reserved_bytes_) / remaining_sharers_ : 0;
}

Result<std::shared_ptr<const ResidentGrid>> ResidencyManager::get(const field::ScalarGrid& grid, const ResidencyOptions& options) {
  const Key key{grid.version(), options.use_float32, options.layout};
  const auto found = entries_.find(key);
  const bool first_use = found == entries_.end() || found->second.last_used != frame_number_;
  Entry entry;
  if (found != entries_.end()) {
    entry = found->second;
  } else {
    const std::int64_t start = now_ns();
    CATENA_CHECK(build(entry, grid, options));
    build_ms_ += ms_since(start);
  }
  entry.last_used = frame_number_;
  entries_[key] = entry;
  if (first_use && remaining_sharers_ > 1) --remaining_sharers_;
  return entry.resident;
}

Outcome ResidencyManager::build(Entry& entry, const field::ScalarGrid& grid, const ResidencyOptions& options) {
  const auto store = [&entry](ResidentGrid uploaded) {
    entry.resident = std::make_shared<const ResidentGrid>(std::move(uploaded));
    return Done{};
  };
  const std::uint64_t room = available_bytes();
  const auto needed = resident_grid_bytes(device_, grid, options);
  if (needed && *needed <= room) {
    CATENA_TRY(ResidentGrid uploaded, make_resident_grid(device_, grid, options));
    return store(std::move(uploaded));
  }
  const auto voxels = [&] {
    const Vec3 n = grid.index_box().hi - grid.index_box().lo + Vec3(1.0);
    constexpr double kMaxBytes = 1e18;
    return std::uint64_t(std::min(kMaxBytes, n.x * n.y * n.z)) * (options.use_float32 ? 4 : 2);
  };
  entry.downsampling = {grid.name(), 1, size_words(grid), needed.value_or(voxels()), room};
  for (const int factor : {2, 4, 8}) {
    // skips a factor that cannot fit, because averaging takes time
    if (entry.downsampling.needed_bytes / (std::uint64_t(factor) * factor * factor) > 4 * room) continue;
    CATENA_TRY(const field::CoarseGrid coarse, field::box_downsample(grid, factor));
    const auto bytes = resident_grid_bytes(device_, *coarse.grid, options);
    if (!bytes || *bytes > room) continue;
    CATENA_TRY(ResidentGrid uploaded, make_downsampled_resident_grid(device_, coarse, factor, options));
    entry.downsampling.factor = factor;
    return store(std::move(uploaded));
  }
  ++device_.counters().refused_allocations;
  return Error{fmt::format(
      "{}: {} needs {} of GPU memory, {} are left of the budget of {}: an eighth of its resolution does not fit either", grid.name(),
      entry.downsampling.size, megabytes(entry.downsampling.needed_bytes), megabytes(room), megabytes(device_.info().memory_budget))};
}

std::vector<GridDownsampling> ResidencyManager::downsampled_grids() const {
  std::vector<GridDownsampling> list;
  for (const auto& [key, entry] : entries_)
    if (entry.resident->downsample_factor > 1) list.push_back(entry.downsampling);
  return list;
}

std::uint64_t ResidencyManager::bytes() const {
  std::uint64_t sum = 0;
  for (const auto& [key, entry] : entries_) sum += entry.resident->bytes();
  return sum;
}

void ResidencyManager::drop_unused() {
  std::erase_if(entries_, [this](const auto& item) { return item.second.last_used != frame_number_; });
}

void ResidencyManager::drop_unused(const field::ScalarGrid& grid) {
  std::erase_if(entries_,
                [&](const auto& item) { return std::get<0>(item.first) == grid.version() && item.second.last_used != frame_number_; });
}

}  // namespace catena::render
