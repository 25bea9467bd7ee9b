#define NANOVDB_USE_TBB
#include "engine/field/convert.h"

#include <nanovdb/util/NanoToOpenVDB.h>
#include <nanovdb/util/OpenToNanoVDB.h>

#include <limits>
#include <mutex>

#include "engine/base/parallel_for.h"
#include "engine/field/grid_storage.h"

namespace catena::field {
namespace {

Index3 index3(const openvdb::Coord& c) { return {c.x(), c.y(), c.z()}; }
Vec3 vec3(const openvdb::Coord& c) { return {static_cast<double>(c.x()), static_cast<double>(c.y()), static_cast<double>(c.z())}; }

template <class Tree>
nanovdb::GridHandle<> to_nano(const Tree& tree) {
  // the grid borrows the tree: nothing is copied, nothing is written
  const typename Tree::Ptr borrowed(const_cast<Tree*>(&tree), [](Tree*) {});
  const openvdb::Grid<Tree> grid(borrowed);
  return nanovdb::openToNanoVDB(grid, nanovdb::StatsMode::Disable, nanovdb::ChecksumMode::Disable);
}

template <class Tree>
openvdb::CoordBBox active_box(const Tree& tree) {
  openvdb::CoordBBox box;
  tree.evalActiveVoxelBoundingBox(box);
  return box;
}

bool finite_background(float v) { return std::isfinite(v); }
bool finite_background(const openvdb::Vec3f& v) { return v.isFinite(); }

/// The mask clipped to the box, its tiles split into leaves.
openvdb::MaskTree leaves_within(const openvdb::MaskTree& mask, const openvdb::CoordBBox& box) {
  openvdb::MaskTree clipped(mask);
  clipped.clip(box);
  clipped.voxelizeActiveTiles();
  return clipped;
}

// ---- statistics ----

template <class T>
void add(GridStats& s, const T& v, bool ranged, std::uint64_t count, bool counted) {
  Vec3 components(0.0);
  double size;
  if constexpr (std::is_same_v<T, float>) {
    size = v;
    components = Vec3(size);
  } else {
    components = Vec3(v[0], v[1], v[2]);
    size = norm(components);
  }
  const bool finite = is_finite(components);
  if (counted) {
    s.active_voxels += count;
    if (!finite) s.nan_count += count;
  }
  if (!ranged || !finite) return;
  s.min = std::min(s.min, size);
  s.max = std::max(s.max, size);
  for (int a = 0; a < 3; ++a) {
    s.component_min[a] = std::min(s.component_min[a], components[a]);
    s.component_max[a] = std::max(s.component_max[a], components[a]);
  }
}

GridStats empty_stats() {
  constexpr double inf = std::numeric_limits<double>::infinity();
  GridStats s;
  s.min = inf;
  s.max = -inf;
  s.component_min = Vec3(inf);
  s.component_max = Vec3(-inf);
  return s;
}

void merge(GridStats& s, const GridStats& t) {
  s.active_voxels += t.active_voxels;
  s.nan_count += t.nan_count;
  s.min = std::min(s.min, t.min);
  s.max = std::max(s.max, t.max);
  for (int a = 0; a < 3; ++a) {
    s.component_min[a] = std::min(s.component_min[a], t.component_min[a]);
    s.component_max[a] = std::max(s.component_max[a], t.component_max[a]);
  }
}

template <class Leaf, class Body>
GridStats over_leaves(const std::vector<const Leaf*>& leaves, const Body& body) {
  GridStats all = empty_stats();
  std::mutex mutex;
  parallel_for(leaves.size(), 64, [&](std::size_t begin, std::size_t end) {
    GridStats part = empty_stats();
    body(part, begin, end);
    const std::lock_guard<std::mutex> lock(mutex);
    merge(all, part);
  });
  return all;
}

template <class Tree>
GridStats tree_stats(const Tree& tree, const openvdb::MaskTree* valid) {
  // every active value: counted, and ranged where no mask asks otherwise
  std::vector<const typename Tree::LeafNodeType*> leaves;
  tree.getNodes(leaves);
  GridStats all = over_leaves(leaves, [&](GridStats& part, std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n)
      for (auto it = leaves[n]->cbeginValueOn(); it; ++it) add(part, *it, !valid, 1, true);
  });
  auto tile = tree.cbeginValueOn();
  tile.setMaxDepth(Tree::ValueOnCIter::LEAF_DEPTH - 1);
  for (; tile; ++tile) add(all, *tile, !valid, tile.getVoxelCount(), true);
  if (!valid) return all;
  // the ranges: voxels that are active and valid
  const openvdb::MaskTree mask = leaves_within(*valid, active_box(tree));
  std::vector<const openvdb::MaskTree::LeafNodeType*> masks;
  mask.getNodes(masks);
  merge(all, over_leaves(masks, [&](GridStats& part, std::size_t begin, std::size_t end) {
          openvdb::tree::ValueAccessor<const Tree> values(tree);
          for (std::size_t n = begin; n < end; ++n)
            for (auto it = masks[n]->cbeginValueOn(); it; ++it) {
              const openvdb::Coord ijk = it.getCoord();
              if (values.isValueOn(ijk)) add(part, values.getValue(ijk), true, 1, false);
            }
        }));
  return all;
}

GridStats finished(GridStats s) {
  if (!(s.min <= s.max)) s.min = s.max = 0, s.component_min = s.component_max = Vec3(0.0);
  return s;
}

// ---- the mask of cells ----

/// Bit at ijk: the voxels ijk + (0 or 1, 0 or 1, 0 or 1) are all valid and in the box; `step` 0 along an axis of one layer.
openvdb::MaskTree erode(const openvdb::MaskTree& valid, const openvdb::CoordBBox& box, const Index3& step) {
  using MaskLeaf = openvdb::MaskTree::LeafNodeType;
  const openvdb::MaskTree voxels = leaves_within(valid, box);
  std::vector<const MaskLeaf*> sources;
  voxels.getNodes(sources);
  openvdb::MaskTree cells(false);
  std::vector<MaskLeaf*> targets;
  for (const MaskLeaf* source : sources) targets.push_back(cells.touchLeaf(source->origin()));
  parallel_for(sources.size(), 64, [&](std::size_t begin, std::size_t end) {
    openvdb::tree::ValueAccessor<const openvdb::MaskTree> neighbours(voxels);
    for (std::size_t n = begin; n < end; ++n) {
      // the leaf and one layer beyond it, then eight bits a cell
      bool window[9][9][9];
      const openvdb::Coord o = sources[n]->origin();
      for (int x = 0; x < 9; ++x)
        for (int y = 0; y < 9; ++y)
          for (int z = 0; z < 9; ++z)
            window[x][y][z] = x < 8 && y < 8 && z < 8 ? sources[n]->isValueOn(static_cast<openvdb::Index>(x * 64 + y * 8 + z))
                                                      : neighbours.isValueOn(o.offsetBy(x, y, z));
      for (int x = 0; x < 8; ++x)
        for (int y = 0; y < 8; ++y)
          for (int z = 0; z < 8; ++z) {
            bool all = true;
            for (int c = 0; c < 8; ++c) all = all && window[x + (c & 1) * step.x][y + (c >> 1 & 1) * step.y][z + (c >> 2) * step.z];
            if (all) targets[n]->setValueOn(static_cast<openvdb::Index>(x * 64 + y * 8 + z));
          }
    }
  });
  return cells;
}

template <class Grid, class Nano, class Tree>
Result<std::shared_ptr<const Grid>> from_tree(std::string name, const Mapping& mapping, const Tree& tree, const ValidMask& valid) {
  // what the grid holds
  const openvdb::CoordBBox box = active_box(tree);
  if (box.empty()) return Error{"has no active voxels, expected a grid with data"};
  const GridStats stats = tree_stats(tree, valid.get());
  if (stats.nan_count == stats.active_voxels) return Error{"has no finite value in any active voxel"};
  if (!(stats.min <= stats.max)) return Error{"has no valid voxel with a finite value: the mask leaves nothing of it"};
  // the buffers
  auto storage = std::make_unique<typename Grid::Storage>();
  storage->set_box(index3(box.min()), index3(box.max()));
  storage->values_handle = to_nano(tree);
  storage->values = storage->values_handle.template grid<Nano>();
  if (valid) {
    storage->voxels_handle = to_nano(*valid);
    storage->cells_handle = to_nano(erode(*valid, box, storage->step));
    storage->valid_voxels = storage->voxels_handle.template grid<nanovdb::ValueMask>();
    storage->valid_cells = storage->cells_handle.template grid<nanovdb::ValueMask>();
  }
  storage->may_be_invalid = valid || stats.nan_count > 0 || !finite_background(tree.background());
  return std::shared_ptr<const Grid>(
      std::make_shared<Grid>(std::move(name), mapping, Box{vec3(box.min()), vec3(box.max())}, std::move(storage), stats));
}

}  // namespace

