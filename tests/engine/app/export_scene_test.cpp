// SPDX-License-Identifier: MIT
/// `catena export SCENE` and `catena import` to other formats: the written values equal closed forms.
#include "engine/io/mesh/load_mesh.h"
#include "engine/io/volume/load_field.h"
#include "tests/engine/app/program_in_folder.h"

namespace catena::export_scene_test {

using test::Table;

class ExportScene : public test::ProgramInFolder {
 protected:
  void SetUp() override {
    write("s.json", R"({
      "fields": {"r": {"analytic": "sphere"}, "w": {"analytic": "circle"}, "l": {"analytic": "linear"}, "g": {"file": "g.vdb"}},
      "widgets": [{"name": "plane", "type": "cutting_plane", "center": [0, 0, 0.5], "normal": [0, 0, 1]}],
      "isosurfaces": [{"field": "g", "level": 0.5}, {"field": "r", "level": 1}],
      "slices": [{"field": "g", "point": [0, 0, 0.25], "normal": [0, 0, 1]}, {"field": "r", "widget": "plane"},
                 {"field": "r", "point": [9, 9, 9], "normal": [1, 0, 0]}],
      "meshes": [{"name": "tetrahedron", "file": "t.obj"}],
      "streamlines": [{"field": "w", "seeds": [[1, 0, 0], [0.5, 0, 0.25]]}]})");
    write("t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
    write("p.csv", "t,x,y,z\n0,0,0,0\n0.001,0.5,0.25,-0.5\n0.002,0,0,5\n");
    succeed("generate sphere -o {g.vdb} --resolution 33 --box -1 1");
  }
  void expect_written(const std::string& more) {
    const test::ProgramResult done = succeed("export {s.json} " + more);
    EXPECT_TRUE(done.err.empty()) << done.err;
  }
  mesh::MeshPtr mesh_in(const std::string& name) {
    auto mesh = mesh::load_mesh(folder_ / name);
    EXPECT_TRUE(mesh) << (mesh ? "" : mesh.error().message);
    return mesh ? *mesh : nullptr;
  }
  Table table(const std::string& name) const { return Table::read(folder_ / name); }
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
    expect_written("--isosurface 0 --outside higher -o {" + name + "}");
    const mesh::MeshPtr mesh = mesh_in(name);
    ASSERT_TRUE(mesh);
    EXPECT_EQ(mesh->open_edges() + mesh->non_manifold_edges() + mesh->misoriented_edges(), 0u);
    EXPECT_NEAR(volume_of(*mesh), 0.5236, 6e-3);
    for (const Vec3& v : mesh->vertices()) ASSERT_NEAR(norm(v), 0.5, 2e-3);
    // With the default --outside, the sphere is inside out.
    expect_written("--isosurface 0 -o {" + name + "}");
    EXPECT_NEAR(volume_of(*mesh_in(name)), -0.5236, 6e-3);
  }
}

TEST_F(ExportScene, MeshKeepsItsVerticesAndOrientation) {
  for (const std::string& name : surface_names("m")) {
    SCOPED_TRACE(name);
    expect_written("--mesh tetrahedron -o {" + name + "}");
    const mesh::MeshPtr mesh = mesh_in(name);
    ASSERT_TRUE(mesh);
    EXPECT_EQ(mesh->triangles().size(), 4u);
    EXPECT_EQ(mesh->vertices().size(), 4u);
    EXPECT_NEAR(volume_of(*mesh), 1.0 / 6, 1e-15);
  }
}

