// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/Dense.h>

#include "engine/field/analytic/analytic.h"
#include "tests/engine/field/field_helpers.h"

namespace catena::field::load_vdb_test {

using namespace test;

class LoadVdb : public FilesTest {
 protected:
  LoadVdb() { openvdb::initialize(); }
  void save(const openvdb::GridPtrVec& grids) const {
    openvdb::io::File file(path_);
    file.write(grids);
    file.close();
  }
  const std::string path_ = folder_ / "a.vdb";
};
using WriteVdb = LoadVdb;

/// Success if the load is refused with one line that begins with the path and contains the part.
testing::AssertionResult is_refused(const LoadRequest& request, const std::string& part = {}) {
  const auto result = load(request);
  if (message_of(result).find(request.path) != 0) return testing::AssertionFailure() << "not about the file: " << message_of(result);
  return fails(result, part);
}

/// A grid with values x + 10 y + 100 z over 4 x 5 x 6 voxels from (-2, 3, 0).
template <class Grid>
typename Grid::Ptr numbers(const std::string& name) {
  auto grid = Grid::create();
  grid->setName(name);
  auto accessor = grid->getAccessor();
  for (int z = 0; z < 6; ++z)
    for (int y = 3; y < 8; ++y)
      for (int x = -2; x < 2; ++x) accessor.setValue({x, y, z}, typename Grid::ValueType(x + 10 * y + 100 * z));
  return grid;
}

TEST_F(LoadVdb, ReadsEveryScalarType) {
  auto half = numbers<openvdb::FloatGrid>("half");
  half->setSaveFloatAsHalf(true);
  save({numbers<openvdb::FloatGrid>("float"), half, numbers<openvdb::DoubleGrid>("double"), numbers<openvdb::Int32Grid>("int32"),
        numbers<openvdb::Int64Grid>("int64")});
  for (const char* name : {"float", "half", "double", "int32", "int64"}) {
    const auto field = read(path_, name);
    const ScalarGrid& grid = *field.scalar->grid();
    EXPECT_EQ(grid.name(), name);
    EXPECT_EQ(grid.index_box().lo, Vec3(-2, 3, 0));
    EXPECT_EQ(grid.index_box().hi, Vec3(1, 7, 5));
    Cursor cursor;
    const ScalarSample s = grid.sample(Vec3(-0.5, 4.25, 3.5), cursor);
    EXPECT_TRUE(s.inside);
    EXPECT_NEAR(s.value, -0.5 + 42.5 + 350, 1e-9) << name;
    EXPECT_NEAR(norm(s.gradient - Vec3(1, 10, 100)), 0, 1e-9);
    EXPECT_EQ(grid.min_value(), 28);
    EXPECT_EQ(grid.max_value(), 571);
  }
  const auto info = value_of(describe_grids(path_));
  ASSERT_EQ(info.size(), 5u);
  for (const GridInfo& i : info) {
    EXPECT_EQ(i.type, i.name);
    EXPECT_EQ(i.size, (Index3{4, 5, 6}));
    EXPECT_EQ(i.first_index, (Index3{-2, 3, 0}));
    EXPECT_EQ(i.stats.active_voxels, 120u);
    EXPECT_EQ(i.stats.max, 571);
    EXPECT_TRUE(i.is_usable);
    EXPECT_FALSE(i.is_vector);
    EXPECT_GT(i.bytes, 0u);
  }
}

TEST_F(LoadVdb, ReadsEveryVectorType) {
  save({numbers<openvdb::Vec3SGrid>("vec3s"), numbers<openvdb::Vec3DGrid>("vec3d"), numbers<openvdb::Vec3IGrid>("vec3i")});
  for (const char* name : {"vec3s", "vec3d", "vec3i"}) {
    const auto field = read(path_, name);
    Cursor cursor;
    EXPECT_NEAR(norm(field.vector->sample(Vec3(0, 5, 2.5), cursor).value - Vec3(300.0)), 0, 1e-9);
    EXPECT_NEAR(field.vector->grid()->stats().max, 571 * std::sqrt(3.0), 1e-9);
    EXPECT_EQ(field.vector->grid()->stats().component_max, Vec3(571.0));
  }
}

TEST_F(LoadVdb, RoundTripKeepsEveryBitAndTheTransform) {
  const Block block = random_block({20, 9, 13}, 1);
  std::vector<std::uint8_t> valid(block.values.size(), 1);
  for (std::size_t n = 0; n < valid.size(); n += 7) valid[n] = 0;
  for (const Mapping& mapping : mappings()) {
    const auto grid = make_scalar_grid("g", mapping, block.size, block.values, valid);
    const AnyField any{grid, nullptr};
    value_of(write_vdb(folder_ / "w.vdb", {{any, "density"}}));
    const auto back = read(folder_ / "w.vdb");
    const ScalarGrid& g = *back.scalar->grid();
    EXPECT_EQ(g.name(), "density");
    EXPECT_TRUE(g.has_mask());
    std::vector<float> values(block.values.size());
    g.read_block({0, 0, 0}, block.size, values);
    EXPECT_EQ(values, block.values);
    std::vector<std::uint8_t> before(valid.size()), after(valid.size());
    grid->read_cell_validity({0, 0, 0}, block.size, before);
    g.read_cell_validity({0, 0, 0}, block.size, after);
    EXPECT_EQ(before, after);
    for (int a = 0; a < 3; ++a) EXPECT_NEAR(norm(g.mapping().world_from_index_linear[a] - mapping.world_from_index_linear[a]), 0, 1e-14);
    EXPECT_EQ(g.mapping().origin, mapping.origin);
    EXPECT_EQ(g.min_value(), grid->min_value());
  }
}

TEST_F(LoadVdb, VectorsAndTheLeftVentricleRoundTrip) {
  std::vector<NamedGrid> items;
  for (const auto part : analytic_parts("left-ventricle")) {
    const AnyField f = make_analytic("left-ventricle", {.scale = 1, .direction = Vec3(1, 0, 0), .part = std::string(part)}).value();
    const AnyField g{f.scalar ? sample_on_grid(*f.scalar, 33, -2, 2) : nullptr, f.vector ? sample_on_grid(*f.vector, 33, -2, 2) : nullptr};
    items.push_back({g, std::string(part)});
  }
  ASSERT_TRUE(write_vdb(folder_ / "lv.vdb", items));
  const auto info = describe_grids(folder_ / "lv.vdb").value();
  ASSERT_EQ(info.size(), 4u);
  std::vector<std::string> names;
  for (const GridInfo& i : info) names.push_back(i.name + " " + i.type);
  EXPECT_EQ(names, (std::vector<std::string>{"density float", "transmural float", "fibre vec3s", "valid bool"}));
  EXPECT_FALSE(info[3].is_usable);
  EXPECT_EQ(info[0].stats.active_voxels, read(folder_ / "lv.vdb", "density").scalar->grid()->stats().active_voxels);
  EXPECT_LT(info[0].stats.active_voxels, 33u * 33 * 33) << "outside the wall nothing is valid";
  const auto fibre = read(folder_ / "lv.vdb", "fibre").vector;
  const VectorGrid& sampled = *items[2].field.vector->grid();
  std::vector<float> a(3 * 33 * 33 * 33), b(a.size());
  sampled.read_block({0, 0, 0}, {33, 33, 33}, a);
  fibre->grid()->read_block({0, 0, 0}, {33, 33, 33}, b);
  EXPECT_EQ(a, b);
  Cursor ca, cb;
  for (int x = 0; x < 32; ++x)
    for (int z = 0; z < 32; ++z) EXPECT_EQ(sampled.cell({x, 16, z}, ca).valid, fibre->grid()->cell({x, 16, z}, cb).valid);
}

TEST_F(LoadVdb, OnlyTheNamedGridIsRead) {
  save({numbers<openvdb::FloatGrid>("a"), numbers<openvdb::FloatGrid>("b"), numbers<openvdb::Vec3SGrid>("c")});
  const LoadCounters before = load_counters();
  read(path_, "b");
  const LoadCounters after = load_counters();
  EXPECT_EQ(after.files - before.files, 1u);
  EXPECT_EQ(after.grids - before.grids, 1u);
  EXPECT_EQ(after.masks - before.masks, 0u);
}

TEST_F(LoadVdb, MasksAreAppliedByValueOnlyIfRequested) {
  auto valid = openvdb::BoolGrid::create(false);
  valid->setName("valid");
  auto accessor = valid->getAccessor();
  for (int z = 0; z < 6; ++z)
    for (int y = 3; y < 8; ++y)
      for (int x = -2; x < 2; ++x) accessor.setValue({x, y, z}, x < 1);  // active voxels with the value false are invalid
  auto other = valid->deepCopy();
  other->setName("shifted");
  other->setTransform(openvdb::math::Transform::createLinearTransform(2.0));
  save({numbers<openvdb::FloatGrid>("density"), valid, other});
  Cursor cursor;
  const auto masked = read(path_, "density").scalar;
  EXPECT_TRUE(masked->sample(Vec3(-0.5, 4, 2), cursor).inside);
  EXPECT_FALSE(masked->sample(Vec3(0.5, 4, 2), cursor).inside);
  EXPECT_EQ(masked->max_value(), 570);
  // The description equals the loaded grid.
  for (const GridStats& stats : {masked->grid()->stats(), describe_grids(path_).value().at(0).stats}) {
    EXPECT_EQ(stats.active_voxels, 90u);
    EXPECT_EQ(stats.max, 570);
  }
  EXPECT_EQ(describe_grids(path_).value().at(0).display_range.hi, 570);
  LoadRequest r = request_for(path_);
  r.mask_grid = std::nullopt;
  const auto bare = load(r).value().scalar;
  EXPECT_TRUE(bare->sample(Vec3(0.5, 4, 2), cursor).inside);
  EXPECT_FALSE(bare->grid()->has_mask());
  r.mask_grid = "nowhere";
  EXPECT_TRUE(load(r));
  r.mask_required = true;
  EXPECT_TRUE(is_refused(r, "nowhere"));
  r.mask_grid = "density";
  EXPECT_TRUE(is_refused(r, "expected bool"));
  r.mask_grid = "shifted";
  EXPECT_TRUE(is_refused(r, "transform"));
}

TEST_F(LoadVdb, InactiveVoxelsHoldTheBackground) {
  auto grid = openvdb::FloatGrid::create(-7.f);
  grid->setName("sparse");
  auto accessor = grid->getAccessor();
  accessor.setValue({0, 0, 0}, 1.f);
  accessor.setValue({100, 40, 30}, 3.f);
  save({grid});
  const auto field = read(path_).scalar;
  Cursor cursor;
  EXPECT_NEAR(field->sample(Vec3(0.25, 0, 0), cursor).value, 0.75 - 7 * 0.25, 1e-12);
  EXPECT_TRUE(field->sample(Vec3(50, 20, 10), cursor).inside);
  EXPECT_EQ(field->sample(Vec3(50, 20, 10), cursor).value, -7);
  EXPECT_EQ(field->min_value(), 1);
  EXPECT_EQ(field->grid()->background(), -7.f);
}

TEST_F(LoadVdb, EveryBadGridIsOneErrorLine) {
  auto empty = openvdb::FloatGrid::create();
  empty->setName("empty");
  auto frustum = numbers<openvdb::FloatGrid>("frustum");
  frustum->setTransform(openvdb::math::Transform::createFrustumTransform(openvdb::BBoxd({0, 0, 0}, {10, 10, 10}), 0.5, 2));
  auto nan = numbers<openvdb::FloatGrid>("nan");
  for (auto it = nan->beginValueOn(); it; ++it) it.setValue(std::nanf(""));
  auto flags = numbers<openvdb::BoolGrid>("flags");
  auto invalid = openvdb::BoolGrid::create(false);
  invalid->setName("invalid");
  save({empty, frustum, nan, flags, invalid, numbers<openvdb::FloatGrid>("good")});
  for (const auto& [name, part] : {std::pair{"", "several grids"},
                                   {"godo", "good (float)"},
                                   {"empty", "no active voxels"},
                                   {"frustum", "frustum"},
                                   {"nan", "finite"},
                                   {"flags", "type bool"}})
    EXPECT_TRUE(is_refused(request_for(path_, name), part));
  LoadRequest r = request_for(path_, "good");
  r.mask_grid = "invalid";
  EXPECT_TRUE(is_refused(r, "no valid voxel"));
  EXPECT_TRUE(load(request_for(path_, "good")));
  for (const GridInfo& i : value_of(describe_grids(path_))) EXPECT_EQ(i.is_usable, i.name == "good") << i.name;
}

TEST_F(LoadVdb, VoxelsAtTheLimitsOfTheIndexRangeAreHandled) {
  auto far = numbers<openvdb::FloatGrid>("far");
  far->tree().setValue({2147483647, 0, 0}, 1.f);
  far->tree().setValue({-2147483647 - 1, 0, 0}, 1.f);
  save({far});
  EXPECT_TRUE(is_refused(request_for(path_), "(-2147483648, 0, 0) to (2147483647, 7, 5), expected indices within"));
  const auto grids = value_of(describe_grids(path_));
  EXPECT_EQ(grids.at(0).size, Size3(4294967296, 8, 6));
  EXPECT_FALSE(grids.at(0).is_usable);
}

TEST_F(LoadVdb, LargeTilesAreCheap) {
  auto wide = numbers<openvdb::FloatGrid>("wide");
  for (int n = 1; n <= 8; ++n) wide->tree().addTile(3, {4096 * n, 0, 0}, 7.f, true);
  save({wide});
  const auto field = read(path_);
  EXPECT_LT(field.get()->bytes(), 4'000'000u);
  Cursor cursor;
  EXPECT_EQ(field.scalar->sample(Vec3(20000.5, 2000, 2000), cursor).value, 7);
  EXPECT_EQ(field.scalar->grid()->stats().active_voxels, 120 + 8 * (std::uint64_t{1} << 36));
  // A mask of tiles and single voxels.
  auto valid = openvdb::BoolGrid::create(false);
  valid->setName("valid");
  valid->tree().addTile(3, {4096, 0, 0}, true, true);
  valid->tree().addTile(2, {2 * 4096 + 128, 0, 0}, true, true);
  valid->tree().addTile(1, {2 * 4096 + 8, 0, 0}, true, true);
  for (int x = 0; x < 5; ++x) valid->tree().setValue({3 * 4096 + x, 0, 0}, true);
  save({wide, valid});
  const auto described = value_of(describe_grids(path_));
  const GridInfo& info = described.at(0);
  EXPECT_EQ(info.stats.active_voxels, (std::uint64_t{1} << 36) + (std::uint64_t{1} << 21) + 512 + 5);
  EXPECT_EQ(info.stats.min, 7);
}

/// A grid that shares its tree with another grid.
TEST_F(LoadVdb, ASharedTreeIsRead) {
  const auto one = numbers<openvdb::FloatGrid>("one");
  const auto two = one->copy();
  two->setName("two");
  save({one, two});
  for (const char* name : {"one", "two"}) {
    const auto field = read(path_, name);
    EXPECT_EQ(field.get()->name(), name);
    EXPECT_EQ(field.scalar->grid()->stats().active_voxels, 120u);
  }
}

TEST_F(LoadVdb, SomeNansLoadAndAreCounted) {
  auto grid = numbers<openvdb::FloatGrid>("g");
  grid->tree().setValue({0, 5, 3}, std::nanf(""));
  save({grid});
  const auto field = read(path_);
  EXPECT_EQ(field.scalar->grid()->stats().nan_count, 1u);
}

TEST_F(LoadVdb, RepeatedNamesAreNumbered) {
  auto second = numbers<openvdb::FloatGrid>("same");
  second->tree().setValue({0, 5, 3}, 9999.f);
  save({numbers<openvdb::FloatGrid>("same"), second});
  EXPECT_TRUE(is_refused(request_for(path_, "other"), "same[1]"));
  EXPECT_EQ(read(path_, "same[1]").scalar->max_value(), 9999);
  EXPECT_EQ(read(path_, "same[0]").scalar->max_value(), 571);
}

TEST_F(LoadVdb, BadFilesAreRefusedWithoutACrash) {
  EXPECT_TRUE(is_refused(request_for(folder_ / "absent.vdb"), "no such file"));
  EXPECT_TRUE(is_refused(request_for(folder_.path()), "folder"));
  EXPECT_TRUE(is_refused(request_for(file("empty.vdb", "")), "empty"));
  EXPECT_TRUE(is_refused(request_for(file("text.vdb", std::string(500, 'x'))), "not a .vdb"));
  EXPECT_TRUE(is_refused(request_for(file("a.txt", "hello")), "expected a data file (.vdb"));
  // Truncated at all significant lengths.
  auto noise = openvdb::FloatGrid::create();
  noise->setName("noise");
  Random random(3);
  for (int n = 0; n < 4000; ++n)
    noise->tree().setValue(
        {static_cast<int>(random.uniform(0, 20)), static_cast<int>(random.uniform(0, 20)), static_cast<int>(random.uniform(0, 20))},
        static_cast<float>(random.uniform(0, 1)));
  noise->setSaveFloatAsHalf(true);
  save({noise, numbers<openvdb::FloatGrid>("b")});
  const std::string whole = read_file(path_);
  read(path_, "noise");
  for (std::size_t length = 0; length < whole.size(); length += length < 700 ? 5 : 397) {
    EXPECT_TRUE(is_refused(request_for(file("cut.vdb", whole.substr(0, length)), "noise")));
    EXPECT_FALSE(describe_grids(folder_ / "cut.vdb"));
  }
  EXPECT_TRUE(is_refused(request_for(file("cut.vdb", whole.substr(0, whole.size() - 1)), "b"), "truncated"));
}

TEST_F(WriteVdb, FailuresAreReportedAndLeaveNoFile) {
  const AnyField any{sample_on_grid(*make_analytic("sphere").value().scalar, 8, -2, 2), nullptr};
  EXPECT_TRUE(fails(write_vdb(folder_ / "nowhere/x.vdb", {{any, "sphere"}}), "does not exist"));
  EXPECT_FALSE(write_vdb(folder_.path(), {{any, "sphere"}}));
  EXPECT_TRUE(fails(write_vdb("/dev/full", {{any, "sphere"}}), "No space left"));
  EXPECT_TRUE(write_vdb("/dev/null", {{any, "sphere"}}));
  // Different masks cannot share a file.
  std::vector<float> ones(27, 1.f);
  std::vector<std::uint8_t> a(27, 1), b(27, 1);
  a[0] = 0, b[26] = 0;
  AnyField ga, gb;
  ga.scalar = make_scalar_grid("a", {}, {3, 3, 3}, ones, a);
  gb.scalar = make_scalar_grid("b", {}, {3, 3, 3}, ones, b);
  EXPECT_FALSE(write_vdb(folder_ / "x.vdb", {{ga, "a"}, {gb, "b"}}));
  EXPECT_FALSE(exists(folder_ / "x.vdb"));
  EXPECT_TRUE(write_vdb(folder_ / "x.vdb", {{ga, "a"}, {ga, "b"}}));
}

}  // namespace catena::field::load_vdb_test
