// SPDX-License-Identifier: MIT
#include "render/residency/resident_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "engine/base/memory_limit.h"
#include "engine/base/threads.h"
#include "render/residency/atlas_plan.h"
#include "render/residency/cell_block.h"
#include "render/residency/texel_encoder.h"
#include "render/residency/voxel_block.h"
#include "render/vk/commands.h"

namespace catena::render {
namespace {

using field::Index3;
constexpr std::uint64_t kCellMapBytes = 128;  // bytes per brick, cell_map.h

class MirrorBuilder {
 public:
  MirrorBuilder(vk::Device& device, const field::ScalarGrid& grid, const ResidencyOptions& options)
      : device_(device), grid_(grid), options_(options), encoder_(grid, options.use_float32) {}

  Result<ResidentGrid> build() {
    CATENA_CHECK(ask());
    if (!plan()) return std::move(resident_);
    resident_.offset = encoder_.offset;
    resident_.scale = encoder_.scale;
    CATENA_CHECK(resident_.atlas ? build_atlas() : build_dense());
    if (resident_.nearest) {
      CATENA_TRY(resident_.point_sampler, vk::Sampler::create(device_, vk::Filter::nearest));
    }
    for (BrickRange& range : resident_.brick_ranges)
      range = resident_.cubic ? widen_for_cubic(encoder_.round_trip(range)) : encoder_.round_trip(range);
    return std::move(resident_);
  }

  /// Bytes of the images, and with those needed for making them and the maps.
  struct Bytes {
    std::uint64_t images = 0, needed = 0;
  };
  std::optional<Bytes> bytes() {
    if (!ask()) return std::nullopt;
    if (!plan()) return Bytes{};
    std::array<std::uint32_t, 3> values{std::uint32_t(size_.x + 2 * pad_), std::uint32_t(size_.y + 2 * pad_),
                                        std::uint32_t(size_.z + 2 * pad_)},
        mask = values;
    if (resident_.atlas) {
      const auto slots = assign_slots(device_, atlas_);
      if (!slots) return std::nullopt;
      for (int a = 0; a < 3; ++a) {
        values[a] = slots->slots_per_axis[a] * kPaddedBrickSize;
        mask[a] = slots->slots_per_axis[a] * kBrickSize;
      }
    } else {
      place(padded_lo());
    }
    const auto value_bytes = vk::image_memory_bytes(device_, vk::volume_image_info(value_format(), values[0], values[1], values[2]));
    const auto mask_bytes = vk::image_memory_bytes(device_, vk::volume_image_info(VK_FORMAT_R8_UINT, mask[0], mask[1], mask[2]));
    if (!value_bytes || !mask_bytes) return std::nullopt;
    const std::uint64_t staging = std::uint64_t(kPaddedBrickSize) * values[0] * values[1] * encoder_.texel_bytes();
    // one word per brick; for surfaces also the cell map
    const std::uint64_t map = resident_.brick_ranges.size() * (sizeof(std::uint32_t) + (encoder_.float32 ? kCellMapBytes : 0));
    const std::uint64_t images = *value_bytes + (resident_.masked ? *mask_bytes : 0);
    return Bytes{images, images + std::max(staging, map) + map};
  }

 private:
  /// Error: too little host memory. A sparse grid may span many more bricks than it stores, and each needs memory.
  Outcome ask() const {
    const Vec3 bricks = (grid_.index_box().hi - grid_.index_box().lo) / double(kBrickSize) + Vec3(2.0);
    constexpr double kBytesPerBrick = 48;  // plan and slots on the host; the cell map is on the GPU
    return check_memory_available(fmt::format("drawing the grid \"{}\", which reaches over {:.0f} x {:.0f} x {:.0f} bricks of 8^3 voxels,",
                                              grid_.name(), bricks.x, bricks.y, bricks.z),
                                  kBytesPerBrick * bricks.x * bricks.y * bricks.z);
  }

