// SPDX-License-Identifier: MIT
// Rows of grids in rendering: any voxel size, shape and position, any magnitude of values, and grids without visible values.
#include "tests/limits/limits_table.h"
#include "tests/limits/render_fixture.h"

namespace catena::extremes {
namespace grid_rendering_limits_test {

using render::Image8;

constexpr std::uint32_t kWidth = 96, kHeight = 72;

struct World {
  double h = 0.0625;    ///< voxel edge
  Vec3 origin{0.0};     ///< centre, in voxels
  double values = 1;    ///< factor of all values
  bool turned = false;  ///< true: anisotropic voxels, 1:1:1024, of the same linear field
};

/// A ball as a volume, a surface and a slice, lines and arrows of a flow, and a box: every kind of object with a position.
Image8 scene_in(const World& world) {
  const test::TemporaryFolder folder;
  constexpr int n = 33;
  write_raw(folder / "s.raw", {n, n, n},
            [&](int x, int y, int z) { return world.values * norm((1.0 / 16) * (Vec3(x, y, z) - Vec3(16.0))); });
  std::vector<float> vectors;
  for (int z = 0; z < n; ++z)
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x)
        for (const double v : {-(y - 16) / 16.0, (x - 16) / 16.0, 0.4}) vectors.push_back(static_cast<float>(v));
  test::write_file(folder / "v.raw", to_bytes(vectors));
  const auto at = [&](const Vec3& p) { return triple(world.h * (16.0 * p + world.origin)); };
  const std::string layout = fmt::format(R"("shape": [33, 33, 33], "spacing": {}, "origin": {})", triple(Vec3(world.h)), at(Vec3(-1.0)));
  const double s = world.values, unit = 16 * world.h;
  return draw(R"({"fields": {"s": {"file": "s.raw", )" + layout + R"(}, "v": {"file": "v.raw", "type": "float32x3", )" + layout + R"(}},
    "volumes": [{"field": "s", "color": [[0, 0.9, 0.2, 0.1], [)" +
                  fmt::format("{}", 1.7 * s) + R"(, 0.1, 0.3, 0.9]], "extinction": [[0, 0], [)" +
                  fmt::format("{}, 0], [{}, {}", 0.7 * s, 1.7 * s, 0.8 / unit) + R"(]]}],
    "isosurfaces": [{"field": "s", "level": )" +
                  fmt::format("{}", 0.5 * s) + R"(}],
    "slices": [{"field": "s", "axis": "z", "at": )" +
                  fmt::format("{}", world.h * (world.origin.z - 6)) + R"(, "color": "viridis"}],
    "streamlines": [{"field": "v", "seeds": [)" +
                  at({0.8, 0, -0.9}) + R"(], "radius": )" + fmt::format("{}", 0.03 * unit) + R"(}],
    "bounding_box": true, "background": "transparent",
    "camera": {"position": )" +
                  at({2, -3.2, 1.5}) + R"(, "target": )" + at(Vec3(0.0)) + R"(, "fovy_deg": 36}})",
              folder, kWidth, kHeight);
}

/// Compares with the same scene with voxels of 1/16 at the origin.
std::string same_as_plain(const std::vector<World>& worlds, int more, double bound) {
  std::vector<Image8> pictures{scene_in({})};
  for (const World& world : worlds) pictures.push_back(scene_in(world));
  return same_pictures(pictures, 500, more, bound);
}

std::string voxels_of_any_size() { return same_as_plain({{1e-9}, {1e-3}, {1e3}, {1e9}}, 2, 0.002); }
// a silhouette moved by half a pixel changes a colour by half: 24 is a tenth of a pixel
std::string far_from_the_origin() {
  return same_as_plain({{0.0625, {1e7, 0, 0}}, {0.0625, {-1e7, 1e7, 1e7}}, {0.1, {1e7, -1e7, 1e7}}, {1e-9, {0, 0, 1e7}}}, 24, 0.002);
}
std::string values_of_any_size() { return same_as_plain({{0.0625, Vec3(0.0), 1e-29}, {0.0625, Vec3(0.0), 1e29}}, 2, 0.002); }

/// s = x + y / 2 + z / 4, reproduced exactly between any nodes, on 1025 x 33 x 2 voxels (edges 1:32:1024) and on 33^3.
std::string voxels_a_thousand_times_as_long() {
  const auto draw_on = [](const std::array<int, 3>& n) {
    const test::TemporaryFolder folder;
    const Vec3 spacing(2.0 / (n[0] - 1), 2.0 / (n[1] - 1), 2.0 / (n[2] - 1));
    write_raw(folder / "s.raw", n,
              [&](int x, int y, int z) { return x * spacing.x - 1 + (y * spacing.y - 1) / 2 + (z * spacing.z - 1) / 4; });
    return draw(R"({"fields": {"s": {"file": "s.raw", "shape": )" + fmt::format("[{}, {}, {}]", n[0], n[1], n[2]) + R"(, "spacing": )" +
                    triple(spacing) +
                    R"(, "origin": [-1, -1, -1]}},
      "volumes": [{"field": "s", "color": [[-1.75, 0.9, 0.2, 0.1], [1.75, 0.1, 0.3, 0.9]], "extinction": [[-1.75, 0], [1.75, 1]]}],
      "isosurfaces": [{"field": "s", "level": -0.4}], "slices": [{"field": "s", "axis": "z", "at": -0.7, "color": "viridis"}],
      "background": "transparent", "camera": {"position": [2, -3.2, 1.5], "target": [0, 0, 0], "fovy_deg": 36}})",
                folder, kWidth, kHeight);
  };
  return same_pictures({draw_on({33, 33, 33}), draw_on({1025, 33, 2})}, 500, 4, 0.01);
}

// ---- grids with few or no valid values ----

const std::string kVolume = R"("volumes": [{"field": "s"}])", kSlice = R"("slices": [{"field": "s", "axis": "z", "at": 4}])";
std::string surface_at(const std::string& level) { return R"("isosurfaces": [{"field": "s", "level": )" + level + "}]"; }

Image8 grid_of(const std::array<int, 3>& n, const std::function<double(int, int, int)>& value, const std::string& drawn) {
  const test::TemporaryFolder folder;
  write_raw(folder / "s.raw", n, value);
  return draw(R"({"fields": {"s": {"file": "s.raw", "shape": )" + fmt::format("[{}, {}, {}]", n[0], n[1], n[2]) + "}}, " + drawn +
                  R"(, "background": "transparent", "camera": {"position": [20, -30, 20], "target": [4, 4, 4]}})",
              folder, kWidth, kHeight);
}

/// Result of a grid of n[0] x n[1] x n[2] values, drawn as a volume, an isosurface, a slice, or all of them.
std::string seen_grid(const std::array<int, 3>& n, const std::function<double(int, int, int)>& value, const std::string& drawn) {
  return seen(grid_of(n, value, drawn));
}
std::string seen_cube(const std::function<double(int, int, int)>& value, const std::string& level) {
  return seen_grid({8, 8, 8}, value, kVolume + ", " + surface_at(level) + ", " + kSlice);
}

const double kNan = std::nan("");
bool even(int x, int y, int z) { return (x + y + z) % 2 == 0; }
double two_and_a_half(int, int, int) { return 2.5; }

std::string all_nan() {
  return seen_cube([](int, int, int) { return kNan; }, "1");
}
std::string every_second_nan() {
  return seen_cube([](int x, int y, int z) { return even(x, y, z) ? kNan : 1.0 * x; }, "1");
}
std::string checkerboard() {
  return seen_cube([](int x, int y, int z) { return even(x, y, z) ? -1.0 : 1.0; }, "0");
}
std::string constant() {
  return Findings()
      .add("its surface: " + seen_grid({8, 8, 8}, two_and_a_half, surface_at("2.5")))
      .add("its slice: " + seen_grid({8, 8, 8}, two_and_a_half, kSlice))
      .add("its volume: " + seen_grid({8, 8, 8}, two_and_a_half, kVolume));
}
std::string one_voxel() { return seen_grid({1, 1, 1}, two_and_a_half, kVolume); }
std::string two_voxels_each_way() {
  return seen_grid(
      {2, 2, 2}, [](int x, int, int) { return 1.0 * x; }, kVolume + ", " + surface_at("0.5"));
}
/// An array of ones in NumPy's format with index order z, y, x, drawn from all sides.
std::string flat_arrays() {
  Findings found;
  for (const std::array<int, 3>& n : {std::array{1, 1, 1}, {1, 1, 5}, {1, 5, 1}, {5, 1, 1}, {1, 5, 5}, {5, 5, 1}}) {
    const test::TemporaryFolder folder;
    std::string head = fmt::format("{{'descr': '<f4', 'fortran_order': False, 'shape': ({}, {}, {}), }}", n[0], n[1], n[2]);
    head += std::string(118 - 1 - head.size(), ' ') + "\n";
    test::write_file(folder / "a.npy", std::string("\x93NUMPY\x01\x00\x76\x00", 10) + head +
                                           to_bytes(std::vector<float>(static_cast<std::size_t>(n[0] * n[1] * n[2]), 1.0f)));
    const Image8 picture = draw(R"({"fields": {"s": {"file": "a.npy"}}, "volumes": [{"field": "s", "extinction": [[0, 0], [1, 5]]}],
        "background": "transparent"})",
                                folder, 32, 24);
    found.add(fmt::format("{}x{}x{}: ", n[0], n[1], n[2]) + seen(picture));
  }
  return found;
}

std::string beyond_floats() {
  const test::TemporaryFolder folder;
  std::vector<double> values;
  for (int i = 0; i < 512; ++i) values.push_back(i % 2 ? 1e300 : 0.1 * i);
  test::write_file(folder / "s.raw", to_bytes(values));
  auto scene = get(scene::parse_scene(R"({"fields": {"s": {"file": "s.raw", "type": "float64", "shape": [8, 8, 8]}},
      "slices": [{"field": "s", "axis": "z", "at": 4}]})",
                                      folder / "s.json"));
  get(render::make_frame(scene, 8, 8));
  Findings found;
  for (const std::string& note : scene.notes) found.add(note.substr(note.rfind('/') + 1));
  return found;
}

}  // namespace grid_rendering_limits_test

Group grid_rendering_rows() {
  using namespace grid_rendering_limits_test;
  return {
      "Rendered fields",
      {
          {"PicturesOfVoxelsOfAnySize",
           "Volume, isosurface, slice, streamline and box of grids with voxels of 1e-9 to 1e9, compared with voxels of 1/16",
           "visible; fraction of pixels that differ by more than 2/255 at most 0.002", voxels_of_any_size},
          {"PicturesFarFromTheOrigin", "The same 1e7 voxels from the origin, along one axis and along all; 24/255 is a tenth of a pixel",
           "visible; fraction of pixels that differ by more than 24/255 at most 0.002", far_from_the_origin},
          {"PicturesOfVoxelsAThousandTimesAsLong", "A linear field on voxels of 1:32:1024, compared with cubes",
           "visible; fraction of pixels that differ by more than 4/255 at most 0.01", voxels_a_thousand_times_as_long},
          {"PicturesOfValuesOfAnySize", "The same scene with values of 1e-29 and 1e29",
           "visible; fraction of pixels that differ by more than 2/255 at most 0.002", values_of_any_size},
          {"AllNan", "A grid of NaN", "s.json:1: field \"s\": s.raw: the data has no finite value in any active voxel", all_nan},
          {"EverySecondNan", "NaN in every second voxel: every cell has one", "empty image", every_second_nan},
          proved_elsewhere("NaN holes in a volume", "cells that touch one are transparent", "Volume.NanIsTransparent"),
          {"Checkerboard", "Isosurface of a checkerboard of 1 and -1 at level 0", "visible", checkerboard},
          {"Constant", "Isosurface, slice and volume of a constant grid, at its value",
           "its surface: empty image; its slice: visible; its volume: visible", constant},
          {"OneVoxel", "A .raw file of one voxel", "s.json:1: \"shape\" holds 1; three whole numbers from 2 to 65536 were expected",
           one_voxel},
          {"TwoVoxelsEachWay", "A grid of one cell", "visible", two_voxels_each_way},
          {"FlatArrays", "NumPy arrays of one voxel, and flat along one or two axes",
           "1x1x1: visible; 1x1x5: visible; 1x5x1: visible; 5x1x1: visible; 1x5x5: visible; 5x5x1: visible", flat_arrays},
          {"BeyondFloats", "64-bit numbers beyond the range of 32-bit floats",
           "s.raw: values of type float64 were rounded to 32-bit floats; s.raw: 256 values exceed the range of 32-bit floats and are read "
           "as holes",
           beyond_floats},
      }};
}

}  // namespace catena::extremes
