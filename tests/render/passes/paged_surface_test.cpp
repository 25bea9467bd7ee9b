// SPDX-License-Identifier: MIT
/// Isosurfaces from pages: the same image and depth as in memory, and no holes where pages of different levels meet.
#include <cmath>

#include "render/image/image_error.h"
#include "tests/render/support/image_fixture.h"
#include "tests/support/formula_bricks.h"

namespace catena::test::paged_surface_test {

using namespace catena::render;

class PagedSurfaces : public ImageTest {};

constexpr field::Index3 kSize{150, 130, 140};  // 3 x 3 x 3 bricks

RenderSettings complete() {
  RenderSettings settings;
  settings.waits_for_pages = settings.shows_finest_pages = true;
  return settings;
}

IsosurfaceItem surface(GridPtr grid, std::shared_ptr<const field::PagedGrid> paged, double level, std::uint32_t id) {
  IsosurfaceItem item{std::move(grid), level, {0.9f, 0.7f, 0.2f}, 1, id};
  item.paged = std::move(paged);
  return item;
}

FramePacket view(std::vector<IsosurfaceItem> items) {
  FramePacket packet = make_packet({400, -330, 260}, {75, 65, 70}, 20);
  packet.isosurfaces = std::move(items);
  return packet;
}

TEST_F(PagedSurfaces, AreThoseOfTheGridInMemory) {
  const auto source = std::make_shared<const FormulaBricks>(kSize, 1, [](const Vec3& p) {
    return 30000 + 20000 * std::sin(0.11 * p.x + 0.02 * p.z) * std::cos(0.07 * p.y) + 9000 * std::sin(0.83 * p.z - 0.3 * p.x);
  });
  const GridPtr whole = source->whole(0), coarse = source->whole(1);
  const auto paged = make_paged(source);
  const Image8 expected = draw(view({surface(whole, nullptr, 31000, 1), surface(whole, nullptr, 52000, 2)}), complete(), "expected");
  const std::vector<float> expected_depths = depths();
  const Image8 blurred = draw(view({surface(coarse, nullptr, 31000, 1), surface(coarse, nullptr, 52000, 2)}));
  const Image8 image = draw(view({surface(coarse, paged, 31000, 1), surface(coarse, paged, 52000, 2)}), complete(), "paged");
  EXPECT_GT(measure_error(blurred, expected).rmse, 3);
  EXPECT_LT(measure_error(image, expected).rmse, 0.05);
  EXPECT_EQ(renderer_->stats().resident_grids, 0u);
  const std::vector<float> image_depths = depths();
  std::size_t surfaces = 0, wrong = 0;
  for (std::size_t i = 0; i < image_depths.size(); ++i) {
    surfaces += std::isfinite(expected_depths[i]);
    wrong += std::isfinite(expected_depths[i]) != std::isfinite(image_depths[i]) ||
             (std::isfinite(expected_depths[i]) && std::fabs(expected_depths[i] - image_depths[i]) > 1e-2);
  }
  EXPECT_GT(surfaces, 4000u);
  EXPECT_LE(wrong, 2u);  // rays that graze the surface
}

TEST_F(PagedSurfaces, HaveNoHolesOnTheFaceBetweenBricks) {
  const auto source = std::make_shared<const FormulaBricks>(kSize, 1, [](const Vec3& p) { return 257 * p.z; });
  FramePacket packet = make_packet({-245.3, -397.3, 426.7}, {75, 65, 127.5}, 20);
  packet.width = 320;
  packet.height = 240;
  packet.isosurfaces = {surface(source->whole(0), nullptr, 32896, 1)};
  draw(packet, complete());
  const std::vector<std::uint32_t> expected = ids();
  packet.isosurfaces = {surface(source->whole(1), make_paged(source), 32896, 1)};
  draw(packet, complete(), "face");
  const std::vector<std::uint32_t> shown = ids();
  std::size_t covered = 0, different = 0;
  for (std::size_t i = 0; i < shown.size(); ++i) covered += expected[i] == 1, different += expected[i] != shown[i];
  EXPECT_GT(covered, 2000u);
  EXPECT_LE(different, 2u);
}

TEST_F(PagedSurfaces, HaveNoHolesWherePagesOfDifferentLevelsMeet) {
  // a wall in y of waves that the coarse level flattens: it is at another place in the pages that can be read
  const auto source = std::make_shared<FormulaBricks>(
      kSize, 1, [](const Vec3& p) { return 30000 + 400 * (p.y - 65) + 6000 * std::sin(1.5 * p.x) * std::sin(1.5 * p.z); });
  source->breaks = [](int level, const field::Index3& brick) { return level == 0 && brick.x == 1; };
  FramePacket packet = make_packet({75, -400, 70}, {75, 65, 70}, 20);
  packet.isosurfaces = {surface(source->whole(1), make_paged(source), 30000, 1)};
  draw(packet, complete(), "mixed");
  EXPECT_GT(renderer_->paging().resident, 0u);
  EXPECT_LT(renderer_->paging().resident, renderer_->paging().visible);
  const std::vector<std::uint32_t> mixed = ids();
  std::size_t holes = 0;
  for (std::uint32_t y = 30; y < 90; ++y)
    for (std::uint32_t x = 40; x < 120; ++x) holes += mixed[y * packet.width + x] == 0;
  EXPECT_EQ(holes, 0u);
}

}  // namespace catena::test::paged_surface_test
