// SPDX-License-Identifier: MIT
/// Collections of files with times, .pvd and .series: the values of each step, and refused collections.
#include <gtest/gtest.h>

#include <filesystem>

#include "engine/io/mesh/load_mesh.h"
#include "engine/io/volume/data_files.h"
#include "engine/io/volume/load_field.h"
#include "engine/scene/scene.h"
#include "engine/scene/time_steps.h"
#include "tests/engine/io/vtk/files.h"
#include "tests/support/support.h"

namespace catena::field {
namespace collection_test {

namespace files = test::vtk_files;

/// An image of 4 x 4 x 3 points with one value.
std::string image(double value) {
  return files::vti("1 0 0 0 1 0 0 0 1", [value](const Vec3&) { return value; });
}

/// A hexahedron from x to x + 1 with one value.
std::string hexahedron(double x, double value) {
  std::string points, values;
  for (int n = 0; n < 8; ++n) {
    points += fmt::format("{} {} {} ", x + ((n & 1) ^ (n >> 1 & 1)), n >> 1 & 1, n >> 2);
    values += fmt::format("{} ", value);
  }
  return "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\"><UnstructuredGrid><Piece NumberOfPoints=\"8\" "
         "NumberOfCells=\"1\"><PointData>" +
         files::array("p", values) + "</PointData><Points>" + files::array("Points", points, 3) + "</Points><Cells>" +
         files::array("connectivity", "0 1 2 3 4 5 6 7", 1, "Int64") + files::array("offsets", "8", 1, "Int64") +
         files::array("types", "12", 1, "UInt8") + "</Cells></Piece></UnstructuredGrid></VTKFile>\n";
}

std::string triangle(double z) {
  return fmt::format(
      "# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\nPOINTS 3 double\n0 0 {0} 1 0 {0} 0 1 {0}\nPOLYGONS 1 4\n3 0 1 2\n", z);
}

std::string pvd(const std::string& sets) {
  return "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\"><Collection>" + sets + "</Collection></VTKFile>\n";
}
std::string set(const std::string& time, const std::string& file, int part = 0) {
  return fmt::format("<DataSet timestep=\"{}\" group=\"\" part=\"{}\" file=\"{}\"/>\n", time, part, file);
}

Result<AnyField> at_step(const std::string& path, int step) {
  LoadRequest request;
  request.path = path;
  request.step = step;
  return load(request);
}

double value_at(const Result<AnyField>& field, const Vec3& world) {
  EXPECT_TRUE(field) << (field ? "" : field.error().message);
  Cursor cursor;
  return field ? field->scalar->sample(world, cursor).value : 0;
}

TEST(Collection, StepsAreSortedByTime) {
  const test::TemporaryFolder folder;
  std::filesystem::create_directory(folder / "data");
  for (const char* name : {"ten.vti", "a half.vti", "data/minus.vti"})
    test::write_file(folder / name, image(name[0] == 't' ? 10 : name[0] == 'a' ? 0.5 : -1));
  test::write_file(folder / "s.pvd", pvd(set("1e1", "ten.vti") + set("-1", "data/minus.vti") + set("0.5", folder / "a half.vti")));
  test::write_file(folder / "s.vti.series", R"({"file-series-version": "1.0", "files": [{"name": "ten.vti", "time": 10},
    {"name": "data/minus.vti", "time": -1}, {"name": "a half.vti", "time": 0.5}]})");
  const double wanted[] = {-1, 0.5, 10};
  for (const char* name : {"s.pvd", "s.vti.series"}) {
    EXPECT_EQ(read_times(folder / name), std::vector<double>(std::begin(wanted), std::end(wanted))) << name;
    for (int step = 0; step < 3; ++step) EXPECT_EQ(value_at(at_step(folder / name, step), {10.5, 21, 32}), wanted[step]) << name << step;
    EXPECT_EQ(at_step(folder / name, 1)->times.size(), 3u);
    // An output must not replace the file of another step.
    const std::vector<FileId> parts = find_data_files(folder / name);
    for (const char* part : {"ten.vti", "a half.vti", "data/minus.vti"})
      EXPECT_NE(std::find(parts.begin(), parts.end(), *find_file_id(folder / part)), parts.end()) << name << " " << part;
  }
  // The default scene of the collection.
  const auto scene = scene::scene_for_file(folder / "s.pvd");
  ASSERT_TRUE(scene) << scene.error().message;
  EXPECT_EQ(scene::step_count(*scene), 3);
  EXPECT_EQ(scene::substitute_time("{time}, {step} of 3", *scene), "-1, 0 of 3");
}

TEST(Collection, FilesOfEqualTimeInASeriesAreSeparateSteps) {
  const test::TemporaryFolder folder;
  for (int i = 0; i < 2; ++i) test::write_file(folder / fmt::format("{}.vti", i), image(i));
  test::write_file(folder / "s.vti.series", R"({"files": [{"name": "0.vti", "time": 4}, {"name": "1.vti", "time": 4}]})");
  for (int step = 0; step < 2; ++step) EXPECT_EQ(value_at(at_step(folder / "s.vti.series", step), {10.5, 21, 32}), step);
}

TEST(Collection, AUniformFirstStepIsColouredByTheLast) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "0.vti", image(0));
  test::write_file(folder / "1.vti", files::vti("1 0 0 0 1 0 0 0 1", [](const Vec3& p) { return p.x; }));
  test::write_file(folder / "s.pvd", pvd(set("0", "0.vti") + set("1", "1.vti")));
  for (const char* name : {"s.pvd", "*.vti"}) {
    const auto scene = scene::scene_for_file(folder / name);
    ASSERT_TRUE(scene) << scene.error().message;
    ASSERT_FALSE(scene->notes.empty());
    EXPECT_NE(scene->notes.front().find("(at step 1; at step 0 all values are equal)"), std::string::npos) << scene->notes.front();
    EXPECT_EQ(scene->time.step, 0);
  }
}

