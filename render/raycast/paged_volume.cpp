// SPDX-License-Identifier: MIT
#include "render/raycast/paged_volume.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>

#include "engine/base/memory_limit.h"
#include "engine/base/threads.h"
#include "engine/field/field_display_range.h"
#include "render/residency/brick_map.h"
#include "render/residency/packed_atlas.h"
#include "render/vk/commands.h"
#include "shaders/shared/fast_volume.h"

namespace catena::render {

namespace {

using field::Index3;

std::uint64_t slot_bytes(PageFormat format, std::size_t channels) {
  return page_words(format) * texel_words(channels) * sizeof(std::uint16_t) + std::uint64_t(kPageBricks) * kPageBricks * kPageBricks;
}
constexpr std::uint32_t kSubBricks = 10, kLevels = 11, kVisits = 12;  // bindings of shaders/lib/page_table.glsl
constexpr std::size_t kPagesPerImage = 64, kPagesPerUpload = 8;       // pages uploaded between two images, and in one transfer
constexpr std::uint64_t kMinHostPoolBytes = std::uint64_t{64} << 20;  // pools in the memory of the host, at least
constexpr std::size_t kMaxKnownLooks = 1u << 16;  // entries up to which looks are found again whenever pages have been read

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
PageProgress page_progress;

void report_pages(std::size_t done, std::size_t of) {
  if (page_progress && of > 0) page_progress(done, of);
}

shared::PageLevels level_data(const std::vector<PageLevel>& levels) {
  static_assert(kMaxPageLevels == MAX_PAGE_LEVELS);
  shared::PageLevels data{};
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const PageLevel& level = levels[i];
    const auto narrow = [](const Vec3& v) { return shared::vec3(float(v.x), float(v.y), float(v.z)); };
    const auto bits = [](int value, int first) { return std::uint32_t(value) << first; };
    const Index3& n = level.counts;
    data.levels[i] = {narrow(level.scale), narrow(level.offset), bits(n.x - 1, 0) | bits(n.y - 1, 16),
                      bits(n.z - 1, 0) | bits(level.shift.x, 16) | bits(level.shift.y, 21) | bits(level.shift.z, 26)};
  }
  return data;
}

}  // namespace

CodeScale number_scale(const field::PagedGrid& grid, const ValueInterval& needed) {
  constexpr int kBits = 16, kUnits = 253;
  const std::string_view type = grid.source().type().name;
  constexpr double kMargin = 2;  // in extents of the display range
  const DisplayRange& shown = display_range(grid.resident_grid());
  const double margin = kMargin * (shown.hi - shown.lo);
  ValueInterval values{std::min(shown.lo - margin, needed.min), std::max(shown.hi + margin, needed.max)};
  const auto holds_all_of = [&values](auto number) {
    using Limits = std::numeric_limits<decltype(number)>;
    values = {double(Limits::min()), double(Limits::max())};
  };
  if (type == "uint8") holds_all_of(std::uint8_t{});
  if (type == "int8") holds_all_of(std::int8_t{});
  if (type == "uint16") holds_all_of(std::uint16_t{});
  if (type == "int16") holds_all_of(std::int16_t{});
  CodeScale scale(values, type.starts_with("float"), kBits);
  const auto encode = scale.encoder<std::uint16_t>();
  scale.range_lo = encode(float(shown.lo));
  scale.range_step = std::max(1, (encode(float(shown.hi)) - scale.range_lo) / kUnits);
  return scale;
}

std::uint64_t page_pool_bytes(const vk::Device& device, std::uint64_t left, std::size_t sharers) {
  std::uint64_t bytes = left - left / 8;
  // a software renderer's device memory is that of the host
  if (device.info().is_cpu()) bytes = std::min(bytes, std::max(available_memory() / 2, kMinHostPoolBytes));
  return bytes / std::max<std::size_t>(1, sharers);
}

void set_page_progress(PageProgress progress) { page_progress = std::move(progress); }

