#include "render/mirror/packed_volume.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <mutex>

#include "engine/base/threads.h"
#include "render/vk/commands.h"

namespace catena::render {

namespace {

using field::Index3;
constexpr double kMaxVoxels = 64.0 * 1024 * 1024;  // 256 MiB of words; above, the brick atlas serves better

struct Extent {
  Index3 lo, size;
};

Extent extent_of(const field::ScalarGrid& grid) {
  const Vec3 lo = grid.index_box().lo, hi = grid.index_box().hi;
  const auto whole = [](double v) { return std::int32_t(std::lround(v)); };
  const Index3 first{whole(lo.x), whole(lo.y), whole(lo.z)};
  return {first, {whole(hi.x) - first.x + 1, whole(hi.y) - first.y + 1, whole(hi.z) - first.z + 1}};
}

/// Least and greatest of the four (x, x+1) x (y, y+1) neighbours of a row of cells.
void row_range(const float* a, const float* b, int cells, float* least, float* greatest) {
  for (int x = 0; x < cells; ++x) {
    const float a0 = a[x], a1 = a[x + 1], b0 = b[x], b1 = b[x + 1];
    const float l0 = a0 < a1 ? a0 : a1, l1 = b0 < b1 ? b0 : b1, g0 = a0 < a1 ? a1 : a0, g1 = b0 < b1 ? b1 : b0;
    least[x] = l0 < l1 ? l0 : l1;
    greatest[x] = g0 < g1 ? g1 : g0;
  }
}

}  // namespace

bool can_be_packed(const vk::Device& device, const field::ScalarGrid& grid) {
  const field::Box& box = grid.index_box();
  const Vec3 n = box.hi - box.lo + Vec3(1.0);
  const double limit = device.info().limits.maxImageDimension3D;
  return grid.stats().active_voxels > 0 && !grid.has_mask() && grid.stats().nan_count == 0 && std::isfinite(grid.background()) &&
         std::min({n.x, n.y, n.z}) >= 2 && std::max({n.x, n.y, n.z}) <= limit && n.x * n.y * n.z <= kMaxVoxels;
}

std::uint64_t packed_bytes(const field::ScalarGrid& grid) {
  const Index3 n = extent_of(grid).size;
  return sizeof(std::uint32_t) * std::uint64_t(n.x) * std::uint64_t(n.y) * std::uint64_t(n.z);
}

ValueInterval range_to_encode(const Index3& size, const std::vector<float>& values, const ValueInterval& active) {
  const std::size_t plane = std::size_t(size.x) * size.y;
  const float from = float(active.least), to = float(active.greatest);
  float least = from, greatest = to;
  std::mutex lock;
  parallel_for(std::size_t(size.z - 1), 4, [&](std::size_t begin, std::size_t end) {
    const int cells = size.x - 1;
    std::vector<float> l0(cells), g0(cells), l1(cells), g1(cells);
    float part_least = from, part_greatest = to;
    for (std::size_t z = begin; z < end; ++z)
      for (int y = 0; y + 1 < size.y; ++y) {
        const float* row = &values[z * plane + std::size_t(y) * size.x];
        row_range(row, row + size.x, cells, l0.data(), g0.data());
        row_range(row + plane, row + plane + size.x, cells, l1.data(), g1.data());
        for (int x = 0; x < cells; ++x) {
          const float l = std::min(l0[x], l1[x]), g = std::max(g0[x], g1[x]);
          const bool touches = g > from && l < to;
          part_least = touches && l < part_least ? l : part_least;
          part_greatest = touches && g > part_greatest ? g : part_greatest;
        }
      }
    const std::scoped_lock held(lock);
    least = std::min(least, part_least);
    greatest = std::max(greatest, part_greatest);
  });
  return {least, greatest};
}

Result<PackedVolume> make_packed_volume(vk::Device& device, const field::ScalarGrid& grid, const ValueInterval& active) {
  CATENA_ASSERT(can_be_packed(device, grid));
  const Extent extent = extent_of(grid);
  const Index3 n = extent.size;
  const std::size_t row = std::size_t(n.x), plane = row * n.y;
  PackedVolume packed;
  packed.origin = extent.lo;
  packed.size = n;

  // codes of all voxels
  std::vector<std::uint8_t> codes(plane * n.z);
  {
    std::vector<float> values(codes.size());
    parallel_for(std::size_t(n.z), 8, [&](std::size_t begin, std::size_t end) {
      grid.read_block({extent.lo.x, extent.lo.y, extent.lo.z + std::int32_t(begin)}, {n.x, n.y, std::int32_t(end - begin)},
                      std::span(values).subspan(begin * plane, (end - begin) * plane));
    });
    const ValueInterval range = range_to_encode(n, values, active);
    packed.lo = range.least;
    packed.per_code = (range.greatest - range.least) / 255;
    const bool flat = !(packed.per_code > 0) || !std::isfinite(1 / packed.per_code);
    if (flat) packed.per_code = 0;
    const auto lo = float(packed.lo), scale = flat ? 0.0f : float(1 / packed.per_code);
    parallel_for(codes.size(), 1 << 16, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const float code = (values[i] - lo) * scale + 0.5f;
        codes[i] = std::uint8_t(code > 0.0f ? (code < 255.0f ? code : 255.0f) : 0.0f);
      }
    });
  }

  // words, plane by plane
  vk::ImageInfo info;
  info.type = VK_IMAGE_TYPE_3D;
  info.format = VK_FORMAT_R32_UINT;
  info.extent = {std::uint32_t(n.x), std::uint32_t(n.y), std::uint32_t(n.z)};
  info.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  auto image = vk::Image::create(device, info);
  if (!image) return Error{fmt::format("the grid \"{}\" cannot be packed: {}", grid.name(), image.error().message)};
  packed.words = std::move(*image);
  CATENA_CHECK(vk::upload_planes(device, packed.words, 1, [&](std::uint32_t first, std::uint32_t count, std::byte* out) {
    parallel_for(std::size_t(count) * n.y, 64, [&](std::size_t begin, std::size_t end) {
      std::vector<std::uint32_t> words(row);
      for (std::size_t line = begin; line < end; ++line) {
        const std::uint8_t* a = &codes[first * plane + line * row];
        const std::uint8_t* b = line % n.y + 1 < std::size_t(n.y) ? a + row : a;
        for (std::size_t x = 0; x + 1 < row; ++x)
          words[x] = a[x] | std::uint32_t(a[x + 1]) << 8 | std::uint32_t(b[x]) << 16 | std::uint32_t(b[x + 1]) << 24;
        words[row - 1] = (a[row - 1] | std::uint32_t(b[row - 1]) << 16) * 0x101u;
        std::memcpy(out + line * row * 4, words.data(), row * 4);
      }
    });
  }));

  // ranges by brick
  const auto bricks = [](int voxels) { return (voxels - 1 + kSmallBrick - 1) / kSmallBrick; };
  packed.bricks = {bricks(n.x), bricks(n.y), bricks(n.z)};
  const auto [bx, by, bz] = packed.bricks;
  packed.ranges.resize(std::size_t(bx) * by * bz);
  parallel_for(std::size_t(by) * bz, 16, [&, bx = bx, by = by](std::size_t begin, std::size_t end) {
    std::vector<std::uint8_t> least(row), greatest(row);
    for (std::size_t line = begin; line < end; ++line) {
      const int y0 = kSmallBrick * int(line % std::size_t(by)), z0 = kSmallBrick * int(line / std::size_t(by));
      std::fill(least.begin(), least.end(), std::uint8_t(255));
      std::fill(greatest.begin(), greatest.end(), std::uint8_t(0));
      for (int z = z0; z <= std::min(z0 + kSmallBrick, n.z - 1); ++z)
        for (int y = y0; y <= std::min(y0 + kSmallBrick, n.y - 1); ++y) {
          const std::uint8_t* from = &codes[z * plane + y * row];
          for (std::size_t x = 0; x < row; ++x) {
            least[x] = std::min(least[x], from[x]);
            greatest[x] = std::max(greatest[x], from[x]);
          }
        }
      for (int x = 0; x < bx; ++x) {
        CodeRange& range = packed.ranges[line * bx + x];
        for (int k = kSmallBrick * x; k <= std::min(kSmallBrick * (x + 1), n.x - 1); ++k)
          range = {std::min(range.least, least[k]), std::max(range.greatest, greatest[k])};
      }
    }
  });
  return packed;
}

