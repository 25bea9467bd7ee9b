#include "render/mirror/gradient_volume.h"

#include <algorithm>
#include <cmath>
#include <mutex>

#include "engine/base/parallel_for.h"
#include "render/mirror/packed_volume.h"
#include "render/vk/upload.h"

namespace catena::render {
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

double root_mean_square(const Values& values) {
  double sum = 0;
  std::size_t count = 0;
  std::mutex lock;
  parallel_for(std::size_t(values.n.z), 4, [&](std::size_t begin, std::size_t end) {
    double part = 0;
    std::size_t some = 0;
    for (std::size_t z = begin; z < end; z += 2)
      for (int y = 0; y < values.n.y; y += 2)
        for (int x = 0; x < values.n.x; x += 2) {
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

Result<GradientVolume> make_gradient_volume(vk::Device& device, const field::ScalarGrid& grid) {
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
  const auto longest = float(3 * root_mean_square(values));
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
