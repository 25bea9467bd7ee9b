// SPDX-License-Identifier: MIT
#include "render/residency/page_table.h"

#include <algorithm>
#include <cmath>

#include "render/residency/brick_map.h"

namespace catena::render {

namespace {

using field::Index3;

constexpr std::uint32_t kHomogeneous = 1u << 31;
constexpr int kDistanceShift = 25, kLevelShift = 21, kSlotBits = 7, kMaxDistance = 63;
constexpr double kRatioTolerance = 0.02;  // of a level's voxel edge; sizes that are not divisible make ratios inexact

/// Returns the exponent of a ratio that is a power of two, at least 1.
std::optional<int> exponent(double ratio) {
  const int e = int(std::lround(std::log2(ratio)));
  return e >= 0 && std::fabs(std::ldexp(1.0, e) / ratio - 1) < kRatioTolerance ? std::optional(e) : std::nullopt;
}

/// Returns the level if its voxels are parallel to the finest ones and powers of two as wide.
std::optional<PageLevel> make_level(const field::BrickSource& source, std::size_t level) {
  const field::Mapping &finest = source.levels().front().mapping, &mapping = source.levels()[level].mapping;
  PageLevel out;
  out.source_level = int(level);
  out.size = source.levels()[level].size;
  out.counts = field::brick_counts(source.levels()[level]);
  const auto in_level = [&](const Vec3& p) { return mapping.index_from_world(finest.world_from_index(p)); };
  out.offset = in_level(Vec3(0.0));
  int* const shifts[] = {&out.shift.x, &out.shift.y, &out.shift.z};
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 unit(0.0);
    unit[axis] = 1;
    const Vec3 step = in_level(unit) - out.offset;
    for (int other = 0; other < 3; ++other)
      if (other != axis && std::fabs(step[other]) > kRatioTolerance * std::fabs(step[axis])) return std::nullopt;
    if (!(step[axis] > 0)) return std::nullopt;
    const std::optional<int> shift = exponent(1 / step[axis]);
    if (!shift) return std::nullopt;
    out.scale[axis] = std::ldexp(1.0, -*shift);
    *shifts[axis] = *shift;
  }
  return out;
}

}  // namespace

std::vector<PageLevel> page_levels(const field::BrickSource& source) {
  std::vector<PageLevel> levels;
  for (std::size_t i = 0; i < source.levels().size() && levels.size() < kMaxPageLevels; ++i)
    if (const auto level = make_level(source, i)) levels.push_back(*level);
  return levels;
}

std::uint64_t page_count(const std::vector<PageLevel>& levels) {
  std::uint64_t count = 0;
  for (const PageLevel& level : levels) count += field::brick_count(level.counts);
  return count;
}

PageTable::PageTable(std::vector<PageLevel> levels, const std::array<std::uint32_t, 3>& slots)
    : levels_(std::move(levels)), slots_per_axis_(slots), slots_(std::size_t(slots[0]) * slots[1] * slots[2]) {
  const std::size_t count = field::brick_count(counts());
  words_.assign(count, kHomogeneous);
  shown_level_.assign(count, kNone);
  looks_.resize(count);
  distances_.resize(count);
}

std::uint64_t PageTable::key_of(const PageId& page) const {
  constexpr int kKeyLevelShift = 56;
  return std::uint64_t(page.level) << kKeyLevelShift | field::brick_number(levels_[page.level].counts, page.brick);
}

PageId PageTable::ancestor(const Index3& entry, std::uint32_t level) const {
  const PageLevel& at = levels_[level];
  const auto axis = [](int e, int shift, int count) { return std::min(e >> shift, count - 1); };
  return {level, {axis(entry.x, at.shift.x, at.counts.x), axis(entry.y, at.shift.y, at.counts.y), axis(entry.z, at.shift.z, at.counts.z)}};
}

std::array<std::uint32_t, 3> PageTable::position(std::size_t slot) const {
  const auto [nx, ny, nz] = slots_per_axis_;
  return {std::uint32_t(slot % nx), std::uint32_t(slot / nx % ny), std::uint32_t(slot / nx / ny)};
}

std::vector<PageId> PageTable::root_pages() const {
  const Index3& n = levels_.back().counts;
  std::vector<PageId> pages(field::brick_count(n));
  for (std::size_t i = 0; i < pages.size(); ++i) pages[i] = {std::uint32_t(levels_.size() - 1), field::brick_at(n, i)};
  return pages;
}

/// Calls body(index) for the entries that a page covers. The last pages of a level cover what lies beyond them, too.
void PageTable::for_each_entry(const PageId& page, const std::function<void(std::size_t)>& body) const {
  const PageLevel& at = levels_[page.level];
  const auto last = [](int brick, int shift, int count, int entries) {
    return brick + 1 == count ? entries - 1 : std::min(entries - 1, ((brick + 1) << shift) - 1);
  };
  const Index3 &b = page.brick, &n = counts();
  for (int z = b.z << at.shift.z; z <= last(b.z, at.shift.z, at.counts.z, n.z); ++z)
    for (int y = b.y << at.shift.y; y <= last(b.y, at.shift.y, at.counts.y, n.y); ++y)
      for (int x = b.x << at.shift.x; x <= last(b.x, at.shift.x, at.counts.x, n.x); ++x) body(field::brick_number(n, {x, y, z}));
}

void PageTable::write_word(std::size_t entry) {
  const std::uint32_t distance = std::uint32_t(std::min<int>(distances_[entry], kMaxDistance)) << kDistanceShift;
  const std::uint32_t level = shown_level_[entry];
  std::uint32_t word = kHomogeneous | looks_[entry].code;
  if (looks_[entry].kind == 0 && level != kNone) {
    const auto [x, y, z] = position(resident_.at(key_of(ancestor(field::brick_at(counts(), entry), level))));
    word = x | y << kSlotBits | z << 2 * kSlotBits | level << kLevelShift;
  }
  word |= distance;
  has_changed_ = has_changed_ || words_[entry] != word;
  words_[entry] = word;
}

