// SPDX-License-Identifier: MIT
/// Collections of files with times, .pvd and .series: the values of each step, and refused collections.
#include <gtest/gtest.h>

#include <filesystem>

#include "engine/io/mesh/load_mesh.h"
#include "engine/io/volume/data_files.h"
#include "engine/scene/scene.h"
#include "engine/scene/time_steps.h"
#include "tests/engine/field/field_helpers.h"
#include "tests/engine/io/vtk/files.h"

namespace catena::field::collection_test {

using namespace test;
namespace files = test::vtk_files;
using Collection = FilesTest;

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
  return files::make_vtu(8, points, values, "0 1 2 3 4 5 6 7", "8", "12");
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

TEST_F(Collection, StepsAreSortedByTime) {
  std::filesystem::create_directory(folder_ / "data");
  for (const char* name : {"ten.vti", "a half.vti", "data/minus.vti"}) file(name, image(name[0] == 't' ? 10 : name[0] == 'a' ? 0.5 : -1));
  file("s.pvd", pvd(set("1e1", "ten.vti") + set("-1", "data/minus.vti") + set("0.5", folder_ / "a half.vti")));
  file("s.vti.series", R"({"file-series-version": "1.0", "files": [{"name": "ten.vti", "time": 10},
    {"name": "data/minus.vti", "time": -1}, {"name": "a half.vti", "time": 0.5}]})");
  const double wanted[] = {-1, 0.5, 10};
  for (const char* name : {"s.pvd", "s.vti.series"}) {
    EXPECT_EQ(read_times(folder_ / name), std::vector<double>(std::begin(wanted), std::end(wanted))) << name;
    for (int step = 0; step < 3; ++step) EXPECT_EQ(value_at(read(folder_ / name, {}, step), {10.5, 21, 32}), wanted[step]) << name << step;
    EXPECT_EQ(read(folder_ / name, {}, 1).times.size(), 3u);
    // An output must not replace the file of another step.
    const std::vector<FileId> parts = find_data_files(folder_ / name);
    for (const char* part : {"ten.vti", "a half.vti", "data/minus.vti"})
      EXPECT_NE(std::find(parts.begin(), parts.end(), *find_file_id(folder_ / part)), parts.end()) << name << " " << part;
  }
  // The default scene of the collection.
  auto scene = value_of(scene::scene_for_file(folder_ / "s.pvd"));
  EXPECT_EQ(scene::step_count(scene), 3);
  EXPECT_EQ(scene::substitute_time("{time}, {step} of 3", scene), "-1, 0 of 3");
}

TEST_F(Collection, FilesOfEqualTimeInASeriesAreSeparateSteps) {
  for (int i = 0; i < 2; ++i) file(fmt::format("{}.vti", i), image(i));
  file("s.vti.series", R"({"files": [{"name": "0.vti", "time": 4}, {"name": "1.vti", "time": 4}]})");
  for (int step = 0; step < 2; ++step) EXPECT_EQ(value_at(read(folder_ / "s.vti.series", {}, step), {10.5, 21, 32}), step);
}

TEST_F(Collection, AUniformFirstStepIsColouredByTheLast) {
  file("0.vti", image(0));
  file("1.vti", files::vti("1 0 0 0 1 0 0 0 1", [](const Vec3& p) { return p.x; }));
  file("s.pvd", pvd(set("0", "0.vti") + set("1", "1.vti")));
  for (const char* name : {"s.pvd", "*.vti"}) {
    auto scene = value_of(scene::scene_for_file(folder_ / name));
    ASSERT_FALSE(scene.notes.empty());
    EXPECT_TRUE(has(scene.notes.front(), "(at step 1; at step 0 all values are equal)"));
    EXPECT_EQ(scene.time.step, 0);
  }
}

TEST_F(Collection, FilesOfLinesOpenAsCurves) {
  file("l.vtk", "# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\nPOINTS 2 double\n0 0 0 1 0 0\nLINES 1 3\n2 0 1\n");
  file("l.pvd", pvd(set("1", "l.vtk") + set("2", "l.vtk")));
  EXPECT_EQ(scene::detect_file_kind(folder_ / "l.pvd"), scene::FileKind::curves);
  auto scene = value_of(scene::scene_for_file(folder_ / "l.pvd"));
  EXPECT_EQ(scene::step_count(scene), 2);
}