  /// Chooses the layout; returns false if the grid has nothing to draw.
  bool plan() {
    const VoxelExtent extent = voxel_extent(grid_);
    lo_ = extent.lo;
    size_ = extent.size;
    hi_ = {lo_.x + size_.x - 1, lo_.y + size_.y - 1, lo_.z + size_.z - 1};
    if (size_.x < 2 || size_.y < 2 || size_.z < 2 || grid_.stats().active_voxels == 0) return false;
    resident_.is_drawable = true;
    resident_.nearest = grid_.interpolation() == field::Interpolation::nearest;
    resident_.masked = has_invalid_cells(grid_);
    resident_.cubic = grid_.interpolation() == field::Interpolation::cubic;
    pad_ = resident_.cubic ? 1 : 0;
    if (resident_.cubic) return true;
    if (options_.layout != GridLayout::dense) {
      const auto down = [](std::int32_t v) { return v & ~(kBrickSize - 1); };
      place({down(lo_.x), down(lo_.y), down(lo_.z)});
      atlas_ = plan_atlas(grid_, resident_.origin, resident_.bricks);
    }
    resident_.atlas = options_.layout == GridLayout::atlas || (options_.layout == GridLayout::automatic && atlas_pays());
    return true;
  }

  Index3 padded_lo() const { return {lo_.x - pad_, lo_.y - pad_, lo_.z - pad_}; }

  void place(const Index3& origin) {
    resident_.origin = origin;
    resident_.box_lo = Vec3(lo_.x - origin.x, lo_.y - origin.y, lo_.z - origin.z);
    resident_.box_hi = Vec3(hi_.x - origin.x, hi_.y - origin.y, hi_.z - origin.z);
    resident_.bricks = {(hi_.x - origin.x + kBrickSize - 1) / kBrickSize, (hi_.y - origin.y + kBrickSize - 1) / kBrickSize,
                        (hi_.z - origin.z + kBrickSize - 1) / kBrickSize};
    resident_.brick_ranges.assign(std::size_t(resident_.bricks[0]) * resident_.bricks[1] * resident_.bricks[2], BrickRange{});
  }

  bool fits_dense() const {
    const auto limit = std::int32_t(device_.info().limits.maxImageDimension3D);
    return size_.x <= limit && size_.y <= limit && size_.z <= limit;
  }

  bool atlas_pays() const {
    const double dense = double(size_.x) * size_.y * size_.z,
                 atlas = double(atlas_.stored_count) * kPaddedBrickSize * kPaddedBrickSize * kPaddedBrickSize;
    return !fits_dense() || (dense > 64.0 * 64 * 64 && atlas < 0.5 * dense);
  }

  VkFormat value_format() const { return encoder_.float32 ? VK_FORMAT_R32_SFLOAT : VK_FORMAT_R16_SFLOAT; }

  Result<vk::Image> create_image(VkFormat format, std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    auto image = vk::Image::create(device_, vk::volume_image_info(format, x, y, z));
    if (!image) return Error{fmt::format("the grid \"{}\" cannot be uploaded: {}", grid_.name(), image.error().message)};
    return image;
  }

  Outcome create_images(std::uint32_t x, std::uint32_t y, std::uint32_t z, std::uint32_t mx, std::uint32_t my, std::uint32_t mz) {
    CATENA_TRY(resident_.values, create_image(value_format(), x, y, z));
    if (!resident_.masked) return Done{};
    CATENA_TRY(resident_.mask, create_image(VK_FORMAT_R8_UINT, mx, my, mz));
    return Done{};
  }