TEST(Collection, FilesOfLinesOpenAsCurves) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "l.vtk",
                   "# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\nPOINTS 2 double\n0 0 0 1 0 0\nLINES 1 3\n2 0 1\n");
  test::write_file(folder / "l.pvd", pvd(set("1", "l.vtk") + set("2", "l.vtk")));
  EXPECT_EQ(scene::detect_file_kind(folder / "l.pvd"), scene::FileKind::curves);
  const auto scene = scene::scene_for_file(folder / "l.pvd");
  ASSERT_TRUE(scene) << scene.error().message;
  EXPECT_EQ(scene::step_count(*scene), 2);
}

TEST(Collection, PartsOfOneTimeAreOneStep) {
  const test::TemporaryFolder folder;
  std::string sets;
  for (int step = 0; step < 2; ++step)
    for (int part = 0; part < 2; ++part) {
      const std::string name = fmt::format("p{}_{}.vtu", step, part);
      test::write_file(folder / name, hexahedron(part, 10 * step + part));
      sets += set(step == 0 ? "0.1" : "0.2", name, part);
    }
  test::write_file(folder / "parts.pvd", pvd(sets));
  for (int step = 0; step < 2; ++step) {
    const auto field = at_step(folder / "parts.pvd", step);
    EXPECT_NEAR(value_at(field, {0.2, 0.5, 0.5}), 10 * step, 1e-6);
    EXPECT_NEAR(value_at(field, {1.8, 0.5, 0.5}), 10 * step + 1, 1e-6);
  }
}

TEST(Collection, MeshesHaveSteps) {
  const test::TemporaryFolder folder;
  for (const char* z : {"1", "2"}) test::write_file(folder / (std::string("t") + z + ".vtk"), triangle(std::stod(z)));
  test::write_file(folder / "t.vtk.series",
                   R"({"file-series-version": "1.0", "files": [{"name": "t1.vtk", "time": 3}, {"name": "t2.vtk", "time": 4}]})");
  for (const std::string name : {"t.vtk.series", "t*.vtk"}) {
    auto scene = scene::scene_for_file(folder / name);
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_EQ(scene::step_count(*scene), 2) << name;
    const scene::Entity mesh = scene::find_named<scene::MeshSource>(*scene, "mesh");
    for (int step = 0; step < 2; ++step) {
      scene::set_step(*scene, step);
      const auto loaded = scene::resolve_mesh(*scene, mesh);
      ASSERT_TRUE(loaded) << loaded.error().message;
      EXPECT_EQ((*loaded)->min_corner().z, 1 + step) << name;
      EXPECT_EQ(scene::format_time(*scene), name[1] == '*' ? fmt::format("step {}", step) : fmt::format("{}", 3 + step));
    }
  }
}

TEST(Collection, TheTimeInAFileIsUsed) {
  const test::TemporaryFolder folder;
  for (int step = 0; step < 2; ++step) {
    std::string text = image(10 * step);
    const std::string tag = "<ImageData WholeExtent",
                      data = "<FieldData>" + files::array("TimeValue", fmt::format("{}", 0.25 * step)) + "</FieldData>";
    text.insert(text.find('>', text.find(tag)) + 1, data);
    test::write_file(folder / fmt::format("w_{}.vti", step), text);
  }
  auto scene = scene::scene_for_file(folder / "w_*.vti");
  ASSERT_TRUE(scene) << scene.error().message;
  scene::set_step(*scene, 1);
  ASSERT_TRUE(scene::resolve_field(*scene, scene::find_field(*scene, "v"), {}));
  EXPECT_EQ(scene::format_time(*scene), "0.25");
  EXPECT_EQ(scene::summarize_file(folder / "w_*.vti").steps.times, (std::vector<double>{0, 0.25}));
}

TEST(Collection, ErrorsAreOneLine) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "good.vti", image(1));
  const struct {
    const char *name, *text;
    std::string sets;
    const char* words;
  } kCases[] = {
      {"gone.pvd", "", set("0", "gone.vti"), "gone.vti\", named in the collection, does not exist"},
      {"above.pvd", "", set("0", "../x.vti"), "is outside the folder of the collection"},
      {"far.pvd", "", set("0", "/etc/passwd"), "is outside the folder of the collection"},
      {"self.pvd", "", set("0", "self.pvd"), "is a collection, too"},
      {"none.pvd", "", " ", "lists no files"},
      {"word.pvd", "", set("soon", "good.vti"), "a finite number was expected"},
      {"half.pvd", "<VTKFile type=\"Collection\"><Collection><DataSet timestep=\"0\" file=\"good.vti\"/>", "", "not valid XML"},
      {"text.pvd", "hello", "", "not valid XML"},
      {"list.vtk.series", "{\"files\": 3}", "", "there is no list \"files\""},
      {"time.vtk.series", "{\"files\": [{\"name\": \"good.vti\"}]}", "", "\"time\""},
      {"half.vtk.series", "{\"files\": [{\"name\": \"good.vti\", \"ti", "", "half.vtk.series:1"},
  };
  for (const auto& one : kCases) {
    test::write_file(folder / one.name, one.sets.empty() ? one.text : pvd(one.sets));
    const auto field = at_step(folder / one.name, 0);
    ASSERT_FALSE(field) << one.name;
    EXPECT_NE(field.error().message.find(one.words), std::string::npos) << field.error().message;
    EXPECT_EQ(field.error().message.find('\n'), std::string::npos) << field.error().message;
  }
}

}  // namespace collection_test
}  // namespace catena::field
