// SPDX-License-Identifier: MIT
// Rows of images: sizes, fields of view, extreme camera positions, and numbers of lines.
#include "tests/limits/limits_table.h"
#include "tests/limits/render_fixture.h"

namespace catena::extremes {
namespace image_limits_test {

using render::Image8;

/// A ball of radius 1 (a formula on 33^3 nodes) on an empty background.
Image8 ball(const std::string& camera, std::uint32_t width, std::uint32_t height,
            const std::string& drawn = R"("isosurfaces": [{"field": "s", "level": 1}])") {
  const test::TemporaryFolder folder;
  return draw(R"({"fields": {"s": {"analytic": "sphere", "resolution": 65}}, )" + drawn + R"(, "background": "transparent", "camera": {)" +
                  camera + "}}",
              folder, width, height);
}

std::string from(const Vec3& position, double fovy_deg) {
  return fmt::format(R"("position": {}, "target": [0, 0, 0], "fovy_deg": {})", triple(position), fovy_deg);
}

/// Relative difference between the number of pixels that the ball covers and those within a disk of the given radius.
double off_the_disk(const Image8& picture, double radius) {
  double right = 0;
  for (std::uint32_t y = 0; y < picture.height; ++y)
    for (std::uint32_t x = 0; x < picture.width; ++x)
      right += std::hypot(x + 0.5 - 0.5 * picture.width, y + 0.5 - 0.5 * picture.height) < radius;
  return std::fabs(count_covered(picture) - right) / std::max(1.0, right);
}

std::string any_field_of_view() {
  constexpr std::uint32_t kSide = 64;
  double off = 0;
  for (const double fov : {1e-3, 1e-2, 0.1, 1.0, 30.0, 90.0, 150.0, 170.0, 179.0}) {
    // the distance at which the ball is half as wide as the image, but outside the data's box
    const double half = std::tan(fov * M_PI / 360), distance = std::max(std::sqrt(1 + 1 / (0.25 * half * half)), 3.6);
    const Image8 picture = ball(from({distance * 0.6, -distance * 0.64, distance * 0.48}, fov), kSide, kSide);
    off = std::max(off, off_the_disk(picture, 0.5 * kSide * std::tan(std::asin(1 / distance)) / half));
  }
  return Findings().at_most("difference from the area of the disk", off, 0.01);
}

std::string any_size() {
  struct Size {
    std::uint32_t width, height;
  };
  Findings found;
  double off = 0;
  for (const Size& size : {Size{1, 1}, Size{1, 8192}, Size{8192, 1}, Size{3, 1000}}) {
    const Image8 picture =
        ball(R"("position": [0, -6, 0], "target": [0, 0, 0], "projection": "orthographic", "height": 4)", size.width, size.height);
    if (picture.width != size.width || picture.height != size.height) found.add("a picture of another size");
    off = std::max(off, off_the_disk(picture, 0.25 * size.height));
  }
  return found.at_most("difference from the area of the disk", off, 0.01);
}

std::string any_height_of_an_orthographic_picture() {
  Findings found;
  for (const char* height : {"1e-15", "1e-9", "1e15"}) {
    const Image8 picture =
        ball(std::string(R"("position": [0, -6, 0], "target": [0, 0, 0], "projection": "orthographic", "height": )") + height, 32, 24);
    const double part = count_covered(picture) / (32 * 24);
    found.add(std::string(height) + ": " +
              (part == 1   ? "the ball everywhere"
               : part == 0 ? "the ball is smaller than a pixel"
                           : "a part of the ball"));
  }
  return found;
}

std::string as_far_away_as_can_be() {
  const Image8 picture = ball(R"("position": [0, -1e15, 0], "target": [0, 0, 0], "fovy_deg": 0.001)", 32, 24);
  return seen(picture);
}

std::string on_the_target() { return seen(ball(R"("position": [1, 2, 3], "target": [1, 2, 3])", 32, 24)); }

std::string in_the_plane_of_a_slice() {
  const std::string slice = R"("slices": [{"field": "s", "axis": "z", "at": 0, "color": "viridis"}])";
  Findings found;
  double maximum = 0;
  for (const Vec3& eye : {Vec3(0, -6, 0), Vec3(0, -1, 0), Vec3(0.3, 0.2, 0), Vec3(1e-3, 0, 0)}) {
    const Image8 picture = ball(from(eye, 60), 64, 48, slice);
    maximum = std::max(maximum, count_covered(picture));
  }
  found.at_most("visible pixels", maximum, 0);
  const Image8 above = ball(from({0, -1, 1e-3}, 60), 64, 48, slice);
  return found.add(count_covered(above) > 300 ? "from 0.001 above, it is visible" : "from 0.001 above, it is not visible");
}

// ---- lines ----

std::string lines(const std::string& seeds, const std::string& more = {}) {
  const test::TemporaryFolder folder;
  const std::string text = R"({"fields": {"v": {"analytic": "helix", "resolution": 9}}, "background": "transparent",
    "streamlines": [{"field": "v", "radius": 0.01, "seeds": )" +
                           seeds + more + R"(}],
    "camera": {"position": [4, -5, 3], "target": [0, 0, 0]}})";
  std::size_t count = 0;
  const std::string visible = seen(draw(text, folder, 64, 48, &count), 100);
  return fmt::format("{} lines, {}", count, visible);
}

std::string no_lines() { return lines("[]"); }
std::string no_lines_of_a_pattern() { return lines(R"({"line": {"from": [0, 0, 0], "to": [1, 0, 0], "count": 0}})"); }
std::string too_many_lines() { return lines(R"({"line": {"from": [0, 0, 0], "to": [1, 0, 0], "count": 100001}})"); }
std::string hundred_thousand_lines() {
  return lines(R"({"sphere": {"center": [0, 0, 0], "radius": 1.5, "count": 100000, "inside": true}})",
               R"(, "length": 0.01, "tolerance": 1e-4)");
}

}  // namespace image_limits_test