void PageTable::set_looks(const std::function<PageLook(const Index3&)>& look) {
  std::vector<std::uint16_t> kinds(looks_.size());
  for (std::size_t i = 0; i < looks_.size(); ++i) {
    looks_[i] = look(field::brick_at(counts(), i));
    kinds[i] = looks_[i].kind;
  }
  distances_ = homogeneous_distances({counts().x, counts().y, counts().z}, kinds);
  for (std::size_t i = 0; i < looks_.size(); ++i) write_word(i);
}

void PageTable::clear() {
  resident_.clear();
  slots_.assign(slots_.size(), {});
  std::ranges::fill(shown_level_, kNone);
  for (std::size_t i = 0; i < words_.size(); ++i) write_word(i);
}

PagePlan PageTable::plan(std::span<const std::uint32_t> visits, const std::function<int(const Index3&)>& desired_level, bool stepwise) {
  struct Visit {
    std::size_t entry;
    std::uint32_t weight, level;
  };
  struct Need {
    PageId page;
    std::uint64_t gain = 0;
  };
  clock_ += 2;
  std::vector<Visit> visited;
  const auto coarsest = std::uint32_t(levels_.size() - 1);
  for (std::size_t i = 0; i < words_.size(); ++i)
    if (visits[i] > 0 && looks_[i].kind == 0)
      visited.push_back({i, visits[i], std::min(coarsest, std::uint32_t(desired_level(field::brick_at(counts(), i))))});

  // the finest level of which all visited pages fit, with room for the last level and for pages on the way to finer ones
  const std::size_t roots = field::brick_count(levels_.back().counts);
  const std::size_t reserve = stepwise && slots_.size() < page_count(levels_) ? slots_.size() / 8 : 0;
  const std::size_t capacity = slots_.size() > roots + reserve ? slots_.size() - roots - reserve : 1;
  PagePlan plan;
  std::unordered_map<std::uint64_t, Need> needs;
  for (std::uint32_t bias = 0;; ++bias) {
    needs.clear();
    std::size_t beside_roots = 0;
    for (const Visit& v : visited) {
      const PageId page = ancestor(field::brick_at(counts(), v.entry), std::max(v.level, bias));
      const auto [at, is_new] = needs.try_emplace(key_of(page), Need{page, 0});
      at->second.gain += v.weight;
      beside_roots += is_new && page.level < coarsest;
    }
    plan.bias = int(bias);
    if (beside_roots <= capacity || bias >= coarsest) break;
  }

  plan.visible = needs.size();
  std::unordered_map<std::uint64_t, Need> loads;
  for (const auto& [key, need] : needs) {
    const auto found = resident_.find(key);
    plan.resident += found != resident_.end();
    if (found != resident_.end())
      slots_[found->second].last_needed = clock_;
    else if (!stepwise)
      loads.insert({key, need});
  }
  for (const Visit& v : visited) {
    if (shown_level_[v.entry] == kNone) continue;
    const Index3 entry = field::brick_at(counts(), v.entry);
    const std::uint32_t shown = shown_level_[v.entry], target = std::max(v.level, std::uint32_t(plan.bias));
    Slot& slot = slots_[resident_.at(key_of(ancestor(entry, shown)))];
    slot.last_needed = std::max(slot.last_needed, clock_ - 1);
    if (!stepwise || shown <= target) continue;
    const PageId next = ancestor(entry, shown - 1);
    if (resident_.contains(key_of(next))) continue;
    loads.try_emplace(key_of(next), Need{next, 0}).first->second.gain += v.weight;
  }
  std::vector<std::pair<std::uint64_t, Need>> sorted(loads.begin(), loads.end());
  std::ranges::sort(sorted, [](const auto& a, const auto& b) {
    if (a.second.page.level != b.second.page.level) return a.second.page.level > b.second.page.level;
    return a.second.gain != b.second.gain ? a.second.gain > b.second.gain : a.first < b.first;
  });
  for (const auto& [key, need] : sorted) plan.loads.push_back(need.page);
  return plan;
}

void PageTable::remove(std::size_t slot) {
  const PageId page = *slots_[slot].page;
  resident_.erase(key_of(page));
  slots_[slot] = {};
  for_each_entry(page, [&](std::size_t entry) {
    if (shown_level_[entry] != page.level) return;
    shown_level_[entry] = kNone;
    for (std::uint32_t level = page.level + 1; level < levels_.size() && shown_level_[entry] == kNone; ++level)
      if (is_resident(ancestor(field::brick_at(counts(), entry), level))) shown_level_[entry] = std::uint8_t(level);
    write_word(entry);
  });
}

std::optional<std::size_t> PageTable::place(const PageId& page) {
  const auto oldest = std::ranges::min_element(slots_, {}, [](const Slot& s) { return s.is_pinned ? ~std::uint64_t{0} : s.last_needed; });
  if (oldest->is_pinned || oldest->last_needed >= clock_) return std::nullopt;
  const auto slot = std::size_t(oldest - slots_.begin());
  if (slots_[slot].page) remove(slot);
  slots_[slot] = {page, clock_, page.level + 1 == levels_.size()};
  resident_[key_of(page)] = slot;
  for_each_entry(page, [&](std::size_t entry) {
    if (shown_level_[entry] <= page.level) return;
    shown_level_[entry] = std::uint8_t(page.level);
    write_word(entry);
  });
  return slot;
}

}  // namespace catena::render
