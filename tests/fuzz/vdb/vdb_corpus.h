// SPDX-License-Identifier: MIT
/// Small .vdb files of every kind that OpenVDB writes: compressions, number types, tiles, masks, shared trees, files without offsets.
#pragma once
#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>

#include <sstream>
#include <string>
#include <vector>

#include "engine/io/volume/load_field.h"

namespace catena::test {

struct VdbFile {
  std::string name, bytes;
};

/// A noisy ball of `radius` voxels, off the origin.
template <class Grid>
typename Grid::Ptr make_bump_grid(const std::string& name, int radius) {
  using Value = typename Grid::ValueType;
  auto grid = Grid::create();
  grid->setName(name);
  grid->insertMeta("unit", openvdb::StringMetadata("kg"));
  grid->setTransform(openvdb::math::Transform::createLinearTransform(0.5));
  auto accessor = grid->getAccessor();
  for (int x = -radius; x <= radius; ++x)
    for (int y = -radius; y <= radius; ++y)
      for (int z = -radius; z <= radius; ++z)
        if (const int r2 = x * x + y * y + z * z; r2 <= radius * radius)
          accessor.setValue({x + 3, y - 2, z}, Value(1 + r2 + (x * 7 + y * 3 + z) % 5));
  return grid;
}

inline std::string vdb_bytes(const openvdb::GridCPtrVec& grids, std::uint32_t compression, bool offsets = true) {
  struct Archive : openvdb::io::Archive {
    void put(std::ostream& out, const openvdb::GridCPtrVec& all, bool seekable) const { write(out, all, seekable); }
  };
  Archive archive;
  archive.setCompression(compression);
  std::ostringstream out;
  archive.put(out, grids, offsets);
  return out.str();
}

/// Samples a field of either kind at an index position.
inline void sample_at_index(const field::AnyField& field, const Vec3& index, field::Cursor& cursor) {
  const Vec3 world = field.get()->mapping().world_from_index(index);
  if (field.scalar)
    field.scalar->sample(world, cursor);
  else
    field.vector->sample(world, cursor);
}

inline std::vector<VdbFile> vdb_corpus() {
  openvdb::initialize();
  using namespace openvdb;
  constexpr std::uint32_t mask = io::COMPRESS_ACTIVE_MASK, blosc = io::COMPRESS_BLOSC | mask, zip = io::COMPRESS_ZIP | mask;
  const auto floats = make_bump_grid<FloatGrid>("density", 4);
  auto halves = make_bump_grid<FloatGrid>("density", 4);
  halves->setSaveFloatAsHalf(true);
  const auto vectors = make_bump_grid<Vec3SGrid>("velocity", 4);
  auto half_vectors = make_bump_grid<Vec3SGrid>("velocity", 4);
  half_vectors->setSaveFloatAsHalf(true);
  auto valid = BoolGrid::create(false);
  valid->setName("valid");
  valid->setTransform(floats->transformPtr()->copy());
  valid->topologyUnion(*floats);
  for (auto value = valid->beginValueOn(); value; ++value) value.setValue(true);
  auto tiles = make_bump_grid<FloatGrid>("density", 3);
  tiles->tree().addTile(1, Coord(64, 0, 0), 2.f, true);
  tiles->tree().addTile(2, Coord(128, 0, 0), 3.f, true);
  tiles->tree().addTile(3, Coord(4096, 0, 0), 4.f, true);
  const auto shared = floats->copy();
  shared->setName("twin");
  return {{"blosc", vdb_bytes({floats}, blosc)},
          {"half-blosc", vdb_bytes({halves}, blosc)},
          {"zip", vdb_bytes({floats}, zip)},
          {"half-zip", vdb_bytes({halves}, zip)},
          {"plain", vdb_bytes({floats}, io::COMPRESS_NONE)},
          {"active-mask", vdb_bytes({floats}, mask)},
          {"vectors", vdb_bytes({vectors}, blosc)},
          {"half-vectors", vdb_bytes({half_vectors}, blosc)},
          {"double", vdb_bytes({make_bump_grid<DoubleGrid>("density", 4)}, blosc)},
          {"int32", vdb_bytes({make_bump_grid<Int32Grid>("density", 4)}, blosc)},
          {"int64", vdb_bytes({make_bump_grid<Int64Grid>("density", 4)}, zip)},
          {"masked", vdb_bytes({floats, valid}, blosc)},
          {"tiles", vdb_bytes({tiles}, blosc)},
          {"twins", vdb_bytes({floats, shared}, blosc)},
          {"streamed", vdb_bytes({floats, valid}, blosc, /*offsets=*/false)}};
}

}  // namespace catena::test