TEST_F(ExportScene, ASliceHasTheValuesOfAllFields) {
  expect_written("--slice 0 --spacing 0.25 -o {s.csv}");
  const Table slice = table("s.csv");
  ASSERT_EQ(slice.rows(), 81u) << "-1 to 1 in steps of 0.25, both ways";
  for (std::size_t i = 0; i < slice.rows(); ++i) {
    const Vec3 p(slice.number(i, "x"), slice.number(i, "y"), slice.number(i, "z"));
    EXPECT_EQ(p, Vec3(-1 + 0.25 * static_cast<double>(i % 9), -1 + 0.25 * static_cast<double>(i / 9), 0.25));
    EXPECT_NEAR(slice.number(i, "r"), norm(p), 1e-15);
    EXPECT_NEAR(slice.number(i, "g"), norm(p), 1e-6);
    EXPECT_EQ(slice.number(i, "w_x"), -p.y);
    EXPECT_EQ(slice.number(i, "w_y"), p.x);
  }
  // A slice by a widget's plane, sampled at the voxel spacing of the drawn grid and written as triangles.
  expect_written("--slice 1 --spacing 0.5 -o {s.vtp}");
  test::expect_parts(read("s.vtp"), {"NumberOfPoints=\"81\"", "NumberOfPolys=\"128\"", "Name=\"l\" NumberOfComponents=\"1\"",
                                     "Name=\"w\" NumberOfComponents=\"3\""});
#ifdef CATENA_TEST_VTK
  const mesh::MeshPtr mesh = mesh_in("s.vtp");
  ASSERT_TRUE(mesh);
  EXPECT_EQ(mesh->min_corner(), Vec3(-2, -2, 0.5));
  EXPECT_EQ(mesh->max_corner(), Vec3(2, 2, 0.5));
#endif
}

TEST_F(ExportScene, StreamlinesEqualTheOutputOfTrace) {
  write("seeds.csv", "x,y,z\n1,0,0\n0.5,0,0.25\n");
  for (const std::string ending : {".csv", ".vtp"}) {
    expect_written("--streamlines 0 -o {a" + ending + "}");
    succeed("trace {s.json} --field w --seeds {seeds.csv} -o {b" + ending + "}");
    EXPECT_TRUE(read("a" + ending) == read("b" + ending)) << ending;
  }
}

TEST_F(ExportScene, AProbePathHasTheFieldValuesAlongIt) {
  expect_written("--probe {p.csv} -o {o.csv}");
  const Table path = table("o.csv");
  ASSERT_EQ(path.rows(), 3u);
  for (const auto& [column, value] : {std::pair{"t", 0.001}, {"r", 0.75}, {"w_x", -0.25}, {"w_y", 0.5}})
    EXPECT_EQ(path.number(1, column), value) << column;
  EXPECT_NEAR(path.number(1, "g"), 0.75, 1e-3);
  EXPECT_EQ(path.text(2, "g"), "") << "outside the grid";
  EXPECT_EQ(path.number(2, "r"), 5);
}

TEST_F(ExportScene, FieldOfASceneAndImportWriteTheSame) {
  for (const std::string ending : {".nii", ".nrrd", ".vti"}) {
    expect_written("--field g -o {a" + ending + "}");
    succeed("import {g.vdb} --name g -o {b" + ending + "}");
    EXPECT_TRUE(read("a" + ending) == read("b" + ending)) << ending;
  }
  field::LoadRequest request;
  request.path = folder_ / "a.nii";
  const auto back = field::load(request);
  ASSERT_TRUE(back) << back.error().message;
  field::Cursor cursor;
  EXPECT_NEAR(back->scalar->sample(Vec3(0.5, 0.25, -0.5), cursor).value, 0.75, 1e-3);
}

TEST_F(ExportScene, MissingItemsAreRefusedInOneLine) {
  const std::string one_of = "one of --isosurface, --slice, --streamlines, --mesh, --field or --probe was expected";
  const std::pair<const char*, std::string> bad[] = {
      {"", one_of},
      {"--isosurface 0 --slice 0", one_of},
      {"--isosurface 2", "there is no item 2 in \"isosurfaces\"; the scene has items 0 to 1"},
      {"--mesh m", "unknown mesh \"m\""},
      {"--field q", "expected an output that ends in .vdb"},
      {"--slice 2", "no sample of the slice lies within its field"},
      {"--slice 0 --spacing 1e-9", "samples, needs"},
      {"--slice 0 --details {d.csv}", "--details applies only to a recording"}};
  for (const auto& [more, part] : bad) expect_refused("export {s.json} -o {none.vtp} " + std::string(more), {part});
  expect_refused("export {s.json} --mesh tetrahedron -o {t.obj}", {"is also an input"});
  expect_refused("import {g.vdb} -o {g.tif}", {".vdb, .nii, .nii.gz, .vti, .nrrd or .zarr"});
}

}  // namespace catena::export_scene_test
