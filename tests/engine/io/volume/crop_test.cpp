// SPDX-License-Identifier: MIT
/// Crops of grids: values equal those of the whole grid, and only the needed leaves of a .vdb are read.
#include "engine/io/volume/crop.h"

#include <gtest/gtest.h>

#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>
#include <fstream>

#include "engine/io/volume/write_field.h"
#include "tests/engine/field/field_helpers.h"

namespace catena::field::crop_test {

double off(double a, double b) { return std::fabs(a - b) / (1 + std::fabs(b)); }
double off(const Vec3& a, const Vec3& b) { return norm(a - b) / (1 + norm(b)); }

/// Expects that each value of the part equals that of the whole; with `everywhere`, that the part has a value wherever box and whole have
/// one.
template <class Field>
void expect_part(const Field& whole, const Field& part, const Box& box, bool everywhere = true) {
  test::Random random(11);
  Cursor a, b;
  int inside = 0;
  for (int k = 0; k < 400; ++k) {
    const bool near = k % 2 == 0;
    const Box& all = whole.index_box();
    const Vec3 p = near ? random.in_box(box.lo, box.hi) : whole.mapping().world_from_index(random.in_box(all.lo, all.hi));
    const auto w = whole.sample(p, a), s = part.sample(p, b);
    ASSERT_TRUE(s.inside == w.inside || !near || !everywhere) << k;
    if (!s.inside) continue;
    ++inside;
    ASSERT_TRUE(w.inside);
    EXPECT_LT(off(s.value, w.value), 1e-12);
  }
  EXPECT_GT(inside, 20);
}

TEST(Crop, EqualsTheWholeWithinTheBoxForAnyMappingAndFormat) {
  const test::TemporaryFolder folder;
  const test::Block block = test::random_block({20, 17, 23}, 4);
  std::vector<std::uint8_t> valid(block.values.size(), 1);
  for (std::size_t n = 0; n < valid.size(); n += 11) valid[n] = 0;
  for (const Mapping& mapping : test::mappings()) {
    const AnyField whole{make_scalar_grid("g", mapping, block.size, block.values, valid), nullptr};
    const Vec3 a = mapping.world_from_index({5.3, 6.1, 7.9}), b = mapping.world_from_index({11.2, 12.7, 15.5});
    const Box box{min(a, b), max(a, b)};
    const auto part = test::value_of(crop_field("f.nrrd", whole, box));
    expect_part(*whole.scalar, *part.scalar, box);
    ASSERT_TRUE(write_vdb(folder / "w.vdb", {{whole, "density"}}));
    LoadRequest request = test::request_for(folder / "w.vdb");
    request.crop = box;
    const auto read = test::value_of(load(request));
    expect_part(*whole.scalar, *read.scalar, box);
    const Vec3 n = part.get()->index_box().hi - part.get()->index_box().lo, m = read.get()->index_box().hi - read.get()->index_box().lo;
    EXPECT_EQ(n, m) << "both ways, the same voxels";
    EXPECT_LT(n.x * n.y * n.z, 19 * 16 * 22);
  }
}

TEST(Crop, VectorsKeepTheirComponents) {
  const test::Block block = test::random_block({12, 9, 27}, 9);  // 9 x 9 x 12 vectors
  const AnyField whole{nullptr, make_vector_grid("v", {}, {12, 9, 9}, block.values)};
  const Box box{{2.5, 1, 3}, {9.5, 6.5, 7}};
  const auto part = test::value_of(crop_field("f.npy", whole, box));
  expect_part(*whole.vector, *part.vector, box);
  EXPECT_EQ(part.get()->index_box().hi - part.get()->index_box().lo, Vec3(8, 6, 4));
}

TEST(Crop, OnlyTheLeavesInTheBoxOfASparseFileAreRead) {
  const test::TemporaryFolder folder;
  openvdb::initialize();
  auto grid = openvdb::FloatGrid::create(0.f);
  grid->setName("far");
  auto accessor = grid->getAccessor();
  test::Random random(5);
  for (int k = 0; k < 20000; ++k) {
    const Vec3 p = random.in_box(Vec3(0.0), Vec3(159.0));
    accessor.setValue({int(p.x), int(p.y), int(p.z)}, float(k + 1));
  }
  grid->fill(openvdb::CoordBBox({0, 0, 32}, {63, 63, 63}), 7.f, true);  // tiles
  auto shared = grid->copyReplacingTransform(openvdb::math::Transform::createLinearTransform(1.0));
  openvdb::GridBase::Ptr instance = openvdb::ConstPtrCast<openvdb::FloatGrid>(shared);
  instance->setName("shared");
  openvdb::io::File file(folder / "s.vdb");
  file.write(openvdb::GridPtrVec{grid, instance});
  file.close();
  std::ofstream stream(folder / "t.vdb", std::ios::binary);  // a stream, which has no offsets of grids
  openvdb::io::Stream(stream).write(openvdb::GridPtrVec{grid});
  stream.close();
  const AnyField whole = test::read(folder / "s.vdb", "far");
  const Box box{{20, 20, 20}, {70, 60, 50}};
  for (const auto& [path, name] : {std::pair{folder / "s.vdb", "far"}, {folder / "s.vdb", "shared"}, {folder / "t.vdb", "far"}}) {
    LoadRequest request = test::request_for(path, name);
    request.crop = box;
    const auto part = test::value_of(load(request));
    expect_part(*whole.scalar, *part.scalar, box, false);
    EXPECT_LT(part.get()->bytes(), whole.get()->bytes() / 4) << name;
    const Box& left = part.get()->index_box();
    EXPECT_GE(left.lo.x, 20);
    EXPECT_LE(left.hi.z, 50);
  }
}

TEST(Crop, ABoxWithoutVoxelsIsOneErrorLine) {
  const test::Block block = test::random_block({8, 8, 8}, 4);
  const AnyField whole{make_scalar_grid("g", {}, block.size, block.values), nullptr};
  EXPECT_EQ(test::message_of(crop_field("f.nrrd", whole, {{20, 0, 0}, {30, 7, 7}})),
            "f.nrrd: \"crop\" contains no voxels of the grid \"g\" along x; a box that overlaps the data was expected");
  EXPECT_FALSE(crop_field("f.nrrd", whole, {{-1e300, -5, -5}, {-1e299, -1, -1}}));
  EXPECT_TRUE(crop_field("f.nrrd", whole, {{-1e300, -1e300, -1e300}, {1e300, 1e300, 1e300}}));
}

}  // namespace catena::field::crop_test
