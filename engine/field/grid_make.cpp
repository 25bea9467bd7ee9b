// Grids from memory: dense leaves, then runs of one value become tiles (the background of an image costs nothing).
#include <openvdb/tools/Prune.h>

#include <algorithm>
#include <cmath>

#include "engine/base/parallel_for.h"
#include "engine/field/convert.h"
#include "engine/field/grid_make.h"

namespace catena::field {
namespace {

std::size_t count_of(const Index3& size) { return static_cast<std::size_t>(size.x) * size.y * size.z; }

/// Pruning takes a NaN for equal to its neighbours, and would lose it.
bool all_finite(std::span<const float> values) {
  return std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); });
}

/// A tree of the voxels of the box 0..size-1 for which put(voxel number, value) says so, all of them active.
template <class Tree, class Put>
typename Tree::Ptr dense_tree(const Index3& size, bool prune, const Put& put) {
  using Leaf = typename Tree::LeafNodeType;
  auto tree = std::make_shared<Tree>(openvdb::zeroVal<typename Tree::ValueType>());
  std::vector<Leaf*> leaves;
  for (int x = 0; x < size.x; x += 8)
    for (int y = 0; y < size.y; y += 8)
      for (int z = 0; z < size.z; z += 8) leaves.push_back(tree->touchLeaf(openvdb::Coord(x, y, z)));
  parallel_for(leaves.size(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      const openvdb::Coord o = leaves[n]->origin();
      for (int x = o.x(); x < std::min(o.x() + 8, size.x); ++x)
        for (int y = o.y(); y < std::min(o.y() + 8, size.y); ++y)
          for (int z = o.z(); z < std::min(o.z() + 8, size.z); ++z)
            put(*leaves[n], static_cast<openvdb::Index>((x & 7) * 64 + (y & 7) * 8 + (z & 7)),
                (static_cast<std::size_t>(z) * size.y + y) * size.x + x);
    }
  });
  if (prune) openvdb::tools::prune(*tree);
  return tree;
}

ValidMask mask_tree(const Index3& size, std::span<const std::uint8_t> valid) {
  if (valid.empty()) return nullptr;
  CATENA_ASSERT(valid.size() == count_of(size));
  return dense_tree<openvdb::MaskTree>(size, true, [&](auto& leaf, openvdb::Index at, std::size_t n) {
    if (valid[n]) leaf.setValueOn(at);
  });
}

}  // namespace

Result<std::shared_ptr<const ScalarGrid>> try_make_scalar_grid(std::string name, const Mapping& mapping, const Index3& size,
                                                               std::span<const float> values, std::span<const std::uint8_t> valid) {
  CATENA_ASSERT(size.x > 0 && size.y > 0 && size.z > 0 && values.size() == count_of(size));
  const auto tree = dense_tree<openvdb::FloatTree>(size, all_finite(values),
                                                   [&](auto& leaf, openvdb::Index at, std::size_t n) { leaf.setValueOn(at, values[n]); });
  return scalar_from_tree(std::move(name), mapping, *tree, mask_tree(size, valid));
}

Result<std::shared_ptr<const VectorGrid>> try_make_vector_grid(std::string name, const Mapping& mapping, const Index3& size,
                                                               std::span<const float> xyz, std::span<const std::uint8_t> valid) {
  CATENA_ASSERT(size.x > 0 && size.y > 0 && size.z > 0 && xyz.size() == 3 * count_of(size));
  const auto tree = dense_tree<openvdb::Vec3fTree>(size, all_finite(xyz), [&](auto& leaf, openvdb::Index at, std::size_t n) {
    leaf.setValueOn(at, openvdb::Vec3f(xyz[3 * n], xyz[3 * n + 1], xyz[3 * n + 2]));
  });
  return vector_from_tree(std::move(name), mapping, *tree, mask_tree(size, valid));
}

std::shared_ptr<const ScalarGrid> make_scalar_grid(std::string name, const Mapping& mapping, const Index3& size,
                                                   std::span<const float> values, std::span<const std::uint8_t> valid) {
  return try_make_scalar_grid(std::move(name), mapping, size, values, valid).value();
}

std::shared_ptr<const VectorGrid> make_vector_grid(std::string name, const Mapping& mapping, const Index3& size, std::span<const float> xyz,
                                                   std::span<const std::uint8_t> valid) {
  return try_make_vector_grid(std::move(name), mapping, size, xyz, valid).value();
}

}  // namespace catena::field
