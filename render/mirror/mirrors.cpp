#include "render/mirror/mirrors.h"

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

/// "67 MB", "0.4 MB"
std::string megabytes(std::uint64_t bytes) {
  const double mb = 1e-6 * double(bytes);
  return mb >= 10 || mb == 0 ? fmt::format("{:.0f} MB", mb) : fmt::format("{:.2g} MB", mb);
}

}  // namespace

std::string MirrorCoarsening::words() const {
  return fmt::format("{}: {} needs {} of GPU memory, {} are left: drawn at {} resolution", grid, size, megabytes(needed_bytes),
                     megabytes(left_bytes),
                     factor == 2   ? "half"
                     : factor == 4 ? "a quarter of its"
                                   : "an eighth of its");
}

void Mirrors::begin_frame(std::uint64_t reserved, std::size_t sharers) {
  ++frame_;
  reserved_ = reserved;
  sharers_ = std::max<std::size_t>(1, sharers);
  // what was too large once may fit by now, even beside its coarse mirror
  std::erase_if(entries_,
                [this](const auto& item) { return item.second.mirror->factor > 1 && item.second.coarsening.needed_bytes <= left(); });
}

std::uint64_t Mirrors::left() const {
  const std::uint64_t left = device_.memory_left();
  return left > reserved_ ? (left - reserved_) / sharers_ : 0;
}

Result<std::shared_ptr<const GridMirror>> Mirrors::get(const field::ScalarGrid& grid, const MirrorOptions& options) {
  const Key key{grid.version(), options.float32, options.layout};
  const auto found = entries_.find(key);
  const bool first_use = found == entries_.end() || found->second.used != frame_;
  Entry entry;
  if (found != entries_.end()) {
    entry = found->second;
  } else {
    const std::int64_t start = now_ns();
    CATENA_CHECK(build(entry, grid, options));
    build_ms_ += ms_since(start);
  }
  entry.used = frame_;
  entries_[key] = entry;
  if (first_use && sharers_ > 1) --sharers_;
  return entry.mirror;
}

Outcome Mirrors::build(Entry& entry, const field::ScalarGrid& grid, const MirrorOptions& options) {
  const auto keep = [&entry](GridMirror mirror) {
    entry.mirror = std::make_shared<const GridMirror>(std::move(mirror));
    return Done{};
  };
  const std::uint64_t room = left();
  const auto needed = mirror_bytes(device_, grid, options);
  if (needed && *needed <= room) {
    CATENA_TRY(GridMirror mirror, make_grid_mirror(device_, grid, options));
    return keep(std::move(mirror));
  }
  const auto voxels = [&] {
    const Vec3 n = grid.index_box().hi - grid.index_box().lo + Vec3(1.0);
    constexpr double kMost = 1e18;
    return std::uint64_t(std::min(kMost, n.x * n.y * n.z)) * (options.float32 ? 4 : 2);
  };
  entry.coarsening = {grid.name(), 1, size_words(grid), needed.value_or(voxels()), room};
  for (const int factor : {2, 4, 8}) {
    // averaging costs time: not where it cannot help
    if (entry.coarsening.needed_bytes / (std::uint64_t(factor) * factor * factor) > 4 * room) continue;
    CATENA_TRY(const field::CoarseGrid coarse, field::coarsen(grid, factor));
    const auto bytes = mirror_bytes(device_, *coarse.grid, options);
    if (!bytes || *bytes > room) continue;
    CATENA_TRY(GridMirror mirror, make_coarse_mirror(device_, coarse, factor, options));
    entry.coarsening.factor = factor;
    return keep(std::move(mirror));
  }
  ++device_.counters().refused;
  return Error{fmt::format(
      "{}: {} needs {} of GPU memory, {} are left of the budget of {}: an eighth of its resolution does not fit either", grid.name(),
      entry.coarsening.size, megabytes(entry.coarsening.needed_bytes), megabytes(room), megabytes(device_.info().memory_budget))};
}

std::vector<MirrorCoarsening> Mirrors::coarsenings() const {
  std::vector<MirrorCoarsening> list;
  for (const auto& [key, entry] : entries_)
    if (entry.mirror->factor > 1) list.push_back(entry.coarsening);
  return list;
}

std::uint64_t Mirrors::bytes() const {
  std::uint64_t sum = 0;
  for (const auto& [key, entry] : entries_) sum += entry.mirror->bytes();
  return sum;
}

void Mirrors::drop_unused() {
  std::erase_if(entries_, [this](const auto& item) { return item.second.used != frame_; });
}

void Mirrors::drop_unused(const field::ScalarGrid& grid) {
  std::erase_if(entries_, [&](const auto& item) { return std::get<0>(item.first) == grid.version() && item.second.used != frame_; });
}

}  // namespace catena::render
