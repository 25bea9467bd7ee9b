// SPDX-License-Identifier: MIT
#include "render/raycast/paged_volume.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

#include "engine/base/threads.h"
#include "render/residency/brick_map.h"
#include "render/residency/packed_atlas.h"
#include "render/vk/commands.h"
#include "shaders/shared/fast_volume.h"

namespace catena::render {

namespace {

using field::Index3;

constexpr std::uint64_t kSlotBytes = kPageWords * sizeof(std::uint16_t) + std::uint64_t(kPageBricks) * kPageBricks * kPageBricks;
constexpr std::size_t kPagesPerImage = 64, kPagesPerUpload = 8;  // pages uploaded between two images, and in one transfer
constexpr std::size_t kMaxKnownLooks = 1u << 16;                 // entries up to which looks are found again whenever pages have been read

/// Returns a block of slots, at most `count` and as many as fit into an image.
std::array<std::uint32_t, 3> slot_layout(const vk::Device& device, std::uint64_t count) {
  const std::uint32_t limit = std::min(kMaxPageSlotsAxis, device.info().limits.maxImageDimension3D / kPageNodes);
  const auto axis = [&](double n) { return std::clamp(std::uint32_t(n), 1u, limit); };
  const std::uint32_t x = axis(std::cbrt(double(count))), y = axis(std::sqrt(double(count) / x));
  return {x, y, axis(std::floor(double(count) / (double(x) * y)))};
}

/// Returns the position on a curve through all bricks, along which near ones are near: the bits of x, y and z in turn.
std::uint64_t morton_code(const Index3& brick) {
  constexpr int kBits = 21;
  std::uint64_t code = 0;
  for (int bit = 0; bit < kBits; ++bit)
    code |= (std::uint64_t(brick.x >> bit & 1) | std::uint64_t(brick.y >> bit & 1) << 1 | std::uint64_t(brick.z >> bit & 1) << 2)
            << 3 * bit;
  return code;
}

/// Returns the levels as shaders read them.
shared::PageLevels level_data(const std::vector<PageLevel>& levels) {
  static_assert(kMaxPageLevels == MAX_PAGE_LEVELS);
  shared::PageLevels data{};
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const PageLevel& level = levels[i];
    const auto narrow = [](const Vec3& v) { return shared::vec3(float(v.x), float(v.y), float(v.z)); };
    data.levels[i] = {narrow(level.scale), narrow(level.offset), narrow(Vec3(1 << level.shift.x, 1 << level.shift.y, 1 << level.shift.z)),
                      narrow(Vec3(level.counts.x - 1, level.counts.y - 1, level.counts.z - 1)),
                      float(1 << std::min({level.shift.x, level.shift.y, level.shift.z}))};
  }
  return data;
}

}  // namespace

Result<PagedVolume> PagedVolume::create(vk::Device& device, std::shared_ptr<const field::PagedGrid> grid, std::uint64_t max_bytes) {
  const std::vector<PageLevel> all = page_levels(grid->source());
  const auto pages = [](const PageLevel& level) { return field::brick_count(level.counts); };
  const std::uint64_t total = page_count(all);
  const std::uint64_t beside_slots = 3 * sizeof(std::uint32_t) * pages(all.front()) + kPagesPerUpload * kSlotBytes;
  const std::uint64_t room = max_bytes > beside_slots ? (max_bytes - beside_slots) / kSlotBytes : 0;
  const std::array<std::uint32_t, 3> slots =
      slot_layout(device, std::clamp<std::uint64_t>(total + total / 4, 1, std::max<std::uint64_t>(1, room)));
  const std::uint64_t needed = pages(all.back()) + 1, count = std::uint64_t(slots[0]) * slots[1] * slots[2];
  if (total > 1 && count < std::min(needed, total)) return memory_limit_error(needed * kSlotBytes + beside_slots, max_bytes);
  PagedVolume volume(device, std::move(grid), PageTable(all, slots));
  volume.ranges_.resize(count);
  CATENA_CHECK(volume.create_images(slots));
  CATENA_TRY(volume.loader_, PageLoader::start(volume.grid_, all));
  return volume;
}