namespace {

using field::Index3;

struct Vector {
  float x, y, z;
  float length() const { return std::sqrt(x * x + y * y + z * z); }
};

struct Values {
  Index3 n;
  std::vector<float> v;
  /// Ends are clamped to the grid, as the exact raycast does.
  Vector gradient(int x, int y, int z) const {
    const std::size_t row = std::size_t(n.x), plane = row * n.y, at = z * plane + y * row + x;
    const auto along = [&](int i, int size, std::size_t stride) {
      const bool before = i > 0, after = i + 1 < size;
      return (v[at + (after ? stride : 0)] - v[at - (before ? stride : 0)]) / float(int(before) + int(after));
    };
    return {along(x, n.x, 1), along(y, n.y, row), along(z, n.z, plane)};
  }
};

double root_mean_square(const Values& values, const ValueInterval& active) {
  double sum = 0;
  std::size_t count = 0;
  std::mutex lock;
  parallel_for(std::size_t(values.n.z), 4, [&](std::size_t begin, std::size_t end) {
    double part = 0;
    std::size_t some = 0;
    for (std::size_t z = begin; z < end; z += 2)
      for (int y = 0; y < values.n.y; y += 2)
        for (int x = 0; x < values.n.x; x += 2) {
          const float v = values.v[z * std::size_t(values.n.x) * values.n.y + std::size_t(y) * values.n.x + x];
          if (!(v >= float(active.least) && v <= float(active.greatest))) continue;
          const double l = values.gradient(x, y, int(z)).length();
          part += l * l;
          some += l > 0;
        }
    const std::scoped_lock held(lock);
    sum += part;
    count += some;
  });
  return count > 0 ? std::sqrt(sum / double(count)) : 1;
}

}  // namespace

