#include "render/mirror/grid_mirror.h"

#include <fmt/format.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <cstring>
#include <limits>
#include <unordered_map>

#include "engine/base/memory_limit.h"
#include "engine/base/threads.h"
#include "render/mirror/brick_slots.h"
#include "render/mirror/half.h"
#include "render/vk/commands.h"

namespace catena::render {
namespace {

using field::Index3;
constexpr std::uint64_t kCellMapBytes = 128;  // a brick, cell_map.h

/// Writes values as texels of the mirror's format. What is not finite becomes the least value (its cells are masked); what lies
/// outside the range can only be outside the domain, where it must stay finite all the same.
struct Encoder {
  bool float32;
  float offset, scale, least, greatest;
  void write(const float* from, std::size_t count, std::byte* out) const {
    for (std::size_t i = 0; i < count; ++i) {
      const float value = from[i] >= least ? std::min(from[i], greatest) : least;
      if (float32) {
        std::memcpy(out + 4 * i, &value, 4);
      } else {
        const std::uint16_t half = half_from_float((value - offset) / scale);
        std::memcpy(out + 2 * i, &half, 2);
      }
    }
  }
  /// What a texel gives back; rounding is monotonic, so ranges can be rounded at their ends.
  BrickRange stored(const BrickRange& r) const {
    if (float32 || r.empty()) return r;
    const auto back = [this](float v) { return offset + scale * float_from_half(half_from_float((v - offset) / scale)); };
    return {back(r.least), back(r.greatest)};
  }
  std::size_t texel() const { return float32 ? 4 : 2; }
};

Encoder choose_encoder(const field::ScalarGrid& grid, bool float32) {
  double least = grid.stats().min, greatest = grid.stats().max;
  const Vec3 voxels = grid.index_box().hi - grid.index_box().lo + Vec3(1.0);
  const float background = grid.background();
  const bool inactive_inside = double(grid.stats().active_voxels) < voxels.x * voxels.y * voxels.z;
  if (inactive_inside && std::isfinite(background)) {
    least = std::min(least, double(background));
    greatest = std::max(greatest, double(background));
  }
  if (!(least <= greatest)) least = greatest = 0;
  Encoder e{float32, 0, 1, float(least), float(greatest)};
  if (grid.interpolation() == field::Interpolation::cubic) {  // ghosts lie within one range of the data beyond its own
    const double span = grid.stats().max - grid.stats().min;
    e.least = float(std::max(std::min(least, grid.stats().min - span), -double{FLT_MAX}));
    e.greatest = float(std::min(std::max(greatest, grid.stats().max + span), double{FLT_MAX}));
  }
  if (float32) return e;
  const double largest = std::max(std::fabs(least), std::fabs(greatest)), range = greatest - least;
  if (range < 0.5 * largest && range > 0) {
    e.offset = float(least);
    e.scale = float(range);
  } else if (largest > 0) {
    // a power of two that brings the largest magnitude to 0.5..1: halves round alike at every power of two
    e.scale = std::exp2(float(std::clamp(std::ilogb(largest) + 1, -120, 120)));
  }
  if (range == 0) e.offset = float(least);
  return e;
}

/// Voxels and cell validity of a box of cells, with what they say about one brick.
struct Block {
  Index3 voxels;  ///< an axis, the apron included
  std::vector<float> values;
  std::vector<std::uint8_t> valid;  ///< by voxel of the block (the cell based there); empty: all valid

  void read(const field::ScalarGrid& grid, const Index3& origin, const Index3& size, bool masked) {
    voxels = size;
    const std::size_t count = std::size_t(size.x) * size.y * size.z;
    values.resize(count);
    grid.read_block(origin, size, values);
    if (!masked) return;
    valid.resize(count);
    grid.read_cell_valid(origin, size, valid);
    for (int z = 0; z + 1 < size.z; ++z)
      for (int y = 0; y + 1 < size.y; ++y)
        for (int x = 0; x + 1 < size.x; ++x) {
          std::uint8_t& v = valid[at(x, y, z)];
          for (int c = 0; c < 8 && v; ++c) v = std::isfinite(values[at(x + (c & 1), y + (c >> 1 & 1), z + (c >> 2))]);
        }
  }
  std::size_t at(int x, int y, int z) const { return (std::size_t(z) * voxels.y + y) * voxels.x + x; }

