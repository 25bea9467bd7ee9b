// SPDX-License-Identifier: MIT
/// The valid data of a file with VTK's flags, masks and gaps, in every form of grid.
#include <gtest/gtest.h>

#include "engine/base/memory_limit.h"
#include "engine/geometry/mesh/isosurface.h"
#include "engine/io/client.h"
#include "engine/io/volume/write_field.h"
#include "tests/engine/field/field_helpers.h"
#include "tests/engine/io/vtk/blanked_grid_files.h"
#include "tests/fuzz/mutate.h"

namespace catena::field::blanked_cells_test {

using namespace test;
namespace files = test::vtk_files;
using files::Form;
constexpr Form kForms[] = {Form::image, Form::rectilinear, Form::structured, Form::unstructured};

double sum(const Vec3& p) { return 1 + 2 * p.x + 3 * p.y + 5 * p.z; }

/// A value of 0 to 1.
double unit(catena::test::Random& random) { return static_cast<double>(random.next() >> 11) * 0x1p-53; }

using BlankedCells = FilesTest;

bool inside(const AnyField& field, const Vec3& p) { return sample_at(field, p).inside; }

struct Allowance {
  explicit Allowance(std::uint64_t bytes) { set_memory_limit(bytes); }
  ~Allowance() { set_memory_limit(std::nullopt); }
};

/// A grid of 4 x 4 x 4 cells: the cell from (1, 1, 1), and the point at (3, 3, 3).
constexpr int kCell = 21, kPoint = 93;

TEST_F(BlankedCells, FlagsHaveVtksMeaningInEveryFormOfGrid) {
  struct Case {
    int flag;
    bool of_cells, hole;
  };
  constexpr Case cases[] = {{1, true, false},  {2, true, false}, {4, true, false},  {8, true, true},
                            {16, true, false}, {32, true, true}, {1, false, false}, {2, false, true}};
  for (const Form form : kForms)
    for (const char* type : {"UInt8", "Int32"})
      for (const auto& [flag, of_cells, hole] : cases) {
        if (type[0] == 'I' && flag != 32 && flag != 2) continue;
        SCOPED_TRACE(fmt::format("{} flag {} of {} as {}", files::file_extension(form), flag, of_cells ? "cells" : "points", type));
        files::Flags flags;
        flags.type = type;
        (of_cells ? flags.cells : flags.points) = [&, at = of_cells ? kCell : kPoint, f = flag](int i) { return i == at ? f : 0; };
        const AnyField field = read(file(std::string("a") + files::file_extension(form), files::boxes(form, 4, sum, flags)), "v");
        // A hidden cell covers one cell; a hidden point hides the eight cells around it.
        const Vec3 middle = of_cells ? Vec3(1.5) : Vec3(3.0), far(of_cells ? 0.9 : 1.4);
        for (const Vec3& offset : {Vec3(0.0), Vec3(far.x / 3, 0, 0), Vec3(0, -far.x / 3, far.x / 3)})
          EXPECT_EQ(inside(field, middle + offset), !hole) << offset.x << " " << offset.y;
        // A voxel of a resampled grid away from the hole has data.
        for (int axis = 0; axis < 3; ++axis) {
          Vec3 p = middle;
          p[axis] -= of_cells ? 0.6 : 1.1;
          const ScalarSample sample = sample_at(field, p);
          EXPECT_TRUE(sample.inside);
          EXPECT_NEAR(sample.value, sum(p), 1e-3);
        }
      }
}

/// A non-finite value hides its cell and no other, and the grid does not vary between runs.
TEST_F(BlankedCells, CellsWithNonFiniteValuesAreInvalid) {
  for (const Form form : {Form::rectilinear, Form::structured, Form::unstructured})
    for (const std::string name : {"v", "c"}) {
      SCOPED_TRACE(name + files::file_extension(form));
      const auto value = [&](const Vec3& p) { return p == Vec3(3.0) || p == Vec3(1.5) ? std::nan("") : sum(p); };
      const AnyField field = read(file("n" + name + files::file_extension(form), files::boxes(form, 4, value)), name);
      const Vec3 middle = name == "v" ? Vec3(3.0) : Vec3(1.5);
      const double half = name == "v" ? 1 : 0.5;
      EXPECT_FALSE(inside(field, middle));
      EXPECT_FALSE(inside(field, middle + Vec3(0.8 * half)));
      const ScalarSample sample = sample_at(field, middle - Vec3(half + 0.1, 0, 0));
      EXPECT_TRUE(sample.inside);
      EXPECT_NEAR(sample.value, sum(middle - Vec3(half + 0.1, 0, 0)), name == "v" ? 1e-3 : 3);
      EXPECT_TRUE(has_note(field, name == "v" ? "1 values at points" : "1 values at cells"));
    }
}

TEST_F(BlankedCells, HiddenValuesDoNotInfluenceValuesOrTheRange) {
  // A layer of hidden cells with the value -9999, and points that belong to hidden cells only.
  const auto is_hidden = [](int cell) { return cell / 16 >= 2; };
  const auto value = [](const Vec3& p) { return p.z > 2.25 ? -9999 : sum(p); };
  for (const Form form : kForms) {
    SCOPED_TRACE(files::file_extension(form));
    files::Flags flags;
    flags.cells = [&](int i) { return is_hidden(i) ? 32 : 0; };
    const std::string path = file(std::string("b") + files::file_extension(form), files::boxes(form, 4, value, flags));
    const auto grids = value_of(describe_grids(path));
    for (const std::string name : {"v", "c"}) {
      const AnyField field = read(path, name);
      const auto& info = *std::find_if(grids.begin(), grids.end(), [&](const GridInfo& g) { return g.name == name; });
      EXPECT_GT(info.stats.min, 0) << name;
      EXPECT_EQ(field.scalar->min_value(), info.stats.min) << name;
      EXPECT_EQ(field.scalar->max_value(), info.stats.max) << name;
      const ScalarSample sample = sample_at(field, {2, 2, 1.4});
      EXPECT_TRUE(sample.inside);
      EXPECT_NEAR(sample.value, sum({2, 2, 1.4}), name == "c" && form != Form::image ? 2.6 : 1e-3) << name;
      EXPECT_FALSE(inside(field, {2, 2, 3}));
    }
  }
}

TEST_F(BlankedCells, AllReadersAgreeOnALayerOfHiddenCells) {
  files::Flags flags;
  flags.cells = [](int i) { return i % 6 == 3 ? 32 : 0; };  // the cells with 3 <= x <= 4 of 6
  const std::string path = file("layer.vti", files::boxes(
                                                 Form::image, 6, [](const Vec3& p) { return p.y + 0.1 * p.x; }, flags));
  const AnyField field = read(path, "v");
  LoadRequest cropped = request_for(path, "v");
  cropped.crop = Box{{2, 0, 0}, {5, 6, 6}};
  std::vector<std::pair<std::string, AnyField>> same{{"file", field}, {"crop", load(cropped).value()}};
  same.push_back({"cubic", {field.scalar->grid()->as_cubic().value(), nullptr}});
  for (const char* name : {"again.vdb", "again.vti"}) {
    ASSERT_TRUE(write_field(folder_ / name, field, "v", {}));
    same.push_back({name, read(folder_ / name, "v")});
  }
  for (const auto& [name, one] : same) {
    SCOPED_TRACE(name);
    const ScalarGrid& grid = *one.scalar->grid();
    Cursor cursor;
    for (const double x : {2.1, 2.9, 3.1, 3.5, 3.9, 4.1, 4.9}) {
      const Vec3 p(x, 2.5, 2.5);
      const bool hole = x > 3 && x < 4;
      EXPECT_EQ(grid.sample(p, cursor).inside, !hole) << x;
      EXPECT_EQ(grid.status_outside(p, cursor), hole ? SampleStatus::masked : SampleStatus::ok) << x;
      EXPECT_EQ(grid.cell(grid.cell_base(grid.mapping().index_from_world(p)), cursor).valid, !hole) << x;
    }
    const auto surface = value_of(mesh::extract_isosurface(grid, 2.6, mesh::OutwardSide::higher, "s"));
    double sides[2] = {0, 0};
    for (const auto& t : surface.triangles) {
      const Vec3 middle = (surface.vertices[t[0]] + surface.vertices[t[1]] + surface.vertices[t[2]]) * (1.0 / 3);
      EXPECT_FALSE(middle.x > 3 && middle.x < 4);
      ++sides[middle.x > 3.5 ? 1 : 0];
    }
    EXPECT_GT(sides[0], 0);
    EXPECT_GT(sides[1], 0);
  }
  // A format without a mask reports the loss.
  EXPECT_TRUE(has(lost_mask_note("a.nrrd", field), "36 invalid cells"));
  EXPECT_TRUE(lost_mask_note("a.vti", field).empty());
}

TEST_F(BlankedCells, AGapBetweenBlocksHasNoValueInAnyOrientation) {
  for (const double angle : {0.0, 5.6 * std::numbers::pi / 180}) {
    std::vector<std::pair<Vec3, Vec3>> boxes;
    for (int i = 0; i < 4; ++i)
      for (int side = 0; side < 2; ++side) boxes.push_back({Vec3(i + 4.2 * side, 0, 0), Vec3(i + 1 + 4.2 * side, 4, 4)});
    const AnyField field = read(file("gap.vtu", files::hexahedra(boxes, angle, sum)), "v");
    const auto turned = [&](const Vec3& p) {
      return Vec3(p.x * std::cos(angle) - p.y * std::sin(angle), p.x * std::sin(angle) + p.y * std::cos(angle), p.z);
    };
    const double voxel = max_abs(field.get()->mapping().world_from_index_linear[0]);
    EXPECT_LT(voxel, 0.1);
    int lost = 0, filled = 0;
    catena::test::Random random{11};
    for (int i = 0; i < 3000; ++i) {
      const Vec3 p(0.05 + 3.9 * unit(random) + (i % 2 == 0 ? 4.2 : 0), 0.05 + 3.9 * unit(random), 0.05 + 3.9 * unit(random));
      const ScalarSample sample = sample_at(field, turned(p));
      lost += sample.inside ? 0 : 1;
      EXPECT_TRUE(!sample.inside || std::fabs(sample.value - sum(p)) < 0.3) << sample.value;
      filled += inside(field, turned({4.1, p.y, p.z})) ? 1 : 0;
    }
    EXPECT_EQ(lost, 0);
    EXPECT_EQ(filled, 0);
    EXPECT_TRUE(has_note(field, "of random positions in the whole box"));
  }
}

TEST_F(BlankedCells, AGapNarrowerThanVoxelsHasANote) {
  const Allowance allowance(16'000'000);
  std::vector<std::pair<Vec3, Vec3>> boxes;
  for (int i = 0; i < 40; ++i) boxes.push_back({Vec3(i * 10, 0, 0), Vec3(i * 10 + 9.98, 400, 400)});
  EXPECT_TRUE(has_note(read(file("thin.vtu", files::hexahedra(boxes, 0, sum)), "v"), "in the middle of gaps that are filled"));
}

TEST_F(BlankedCells, PolyhedraReproduceALinearFieldUpToTheirFaces) {
  const AnyField field = read(file("p.vtu", files::polyhedra(4, sum)), "v");
  catena::test::Random random{5};
  int wrong = 0;
  constexpr int kPlaces = 4000;
  for (int i = 0; i < kPlaces; ++i) {
    const Vec3 p = Vec3(4.0) * Vec3(unit(random), unit(random), unit(random));
    const ScalarSample sample = sample_at(field, p);
    wrong += sample.inside && std::fabs(sample.value - sum(p)) < 0.01 * sum(p) ? 0 : 1;
  }
  EXPECT_LE(wrong, kPlaces / 1000);
  EXPECT_EQ(field.scalar->min_value(), 1) << "not that of a point without a cell";
  EXPECT_FALSE(has_note(field, "lost"));
}

TEST_F(BlankedCells, ASmallCellsPeakIsKeptOrItsLossHasANote) {
  const Allowance allowance(16'000'000);
  const auto boxes = [](double small, double aside) {
    std::vector<std::pair<Vec3, Vec3>> all;
    for (int i = 0; i < 5; ++i) all.push_back({Vec3(i, 0, 0), Vec3(i + 1, 1, 1)});
    all.push_back({Vec3(5, aside, aside), Vec3(5 + small, aside + small, aside + small)});
    return all;
  };
  const auto peak = [](const Vec3& p) { return p.x > 5 ? 100.0 : 1.0; };
  const AnyField preserved = read(file("kept.vtu", files::hexahedra(boxes(0.05, 0), 0, peak)), "v");
  EXPECT_FALSE(has_note(preserved, "is lost"));
  EXPECT_EQ(preserved.scalar->max_value(), 100);
  const AnyField lost = read(file("lost.vtu", files::hexahedra(boxes(0.001, 0.4003), 0, peak)), "v");
  EXPECT_TRUE(has_note(lost, "the maximum, 100, is lost"));
}

TEST_F(BlankedCells, TheResampledGridDependsOnTheFileAndTheStatedLimitOnly) {
  const std::string path = file("w.vtu", files::hexahedra({{Vec3(0.0), Vec3(1.0)}, {Vec3(1, 0, 0), Vec3(2, 1, 1)}}, 0,
                                                          [](const Vec3& p) { return p.x * p.x + p.y; }));
  const auto size = [&] { return describe_grids(path).value().front().size; };
  const Size3 whole = size();
  EXPECT_EQ(read(path, "v").get()->index_box().hi.x + 1, static_cast<double>(whole.x));
  std::vector<Size3> sizes;
  for (const std::uint64_t bytes : {std::uint64_t{4} << 30, std::uint64_t{1} << 30, std::uint64_t{2'000'000}}) {
    set_memory_limit(bytes);
    sizes.push_back(size());
    const AnyField field = read(path, "v");
    EXPECT_EQ(bool(has_note(field, "--memory")), bytes == 2'000'000);
    set_memory_limit(std::nullopt);
  }
  EXPECT_EQ(sizes[0], whole);
  EXPECT_EQ(sizes[1], whole);
  EXPECT_LT(sizes[2].x, whole.x);
  // Without a stated limit, and with too little free memory.
  reader_settings().memory_bytes = 300'000;
  const auto refused = load(request_for(path));
  reader_settings().memory_bytes = 0;
  EXPECT_TRUE(fails(refused, "--memory 1 resamples to fewer voxels"));
}

}  // namespace catena::field::blanked_cells_test