Outcome PagedVolume::create_images(const std::array<std::uint32_t, 3>& slots) {
  const auto create = [&](VkFormat format, std::size_t x, std::size_t y, std::size_t z) -> Result<vk::Image> {
    CATENA_TRY(vk::Image image, vk::Image::create(*device_, vk::volume_image_info(format, x, y, z)));
    CATENA_TRY(vk::Commands commands, vk::Commands::begin(*device_));
    commands.transition(image, vk::kFragmentRead);
    CATENA_CHECK(commands.finish());
    return image;
  };
  const std::size_t nodes = kPageNodes, bricks = kPageBricks;
  const Index3& n = table_.counts();
  CATENA_TRY(words_, create(VK_FORMAT_R16_UINT, slots[0] * std::size_t(kPageEdge), slots[1] * nodes, slots[2] * nodes));
  CATENA_TRY(sub_bricks_, create(VK_FORMAT_R8_UINT, slots[0] * bricks, slots[1] * bricks, slots[2] * bricks));
  CATENA_TRY(map_, create(VK_FORMAT_R32_UINT, std::size_t(n.x), std::size_t(n.y), std::size_t(n.z)));
  last_visits_.assign(table_.words().size(), 0);
  CATENA_TRY(visits_, vk::Buffer::create(*device_, last_visits_.size() * sizeof(std::uint32_t), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                                         vk::Memory::readback));
  std::memset(visits_.bytes().data(), 0, visits_.bytes().size());
  CATENA_TRY(staging_, vk::Buffer::create(*device_, std::max<std::uint64_t>(kPagesPerUpload * kSlotBytes, table_.words().size_bytes()),
                                          VK_BUFFER_USAGE_TRANSFER_SRC_BIT, vk::Memory::upload));
  return vk::write_uniform(*device_, levels_, level_data(table_.levels()));
}