  /// Over the corners of valid cells with base from `first` to before `end`, and what lies within `reach` of the corners.
  BrickRange range(const Index3& first, const Index3& end, int reach) const {
    float least = std::numeric_limits<float>::infinity(), greatest = -least;
    const auto take = [&](const Index3& from, const Index3& to) {
      for (int z = from.z; z <= to.z; ++z)
        for (int y = from.y; y <= to.y; ++y)
          for (int x = from.x; x <= to.x; ++x) {
            const float v = values[at(x, y, z)];
            least = std::min(least, v);
            greatest = std::max(greatest, v);
          }
    };
    // most bricks are all valid, or not at all
    std::size_t some = 0, count = 0;
    if (!valid.empty()) {
      for (int z = first.z; z < end.z; ++z)
        for (int y = first.y; y < end.y; ++y)
          for (int x = first.x; x < end.x; ++x, ++count) some += valid[at(x, y, z)] != 0;
    }
    if (some == count) {
      take({first.x - reach, first.y - reach, first.z - reach}, {end.x + reach, end.y + reach, end.z + reach});
    } else if (some > 0) {
      for (int z = first.z; z < end.z; ++z)
        for (int y = first.y; y < end.y; ++y)
          for (int x = first.x; x < end.x; ++x)
            if (valid[at(x, y, z)]) take({x - reach, y - reach, z - reach}, {x + 1 + reach, y + 1 + reach, z + 1 + reach});
    }
    return least <= greatest ? BrickRange{least, greatest} : BrickRange{};
  }
};

/// What a cubic may make of samples in a range.
BrickRange widened(const BrickRange& r) {
  if (r.empty() || r.least == r.greatest) return r;
  const double beyond = field::kCubicOvershoot * (double(r.greatest) - r.least);
  const auto outwards = [](double v, float to) { return std::nextafter(float(std::clamp(v, -double{FLT_MAX}, double{FLT_MAX})), to); };
  return {outwards(r.least - beyond, -FLT_MAX), outwards(r.greatest + beyond, FLT_MAX)};
}

class MirrorBuilder {
 public:
  MirrorBuilder(vk::Device& device, const field::ScalarGrid& grid, const MirrorOptions& options)
      : device_(device), grid_(grid), options_(options), encoder_(choose_encoder(grid, options.float32)) {}

  Result<GridMirror> build() {
    CATENA_CHECK(ask());
    if (!plan()) return std::move(mirror_);
    mirror_.offset = encoder_.offset;
    mirror_.scale = encoder_.scale;
    CATENA_CHECK(mirror_.atlas ? build_atlas() : build_dense());
    if (mirror_.nearest) {
      CATENA_TRY(mirror_.one, vk::Sampler::create(device_, vk::Filter::nearest));
    }
    for (BrickRange& range : mirror_.ranges) range = mirror_.cubic ? widened(encoder_.stored(range)) : encoder_.stored(range);
    return std::move(mirror_);
  }

  /// Of the images, and with what making them and the maps needs.
  struct Bytes {
    std::uint64_t images = 0, needed = 0;
  };
  std::optional<Bytes> bytes() {
    if (!ask()) return std::nullopt;
    if (!plan()) return Bytes{};
    std::array<std::uint32_t, 3> values{std::uint32_t(size_.x + 2 * pad_), std::uint32_t(size_.y + 2 * pad_),
                                        std::uint32_t(size_.z + 2 * pad_)},
        mask = values;
    if (mirror_.atlas) {
      if (!assign_slots()) return std::nullopt;
      for (int a = 0; a < 3; ++a) {
        values[a] = slots_[a] * kApron;
        mask[a] = slots_[a] * kBrick;
      }
    } else {
      place(padded_lo());
    }
    const auto value_bytes = vk::image_bytes(device_, vk::volume_info(value_format(), values[0], values[1], values[2]));
    const auto mask_bytes = vk::image_bytes(device_, vk::volume_info(VK_FORMAT_R8_UINT, mask[0], mask[1], mask[2]));
    if (!value_bytes || !mask_bytes) return std::nullopt;
    const std::uint64_t staging = std::uint64_t(kApron) * values[0] * values[1] * encoder_.texel();
    // a word a brick; for surfaces also the map of cells
    const std::uint64_t map = mirror_.ranges.size() * (sizeof(std::uint32_t) + (encoder_.float32 ? kCellMapBytes : 0));
    const std::uint64_t images = *value_bytes + (mirror_.masked ? *mask_bytes : 0);
    return Bytes{images, images + std::max(staging, map) + map};
  }