  /// Uploads rows of bricks in parallel; the mask is collected meanwhile and uploaded afterwards.
  Outcome build_dense() {
    const Index3 lo = padded_lo();
    place(lo);
    const auto nx = std::uint32_t(size_.x + 2 * pad_), ny = std::uint32_t(size_.y + 2 * pad_), nz = std::uint32_t(size_.z + 2 * pad_);
    CATENA_CHECK(create_images(nx, ny, nz, nx, ny, nz));
    std::vector<std::uint8_t> mask(resident_.masked ? std::size_t(nx) * ny * nz : 0);
    const std::size_t texel = encoder_.texel_bytes();
    CATENA_CHECK(vk::upload_planes(device_, resident_.values, kBrickSize, [&](std::uint32_t first, std::uint32_t count, std::byte* out) {
      const std::uint32_t layers = (count + kBrickSize - 1) / kBrickSize, rows = (ny + kBrickSize - 1) / kBrickSize;
      parallel_for(std::size_t(layers) * rows, 1, [&](std::size_t begin, std::size_t end) {
        CellBlock block;
        for (std::size_t task = begin; task < end; ++task) {
          const int y0 = kBrickSize * int(task % rows), z0 = int(first) + kBrickSize * int(task / rows);
          // including the voxels that the brick's last cells read, and the first cells of a padded brick
          const int before_y = std::min(pad_, y0), before_z = std::min(pad_, z0);
          const int height = std::min(kPaddedBrickSize + pad_, int(ny) - y0), depth = std::min(kPaddedBrickSize + pad_, int(nz) - z0);
          block.read(grid_, {lo.x, lo.y + y0 - before_y, lo.z + z0 - before_z}, {int(nx), height + before_y, depth + before_z},
                     resident_.masked);
          for (int z = 0; z < std::min(kBrickSize, depth); ++z)
            for (int y = 0; y < std::min(kBrickSize, height); ++y) {
              const std::size_t row = (std::size_t(z0 + z) * ny + y0 + y) * nx, from = block.voxel_index(0, y + before_y, z + before_z);
              encoder_.write(&block.values[from], nx, out + (row - std::size_t(first) * ny * nx) * texel);
              if (!mask.empty()) std::copy_n(&block.valid[from], nx, &mask[row]);
            }
          find_ranges(block, y0, z0, before_y, before_z);
        }
      });
    }));
    if (mask.empty()) return Done{};
    return vk::upload_planes(device_, resident_.mask, 1, [&](std::uint32_t first, std::uint32_t count, std::byte* out) {
      std::memcpy(out, mask.data() + std::size_t(first) * nx * ny, std::size_t(count) * nx * ny);
    });
  }

  /// Sets the ranges of a row of bricks along x. y0, z0: its position in the image; before_y, before_z: in the block.
  void find_ranges(const CellBlock& block, int y0, int z0, int before_y, int before_z) {
    const int cells_y = std::min(kBrickSize, int(resident_.box_hi.y) - y0), cells_z = std::min(kBrickSize, int(resident_.box_hi.z) - z0);
    if (cells_y < 1 || cells_z < 1) return;
    const auto cells_x = int(resident_.box_hi.x);
    // the padding has no cells of its own: the first bricks skip it
    const int first_y = before_y + std::max(0, pad_ - y0), first_z = before_z + std::max(0, pad_ - z0);
    for (int x = 0; x < resident_.bricks[0]; ++x)
      resident_.brick_ranges[resident_.brick_index(x, y0 / kBrickSize, z0 / kBrickSize)] =
          block.compute_range({std::max(pad_, kBrickSize * x), first_y, first_z},
                              {std::min(kBrickSize * (x + 1), cells_x), before_y + cells_y, before_z + cells_z}, pad_);
  }

  Outcome build_atlas() {
    auto slots = assign_slots(device_, atlas_);
    if (!slots) return Error{fmt::format("the grid \"{}\" has {}", grid_.name(), slots.error().message)};
    resident_.brick_slots = std::move(slots->brick_words);
    const std::vector<std::size_t>& brick_of = slots->slot_bricks;
    const auto [sx, sy, sz] = slots->slots_per_axis;
    CATENA_CHECK(create_images(sx * kPaddedBrickSize, sy * kPaddedBrickSize, sz * kPaddedBrickSize, sx * kBrickSize, sy * kBrickSize,
                               sz * kBrickSize));
    constexpr std::size_t mask_bytes = std::size_t(kBrickSize) * kBrickSize * kBrickSize;
    std::vector<std::uint8_t> mask(resident_.masked ? mask_bytes * sx * sy * sz : 0);
    const std::size_t texel = encoder_.texel_bytes(), width = std::size_t(sx) * kPaddedBrickSize,
                      height = std::size_t(sy) * kPaddedBrickSize;
    CATENA_CHECK(vk::upload_planes(
        device_, resident_.values, kPaddedBrickSize, [&, sx = sx, sy = sy](std::uint32_t first, std::uint32_t count, std::byte* out) {
          const std::size_t begin_slot = std::size_t(first / kPaddedBrickSize) * sx * sy;
          const std::size_t end_slot = std::min(brick_of.size(), begin_slot + std::size_t(count / kPaddedBrickSize) * sx * sy);
          std::memset(out, 0, width * height * count * texel);
          parallel_for(end_slot - begin_slot, 8, [&](std::size_t begin, std::size_t end) {
            CellBlock block;
            for (std::size_t slot = begin_slot + begin; slot < begin_slot + end; ++slot) {
              const std::size_t brick = brick_of[slot];
              const Index3 origin = atlas_.first_voxel(brick);
              block.read(grid_, origin, {kPaddedBrickSize, kPaddedBrickSize, kPaddedBrickSize}, resident_.masked);
              resident_.brick_ranges[brick] = clipped_range(block, origin);
              const std::size_t ox = slot % sx * kPaddedBrickSize, oy = slot / sx % sy * kPaddedBrickSize,
                                oz = (slot - begin_slot) / sx / sy * kPaddedBrickSize;
              for (int k = 0; k < kPaddedBrickSize; ++k)
                for (int j = 0; j < kPaddedBrickSize; ++j)
                  encoder_.write(&block.values[block.voxel_index(0, j, k)], kPaddedBrickSize,
                                 out + (((oz + k) * height + oy + j) * width + ox) * texel);
              if (mask.empty()) continue;
              const std::size_t mw = std::size_t(sx) * kBrickSize, mh = std::size_t(sy) * kBrickSize;
              for (int k = 0; k < kBrickSize; ++k)
                for (int j = 0; j < kBrickSize; ++j)
                  std::copy_n(
                      &block.valid[block.voxel_index(0, j, k)], kBrickSize,
                      &mask[((slot / sx / sy * kBrickSize + k) * mh + slot / sx % sy * kBrickSize + j) * mw + slot % sx * kBrickSize]);
            }
          });
        }));
    for (std::size_t i = 0; i < atlas_.is_constant.size(); ++i)
      if (atlas_.is_constant[i]) resident_.brick_ranges[i] = {atlas_.constant_values[i], atlas_.constant_values[i]};
    if (mask.empty()) return Done{};
    const std::size_t plane = std::size_t(sx) * kBrickSize * sy * kBrickSize;
    return vk::upload_planes(device_, resident_.mask, 1, [&](std::uint32_t first, std::uint32_t count, std::byte* out) {
      std::memcpy(out, mask.data() + first * plane, count * plane);
    });
  }