void add_page_layout(std::vector<vk::LayoutBinding>& slots) {
  slots.insert(slots.end(),
               {{kSubBricks, vk::DescriptorKind::texture}, {kLevels, vk::DescriptorKind::uniform}, {kVisits, vk::DescriptorKind::buffer}});
}

void PagedVolume::add_bindings(std::vector<vk::Binding>& bindings) const {
  bindings.push_back({kSubBricks, vk::DescriptorKind::texture, nullptr, &sub_bricks_, nullptr});
  bindings.push_back({kLevels, vk::DescriptorKind::uniform, &levels_, nullptr, nullptr});
  bindings.push_back({kVisits, vk::DescriptorKind::buffer, &visits_, nullptr, nullptr});
}

bool have_same_pages(const field::PagedGrid& a, const field::PagedGrid& b) {
  const auto is_same = [](const field::Mapping& some, const field::Mapping& other) {
    return some.world_from_index_linear == other.world_from_index_linear && some.origin == other.origin;
  };
  const auto same_level = [&](const field::BrickLevel& some, const field::BrickLevel& other) {
    return some.size == other.size && is_same(some.mapping, other.mapping);
  };
  return a.first_voxel() == b.first_voxel() && a.index_box() == b.index_box() && is_same(a.mapping(), b.mapping()) &&
         std::ranges::equal(a.source().levels(), b.source().levels(), same_level);
}

Result<PagedVolume> PagedVolume::create(vk::Device& device, ChannelGrids grids, PageFormat format, std::uint64_t max_bytes) {
  const std::vector<PageLevel> all = page_levels(grids.front()->source());
  const auto pages = [](const PageLevel& level) { return field::brick_count(level.counts); };
  const std::uint64_t total = page_count(all);
  const std::uint64_t a_slot = slot_bytes(format, grids.size());
  const std::uint64_t beside_slots = 3 * sizeof(std::uint32_t) * pages(all.front()) + kPagesPerUpload * a_slot;
  const std::uint64_t room = max_bytes > beside_slots ? (max_bytes - beside_slots) / a_slot : 0;
  const std::array<std::uint32_t, 3> slots =
      slot_layout(device, std::clamp<std::uint64_t>(total + total / 4, 1, std::max<std::uint64_t>(1, room)));
  const std::uint64_t needed = pages(all.back()) + 1, count = std::uint64_t(slots[0]) * slots[1] * slots[2];
  if (total > 1 && count < std::min(needed, total)) return memory_limit_error(needed * a_slot + beside_slots, max_bytes);
  PagedVolume volume(device, std::move(grids), format, PageTable(all, slots));
  volume.ranges_.resize(count);
  constexpr double kCostly = 16;  // decoded voxels per voxel
  for (const PageLevel& level : all) volume.is_costly_.push_back(volume.grid().source().decoded_voxels(level.source_level) > kCostly);
  CATENA_CHECK(volume.create_images(slots));
  CATENA_TRY(volume.loader_, PageLoader::start(volume.grids_, all));
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
  constexpr VkFormat kFormats[] = {VK_FORMAT_R16_UINT, VK_FORMAT_R16G16_UINT, VK_FORMAT_R16G16B16A16_UINT, VK_FORMAT_R16G16B16A16_UINT};
  CATENA_TRY(words_, create(kFormats[grids_.size() - 1], slots[0] * std::size_t(page_width(format_)), slots[1] * nodes, slots[2] * nodes));
  CATENA_TRY(sub_bricks_, create(VK_FORMAT_R8_UINT, slots[0] * bricks, slots[1] * bricks, slots[2] * bricks));
  CATENA_TRY(map_, create(VK_FORMAT_R32_UINT, std::size_t(n.x), std::size_t(n.y), std::size_t(n.z)));
  last_visits_.assign(table_.words().size(), 0);
  CATENA_TRY(visits_, vk::Buffer::create(*device_, last_visits_.size() * sizeof(std::uint32_t), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                                         vk::Memory::readback));
  std::memset(visits_.bytes().data(), 0, visits_.bytes().size());
  CATENA_TRY(staging_,
             vk::Buffer::create(*device_,
                                std::max<std::uint64_t>(kPagesPerUpload * slot_bytes(format_, grids_.size()), table_.words().size_bytes()),
                                VK_BUFFER_USAGE_TRANSFER_SRC_BIT, vk::Memory::upload));
  return vk::write_uniform(*device_, levels_, level_data(table_.levels()));
}

