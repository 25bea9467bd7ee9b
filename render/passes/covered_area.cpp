#include "render/passes/covered_area.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/field/grid.h"

namespace catena::render {

VkRect2D covered_area(std::span<const Vec3> points, const Camera& camera) {
  double x0 = camera.width, y0 = camera.height, x1 = 0, y1 = 0;
  if (points.empty()) return {};
  for (const Vec3& point : points) {
    const auto pixel = project(camera, point);
    if (!pixel) return {{0, 0}, {std::uint32_t(camera.width), std::uint32_t(camera.height)}};
    x0 = std::min(x0, pixel->x);
    y0 = std::min(y0, pixel->y);
    x1 = std::max(x1, pixel->x);
    y1 = std::max(y1, pixel->y);
  }
  x0 = std::clamp(std::floor(x0) - 1, 0.0, camera.width);
  y0 = std::clamp(std::floor(y0) - 1, 0.0, camera.height);
  x1 = std::clamp(std::ceil(x1) + 1, x0, camera.width);
  y1 = std::clamp(std::ceil(y1) + 1, y0, camera.height);
  return {{std::int32_t(x0), std::int32_t(y0)}, {std::uint32_t(x1 - x0), std::uint32_t(y1 - y0)}};
}

VkRect2D covered_area(std::span<const field::ScalarGrid* const> grids, const Camera& camera) {
  std::vector<Vec3> corners;
  for (const field::ScalarGrid* grid : grids)
    for (int i = 0; i < 8; ++i) corners.push_back(grid->corner(i));
  return covered_area(corners, camera);
}

}  // namespace catena::render
