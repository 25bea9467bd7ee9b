// SPDX-License-Identifier: MIT
/// `catena export SCENE` and `catena import` to other formats: the written values equal closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>

#include "engine/io/mesh/load_mesh.h"
#include "engine/io/volume/load_field.h"
#include "tests/support/run_program.h"
#include "tests/support/support.h"

namespace catena {
namespace export_scene_test {

using test::ProgramResult;
using test::Table;

class ExportScene : public ::testing::Test {
 protected:
  void SetUp() override {
    test::write_file(folder_ / "s.json", R"({
      "fields": {"r": {"analytic": "sphere"}, "w": {"analytic": "circle"}, "l": {"analytic": "linear"}, "g": {"file": "g.vdb"}},
      "widgets": [{"name": "plane", "type": "cutting_plane", "center": [0, 0, 0.5], "normal": [0, 0, 1]}],
      "isosurfaces": [{"field": "g", "level": 0.5}, {"field": "r", "level": 1}],
      "slices": [{"field": "g", "point": [0, 0, 0.25], "normal": [0, 0, 1]}, {"field": "r", "widget": "plane"},
                 {"field": "r", "point": [9, 9, 9], "normal": [1, 0, 0]}],
      "meshes": [{"name": "tetrahedron", "file": "t.obj"}],
      "streamlines": [{"field": "w", "seeds": [[1, 0, 0], [0.5, 0, 0.25]]}]})");
    test::write_file(folder_ / "t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
    test::write_file(folder_ / "p.csv", "t,x,y,z\n0,0,0,0\n0.001,0.5,0.25,-0.5\n0.002,0,0,5\n");
    ASSERT_EQ(test::run_catena({"generate", "sphere", "-o", folder_ / "g.vdb", "--resolution", "33", "--box", "-1", "1"}).exit_code, 0);
  }
  ProgramResult write(std::vector<std::string> more) {
    more.insert(more.begin(), {"export", folder_ / "s.json"});
    return test::run_catena(more);
  }
  void expect_written(std::vector<std::string> more) {
    const ProgramResult run = write(std::move(more));
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_TRUE(run.err.empty()) << run.err;
  }
  void expect_refused(std::vector<std::string> more, const std::string& words) {
    more.insert(more.end(), {"-o", folder_ / "none.vtp"});
    const ProgramResult run = write(std::move(more));
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_NE(run.err.find(words), std::string::npos) << run.err;
    EXPECT_FALSE(test::exists(folder_ / "none.vtp"));
  }
  mesh::MeshPtr mesh_in(const std::string& name) {
    auto mesh = mesh::load_mesh(folder_ / name);
    EXPECT_TRUE(mesh) << (mesh ? "" : mesh.error().message);
    return mesh ? *mesh : nullptr;
  }