Result<GradientVolume> make_gradient_volume(vk::Device& device, const field::ScalarGrid& grid, const ValueInterval& active) {
  CATENA_ASSERT(can_be_packed(device, grid));
  const field::Box& box = grid.index_box();
  const auto whole = [](double a) { return std::int32_t(std::lround(a)); };
  const Index3 lo{whole(box.lo.x), whole(box.lo.y), whole(box.lo.z)};
  Values values;
  values.n = {whole(box.hi.x) - lo.x + 1, whole(box.hi.y) - lo.y + 1, whole(box.hi.z) - lo.z + 1};
  const Index3 n = values.n;
  const std::size_t plane = std::size_t(n.x) * n.y;
  values.v.resize(plane * n.z);
  parallel_for(std::size_t(n.z), 8, [&](std::size_t begin, std::size_t end) {
    grid.read_block({lo.x, lo.y, lo.z + std::int32_t(begin)}, {n.x, n.y, std::int32_t(end - begin)},
                    std::span(values.v).subspan(begin * plane, (end - begin) * plane));
  });
  const auto longest = float(3 * root_mean_square(values, active));
  GradientVolume volume;
  volume.unit = longest / 127;

  vk::ImageInfo info;
  info.type = VK_IMAGE_TYPE_3D;
  info.format = VK_FORMAT_R8G8B8A8_UNORM;
  info.extent = {std::uint32_t(n.x), std::uint32_t(n.y), std::uint32_t(n.z)};
  info.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  CATENA_TRY(volume.image, vk::Image::create(device, info));
  CATENA_CHECK(vk::upload_planes(device, volume.image, 1, [&](std::uint32_t first, std::uint32_t count, std::byte* out) {
    parallel_for(std::size_t(count) * n.y, 64, [&](std::size_t begin, std::size_t end) {
      const auto code = [](float a) { return std::byte(std::lround(128 + 127 * a)); };
      for (std::size_t line = begin; line < end; ++line) {
        std::byte* to = out + 4 * line * n.x;
        for (int x = 0; x < n.x; ++x, to += 4) {
          const Vector g = values.gradient(x, int(line % n.y), int(first + line / n.y));
          const float scale = 1 / std::max(longest, g.length());
          to[0] = code(g.x * scale);
          to[1] = code(g.y * scale);
          to[2] = code(g.z * scale);
          to[3] = std::byte(g.length() > longest ? 255 : 0);
        }
      }
    });
  }));
  return volume;
}

}  // namespace catena::render