Outcome PagedVolume::set_codes(ChannelCodes codes, std::vector<CodeAppearance> appearances) {
  appearances_ = std::move(appearances);
  return change_codes(std::move(codes));
}

Outcome PagedVolume::set_codes(const CodeScale& codes, SubBrickTexels texels) {
  texels_ = texels;
  return change_codes({codes});
}

Outcome PagedVolume::change_codes(ChannelCodes codes) {
  ++version_;
  if (codes != codes_) {
    table_.clear();
    codes_ = std::move(codes);
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
    auto page = encode_page(grids_, table_.levels(), id, codes_);
    if (!page) return page.error();
    pages.push_back(std::move(*page));
  }
  return upload(std::move(pages));
}

/// Returns the kind of a brick by the ranges of its channels, as CodeAppearance::classify(). Several channels are alike only where all are
/// invisible.
std::uint16_t PagedVolume::classify(std::span<const CodeRange> ranges) const {
  if (ranges.size() == 1) return appearances_.front().classify(ranges.front());
  for (std::size_t channel = 0; channel < ranges.size(); ++channel)
    if (appearances_[channel].classify(ranges[channel]) != 1) return 0;
  return 1;
}

/// Range of the codes of a brick.
struct PagedVolume::Codes {
  std::uint16_t min = 65535, max = 0;
  bool is_known = true, is_fill = true;

  void extend(const Codes& other) {
    min = std::min(min, other.min);
    max = std::max(max, other.max);
    is_known = is_known && other.is_known;
    is_fill = is_fill && other.is_fill;
  }
};

/// Returns the look of an entry by the codes of its channels.
PageLook PagedVolume::look_of(std::span<const Codes> codes) const {
  if (!std::ranges::all_of(codes, &Codes::is_known)) return {};
  const Codes& first = codes.front();
  if (appearances_.empty()) {
    const bool is_even = first.min == first.max && (!codes_.front().has_mask || first.is_fill);
    if (first.min > first.max) return {1, CodeScale::kInvalidCode};
    return {std::uint16_t(is_even ? std::max(1, first.min + 1) : 0), first.min};
  }
  std::array<CodeRange, kMaxChannels> ranges;
  for (std::size_t channel = 0; channel < codes.size(); ++channel) {
    const Codes& of = codes[channel];
    if (of.min <= of.max) ranges[channel] = codes_[channel].range_of(of.min, of.max, codes_[channel].has_mask);
  }
  return {classify({ranges.data(), codes.size()}), first.min > first.max ? std::uint16_t{CodeScale::kInvalidCode} : first.min};
}

/// Finds which entries are homogeneous, as far as the ranges of the bricks are known. Cells at an entry's far faces reach into its
/// neighbors.
void PagedVolume::find_looks() {
  const Index3& n = table_.counts();
  const std::size_t channels = grids_.size();
  std::vector<Codes> codes(table_.words().size() * channels);
  parallel_for(table_.words().size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t channel = 0; channel < channels; ++channel) {
      const auto encode = codes_[channel].encoder<std::uint16_t>();
      for (std::size_t i = begin; i < end; ++i) {
        const field::BrickRange range = grids_[channel]->source().range(0, field::brick_at(n, i));
        Codes& out = codes[i * channels + channel];
        out.is_known = range.is_known;
        out.is_fill = !range.has_data;
        if (range.is_known && range.min <= range.max) {
          constexpr float kAlmostOne = 0x1.fffffep-1f;
          out.min = encode(float(range.min), codes_[channel].is_dithered ? 0 : 0.5f);
          out.max = encode(float(range.max), codes_[channel].is_dithered ? kAlmostOne : 0.5f);
        }
      }
    }
  });
  table_.set_looks([&](const Index3& e) {
    std::array<Codes, kMaxChannels> all;
    for (int c = 0; c < 8; ++c) {
      const Index3 at{std::min(e.x + (c & 1), n.x - 1), std::min(e.y + (c >> 1 & 1), n.y - 1), std::min(e.z + (c >> 2), n.z - 1)};
      for (std::size_t channel = 0; channel < channels; ++channel)
        all[channel].extend(codes[field::brick_number(n, at) * channels + channel]);
    }
    return look_of({all.data(), channels});
  });
  has_new_looks_ = false;
}