 private:
  /// A sparse grid may reach over far more bricks than it has, and something is kept for each.
  Outcome ask() const {
    const Vec3 bricks = (grid_.index_box().hi - grid_.index_box().lo) / double(kBrick) + Vec3(2.0);
    constexpr double kBytesABrick = 48;  // plan and slots here; the map of cells is the GPU's
    return ask_for_memory(fmt::format("drawing the grid \"{}\", which reaches over {:.0f} x {:.0f} x {:.0f} bricks of 8^3 voxels,",
                                      grid_.name(), bricks.x, bricks.y, bricks.z),
                          kBytesABrick * bricks.x * bricks.y * bricks.z);
  }

  /// What the grid is and how it is laid out; false where there is nothing to draw.
  bool plan() {
    const Vec3 lo = grid_.index_box().lo, hi = grid_.index_box().hi;
    lo_ = {std::int32_t(std::lround(lo.x)), std::int32_t(std::lround(lo.y)), std::int32_t(std::lround(lo.z))};
    hi_ = {std::int32_t(std::lround(hi.x)), std::int32_t(std::lround(hi.y)), std::int32_t(std::lround(hi.z))};
    size_ = {hi_.x - lo_.x + 1, hi_.y - lo_.y + 1, hi_.z - lo_.z + 1};
    if (size_.x < 2 || size_.y < 2 || size_.z < 2 || grid_.stats().active_voxels == 0) return false;
    mirror_.drawable = true;
    mirror_.nearest = grid_.interpolation() == field::Interpolation::nearest;
    mirror_.masked = grid_.has_mask() || grid_.stats().nan_count > 0 || !std::isfinite(grid_.background());
    mirror_.cubic = grid_.interpolation() == field::Interpolation::cubic;
    pad_ = mirror_.cubic ? 1 : 0;
    if (mirror_.cubic) return true;
    if (options_.layout != MirrorLayout::dense) plan_atlas();
    mirror_.atlas = options_.layout == MirrorLayout::atlas || (options_.layout == MirrorLayout::automatic && atlas_pays());
    return true;
  }

  Index3 padded_lo() const { return {lo_.x - pad_, lo_.y - pad_, lo_.z - pad_}; }

  /// The first index of a brick, counted from the leaf that holds the box's corner.
  Index3 leaf(int x, int y, int z) const { return {leaves_lo_.x + kBrick * x, leaves_lo_.y + kBrick * y, leaves_lo_.z + kBrick * z}; }

  void place(const Index3& origin) {
    mirror_.origin = origin;
    mirror_.box_lo = Vec3(lo_.x - origin.x, lo_.y - origin.y, lo_.z - origin.z);
    mirror_.box_hi = Vec3(hi_.x - origin.x, hi_.y - origin.y, hi_.z - origin.z);
    mirror_.bricks = {(hi_.x - origin.x + kBrick - 1) / kBrick, (hi_.y - origin.y + kBrick - 1) / kBrick,
                      (hi_.z - origin.z + kBrick - 1) / kBrick};
    mirror_.ranges.assign(std::size_t(mirror_.bricks[0]) * mirror_.bricks[1] * mirror_.bricks[2], BrickRange{});
  }

