// SPDX-License-Identifier: MIT
/// Slices: colours, lines, depths and ids against closed forms and an independent evaluation on the CPU.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/geometry/flow/lic.h"
#include "render/frame/camera.h"
#include "tests/render/support/image_fixture.h"

namespace catena::test::slice_test {

using namespace catena::render;

class SliceImage : public ImageTest {};

using Table = std::vector<std::array<double, 4>>;
const Table kTable{{-4, 0.1, 0.0, 0.9}, {-1, 0.9, 0.2, 0.1}, {0.5, 0.2, 1.0, 0.3}, {6, 1.0, 0.9, 0.0}};

std::array<double, 3> table_color(const Table& table, double value) {
  if (value <= table.front()[0]) return {table.front()[1], table.front()[2], table.front()[3]};
  for (std::size_t i = 1; i < table.size(); ++i)
    if (value <= table[i][0]) {
      const double u = (value - table[i - 1][0]) / (table[i][0] - table[i - 1][0]);
      std::array<double, 3> c{};
      for (std::size_t k = 0; k < 3; ++k) c[k] = (1 - u) * table[i - 1][k + 1] + u * table[i][k + 1];
      return c;
    }
  return {table.back()[1], table.back()[2], table.back()[3]};
}

/// A rotated, sheared and anisotropic mapping away from the origin.
field::Mapping sheared() {
  const Mat3 turn = Mat3(Vec3(0.8, 0.6, 0.0), Vec3(-0.6, 0.8, 0.0), Vec3(0.0, 0.0, 1.0));
  const Mat3 shear = Mat3(Vec3(0.10, 0.0, 0.0), Vec3(0.04, 0.13, 0.0), Vec3(-0.03, 0.05, 0.08));
  return field::Mapping::from_linear(turn * shear, {5, -3, 2});
}

GridPtr wavy_grid(const std::function<bool(const Vec3&)>& valid = nullptr) {
  return make_grid(
      {24, 20, 28}, [](const Vec3& p) { return 3 * std::sin(0.5 * p.x) * std::cos(0.35 * p.y) + 0.1 * p.z; }, sheared(), valid);
}

Vec3 centre_of(const field::ScalarGrid& grid) {
  return grid.mapping().world_from_index(0.5 * grid.index_box().lo + 0.5 * grid.index_box().hi);
}

const Table kWhite{{0, 1, 1, 1}};

SliceItem slice_of(GridPtr grid, const Vec3& point, const Vec3& normal, const Table& colors = kTable) {
  return {std::move(grid), point, normal, colors};
}

/// An orthographic view with y upwards.
void set_plan_view(FramePacket& packet, double height) {
  packet.view.up = {0, 1, 0};
  set_orthographic(packet, height);
}

/// Intersection of a pixel's ray with a plane in index space, and its distance in voxels inside the domain.
struct Met {
  Vec3 world{0.0}, index{0.0};
  double inside = 0, view_depth = 0;
};
Met meet(const Camera& camera, const SliceItem& item, double x, double y) {
  const Ray ray = pixel_ray(camera, x, y);
  const double s = dot(item.normal, item.point - ray.origin) / dot(item.normal, ray.direction);
  Met met;
  met.world = ray.origin + s * ray.direction;
  met.index = item.grid->mapping().index_from_world(met.world);
  met.inside = HUGE_VAL;
  for (int a = 0; a < 3; ++a)
    met.inside = std::min({met.inside, met.index[a] - item.grid->index_box().lo[a], item.grid->index_box().hi[a] - met.index[a]});
  met.view_depth = dot(met.world - camera.position, -camera.back);
  return met;
}

TEST_F(SliceImage, ATextureChangesColorsByItsTexels) {
  const auto grid = wavy_grid();
  FramePacket packet = make_packet(centre_of(*grid) + Vec3(2.5, -4, 3), centre_of(*grid));
  packet.slices = {slice_of(grid, centre_of(*grid), {0.5, -0.6, 0.9}, {{0, 0.5, 0.5, 0.25}})};
  SliceItem& item = packet.slices[0];
  const Image8 plain = draw(packet);
  // a texture of four columns: bright, dark, without a flow, bright at phase 0.5 only
  auto texture = std::make_shared<flow::LicTexture>();
  const Vec3 n = direction(item.normal), u = direction(cross(Vec3(0, 0, 1), n));
  texture->plane = {item.point - 3.0 * u - 3.0 * cross(n, u), u, cross(n, u), 2, 4, 4, 0, 0};
  constexpr std::int16_t kHalf = 16384, kOne = 32767;
  for (int j = 0; j < 4; ++j)
    for (const flow::LicTexture::Texel& texel :
         {flow::LicTexture::Texel{kHalf, 0, 0, kOne}, {-kHalf, 0, 0, kOne}, {kHalf, 0, 0, 0}, {0, -kHalf, 0, kOne}})
      texture->texels.push_back(texel);
  item.texture = texture;
  item.texture_strength = 0.6f;
  const Camera camera = make_camera(packet.view, packet.width, packet.height, {});
  for (const float phase : {0.f, 0.5f}) {
    item.texture_phase = phase;
    const Image8 image = draw(packet, {}, fmt::format("texture_{:.0f}", 10 * phase));
    const double last = phase == 0 ? 0.4 : 1.6;
    const double factors[] = {1.6, 0.4, 1, last};
    int seen[4] = {}, worst = 0;
    for (std::uint32_t y = 0; y < packet.height; ++y)
      for (std::uint32_t x = 0; x < packet.width; ++x) {
        const std::size_t at = 4 * (std::size_t{y} * packet.width + x);
        const Met met = meet(camera, item, x + 0.5, y + 0.5);
        const double column = dot(met.world - texture->plane.origin, u) / 2;
        const auto k = static_cast<int>(std::lround(column));
        if (plain.rgba[at] == 0 || met.inside < 0.1 || k < 0 || k > 3 || std::fabs(column - k) > 0.02) continue;
        ++seen[k];
        for (int c = 0; c < 3; ++c)
          worst = std::max(
              worst, std::abs(static_cast<int>(std::lround(std::min(255.0, factors[k] * (c == 2 ? 63.75 : 127.5)))) - image.rgba[at + c]));
      }
    EXPECT_LE(worst, 5) << phase;  // a fiftieth of the way to the next column
    EXPECT_GT(seen[1] + seen[2], 50);
  }
}

TEST_F(SliceImage, EveryPixelOfAShearedGridHasItsTableColorDepthAndId) {
  const auto grid = wavy_grid();
  for (const bool orthographic : {false, true}) {
    FramePacket packet = make_packet(centre_of(*grid) + Vec3(2.5, -4, 3), centre_of(*grid));
    if (orthographic) set_orthographic(packet, 3);
    packet.slices = {slice_of(grid, centre_of(*grid) + Vec3(0.1, 0, 0.05), {0.5, -0.6, 0.9})};
    packet.slices[0].id = 17;
    const Image8 image = draw(packet, {}, orthographic ? "orthographic" : "perspective");
    const std::vector<float> depth = depths();
    const std::vector<std::uint32_t> id = ids();
    const Camera camera = make_camera(packet.view, packet.width, packet.height, {});
    int inside = 0, worst = 0;
    double worst_depth = 0;
    for (std::uint32_t y = 0; y < packet.height; ++y)
      for (std::uint32_t x = 0; x < packet.width; ++x) {
        const Met met = meet(camera, packet.slices[0], x + 0.5, y + 0.5);
        if (std::fabs(met.inside) < 0.01) continue;
        const std::uint8_t* p = image.pixel(x, y);
        const std::size_t at = y * packet.width + x;
        ASSERT_EQ(p[3], met.inside > 0 ? 255 : 0) << x << " " << y;
        ASSERT_EQ(id[at], met.inside > 0 ? 17u : 0u);
        if (met.inside <= 0) continue;
        ++inside;
        field::Cursor cursor;
        const auto color = table_color(kTable, grid->sample(met.world, cursor).value);
        for (std::size_t c = 0; c < 3; ++c) worst = std::max(worst, std::abs(int(std::lround(255 * color[c])) - int(p[c])));
        // minus the depth offset over coplanar surfaces: a fraction of the distance, and the slope over 1/128 pixel
        const auto beside = [&](double dx, double dy) {
          return std::fabs(meet(camera, packet.slices[0], x + 0.5 + dx, y + 0.5 + dy).view_depth - met.view_depth);
        };
        const double due = (1 - 8e-6) * met.view_depth - beside(1. / 128, 0) - beside(0, 1. / 128);
        worst_depth = std::max(worst_depth, std::fabs(depth[at] - due));
      }
    EXPECT_GT(inside, 3000);
    EXPECT_LE(worst, 1);
    EXPECT_LE(worst_depth, 2e-5);
    RecordProperty("worst_color", worst);
  }
}

TEST_F(SliceImage, AThresholdLeavesOutOtherValues) {
  const auto grid = make_grid({33, 33, 9}, [](const Vec3& p) { return p.x; });
  FramePacket packet = make_packet({16, 16, 40}, {16, 16, 0});
  set_plan_view(packet, 40);
  for (const Threshold& threshold : {Threshold{{8, 20}}, Threshold{{2, 8}, {20, 30}}, Threshold{{40, 50}}}) {
    packet.slices = {slice_of(grid, {16, 16, 4}, {0, 0, 1}, kWhite)};
    packet.slices[0].threshold = threshold;
    const Image8 image = draw(packet);
    const Camera camera = make_camera(packet.view, packet.width, packet.height, {});
    for (std::uint32_t x = 0; x < packet.width; ++x) {
      const double value = meet(camera, packet.slices[0], x + 0.5, packet.height / 2 + 0.5).world.x;
      const auto near_bound = [&](const auto& range) { return std::fabs(value - range[0]) < 0.01 || std::fabs(value - range[1]) < 0.01; };
      if (std::ranges::any_of(threshold, near_bound) || std::fabs(value) < 0.01 || std::fabs(value - 32) < 0.01) continue;
      const bool shown = value > 0 && value < 32 && is_within(threshold, value);
      EXPECT_EQ(image.pixel(x, packet.height / 2)[3], shown ? 255 : 0) << value;
    }
  }
}

/// Position of a line in a row or a column, as the centroid of its darkness.
double centroid(const Image8& image, std::uint32_t from, std::uint32_t to, std::uint32_t row, double* sum_out = nullptr) {
  double sum = 0, moment = 0;
  for (std::uint32_t x = from; x < to; ++x) {
    const double dark = 1 - image.pixel(x, row)[1] / 255.0;
    sum += dark;
    moment += dark * (x + 0.5);
  }
  if (sum_out) *sum_out = sum;
  return moment / sum;
}

/// x + 2 y on a plane seen perpendicularly: contours at x = level - 2 y with the stated width.
TEST_F(SliceImage, ContoursOfALinearFieldHaveTheirPositionAndWidth) {
  const auto grid = make_grid({33, 33, 9}, [](const Vec3& p) { return p.x + 2 * p.y; });
  FramePacket packet = make_packet({16, 16, 40}, {16, 16, 0});
  set_plan_view(packet, 30);  // 0.25 per pixel
  packet.background = {1, 1, 1, 1};
  packet.slices = {slice_of(grid, {0, 0, 4}, {0, 0, 1}, kWhite)};
  packet.slices[0].contour_levels = {30.1, 48.33, 63};
  for (const double width : {1.0, 2.0, 5.0}) {
    packet.slices[0].line_width = float(width);
    const Image8 image = draw(packet, {}, "w" + std::to_string(int(width)));
    for (const double level : packet.slices[0].contour_levels)
      for (std::uint32_t row = 30; row < 90; row += 7) {
        const double y = 16 + (59.5 - row) * 0.25, x = level - 2 * y, px = 80 + (x - 16) / 0.25;
        if (px < 20 || px > 140) continue;
        double sum = 0;
        EXPECT_NEAR(centroid(image, std::uint32_t(px) - 12, std::uint32_t(px) + 13, row, &sum), px, 0.05) << level << " " << row;
        // along a row the line is wider by 1 / cos of its slope
        EXPECT_NEAR(sum, width * std::sqrt(5.0), 0.02 * width + 0.1) << level << " " << row;
      }
  }
}

/// Oblique perspective view: the line is at the intersection of plane, level and row.
TEST_F(SliceImage, ContoursInPerspectiveAreWithinATenthOfAPixel) {
  const auto grid = make_grid({32, 32, 32}, [](const Vec3& p) { return p.x - 0.3 * p.y + 0.5 * p.z; });
  FramePacket packet = make_packet({-10, -45, 40}, {15.5, 15.5, 15.5}, 40);
  packet.background = {1, 1, 1, 1};
  packet.slices = {slice_of(grid, {15.5, 15.5, 15.5}, {0.2, -0.5, 0.8}, kWhite)};
  packet.slices[0].contour_levels = {12.3, 18.9, 24};
  packet.slices[0].line_width = 2;
  const Image8 image = draw(packet, {}, "lines");
  const Camera camera = make_camera(packet.view, packet.width, packet.height, {});
  const auto value = [&](double x, double y) {
    const Met met = meet(camera, packet.slices[0], x, y);
    return met.inside > 1 ? met.index.x - 0.3 * met.index.y + 0.5 * met.index.z : NAN;
  };
  int found = 0;
  for (std::uint32_t row = 20; row < 110; row += 3)
    for (std::uint32_t x = 12; x < 148; ++x)
      for (const double level : packet.slices[0].contour_levels) {
        const double a = value(x, row + 0.5), b = value(x + 1, row + 0.5);
        if (std::isnan(value(x - 10, row + 0.5)) || std::isnan(value(x + 10, row + 0.5)) || (a - level) * (b - level) >= 0) continue;
        // lines nearly parallel to a row are excluded
        if (std::fabs(value(x, row + 0.5) - value(x, row + 1.5)) > 1.5 * std::fabs(a - b)) continue;
        EXPECT_NEAR(centroid(image, x - 6, x + 7, row), x + (level - a) / (b - a), 0.1) << row << " " << level;
        ++found;
      }
  EXPECT_GT(found, 20);
}

/// A cone on a trilinear grid: its contour is a circle up to the grid's error, and has a constant width.
TEST_F(SliceImage, ACurvedContourKeepsItsWidthAcrossCells) {
  const auto grid = make_grid({33, 33, 5}, [](const Vec3& p) { return norm(Vec3(p.x - 16.2, p.y - 15.7, 0)); });
  FramePacket packet = make_packet({16, 16, 40}, {16, 16, 0});
  set_plan_view(packet, 30);
  packet.background = {1, 1, 1, 1};
  packet.slices = {slice_of(grid, {0, 0, 2}, {0, 0, 1}, kWhite)};
  packet.slices[0].contour_levels = {9};
  packet.slices[0].line_width = 2;
  const Image8 image = draw(packet, {}, "circle");
  for (int i = 0; i < 72; ++i) {
    const double angle = 2 * M_PI * i / 72;
    const auto dark_at = [&](double r) {  // bilinear interpolation
      const double x = 80 + (16.2 + r * std::cos(angle) - 16) / 0.25 - 0.5, y = 60 - (15.7 + r * std::sin(angle) - 16) / 0.25 - 0.5;
      const auto i0 = std::uint32_t(x), j0 = std::uint32_t(y);
      const double u = x - i0, v = y - j0;
      const auto d = [&](std::uint32_t a, std::uint32_t b) { return 1 - image.pixel(a, b)[1] / 255.0; };
      return (1 - v) * ((1 - u) * d(i0, j0) + u * d(i0 + 1, j0)) + v * ((1 - u) * d(i0, j0 + 1) + u * d(i0 + 1, j0 + 1));
    };
    double sum = 0, moment = 0;
    for (double r = 7.5; r < 10.5; r += 0.01) {
      sum += 0.01 * dark_at(r);
      moment += 0.01 * r * dark_at(r);
    }
    EXPECT_NEAR(sum / 0.25, 2, 0.15) << i;
    EXPECT_NEAR(moment / sum, 9, 0.03) << i;
  }
}

/// The contour of a level on a slice is at the cut of the isosurface of that level.
TEST_F(SliceImage, AContourIsAtTheCutOfTheIsosurface) {
  const auto grid = wavy_grid();
  FramePacket packet = make_packet(centre_of(*grid) + Vec3(0, 0, 8), centre_of(*grid));
  set_plan_view(packet, 3);
  const Vec3 point = centre_of(*grid) + Vec3(0, 0, 0.3);
  packet.slices = {slice_of(grid, point, {0, 0, 1}, kWhite)};
  packet.slices[0].contour_levels = {1.5};
  const Image8 lines = draw(packet, {}, "line");
  packet.slices.clear();
  packet.isosurfaces = {{grid, 1.5, {1, 0, 0}}};
  packet.clip_planes = {{point, {0, 0, -1}}};  // keeps the part below the plane
  draw(packet, {}, "cut");
  const std::vector<float> depth = depths();
  // next to the line, on the surface's side, the depth is nearly the plane's
  const double plane = 8 - 0.3;
  int checked = 0;
  for (std::uint32_t y = 2; y + 2 < packet.height; ++y)
    for (std::uint32_t x = 2; x + 2 < packet.width; ++x) {
      const float d = depth[y * packet.width + x];
      if (!(std::fabs(d - plane) < 0.001)) continue;
      double darkest = 0;
      for (std::uint32_t b = y - 1; b <= y + 1; ++b)
        for (std::uint32_t a = x - 1; a <= x + 1; ++a) darkest = std::max(darkest, 1 - lines.pixel(a, b)[1] / 255.0);
      EXPECT_GT(darkest, 0.3) << x << " " << y;
      ++checked;
    }
  EXPECT_GT(checked, 5);
}

TEST_F(SliceImage, MaskedAndUndefinedCellsAreTransparent) {
  const auto masked = make_grid(
      {16, 16, 16}, [](const Vec3& p) { return p.x; }, {}, [](const Vec3& p) { return p.x < 8; });
  const auto holed = make_grid({16, 16, 16}, [](const Vec3& p) { return p.x == 11 && p.y == 7 ? NAN : p.x; });
  FramePacket packet = make_packet({7.5, 7.5, 40}, {7.5, 7.5, 0});
  set_plan_view(packet, 24);  // 0.2 per pixel
  const auto column = [](double x) { return std::uint32_t(80 + (x - 7.5) / 0.2); };
  const auto row = [](double y) { return std::uint32_t(60 - (y - 7.5) / 0.2); };
  for (const float opacity : {1.0f, 0.5f}) {
    packet.slices = {slice_of(masked, {0, 0, 7.5}, {0, 0, 1})};
    packet.slices[0].opacity = opacity;
    const Image8 left = draw(packet, {}, "masked");
    const int alpha = opacity == 1 ? 255 : 128;
    EXPECT_NEAR(left.pixel(column(6.8), 60)[3], alpha, 1);
    EXPECT_EQ(left.pixel(column(7.3), 60)[3], 0);
    EXPECT_EQ(left.pixel(column(12), 60)[3], 0);
    packet.slices[0].grid = holed;
    const Image8 hole = draw(packet, {}, "hole");
    for (const double y : {6.2, 7.8}) EXPECT_EQ(hole.pixel(column(10.3), row(y))[3], 0);
    EXPECT_NEAR(hole.pixel(column(9.8), row(7.5))[3], alpha, 1);
    EXPECT_NEAR(hole.pixel(column(11), row(8.3))[3], alpha, 1);
  }
}

TEST_F(SliceImage, SlicesInTheDomainsFacesAreDrawnCompletely) {
  const auto grid = make_grid({9, 9, 9}, [](const Vec3& p) { return p.x; });
  FramePacket packet = make_packet({4, 4, 40}, {4, 4, 0});
  set_plan_view(packet, 12);  // 0.1 per pixel
  for (const double z : {0.0, 8.0}) {
    packet.slices = {slice_of(grid, {0, 0, z}, {0, 0, z > 4 ? 1.0 : -1.0})};
    EXPECT_EQ(covered(draw(packet, {}, "z" + std::to_string(int(z))), 255), 80 * 80) << z;
  }
  packet.slices = {slice_of(grid, {0, 0, 8.01}, {0, 0, 1})};
  EXPECT_EQ(covered(draw(packet)), 0);
}

/// Clip planes cut a slice unless "clip" is false; a slice in a clip plane is kept.
TEST_F(SliceImage, ClipPlanesCutASliceAndKeepOneThatLiesInThem) {
  const auto grid = make_grid({17, 17, 17}, [](const Vec3& p) { return p.x; });
  FramePacket packet = make_packet({2, -14, 34}, {8, 8, 8}, 40);
  packet.slices = {slice_of(grid, {8, 8, 8}, {0.3, 0.2, 1})};
  const auto drawn = [&](const char* name) { return covered(draw(packet, {}, name), 255); };
  const int whole = drawn("whole");
  packet.clip_planes = {{{8, 8, 8}, {-0.3, -0.2, -1}}};
  EXPECT_EQ(drawn("in_plane"), whole);
  packet.clip_planes = {{{8, 8, 8}, {1, 0, 0}}};
  const int half = drawn("half");
  EXPECT_LT(half, 0.7 * whole);
  EXPECT_GT(half, 0.3 * whole);
  packet.slices[0].is_clipped = false;
  EXPECT_EQ(drawn("unclipped"), whole);
}

TEST_F(SliceImage, AShadedSliceUsesItsNormalAndSlicesHideEachOther) {
  const auto grid = make_grid({17, 17, 17}, [](const Vec3&) { return 0.5; });
  FramePacket packet = make_packet({8, -30, 8}, {8, 8, 8});
  set_orthographic(packet, 24);
  packet.slices = {slice_of(grid, {8, 8, 8}, {std::sqrt(3.0), 1, 0}, {{0, 0, 0, 1}})};
  packet.slices[0].lit = true;
  EXPECT_NEAR(draw(packet, {}, "lit").pixel(80, 60)[2], 255 * (0.2 + 0.7 * 0.5), 1.5);
  packet.slices.push_back(slice_of(grid, {8, 8, 8}, {-std::sqrt(3.0), 1, 0}, {{0, 1, 0, 0}}));
  for (const bool turned : {false, true}) {
    if (turned) std::swap(packet.slices[0], packet.slices[1]);
    const Image8 cross = draw(packet, {}, "cross");
    // the blue slice is nearer on the right, the red one on the left
    EXPECT_GT(cross.pixel(90, 60)[2], 100);
    EXPECT_EQ(cross.pixel(90, 60)[0], 0);
    EXPECT_EQ(cross.pixel(70, 60)[0], 255);
  }
}

/// A square of two triangles at z = 8, larger than the grids.
MeshItem square_at_8() {
  auto geometry = std::make_shared<MeshGeometry>();
  geometry->vertices = {{-2.3, -2.1, 8}, {18.7, -2.2, 8}, {18.4, 18.9, 8}, {-2.6, 18.2, 8}};
  geometry->triangles = {0, 1, 2, 0, 2, 3};
  return {geometry, {0, 0.4f, 1}, 3};
}

/// A slice is over a coplanar surface at every pixel, from both sides and for any opacity: the image equals the slice's image over the
/// surface's image.
TEST_F(SliceImage, ASliceIsDrawnOverCoplanarSurfaces) {
  const auto rising = make_grid({17, 17, 17}, [](const Vec3& p) { return p.z; });
  const auto even = make_grid({17, 17, 17}, [](const Vec3&) { return 1; });
  struct Eye {
    const char* name;
    Vec3 position, target;
    double fovy_deg, height;  // height > 0: orthographic
  };
  const std::vector<Eye> eyes{{"below", {-9, -17, -21}, {8, 8, 8}, 40, 0},
                              {"close", {7.7, 0.9, 8.21}, {8.1, 3, 8}, 70, 0},
                              {"far", {2100, -2900, 1830}, {8, 8, 8}, 0.3, 0},
                              {"orthographic", {25, -31, 22}, {8, 8, 8}, 30, 22}};
  for (const Eye& eye : eyes) {
    FramePacket empty = make_packet(eye.position, eye.target, eye.fovy_deg);
    set_size(empty, 96, 72);
    if (eye.height > 0) set_orthographic(empty, eye.height);
    empty.background = {0, 0, 0, 1};
    std::vector<FramePacket> surfaces;
    std::vector<Image8> under;
    for (const float opacity : {1.f, 0.6f}) {
      surfaces.push_back(empty);
      surfaces.back().meshes = {square_at_8()};
      surfaces.back().meshes[0].opacity = opacity;
      surfaces.push_back(empty);
      surfaces.back().isosurfaces = {{rising, 8.0, {0, 0.4f, 1}, opacity, 3}};
    }
    for (const FramePacket& packet : surfaces) under.push_back(draw(packet));
    for (const float opacity : {1.f, 0.4f}) {
      SliceItem slice = slice_of(even, {3, 4, 8}, {0, 0, 1}, {{0, 1, 0, 0}});
      slice.opacity = opacity;
      slice.id = 2;
      FramePacket packet = empty;
      packet.slices = {slice};
      const Image8 alone = draw(packet);
      for (std::size_t k = 0; k < surfaces.size(); ++k) {
        packet = surfaces[k];
        packet.slices = {slice};
        const std::string name = fmt::format("{}_{}_{:.0f}", eye.name, k, 10 * opacity);
        const Image8 both = draw(packet, {}, name);
        int covered = 0, wrong = 0;
        for (std::size_t i = 0; i < both.rgba.size(); i += 4) {
          if (alone.rgba[i] == 0 || under[k].rgba[i + 2] == 0) continue;
          ++covered;
          bool differs = false;
          for (std::size_t c = i; c < i + 3; ++c)
            differs = differs || std::fabs(both.rgba[c] - (alone.rgba[c] + (1 - opacity) * under[k].rgba[c])) > 2;
          wrong += differs;
        }
        EXPECT_GT(covered, 250) << name;
        EXPECT_EQ(wrong, 0) << name << ", of " << covered << " pixels";
      }
    }
  }
}

/// The atlas and the dense layout give the same image.
TEST_F(SliceImage, AtlasAndDenseStorageDrawTheSameImage) {
  const auto grid = wavy_grid();
  FramePacket packet = make_packet(centre_of(*grid) + Vec3(2.5, -4, 3), centre_of(*grid));
  packet.slices = {slice_of(grid, centre_of(*grid), {0.5, -0.6, 0.9})};
  packet.slices[0].contour_levels = {-1, 0, 1, 2};
  RenderSettings dense, atlas;
  dense.layout = GridLayout::dense;
  atlas.layout = GridLayout::atlas;
  EXPECT_LE(max_difference(draw(packet, dense, "dense"), draw(packet, atlas, "atlas")), 1);
}

}  // namespace catena::test::slice_test
