#include "render/mirror/brick_distances.h"

#include <algorithm>

namespace catena::render {

// Chamfer distance of the largest coordinate to the nearest brick of another kind, for all kinds at once: two sweeps over the 13
// neighbours that come before (after) a brick. Outside the grid nothing is of another kind.
std::vector<std::uint8_t> plain_distances(const std::array<std::int32_t, 3>& bricks, const std::vector<std::uint16_t>& kind) {
  const auto [nx, ny, nz] = bricks;
  std::vector<std::uint8_t> distance(kind.size());
  for (std::size_t i = 0; i < kind.size(); ++i) distance[i] = kind[i] ? 255 : 0;
  const auto relax = [&, nx = nx, ny = ny, nz = nz](int x, int y, int z, int sign) {
    const std::size_t at = (std::size_t(z) * ny + y) * nx + x;
    int here = distance[at];
    for (int k = 0; k < 13 && here > 1; ++k) {
      const int a = x + sign * (k % 3 - 1), b = y + sign * (k / 3 % 3 - 1), c = z + sign * (k / 9 - 1);
      if (a < 0 || b < 0 || c < 0 || a >= nx || b >= ny || c >= nz) continue;
      const std::size_t other = (std::size_t(c) * ny + b) * nx + a;
      here = std::min(here, kind[other] == kind[at] ? distance[other] + 1 : 1);
    }
    distance[at] = std::uint8_t(here);
  };
  for (int z = 0; z < nz; ++z)
    for (int y = 0; y < ny; ++y)
      for (int x = 0; x < nx; ++x) relax(x, y, z, 1);
  for (int z = nz - 1; z >= 0; --z)
    for (int y = ny - 1; y >= 0; --y)
      for (int x = nx - 1; x >= 0; --x) relax(x, y, z, -1);
  return distance;
}

std::vector<std::uint8_t> brick_distances(const std::array<std::int32_t, 3>& bricks, const std::vector<std::uint8_t>& active) {
  std::vector<std::uint16_t> kind(active.size());
  std::transform(active.begin(), active.end(), kind.begin(), [](std::uint8_t a) { return std::uint16_t(a ? 0 : 1); });
  return plain_distances(bricks, kind);
}

}  // namespace catena::render