  /// Finds the bricks whose 9^3 voxels are one value: the block and the seven that the apron touches.
  void plan_atlas() {
    const auto down = [](std::int32_t v) { return v & ~(kBrick - 1); };
    leaves_lo_ = {down(lo_.x), down(lo_.y), down(lo_.z)};
    place(leaves_lo_);
    const auto [bx, by, bz] = mirror_.bricks;
    // constant blocks, one more an axis for the aprons
    const int cx = bx + 1, cy = by + 1;
    std::vector<std::uint8_t> constant(std::size_t(cx) * cy * (bz + 1));
    std::vector<float> value(constant.size());
    parallel_for(constant.size(), 64, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        constant[i] = grid_.constant_block(leaf(int(i % cx), int(i / cx % cy), int(i / cx / cy)), value[i]) && std::isfinite(value[i]);
    });
    is_constant_.assign(mirror_.ranges.size(), 0);
    constant_value_.assign(mirror_.ranges.size(), 0);
    stored_ = 0;
    for (int z = 0; z < bz; ++z)
      for (int y = 0; y < by; ++y)
        for (int x = 0; x < bx; ++x) {
          bool same = !grid_.has_mask();
          const auto at = [&](int c) { return (std::size_t(z + (c >> 2)) * cy + y + (c >> 1 & 1)) * cx + x + (c & 1); };
          for (int c = 0; c < 8 && same; ++c) same = constant[at(c)] && value[at(c)] == value[at(0)];
          const std::size_t brick = mirror_.brick_index(x, y, z);
          is_constant_[brick] = same;
          constant_value_[brick] = value[at(0)];
          stored_ += !same;
        }
  }

  bool fits_dense() const {
    const auto limit = std::int32_t(device_.info().limits.maxImageDimension3D);
    return size_.x <= limit && size_.y <= limit && size_.z <= limit;
  }

  bool atlas_pays() const {
    const double dense = double(size_.x) * size_.y * size_.z, atlas = double(stored_) * kApron * kApron * kApron;
    return !fits_dense() || (dense > 64.0 * 64 * 64 && atlas < 0.5 * dense);
  }

  VkFormat value_format() const { return encoder_.float32 ? VK_FORMAT_R32_SFLOAT : VK_FORMAT_R16_SFLOAT; }

  Result<vk::Image> create_image(VkFormat format, std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    auto image = vk::Image::create(device_, vk::volume_info(format, x, y, z));
    if (!image) return Error{fmt::format("the grid \"{}\" cannot be mirrored: {}", grid_.name(), image.error().message)};
    return image;
  }

  Outcome create_images(std::uint32_t x, std::uint32_t y, std::uint32_t z, std::uint32_t mx, std::uint32_t my, std::uint32_t mz) {
    CATENA_TRY(mirror_.values, create_image(value_format(), x, y, z));
    if (!mirror_.masked) return Done{};
    CATENA_TRY(mirror_.mask, create_image(VK_FORMAT_R8_UINT, mx, my, mz));
    return Done{};
  }

  /// Rows of bricks, in parallel; the mask is uploaded from a copy kept while the values go up.
  Outcome build_dense() {
    const Index3 lo = padded_lo();
    place(lo);
    const auto nx = std::uint32_t(size_.x + 2 * pad_), ny = std::uint32_t(size_.y + 2 * pad_), nz = std::uint32_t(size_.z + 2 * pad_);
    CATENA_CHECK(create_images(nx, ny, nz, nx, ny, nz));
    std::vector<std::uint8_t> mask(mirror_.masked ? std::size_t(nx) * ny * nz : 0);
    const std::size_t texel = encoder_.texel();
    CATENA_CHECK(vk::upload_planes(device_, mirror_.values, kBrick, [&](std::uint32_t first, std::uint32_t count, std::byte* out) {
      const std::uint32_t layers = (count + kBrick - 1) / kBrick, rows = (ny + kBrick - 1) / kBrick;
      parallel_for(std::size_t(layers) * rows, 1, [&](std::size_t begin, std::size_t end) {
        Block block;
        for (std::size_t task = begin; task < end; ++task) {
          const int y0 = kBrick * int(task % rows), z0 = int(first) + kBrick * int(task / rows);
          // with what the brick's last cells reach, and a padded one's first ones
          const int before_y = std::min(pad_, y0), before_z = std::min(pad_, z0);
          const int height = std::min(kApron + pad_, int(ny) - y0), depth = std::min(kApron + pad_, int(nz) - z0);
          block.read(grid_, {lo.x, lo.y + y0 - before_y, lo.z + z0 - before_z}, {int(nx), height + before_y, depth + before_z},
                     mirror_.masked);
          for (int z = 0; z < std::min(kBrick, depth); ++z)
            for (int y = 0; y < std::min(kBrick, height); ++y) {
              const std::size_t row = (std::size_t(z0 + z) * ny + y0 + y) * nx, from = block.at(0, y + before_y, z + before_z);
              encoder_.write(&block.values[from], nx, out + (row - std::size_t(first) * ny * nx) * texel);
              if (!mask.empty()) std::copy_n(&block.valid[from], nx, &mask[row]);
            }
          find_ranges(block, y0, z0, before_y, before_z);
        }
      });
    }));
    if (mask.empty()) return Done{};
    return vk::upload_planes(device_, mirror_.mask, 1, [&](std::uint32_t first, std::uint32_t count, std::byte* out) {
      std::memcpy(out, mask.data() + std::size_t(first) * nx * ny, std::size_t(count) * nx * ny);
    });
  }