  /// Returns the range of a brick's cells inside the index box.
  BrickRange clipped_range(const CellBlock& block, const Index3& origin) const {
    const auto first = [](int lo, int at) { return std::max(0, lo - at); };
    const auto last = [](int hi, int at) { return std::min(kBrickSize, hi - at); };
    const int x0 = first(lo_.x, origin.x), y0 = first(lo_.y, origin.y), z0 = first(lo_.z, origin.z);
    const int x1 = last(hi_.x, origin.x), y1 = last(hi_.y, origin.y), z1 = last(hi_.z, origin.z);
    if (x0 >= x1 || y0 >= y1 || z0 >= z1) return {};
    return block.compute_range({x0, y0, z0}, {x1, y1, z1}, 0);
  }

  vk::Device& device_;
  const field::ScalarGrid& grid_;
  const ResidencyOptions options_;
  const TexelEncoder encoder_;
  ResidentGrid resident_;
  Index3 lo_, hi_, size_;
  int pad_ = 0;  ///< voxels on each side, for a cubic grid
  AtlasPlan atlas_;
};

}  // namespace

Result<ResidentGrid> make_resident_grid(vk::Device& device, const field::ScalarGrid& grid, const ResidencyOptions& options) {
  return MirrorBuilder(device, grid, options).build();
}

std::optional<std::uint64_t> resident_grid_bytes(vk::Device& device, const field::ScalarGrid& grid, const ResidencyOptions& options) {
  const auto bytes = MirrorBuilder(device, grid, options).bytes();
  return bytes ? std::optional(bytes->needed) : std::nullopt;
}

std::optional<std::uint64_t> resident_image_bytes(vk::Device& device, const field::ScalarGrid& grid, const ResidencyOptions& options) {
  const auto bytes = MirrorBuilder(device, grid, options).bytes();
  return bytes ? std::optional(bytes->images) : std::nullopt;
}

Result<ResidentGrid> make_downsampled_resident_grid(vk::Device& device, const field::CoarseGrid& grid, int factor,
                                                    const ResidencyOptions& options) {
  CATENA_TRY(ResidentGrid resident, make_resident_grid(device, *grid.grid, options));
  resident.downsample_factor = factor;
  resident.downsampled = grid.grid;
  const Vec3 origin(resident.origin.x, resident.origin.y, resident.origin.z);
  resident.domain_lo = grid.domain.lo - origin;
  resident.domain_hi = grid.domain.hi - origin;
  return resident;
}

}  // namespace catena::render