Outcome PagedVolume::set_codes(const CodeScale& codes, const CodeAppearance& appearance) {
  ++version_;
  appearance_ = appearance;
  const bool is_first = codes_.per_code == 0 && codes_.lo == 0;
  if (!(codes == codes_) || is_first) {
    table_.clear();
    codes_ = codes;
    CATENA_CHECK(load_roots());
  } else {
    std::vector<std::size_t> all(ranges_.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    CATENA_CHECK(upload_sub_bricks(all));
  }
  find_looks();
  return upload_map();
}

Outcome PagedVolume::load_roots() {
  std::vector<EncodedPage> pages;
  for (const PageId& id : table_.root_pages()) {
    auto page = encode_page(*grid_, table_.levels(), id, codes_);
    if (!page) return page.error();
    pages.push_back(std::move(*page));
  }
  return upload(std::move(pages));
}

/// Finds which entries are homogeneous, as far as the ranges of the bricks are known. Cells at an entry's far faces reach into its
/// neighbors.
void PagedVolume::find_looks() {
  const Index3& n = table_.counts();
  std::vector<CodeRange> ranges(table_.words().size());
  parallel_for(ranges.size(), 4096, [&](std::size_t begin, std::size_t end) {
    const auto encode = codes_.encoder();
    for (std::size_t i = begin; i < end; ++i) {
      const field::BrickRange range = grid_->source().range(0, field::brick_at(n, i));
      ranges[i] = {0, 255, !range.is_known};
      if (range.is_known && range.min <= range.max) ranges[i] = {encode(float(range.min)), encode(float(range.max)), false};
    }
  });
  table_.set_looks([&](const Index3& e) {
    CodeRange all;
    for (int c = 0; c < 8; ++c) {
      const Index3 at{std::min(e.x + (c & 1), n.x - 1), std::min(e.y + (c >> 1 & 1), n.y - 1), std::min(e.z + (c >> 2), n.z - 1)};
      const CodeRange& range = ranges[field::brick_number(n, at)];
      if (range.has_unused) return PageLook{};
      all = {std::min(all.min, range.min), std::max(all.max, range.max), codes_.has_mask};
    }
    return PageLook{appearance_.classify(all), all.min};
  });
  has_new_looks_ = false;
}

/// Returns the level whose voxels are about as large as a pixel at the nearest point of an entry.
int PagedVolume::desired_level(const Index3& entry) const {
  const Camera& camera = rays_.camera;
  const double half_edge = 0.5 * kPageEdge;
  const field::Mapping& mapping = grid_->mapping();
  const Index3& first = grid_->first_voxel();
  const Vec3 center = mapping.world_from_index(Vec3(kPageEdge * entry.x + half_edge - first.x, kPageEdge * entry.y + half_edge - first.y,
                                                    kPageEdge * entry.z + half_edge - first.z));
  double radius = 0;
  for (int axis = 0; axis < 3; ++axis) radius += half_edge * norm(mapping.world_from_index_linear[axis]);
  const double depth = camera.orthographic ? 1 : std::max(rays_.view_depth(center) - radius, 1e-3 * radius);
  const double pixel = 2 * camera.half_width / std::max(1.0, double(camera.width)) * depth, voxel = mapping.min_voxel_edge();
  int level = 0;
  const std::vector<PageLevel>& levels = table_.levels();
  const auto width = [](const PageLevel& l) { return double(1 << std::max({l.shift.x, l.shift.y, l.shift.z})); };
  while (std::size_t(level) + 1 < levels.size() && voxel * width(levels[std::size_t(level) + 1]) <= pixel) ++level;
  return level;
}

/// Fetches the visits of the last image, and begins to count those of the next one.
void PagedVolume::read_visits() {
  const std::span<std::byte> bytes = visits_.bytes();
  std::vector<std::uint32_t> visits(last_visits_.size());
  std::memcpy(visits.data(), bytes.data(), bytes.size());
  if (std::ranges::all_of(visits, [](std::uint32_t v) { return v == 0; })) return;  // no ray was marched again
  std::memset(bytes.data(), 0, bytes.size());
  if (adds_visits_)
    std::ranges::transform(visits, last_visits_, last_visits_.begin(), [](std::uint32_t a, std::uint32_t b) { return std::max(a, b); });
  else
    last_visits_ = std::move(visits);
}

void PagedVolume::make_plan(bool is_final) {
  plan_ = table_.plan(
      last_visits_, [&](const Index3& entry) { return is_final ? 0 : desired_level(entry); }, !is_final);
}

Outcome PagedVolume::update() {
  read_visits();
  if (loader_->take_found_empty(false)) has_new_looks_ = true;
  if (has_new_looks_ && table_.words().size() <= kMaxKnownLooks) find_looks();
  CATENA_CHECK(upload(loader_->take(kPagesPerImage)));
  make_plan(false);
  loader_->set_wanted(plan_.loads, codes_);
  return upload_map();
}

Outcome PagedVolume::finish(bool only_if_they_fit) {
  read_visits();
  if (loader_->take_found_empty(true)) has_new_looks_ = true;
  if (has_new_looks_) find_looks();
  make_plan(true);
  if (only_if_they_fit && plan_.bias > 0) return Done{};
  // pages that are near each other need the same bricks
  std::ranges::sort(plan_.loads, {}, [](const PageId& id) { return std::pair(id.level, morton_code(id.brick)); });
  loader_->set_wanted(plan_.loads, codes_);
  while (loader_->wait()) CATENA_CHECK(upload(loader_->take(kPagesPerUpload)));
  make_plan(true);
  return upload_map();
}

Outcome PagedVolume::upload(std::vector<EncodedPage> pages) {
  constexpr VkDeviceSize bytes = kPageWords * sizeof(std::uint16_t);
  std::vector<std::size_t> placed;
  for (std::size_t first = 0; first < pages.size(); first += kPagesPerUpload) {
    CATENA_TRY(vk::Commands commands, vk::Commands::begin(*device_));
    commands.transition(words_, vk::kTransferWrite);
    const std::size_t count = std::min(kPagesPerUpload, pages.size() - first);
    for (std::size_t i = 0; i < count; ++i) {
      const EncodedPage& page = pages[first + i];
      if (table_.is_resident(page.id)) continue;
      const auto slot = table_.place(page.id);
      if (!slot) continue;
      const auto [x, y, z] = table_.position(*slot);
      std::memcpy(staging_.bytes().data() + i * bytes, page.words.data(), bytes);
      commands.copy(staging_, i * bytes, words_, {int(x) * kPageEdge, int(y) * kPageNodes, int(z) * kPageNodes},
                    {kPageEdge, kPageNodes, kPageNodes});
      placed.push_back(*slot);
      ranges_[*slot] = page.ranges;
    }
    commands.transition(words_, vk::kFragmentRead);
    CATENA_CHECK(commands.finish());
  }
  if (placed.empty()) return Done{};
  ++version_;
  loaded_count_ += placed.size();
  has_new_looks_ = true;
  return upload_sub_bricks(placed);
}

/// Writes which sub-bricks are homogeneous, for the pages in some slots.
Outcome PagedVolume::upload_sub_bricks(std::span<const std::size_t> slots) {
  constexpr std::size_t bytes = std::tuple_size_v<PageRanges>;
  const std::size_t at_a_time = staging_.bytes().size() / bytes;
  for (std::size_t first = 0; first < slots.size(); first += at_a_time) {
    CATENA_TRY(vk::Commands commands, vk::Commands::begin(*device_));
    commands.transition(sub_bricks_, vk::kTransferWrite);
    const std::size_t count = std::min(at_a_time, slots.size() - first);
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t slot = slots[first + i];
      std::vector<std::uint16_t> kinds(bytes);
      std::ranges::transform(ranges_[slot], kinds.begin(), [&](const CodeRange& range) { return appearance_.classify(range); });
      const std::vector<std::uint8_t> distances = homogeneous_distances({kPageBricks, kPageBricks, kPageBricks}, kinds);
      std::memcpy(staging_.bytes().data() + i * bytes, distances.data(), bytes);
      const auto [x, y, z] = table_.position(slot);
      commands.copy(staging_, i * bytes, sub_bricks_, {int(x) * kPageBricks, int(y) * kPageBricks, int(z) * kPageBricks},
                    {kPageBricks, kPageBricks, kPageBricks});
    }
    commands.transition(sub_bricks_, vk::kFragmentRead);
    CATENA_CHECK(commands.finish());
  }
  return Done{};
}

Outcome PagedVolume::upload_map() {
  if (!table_.take_changed()) return Done{};
  ++version_;
  CATENA_TRY(vk::Commands commands, vk::Commands::begin(*device_));
  std::memcpy(staging_.bytes().data(), table_.words().data(), table_.words().size_bytes());
  commands.transition(map_, vk::kTransferWrite);
  commands.copy(staging_, 0, map_, {0, 0, 0}, map_.info().extent);
  commands.transition(map_, vk::kFragmentRead);
  return commands.finish();
}

}  // namespace catena::render
