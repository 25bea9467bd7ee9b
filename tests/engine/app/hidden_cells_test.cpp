// SPDX-License-Identifier: MIT
/// Hidden cells: a small file with a layer of hidden cells, one cell thick, sampled by every command at the same positions.
#include "engine/base/numbers.h"
#include "engine/io/mesh/load_mesh.h"
#include "tests/engine/app/program_in_folder.h"
#include "tests/engine/io/vtk/blanked_grid_files.h"

namespace catena::hidden_cells_test {

#ifdef CATENA_TEST_VTK
namespace files = test::vtk_files;
using test::Table;

using HiddenCells = test::ProgramInFolder;

/// Points 0 .. 6 along each axis; the cells from x = 3 to 4 are hidden. v = y + 0.05 x, w = (1, 0, 0).
TEST_F(HiddenCells, ValuesLinesSurfacesSlicesAndLinksAgree) {
  files::Flags flags;
  flags.cells = [](int i) { return i % 6 == 3 ? 32 : 0; };
  std::string text = files::boxes(
                  files::Form::image, 6, [](const Vec3&p) { return p.y + 0.05 * p.x; }, flags),
              along;
  for (int i = 0; i < 343; ++i) along += "1 0 0 ";
  text.insert(text.find("</PointData>"), files::array("w", along, 3));
  write("layer.vti", text);
  write("s.json", R"({"fields": {"v": {"file": "layer.vti", "grid": "v"}, "w": {"file": "layer.vti", "grid": "w"}},
    "isosurfaces": [{"field": "v", "level": 2.6}], "slices": [{"field": "v", "point": [0, 0, 2.5], "normal": [0, 0, 1]}]})");
  const auto table = [&](const char* name) { return Table::read(folder_ / name); };
  const auto in_hole = [](double x, double slack) { return x > 3 + slack && x < 4 - slack; };
  // Field values.
  std::string probe = "t,x,y,z\n";
  constexpr int kTicks = 500;
  for (int i = 0; i < kTicks; ++i) probe += fmt::format("{},{},2.3,2.5\n", to_text(0.001 * i), to_text(1 + 0.008 * i));
  write("p.csv", probe);
  succeed("export {s.json} --probe {p.csv} -o {v.csv}");
  const Table values = table("v.csv");
  ASSERT_EQ(values.rows(), static_cast<std::size_t>(kTicks));
  for (std::size_t row = 0; row < values.rows(); ++row) {
    const double x = values.number(row, "x");
    if (std::fabs(x - 3) < 1e-6 || std::fabs(x - 4) < 1e-6) continue;
    EXPECT_EQ(values.text(row, "v").empty() || values.text(row, "v") == "nan", in_hole(x, 0)) << x << " " << values.text(row, "v");
  }
  // Streamlines.
  write("seeds.csv", "x,y,z\n1,2,2\n5,2,2\n");
  succeed("trace {s.json} --field w --seeds {seeds.csv} -o {l.csv}");
  const Table lines = table("l.csv");
  double min_x[2] = {9, 9}, max_x[2] = {0, 0};
  for (std::size_t row = 0; row < lines.rows(); ++row) {
    const double x = lines.number(row, "x");
    const int side = x > 3.5 ? 1 : 0;
    min_x[side] = std::min(min_x[side], x);
    max_x[side] = std::max(max_x[side], x);
  }
  EXPECT_NEAR(min_x[0], 0, 1e-6);
  EXPECT_NEAR(max_x[0], 3, 1e-3);
  EXPECT_NEAR(min_x[1], 4, 1e-3);
  EXPECT_NEAR(max_x[1], 6, 1e-6);
  // Surfaces and slices, of the original file and of exported files.
  for (const char* name : {"again.vti", "again.vdb"}) succeed("export {s.json} --field v -o {" + std::string(name) + "}");
  for (const char* name : {"layer.vti", "again.vti", "again.vdb"}) {
    write("t.json", fmt::format(R"({{"fields": {{"v": {{"file": "{}", "grid": "v"}}}},
      "isosurfaces": [{{"field": "v", "level": 2.6}}], "slices": [{{"field": "v", "point": [0, 0, 2.5], "normal": [0, 0, 1]}}]}})",
                                name));
    succeed("export {t.json} --isosurface 0 -o {i.stl}");
    const auto mesh = mesh::load_mesh(folder_ / "i.stl");
    ASSERT_TRUE(mesh);
    for (const mesh::Triangle& t : (*mesh)->triangles()) {
      double x = 0;
      for (int c = 0; c < 3; ++c) x += (*mesh)->vertices()[t[static_cast<std::size_t>(c)]].x / 3;
      EXPECT_FALSE(in_hole(x, 0)) << name;
    }
    EXPECT_EQ((*mesh)->triangles().size(), 60u) << name;
    succeed("export {t.json} --slice 0 --spacing 0.25 -o {s.csv}");
    const Table slice = table("s.csv");
    int holes = 0;
    for (std::size_t row = 0; row < slice.rows(); ++row) holes += in_hole(slice.number(row, "x"), 1e-6) ? 1 : 0;
    EXPECT_EQ(holes, 0) << name;
    EXPECT_GT(slice.rows(), 100u);
  }
  // The proxy on the isosurface and on a streamline.
  const std::string links[] = {R"({"name": "link", "type": "isosurface", "field": "v", "level": 2.6})",
                               R"({"name": "link", "type": "streamline", "field": "w", "seed": [1, 2.3, 2.5]})"};
  for (const std::string& link : links) {
    write("h.json", R"({"fields": {"v": {"file": "layer.vti", "grid": "v"}, "w": {"file": "layer.vti", "grid": "w"}},
      "chain": [)" + link +
                        "]}");
    succeed("replay {h.json} --probe {p.csv} -o {h.csv}");
    const Table ticks = table("h.csv");
    for (std::size_t row = 0; row < ticks.rows(); ++row)
      EXPECT_FALSE(in_hole(ticks.number(row, "link_x"), 1e-3) && ticks.text(row, "link_status") == "OK") << link << row;
  }
}
#endif

}  // namespace catena::hidden_cells_test