Result<std::shared_ptr<const ScalarGrid>> scalar_from_tree(std::string name, const Mapping& mapping, const openvdb::FloatTree& tree,
                                                           const ValidMask& valid) {
  return from_tree<ScalarGrid, float>(std::move(name), mapping, tree, valid);
}

Result<std::shared_ptr<const VectorGrid>> vector_from_tree(std::string name, const Mapping& mapping, const openvdb::Vec3fTree& tree,
                                                           const ValidMask& valid) {
  return from_tree<VectorGrid, nanovdb::Vec3f>(std::move(name), mapping, tree, valid);
}

GridStats stats_of(const openvdb::FloatTree& tree, const openvdb::MaskTree* valid) { return finished(tree_stats(tree, valid)); }
GridStats stats_of(const openvdb::Vec3fTree& tree, const openvdb::MaskTree* valid) { return finished(tree_stats(tree, valid)); }

std::size_t nano_bytes(const openvdb::FloatTree& tree) { return to_nano(tree).size(); }
std::size_t nano_bytes(const openvdb::Vec3fTree& tree) { return to_nano(tree).size(); }
std::size_t nano_bytes(const openvdb::MaskTree& tree) { return to_nano(tree).size(); }

openvdb::FloatGrid::Ptr open_grid(const ScalarGrid& grid) { return nanovdb::nanoToOpenVDB(*grid.storage().values); }
openvdb::Vec3SGrid::Ptr open_grid(const VectorGrid& grid) { return nanovdb::nanoToOpenVDB(*grid.storage().values); }

openvdb::MaskTree::Ptr open_mask(const ScalarGrid& grid) {
  const NanoMask* mask = grid.storage().valid_voxels;
  return mask ? nanovdb::nanoToOpenVDB(*mask)->treePtr() : nullptr;
}

openvdb::MaskTree::Ptr open_mask(const VectorGrid& grid) {
  const NanoMask* mask = grid.storage().valid_voxels;
  return mask ? nanovdb::nanoToOpenVDB(*mask)->treePtr() : nullptr;
}

}  // namespace catena::field