/// Returns the coarsest level whose voxels are not larger than a pixel at the nearest point of an entry; instead of a level of which bricks
/// are costly to read, one with voxels of up to two pixels.
int PagedVolume::desired_level(const Index3& entry) const {
  const Camera& camera = rays_.camera;
  const double half_edge = 0.5 * kPageEdge;
  const field::Mapping& mapping = grid().mapping();
  const Index3& first = grid().first_voxel();
  const Vec3 center = mapping.world_from_index(Vec3(kPageEdge * entry.x + half_edge - first.x, kPageEdge * entry.y + half_edge - first.y,
                                                    kPageEdge * entry.z + half_edge - first.z));
  double radius = 0;
  for (int axis = 0; axis < 3; ++axis) radius += half_edge * norm(mapping.world_from_index_linear[axis]);
  const double depth = camera.orthographic ? 1 : std::max(rays_.view_depth(center) - radius, 1e-3 * radius);
  const double pixel = 2 * camera.half_width / std::max(1.0, double(camera.width)) * depth, voxel = mapping.min_voxel_edge();
  const std::vector<PageLevel>& levels = table_.levels();
  const auto width = [](const PageLevel& l) { return double(1 << std::max({l.shift.x, l.shift.y, l.shift.z})); };
  std::size_t level = 0;
  while (level + 1 < levels.size() && voxel * width(levels[level + 1]) <= (is_costly_[level] ? 2 : 1) * pixel) ++level;
  return int(level);
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

void PagedVolume::make_plan(bool finest, bool stepwise) {
  plan_ = table_.plan(
      last_visits_, [&](const Index3& entry) { return finest ? 0 : desired_level(entry); }, stepwise);
}

Outcome PagedVolume::update() {
  read_visits();
  if (loader_->take_found_empty(false)) has_new_looks_ = true;
  if (has_new_looks_ && table_.words().size() <= kMaxKnownLooks) find_looks();
  CATENA_CHECK(upload(loader_->take(kPagesPerImage)));
  make_plan(false, true);
  loader_->set_wanted(plan_.loads, codes_);
  return upload_map();
}

Outcome PagedVolume::finish(bool finest, bool only_if_they_fit) {
  read_visits();
  if (loader_->take_found_empty(true)) has_new_looks_ = true;
  if (has_new_looks_) find_looks();
  make_plan(finest, false);
  if (only_if_they_fit && plan_.bias > 0) return Done{};
  // pages that are near each other need the same bricks
  std::ranges::sort(plan_.loads, {}, [](const PageId& id) { return std::pair(id.level, morton_code(id.brick)); });
  loader_->set_wanted(plan_.loads, codes_);
  std::size_t done = 0;
  const std::size_t all = plan_.loads.size();
  while (loader_->wait()) {
    std::vector<EncodedPage> pages = loader_->take(kPagesPerUpload);
    done += pages.size();
    report_pages(done, all);
    CATENA_CHECK(upload(std::move(pages)));
  }
  report_pages(all, all);
  make_plan(finest, false);
  return upload_map();
}

Outcome PagedVolume::upload(std::vector<EncodedPage> pages) {
  const VkDeviceSize bytes = page_bytes();
  const int width = page_width(format_);
  std::vector<std::size_t> placed;
  for (std::size_t first = 0; first < pages.size(); first += kPagesPerUpload) {
    CATENA_TRY(vk::Commands commands, vk::Commands::begin(*device_));
    commands.transition(words_, vk::kTransferWrite);
    const std::size_t count = std::min(kPagesPerUpload, pages.size() - first);
    for (std::size_t i = 0; i < count; ++i) {
      EncodedPage& page = pages[first + i];
      if (table_.is_resident(page.id)) continue;
      const auto slot = table_.place(page.id);
      if (!slot) continue;
      const auto [x, y, z] = table_.position(*slot);
      std::memcpy(staging_.bytes().data() + i * bytes, page.words.data(), bytes);
      commands.copy(staging_, i * bytes, words_, {int(x) * width, int(y) * kPageNodes, int(z) * kPageNodes},
                    {std::uint32_t(width), kPageNodes, kPageNodes});
      placed.push_back(*slot);
      ranges_[*slot] = std::move(page.ranges);
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

std::vector<std::uint8_t> PagedVolume::sub_brick_texels(std::size_t slot) const {
  const std::vector<PageRanges>& ranges = ranges_[slot];
  std::vector<std::uint8_t> texels(std::tuple_size_v<PageRanges>);
  if (ranges.empty()) return texels;
  if (texels_ != SubBrickTexels::distances) {
    std::ranges::transform(ranges.front(), texels.begin(), [&](const CodeRange& range) {
      return std::uint8_t(range.empty() ? 0 : texels_ == SubBrickTexels::maxima ? range.max : 255 - range.min);
    });
    return texels;
  }
  std::vector<std::uint16_t> kinds(texels.size());
  for (std::size_t k = 0; k < kinds.size(); ++k) {
    std::array<CodeRange, kMaxChannels> of_channels;
    std::ranges::transform(ranges, of_channels.begin(), [&](const PageRanges& r) { return r[k]; });
    kinds[k] = classify({of_channels.data(), ranges.size()});
  }
  return homogeneous_distances({kPageBricks, kPageBricks, kPageBricks}, kinds);
}

/// Writes the texels of the sub-bricks of the pages in some slots.
Outcome PagedVolume::upload_sub_bricks(std::span<const std::size_t> slots) {
  constexpr std::size_t bytes = std::tuple_size_v<PageRanges>;
  const std::size_t at_a_time = staging_.bytes().size() / bytes;
  for (std::size_t first = 0; first < slots.size(); first += at_a_time) {
    CATENA_TRY(vk::Commands commands, vk::Commands::begin(*device_));
    commands.transition(sub_bricks_, vk::kTransferWrite);
    const std::size_t count = std::min(at_a_time, slots.size() - first);
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t slot = slots[first + i];
      const std::vector<std::uint8_t> texels = sub_brick_texels(slot);
      std::memcpy(staging_.bytes().data() + i * bytes, texels.data(), bytes);
      const auto [x, y, z] = table_.position(slot);
      commands.copy(staging_, i * bytes, sub_bricks_, {int(x) * kPageBricks, int(y) * kPageBricks, int(z) * kPageBricks},
                    {kPageBricks, kPageBricks, kPageBricks});
    }
    commands.transition(sub_bricks_, vk::kFragmentRead);
    CATENA_CHECK(commands.finish());
  }
  return Done{};
}

void PagedVolume::finish_visits(vk::Commands& commands) {
  constexpr vk::ResourceUse kVisit{VK_IMAGE_LAYOUT_UNDEFINED, VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, VK_ACCESS_2_SHADER_WRITE_BIT};
  commands.barrier(visits_, kVisit, vk::kHostRead);
}

bool PagedVolume::halves_voxels() const {
  return std::ranges::all_of(table_.levels(), [](const PageLevel& level) {
    const Vec3 scale(std::exp2(-level.shift.x), std::exp2(-level.shift.y), std::exp2(-level.shift.z));
    return level.scale == scale && level.offset == 0.5 * scale - Vec3(0.5);
  });
}

ResidentGrid PagedVolume::local_geometry() const {
  const Index3& first = grid().first_voxel();
  ResidentGrid layout;
  layout.origin = {-first.x, -first.y, -first.z};
  layout.box_lo = Vec3(first.x, first.y, first.z);
  layout.box_hi = layout.box_lo + grid().index_box().hi;
  return layout;
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