Group image_rows() {
  using namespace image_limits_test;
  return {"Images",
          {
              {"AnyFieldOfView", "A sphere with fields of view of 0.001 to 179 degrees, from a matching distance",
               "difference from the area of the disk at most 0.01", any_field_of_view},
              {"AnySize", "Images of 1x1, 1x8192, 8192x1 and 3x1000 pixels", "difference from the area of the disk at most 0.01", any_size},
              {"AnyHeightOfAnOrthographicPicture", "Orthographic images with heights of 1e-15, 1e-9 and 1e15 units",
               "1e-15: the ball everywhere; 1e-9: the ball everywhere; 1e15: the ball is smaller than a pixel",
               any_height_of_an_orthographic_picture},
              {"AsFarAwayAsCanBe", "Camera 1e15 units away", "empty image", as_far_away_as_can_be},
              {"OnTheTarget", "Camera at its target",
               "s.json:1: \"target\": the target is at the position, or too near to it; two different points were expected", on_the_target},
              {"InThePlaneOfASlice", "Camera in the plane of a slice, outside its field and inside",
               "visible pixels at most 0; from 0.001 above, it is visible", in_the_plane_of_a_slice},
              {"NoLines", "No seeds", "s.json:2: \"seeds\" is missing or empty; at least one seed [x, y, z], or a pattern, was expected",
               no_lines},
              {"NoLinesOfAPattern", "A pattern of 0 seeds", "s.json:2: \"count\" is 0; a whole number from 1 to 100000 was expected",
               no_lines_of_a_pattern},
              {"TooManyLines", "A pattern of 100001 seeds", "s.json:2: \"count\" is 100001; a whole number from 1 to 100000 was expected",
               too_many_lines},
              {"HundredThousandLines", "A pattern of 100000 seeds", "100000 lines, visible", hundred_thousand_lines},
          }};
}

}  // namespace catena::extremes
