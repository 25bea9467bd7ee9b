// SPDX-License-Identifier: MIT
#include <cmath>

#include "engine/field/derived/magnitude.h"
#include "engine/field/grid/grid.h"
#include "render/extract/extract_internal.h"
#include "tests/render/support/scene_packet.h"
#include "tests/support/support.h"

namespace catena::render::surfaces_test {

using test::packet_error, test::packet_from;

std::string sliced(const std::string& keys) {
  return R"({"fields": {"s": {"analytic": "sphere", "resolution": 9}, "v": {"analytic": "circle", "resolution": 9}},
    "slices": [{)" +
         keys + "}]}";
}

TEST(ExtractSlices, PlaneColorsAndLevelsReachThePacket) {
  const FramePacket packet =
      packet_from(sliced(R"("field": "s", "axis": "z", "at": 0.5, "color": [[0, 1, 0, 0], [2, 0, 0, 1]], "opacity": 0.5,
    "contours": {"count": 3, "width": 2, "color": [0, 1, 0]}, "clip": false)"));
  ASSERT_EQ(packet.slices.size(), 1u);
  const SliceItem& slice = packet.slices[0];
  EXPECT_EQ(slice.point, Vec3(0, 0, 0.5));
  EXPECT_EQ(slice.normal, Vec3(0, 0, 1));
  ASSERT_EQ(slice.colors.size(), 2u);
  EXPECT_EQ(slice.colors[1], (std::array<double, 4>{2, 0, 0, 1}));
  EXPECT_EQ(slice.contour_levels, (std::vector<double>{0.5, 1, 1.5}));
  EXPECT_EQ(slice.line_width, 2);
  EXPECT_EQ(slice.opacity, 0.5f);
  EXPECT_FALSE(slice.is_clipped);
  ASSERT_EQ(packet.objects.size(), 1u);
  EXPECT_EQ(packet.objects[0].kind, "slice");
  EXPECT_EQ(packet.objects[0].id, slice.id);
  // the fitted camera looks at the domain
  EXPECT_NEAR(packet_bounds(packet).diagonal(), 4 * std::sqrt(3.0), 1e-9);
}

TEST(ExtractSlices, NamedColorsCoverTheFieldAndMultiplesAreWithinIt) {
  const FramePacket packet = packet_from(sliced(R"("field": "s", "axis": "z", "at": 0, "contours": {"spacing": 0.75})"));
  const SliceItem& slice = packet.slices[0];
  EXPECT_EQ(slice.colors.front()[0], slice.grid->min_value());
  EXPECT_EQ(slice.colors.back()[0], slice.grid->max_value());
  EXPECT_EQ(slice.contour_levels, (std::vector<double>{0, 0.75, 1.5, 2.25, 3}));
}

TEST(ExtractSlices, AVectorFieldIsShownByItsMagnitude) {
  const FramePacket packet = packet_from(sliced(R"("field": "v", "axis": "z", "at": 0)"));
  field::Cursor cursor;
  for (const Vec3& p : {Vec3(1, 0.5, 0), Vec3(-1.5, 2, 1), Vec3(0, 0, -2)})
    EXPECT_NEAR(packet.slices[0].grid->sample(p, cursor).value, std::hypot(p.x, p.y), 1e-6);
}

TEST(ExtractSlices, TheMagnitudeGridKeepsMaskMappingAndHoles) {
  std::vector<float> xyz;
  std::vector<std::uint8_t> valid;
  for (int z = 0; z < 4; ++z)
    for (int y = 0; y < 5; ++y)
      for (int x = 0; x < 6; ++x) {
        xyz.insert(xyz.end(), {float(x), float(2 * y), z == 3 && x == 5 && y == 4 ? NAN : float(z)});
        valid.push_back(x < 4);
      }
  const auto mapping = field::Mapping::from_linear(Mat3(0.5), {10, 20, 30});
  const auto grid = field::make_vector_grid("v", mapping, {6, 5, 4}, xyz, valid);
  const auto magnitude = *field::make_magnitude_grid(*grid, "v");
  const auto whole = *field::make_magnitude_grid(*field::make_vector_grid("v", mapping, {6, 5, 4}, xyz), "v");
  field::Cursor one, two, three;
  for (int z = 0; z < 3; ++z)
    for (int y = 0; y < 4; ++y)
      for (int x = 0; x < 5; ++x) {
        const Vec3 middle = mapping.world_from_index(Vec3(x + 0.5, y + 0.5, z + 0.5));
        EXPECT_EQ(magnitude->sample(middle, one).inside, grid->sample(middle, two).inside) << x << y << z;
        EXPECT_EQ(whole->sample(middle, three).inside, !(x == 4 && y == 3 && z == 2)) << x << y << z;
        if (x == 4 && y == 3 && z == 2) continue;
        EXPECT_NEAR(magnitude->sample(mapping.world_from_index(Vec3(x, y, z)), one).value, norm(Vec3(x, 2 * y, z)), 1e-5);
      }
}

TEST(ExtractSlices, UndrawableSlicesAreErrorsWithTheirLine) {
  for (const auto& [keys, expected] : {std::pair{R"("field": "s", "axis": "z", "at": 2.5)", "does not meet the domain"},
                                       {R"("field": "s", "axis": "z", "at": 0, "contours": {"spacing": 1e-6})", "levels; at most 1000"}}) {
    const std::string error = packet_error(sliced(keys));
    EXPECT_NE(error.find(expected), std::string::npos) << error;
    EXPECT_EQ(error.find("s.json:2"), 0u) << error;
  }
}

TEST(ExtractMeshes, NormalsColorsAndOpacityReachThePacket) {
  const test::TemporaryFolder folder;
  // two perpendicular faces
  test::write_file(folder / "fold.obj", "v 0 0 0\nv 0 1 0\nv 1 0 0\nv 1 1 0\nv 0 0 1\nv 0 1 1\nf 1 3 4 2\nf 1 2 6 5\n");
  const std::string fields = R"({"fields": {"x": {"analytic": "linear", "resolution": 9}}, "meshes": [{"name": "m", "file": "fold.obj")";
  FramePacket packet = packet_from(fields + R"(, "shading": "smooth", "opacity": 0.25, "edges": true}]})", folder / "s.json");
  const MeshItem& item = packet.meshes[0];
  EXPECT_TRUE(item.smooth && item.show_edges);
  EXPECT_EQ(item.opacity, 0.25f);
  ASSERT_EQ(item.geometry->normals.size(), 6u);
  for (std::size_t v = 0; v < 6; ++v) {
    const Vec3 &p = item.geometry->vertices[v], n = direction(item.geometry->normals[v]);
    const Vec3 expected = p.x > 0 ? Vec3(0, 0, 1) : p.z > 0 ? Vec3(1, 0, 0) : direction(Vec3(1, 0, 1));
    EXPECT_LE(norm(n - expected), 1e-12) << v;
  }
  packet = packet_from(fields + R"(, "color_by": {"field": "x", "color": [[0, 0, 0, 0], [2, 1, 0.5, 0]]}}]})", folder / "s.json");
  const MeshGeometry& colored = *packet.meshes[0].geometry;
  EXPECT_TRUE(colored.normals.empty());
  ASSERT_EQ(colored.colors.size(), 6u);
  const auto field = field::make_analytic("linear", {});
  ASSERT_TRUE(field);
  field::Cursor cursor;
  for (std::size_t v = 0; v < 6; ++v) {
    const double value = field->scalar->sample(colored.vertices[v], cursor).value;
    EXPECT_NEAR(colored.colors[v].r, std::clamp(0.5 * value, 0.0, 1.0), 1e-6) << v;
  }
}

}  // namespace catena::render::surfaces_test
