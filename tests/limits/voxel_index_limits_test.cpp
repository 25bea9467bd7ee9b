// SPDX-License-Identifier: MIT
// Rows of .vdb grids with large voxel indices (1e7) at the same world position, and of points far from the origin.
#include <openvdb/openvdb.h>

#include "engine/io/curves/load_points.h"
#include "tests/acceptance/chain_fixture.h"
#include "tests/limits/limits_table.h"
#include "tests/limits/probe_path.h"
#include "tests/limits/render_fixture.h"
#include "tests/support/curve_files.h"

namespace catena::extremes {
namespace voxel_index_limits_test {

using acceptance::ChainRig;
using acceptance::make_program;

constexpr double kEdge = 0.125;

/// The distance from the origin and a helical flow on 33^3 voxels of 0.125 about the world's origin, with first voxel index `first`.
void write_vdb(const std::string& path, const openvdb::Coord& first) {
  openvdb::initialize();
  auto scalars = openvdb::FloatGrid::create();
  auto vectors = openvdb::Vec3SGrid::create();
  scalars->setName("s");
  vectors->setName("v");
  const auto transform = openvdb::math::Transform::createLinearTransform(kEdge);
  transform->postTranslate(openvdb::Vec3d(-2) - kEdge * first.asVec3d());
  scalars->setTransform(transform);
  vectors->setTransform(transform->copy());
  for (int z = 0; z < 33; ++z)
    for (int y = 0; y < 33; ++y)
      for (int x = 0; x < 33; ++x) {
        const openvdb::Vec3d p = kEdge * openvdb::Vec3d(x, y, z) - openvdb::Vec3d(2);
        scalars->tree().setValue(first.offsetBy(x, y, z), static_cast<float>(p.length()));
        vectors->tree().setValue(first.offsetBy(x, y, z), openvdb::Vec3s(openvdb::Vec3d(-p.y(), p.x(), 0.2)));
      }
  openvdb::io::File(path).write({scalars, vectors});
}

const std::string kLine = R"("type": "streamline", "field": "v", "seed": [0.8, 0.1, -0.5])";
const openvdb::Coord kNear(0, 0, 0), kFar(10'000'000, -10'000'000, 10'000'000);

std::string fields_of(const std::string& path) {
  return R"({"fields": {"s": {"file": ")" + path + R"(", "grid": "s"}, "v": {"file": ")" + path + R"(", "grid": "v"}}, )";
}

std::string under_the_hand(const std::string& link, double bound) {
  const test::TemporaryFolder folder;
  std::vector<ChainRig> rigs;
  for (const auto& [name, first] : {std::pair{"near.vdb", kNear}, {"far.vdb", kFar}}) {
    write_vdb(folder / name, first);
    const auto program =
        make_program(fields_of(folder / name) + R"("workspace": {"metres_per_unit": 0.05}, "chain": [{"name": "a", )" + link + "}]}");
    if (!program) return "no program";
    rigs.emplace_back(program);
  }
  double off = 0;
  long long same = 0;
  constexpr int kTicks = 1500;
  for (int i = 0; i < kTicks; ++i) {
    for (ChainRig& rig : rigs) rig.step_to(probe_at(i) - Vec3(0, 0, 0.5 - 1e-3 * i));
    off = std::max(off, norm(rigs[0].proxy() - rigs[1].proxy()) / 4);
    same += rigs[0].status() == rigs[1].status();
  }
  return Findings().at_most("distance of the proxies from those for indices from 0", off, bound, "L").all("the same status", same, kTicks);
}

std::string under_the_eye() {
  std::vector<render::Image8> pictures;
  for (const openvdb::Coord& first : {kNear, kFar}) {
    const test::TemporaryFolder folder;
    write_vdb(folder / "a.vdb", first);
    pictures.push_back(draw(fields_of("a.vdb") + R"("background": "transparent",
      "volumes": [{"field": "s", "extinction": [[1.5, 0], [3.4, 1]]}], "isosurfaces": [{"field": "s", "level": 0.9}],
      "slices": [{"field": "s", "axis": "z", "at": -1, "color": "viridis"}],
      "streamlines": [{"field": "v", "seeds": [[0.8, 0.1, -0.5]], "radius": 0.05}],
      "camera": {"position": [4, -6, 3], "target": [0, 0, 0], "fovy_deg": 36}})",
                            folder, 96, 72));
  }
  return same_pictures(pictures, 500, 24, 0.002);
}

// ---- points of a table ----

/// Twenty positions about the origin, and a table of them shifted by `far`.
Vec3 place(int i) { return {0.9 * std::cos(i), 0.9 * std::sin(i), -0.8 + 0.08 * i}; }
std::string table_at(const Vec3& far) {
  std::string text = "x,y,z\n";
  for (int i = 0; i < 20; ++i) {
    const Vec3 p = far + place(i);
    text += fmt::format("{},{},{}\n", p.x, p.y, p.z);
  }
  return text;
}
const Vec3 kFarPlace(625000, -5250000, 1250000);