TEST_F(Collection, PartsOfOneTimeAreOneStep) {
  std::string sets;
  for (int step = 0; step < 2; ++step)
    for (int part = 0; part < 2; ++part) {
      const std::string name = fmt::format("p{}_{}.vtu", step, part);
      file(name, hexahedron(part, 10 * step + part));
      sets += set(step == 0 ? "0.1" : "0.2", name, part);
    }
  file("parts.pvd", pvd(sets));
  for (int step = 0; step < 2; ++step) {
    const AnyField field = read(folder_ / "parts.pvd", {}, step);
    EXPECT_NEAR(value_at(field, {0.2, 0.5, 0.5}), 10 * step, 1e-6);
    EXPECT_NEAR(value_at(field, {1.8, 0.5, 0.5}), 10 * step + 1, 1e-6);
  }
}

TEST_F(Collection, MeshesHaveSteps) {
  for (const char* z : {"1", "2"}) file(std::string("t") + z + ".vtk", triangle(std::stod(z)));
  file("t.vtk.series", R"({"file-series-version": "1.0", "files": [{"name": "t1.vtk", "time": 3}, {"name": "t2.vtk", "time": 4}]})");
  for (const std::string name : {"t.vtk.series", "t*.vtk"}) {
    auto scene = value_of(scene::scene_for_file(folder_ / name));
    EXPECT_EQ(scene::step_count(scene), 2) << name;
    const scene::Entity mesh = scene::find_named<scene::MeshSource>(scene, "mesh");
    for (int step = 0; step < 2; ++step) {
      scene::set_step(scene, step);
      const auto loaded = value_of(scene::resolve_mesh(scene, mesh));
      EXPECT_EQ(loaded->min_corner().z, 1 + step) << name;
      EXPECT_EQ(scene::format_time(scene), name[1] == '*' ? fmt::format("step {}", step) : fmt::format("{}", 3 + step));
    }
  }
}

TEST_F(Collection, TheTimeInAFileIsUsed) {
  for (int step = 0; step < 2; ++step) {
    std::string text = image(10 * step);
    const std::string tag = "<ImageData WholeExtent",
                      data = "<FieldData>" + files::array("TimeValue", fmt::format("{}", 0.25 * step)) + "</FieldData>";
    text.insert(text.find('>', text.find(tag)) + 1, data);
    file(fmt::format("w_{}.vti", step), text);
  }
  auto scene = value_of(scene::scene_for_file(folder_ / "w_*.vti"));
  scene::set_step(scene, 1);
  ASSERT_TRUE(scene::resolve_field(scene, scene::find_field(scene, "v"), {}));
  EXPECT_EQ(scene::format_time(scene), "0.25");
  EXPECT_EQ(scene::summarize_file(folder_ / "w_*.vti").steps.times, (std::vector<double>{0, 0.25}));
}

TEST_F(Collection, ErrorsAreOneLine) {
  file("good.vti", image(1));
  for (const auto& [name, text, words] : {
           std::tuple{"gone.pvd", pvd(set("0", "gone.vti")), "gone.vti\", named in the collection, does not exist"},
           {"above.pvd", pvd(set("0", "../x.vti")), "is outside the folder of the collection"},
           {"far.pvd", pvd(set("0", "/etc/passwd")), "is outside the folder of the collection"},
           {"self.pvd", pvd(set("0", "self.pvd")), "is a collection, too"},
           {"none.pvd", pvd(" "), "lists no files"},
           {"word.pvd", pvd(set("soon", "good.vti")), "a finite number was expected"},
           {"half.pvd", "<VTKFile type=\"Collection\"><Collection><DataSet timestep=\"0\" file=\"good.vti\"/>", "not valid XML"},
           {"text.pvd", "hello", "not valid XML"},
           {"list.vtk.series", "{\"files\": 3}", "there is no list \"files\""},
           {"time.vtk.series", "{\"files\": [{\"name\": \"good.vti\"}]}", "\"time\""},
           {"half.vtk.series", "{\"files\": [{\"name\": \"good.vti\", \"ti", "half.vtk.series:1"},
       })
    EXPECT_TRUE(fails(load(request_for(file(name, text))), words)) << name;
}

}  // namespace catena::field::collection_test