  /// Of a row of bricks along x from y0, z0 in the image, which are before_y, before_z in the block.
  void find_ranges(const Block& block, int y0, int z0, int before_y, int before_z) {
    const int cells_y = std::min(kBrick, int(mirror_.box_hi.y) - y0), cells_z = std::min(kBrick, int(mirror_.box_hi.z) - z0);
    if (cells_y < 1 || cells_z < 1) return;
    const auto cells_x = int(mirror_.box_hi.x);
    // the padding's cells are none: in the first bricks they are passed over
    const int first_y = before_y + std::max(0, pad_ - y0), first_z = before_z + std::max(0, pad_ - z0);
    for (int x = 0; x < mirror_.bricks[0]; ++x)
      mirror_.ranges[mirror_.brick_index(x, y0 / kBrick, z0 / kBrick)] =
          block.range({std::max(pad_, kBrick * x), first_y, first_z},
                      {std::min(kBrick * (x + 1), cells_x), before_y + cells_y, before_z + cells_z}, pad_);
  }

  /// Gives every brick a slot; constant ones of one value share theirs.
  Outcome assign_slots() {
    const std::size_t count = mirror_.ranges.size();
    mirror_.slots.assign(count, 0);
    std::vector<std::uint32_t> linear(count);
    std::unordered_map<float, std::uint32_t> shared;
    for (std::size_t i = 0; i < count; ++i) {
      std::uint32_t slot = std::uint32_t(brick_of_slot_.size());
      if (is_constant_[i]) {
        const auto [found, added] = shared.try_emplace(constant_value_[i], slot);
        slot = found->second;
        if (added) brick_of_slot_.push_back(i);
      } else {
        brick_of_slot_.push_back(i);
      }
      linear[i] = slot;
    }
    const auto slots = brick_slots(device_, brick_of_slot_.size(), kApron);
    if (!slots) return Error{fmt::format("the grid \"{}\" has {}", grid_.name(), slots.error().message)};
    slots_ = slots->an_axis;
    for (std::size_t i = 0; i < count; ++i) mirror_.slots[i] = slots->word(linear[i]);
    return Done{};
  }

  Outcome build_atlas() {
    CATENA_CHECK(assign_slots());
    const auto [sx, sy, sz] = slots_;
    CATENA_CHECK(create_images(sx * kApron, sy * kApron, sz * kApron, sx * kBrick, sy * kBrick, sz * kBrick));
    const auto [bx, by, bz] = mirror_.bricks;
    constexpr std::size_t mask_bytes = std::size_t(kBrick) * kBrick * kBrick;
    std::vector<std::uint8_t> mask(mirror_.masked ? mask_bytes * sx * sy * sz : 0);
    const std::size_t texel = encoder_.texel(), width = std::size_t(sx) * kApron, height = std::size_t(sy) * kApron;
    CATENA_CHECK(vk::upload_planes(
        device_, mirror_.values, kApron, [&, bx = bx, by = by, sx = sx, sy = sy](std::uint32_t first, std::uint32_t count, std::byte* out) {
          const std::size_t begin_slot = std::size_t(first / kApron) * sx * sy;
          const std::size_t end_slot = std::min(brick_of_slot_.size(), begin_slot + std::size_t(count / kApron) * sx * sy);
          std::memset(out, 0, width * height * count * texel);
          parallel_for(end_slot - begin_slot, 8, [&](std::size_t begin, std::size_t end) {
            Block block;
            for (std::size_t slot = begin_slot + begin; slot < begin_slot + end; ++slot) {
              const std::size_t brick = brick_of_slot_[slot];
              const int x = int(brick % std::size_t(bx)), y = int(brick / std::size_t(bx) % std::size_t(by)),
                        z = int(brick / std::size_t(bx) / std::size_t(by));
              const Index3 origin = leaf(x, y, z);
              block.read(grid_, origin, {kApron, kApron, kApron}, mirror_.masked);
              mirror_.ranges[brick] = clipped_range(block, origin);
              const std::size_t ox = slot % sx * kApron, oy = slot / sx % sy * kApron, oz = (slot - begin_slot) / sx / sy * kApron;
              for (int k = 0; k < kApron; ++k)
                for (int j = 0; j < kApron; ++j)
                  encoder_.write(&block.values[block.at(0, j, k)], kApron, out + (((oz + k) * height + oy + j) * width + ox) * texel);
              if (mask.empty()) continue;
              const std::size_t mw = std::size_t(sx) * kBrick, mh = std::size_t(sy) * kBrick;
              for (int k = 0; k < kBrick; ++k)
                for (int j = 0; j < kBrick; ++j)
                  std::copy_n(&block.valid[block.at(0, j, k)], kBrick,
                              &mask[((slot / sx / sy * kBrick + k) * mh + slot / sx % sy * kBrick + j) * mw + slot % sx * kBrick]);
            }
          });
        }));
    for (std::size_t i = 0; i < is_constant_.size(); ++i)
      if (is_constant_[i]) mirror_.ranges[i] = {constant_value_[i], constant_value_[i]};
    if (mask.empty()) return Done{};
    const std::size_t plane = std::size_t(sx) * kBrick * sy * kBrick;
    return vk::upload_planes(device_, mirror_.mask, 1, [&](std::uint32_t first, std::uint32_t count, std::byte* out) {
      std::memcpy(out, mask.data() + first * plane, count * plane);
    });
  }