std::string points_under_the_hand() {
  haptics::tests::Fields fields;
  fields.points["p"] = std::make_shared<const curves::PointSet>(get(curves::parse_points(table_at(kFarPlace), "p.csv")));
  double off = 0;
  for (int i = 0; i < 20; ++i) {
    haptics::tests::Rig rig(haptics::tests::build(R"({"name": "a", "type": "points", "points": "p"})", fields));
    rig.tick(kFarPlace + place(i) + Vec3(0.02, -0.01, 0.01));
    off = std::max(off, norm(rig.state.proxy - (kFarPlace + place(i))));
  }
  return Findings().at_most("distance from the point", off, 1e-6);
}

std::string curves_under_the_hand() {
  haptics::tests::Fields fields;
  test::Polylines lines(1);
  for (int i = 0; i < 20; ++i) lines[0].push_back(kFarPlace + place(i));
  fields.curves["c"] = std::make_shared<const curves::CurveSet>(get(curves::parse_tck(test::tck_bytes(lines, "Float64LE"), "c.tck")));
  double off = 0;
  for (int i = 1; i < 20; ++i) {
    haptics::tests::Rig rig(haptics::tests::build(R"({"name": "a", "type": "curves", "curves": "c"})", fields));
    const Vec3 probe = kFarPlace + 0.5 * (place(i - 1) + place(i));
    for (int tick = 0; tick < 3; ++tick) rig.tick(probe);
    off = std::max(off, norm(rig.state.proxy - probe));
  }
  return Findings().at_most("distance from the middle of a segment", off, 0.5);
}

std::string points_under_the_eye() {
  std::vector<render::Image8> pictures;
  for (const Vec3& far : {Vec3(0.0), kFarPlace}) {
    const test::TemporaryFolder folder;
    test::write_file(folder / "p.csv", table_at(far));
    pictures.push_back(draw(R"({"points": [{"name": "p", "file": "p.csv", "radius": 0.1}], "background": "transparent",
      "camera": {"position": )" +
                                triple(far + Vec3(2, -3.2, 1.5)) + R"(, "target": )" + triple(far) + R"(, "fovy_deg": 36}})",
                            folder, 96, 72));
  }
  return same_pictures(pictures, 100, 24, 0.002);
}

}  // namespace voxel_index_limits_test

Group index_rows() {
  using namespace voxel_index_limits_test;
  const std::string same = "distance of the proxies from those for indices from 0 at most 1e-09 L; the same status in every case";
  return {"Far indices and positions",
          {
              {"SurfaceOfFarIndices", "Isosurface of a .vdb grid whose indices start at (1e7, -1e7, 1e7), at the same world position", same,
               [] { return under_the_hand(R"("type": "isosurface", "field": "s", "level": 0.9)", 1e-9); }},
              {"SelectedLineOfFarIndices", "Selected streamline of such a grid", same, [] { return under_the_hand(kLine, 1e-9); }},
              {"OnlineLineOfFarIndices", "Online streamline of such a grid", same,
               [] { return under_the_hand(kLine + R"(, "follow": "online")", 1e-9); }},
              {"PicturesOfFarIndices",
               "Image of a volume, an isosurface, a slice and a streamline of such a grid; 24/255 is a tenth of a pixel",
               "visible; fraction of pixels that differ by more than 24/255 at most 0.002", under_the_eye},
              {"FarPointsUnderTheHand", "`points` link to twenty points within one unit, at map coordinates (625000, -5250000, 1250000)",
               "distance from the point at most 1e-06", points_under_the_hand},
              {"PicturesOfFarPoints", "Image of these points as balls, compared with the same points at the origin",
               "visible; fraction of pixels that differ by more than 24/255 at most 0.002", points_under_the_eye},
              {"FarCurvesUnderTheHand", "`curves` link to a polyline through these points, from a 64-bit .tck file",
               "distance from the middle of a segment at most 0.5", curves_under_the_hand,
               "At most 1e-06. Curves are stored in single precision relative to the world's origin, like most curve files"},
              proved_elsewhere("Voxel indices near the limits of 32-bit integers", "an error states the valid range",
                               "LoadVdb.VoxelsAtTheLimitsOfTheIndexRangeAreHandled"),
              proved_elsewhere("A .vdb grid without active voxels", "an error says so", "LoadVdb.EveryBadGridIsOneErrorLine"),
              proved_elsewhere("Tiles of 2^36 voxels", "they cost no time or memory", "LoadVdb.LargeTilesAreCheap"),
          }};
}

}  // namespace catena::extremes