  test::TemporaryFolder folder_;
};

double volume_of(const mesh::TriangleMesh& mesh) {
  double volume = 0;
  for (const mesh::Triangle& t : mesh.triangles())
    volume += dot(mesh.vertices()[t[0]], cross(mesh.vertices()[t[1]], mesh.vertices()[t[2]])) / 6;
  return volume;
}

std::vector<std::string> surface_names(const std::string& stem) {
#ifdef CATENA_TEST_VTK
  return {stem + ".stl", stem + ".obj", stem + ".vtp", stem + ".ply"};
#else
  return {stem + ".stl", stem + ".obj"};
#endif
}

TEST_F(ExportScene, IsosurfaceIsTheSameSphereInEveryFormat) {
  for (const std::string& name : surface_names("i")) {
    SCOPED_TRACE(name);
    expect_written({"--isosurface", "0", "--outside", "higher", "-o", folder_ / name});
    const mesh::MeshPtr mesh = mesh_in(name);
    ASSERT_TRUE(mesh);
    EXPECT_EQ(mesh->open_edges() + mesh->non_manifold_edges() + mesh->misoriented_edges(), 0u);
    EXPECT_NEAR(volume_of(*mesh), 0.5236, 6e-3);
    for (const Vec3& v : mesh->vertices()) ASSERT_NEAR(norm(v), 0.5, 2e-3);
    // With the default --outside, the sphere is inside out.
    expect_written({"--isosurface", "0", "-o", folder_ / name});
    EXPECT_NEAR(volume_of(*mesh_in(name)), -0.5236, 6e-3);
  }
}

TEST_F(ExportScene, MeshKeepsItsVerticesAndOrientation) {
  for (const std::string& name : surface_names("m")) {
    SCOPED_TRACE(name);
    expect_written({"--mesh", "tetrahedron", "-o", folder_ / name});
    const mesh::MeshPtr mesh = mesh_in(name);
    ASSERT_TRUE(mesh);
    EXPECT_EQ(mesh->triangles().size(), 4u);
    EXPECT_EQ(mesh->vertices().size(), 4u);
    EXPECT_NEAR(volume_of(*mesh), 1.0 / 6, 1e-15);
  }
}

TEST_F(ExportScene, ASliceHasTheValuesOfAllFields) {
  expect_written({"--slice", "0", "--spacing", "0.25", "-o", folder_ / "s.csv"});
  const Table table = Table::read(folder_ / "s.csv");
  ASSERT_EQ(table.rows(), 81u) << "-1 to 1 in steps of 0.25, both ways";
  for (std::size_t i = 0; i < table.rows(); ++i) {
    const Vec3 p(table.number(i, "x"), table.number(i, "y"), table.number(i, "z"));
    EXPECT_EQ(p, Vec3(-1 + 0.25 * static_cast<double>(i % 9), -1 + 0.25 * static_cast<double>(i / 9), 0.25));
    EXPECT_NEAR(table.number(i, "r"), norm(p), 1e-15);
    EXPECT_NEAR(table.number(i, "g"), norm(p), 1e-6);
    EXPECT_EQ(table.number(i, "w_x"), -p.y);
    EXPECT_EQ(table.number(i, "w_y"), p.x);
  }
  // A slice by a widget's plane, sampled at the voxel spacing of the drawn grid and written as triangles.
  expect_written({"--slice", "1", "--spacing", "0.5", "-o", folder_ / "s.vtp"});
  const std::string file = test::read_file(folder_ / "s.vtp");
  EXPECT_NE(file.find("NumberOfPoints=\"81\""), std::string::npos);
  EXPECT_NE(file.find("NumberOfPolys=\"128\""), std::string::npos);
  EXPECT_NE(file.find("Name=\"l\" NumberOfComponents=\"1\""), std::string::npos);
  EXPECT_NE(file.find("Name=\"w\" NumberOfComponents=\"3\""), std::string::npos);
#ifdef CATENA_TEST_VTK
  const mesh::MeshPtr mesh = mesh_in("s.vtp");
  ASSERT_TRUE(mesh);
  EXPECT_EQ(mesh->min_corner(), Vec3(-2, -2, 0.5));
  EXPECT_EQ(mesh->max_corner(), Vec3(2, 2, 0.5));
#endif
}

TEST_F(ExportScene, StreamlinesEqualTheOutputOfTrace) {
  test::write_file(folder_ / "seeds.csv", "x,y,z\n1,0,0\n0.5,0,0.25\n");
  for (const std::string ending : {".csv", ".vtp"}) {
    expect_written({"--streamlines", "0", "-o", folder_ / ("a" + ending)});
    ASSERT_EQ(
        test::run_catena({"trace", folder_ / "s.json", "--field", "w", "--seeds", folder_ / "seeds.csv", "-o", folder_ / ("b" + ending)})
            .exit_code,
        0);
    EXPECT_TRUE(test::read_file(folder_ / ("a" + ending)) == test::read_file(folder_ / ("b" + ending))) << ending;
  }
}

TEST_F(ExportScene, AProbePathHasTheFieldValuesAlongIt) {
  expect_written({"--probe", folder_ / "p.csv", "-o", folder_ / "o.csv"});
  const Table table = Table::read(folder_ / "o.csv");
  ASSERT_EQ(table.rows(), 3u);
  EXPECT_EQ(table.number(1, "t"), 0.001);
  EXPECT_EQ(table.number(1, "r"), 0.75);
  EXPECT_EQ(table.number(1, "w_x"), -0.25);
  EXPECT_EQ(table.number(1, "w_y"), 0.5);
  EXPECT_NEAR(table.number(1, "g"), 0.75, 1e-3);
  EXPECT_EQ(table.text(2, "g"), "") << "outside the grid";
  EXPECT_EQ(table.number(2, "r"), 5);
}

TEST_F(ExportScene, FieldOfASceneAndImportWriteTheSame) {
  for (const std::string ending : {".nii", ".nrrd", ".vti"}) {
    expect_written({"--field", "g", "-o", folder_ / ("a" + ending)});
    const ProgramResult run = test::run_catena({"import", folder_ / "g.vdb", "--name", "g", "-o", folder_ / ("b" + ending)});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_TRUE(test::read_file(folder_ / ("a" + ending)) == test::read_file(folder_ / ("b" + ending))) << ending;
  }
  field::LoadRequest request;
  request.path = folder_ / "a.nii";
  const auto back = field::load(request);
  ASSERT_TRUE(back) << back.error().message;
  field::Cursor cursor;
  EXPECT_NEAR(back->scalar->sample(Vec3(0.5, 0.25, -0.5), cursor).value, 0.75, 1e-3);
}

TEST_F(ExportScene, MissingItemsAreRefusedInOneLine) {
  expect_refused({}, "one of --isosurface, --slice, --streamlines, --mesh, --field or --probe was expected");
  expect_refused({"--isosurface", "0", "--slice", "0"},
                 "one of --isosurface, --slice, --streamlines, --mesh, --field or --probe was expected");
  expect_refused({"--isosurface", "2"}, "there is no item 2 in \"isosurfaces\"; the scene has items 0 to 1");
  expect_refused({"--mesh", "m"}, "unknown mesh \"m\"");
  expect_refused({"--field", "q"}, "expected an output that ends in .vdb");
  expect_refused({"--slice", "2"}, "no sample of the slice lies within its field");
  expect_refused({"--slice", "0", "--spacing", "1e-9"}, "samples, needs");
  expect_refused({"--slice", "0", "--details", folder_ / "d.csv"}, "--details applies only to a recording");
  const ProgramResult onto_input = write({"--mesh", "tetrahedron", "-o", folder_ / "t.obj"});
  EXPECT_EQ(onto_input.exit_code, 2);
  EXPECT_NE(onto_input.err.find("is also an input"), std::string::npos) << onto_input.err;
  const ProgramResult ending = test::run_catena({"import", folder_ / "g.vdb", "-o", folder_ / "g.tif"});
  EXPECT_EQ(ending.exit_code, 2);
  EXPECT_NE(ending.err.find(".vdb, .nii, .nii.gz, .vti or .nrrd"), std::string::npos) << ending.err;
}

}  // namespace export_scene_test
}  // namespace catena