  /// Cells outside the index box say nothing about a brick.
  BrickRange clipped_range(const Block& block, const Index3& origin) const {
    const auto first = [](int lo, int at) { return std::max(0, lo - at); };
    const auto last = [](int hi, int at) { return std::min(kBrick, hi - at); };
    const int x0 = first(lo_.x, origin.x), y0 = first(lo_.y, origin.y), z0 = first(lo_.z, origin.z);
    const int x1 = last(hi_.x, origin.x), y1 = last(hi_.y, origin.y), z1 = last(hi_.z, origin.z);
    if (x0 >= x1 || y0 >= y1 || z0 >= z1) return {};
    return block.range({x0, y0, z0}, {x1, y1, z1}, 0);
  }

  vk::Device& device_;
  const field::ScalarGrid& grid_;
  const MirrorOptions options_;
  const Encoder encoder_;
  GridMirror mirror_;
  Index3 lo_, hi_, size_, leaves_lo_;
  int pad_ = 0;  ///< voxels each side, of a cubic grid
  std::vector<std::uint8_t> is_constant_;
  std::vector<float> constant_value_;
  std::size_t stored_ = 0;
  std::vector<std::size_t> brick_of_slot_;
  std::array<std::uint32_t, 3> slots_{};
};

}  // namespace

Result<GridMirror> make_grid_mirror(vk::Device& device, const field::ScalarGrid& grid, const MirrorOptions& options) {
  return MirrorBuilder(device, grid, options).build();
}

std::optional<std::uint64_t> mirror_bytes(vk::Device& device, const field::ScalarGrid& grid, const MirrorOptions& options) {
  const auto bytes = MirrorBuilder(device, grid, options).bytes();
  return bytes ? std::optional(bytes->needed) : std::nullopt;
}

std::optional<std::uint64_t> mirror_image_bytes(vk::Device& device, const field::ScalarGrid& grid, const MirrorOptions& options) {
  const auto bytes = MirrorBuilder(device, grid, options).bytes();
  return bytes ? std::optional(bytes->images) : std::nullopt;
}

Result<GridMirror> make_coarse_mirror(vk::Device& device, const field::CoarseGrid& grid, int factor, const MirrorOptions& options) {
  CATENA_TRY(GridMirror mirror, make_grid_mirror(device, *grid.grid, options));
  mirror.factor = factor;
  mirror.coarse = grid.grid;
  const Vec3 origin(mirror.origin.x, mirror.origin.y, mirror.origin.z);
  mirror.domain_lo = grid.domain.lo - origin;
  mirror.domain_hi = grid.domain.hi - origin;
  return mirror;
}

}  // namespace catena::render
