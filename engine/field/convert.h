/// Private to this room: OpenVDB trees (what files hold) into immutable NanoVDB grids (what is sampled).
/// One of the few headers that include OpenVDB: only coarsen.cpp, convert.cpp, grid_make.cpp, load_vdb.cpp and write_vdb.cpp include it.
#pragma once
#include <openvdb/openvdb.h>

#include "engine/base/result.h"
#include "engine/field/grid.h"

namespace catena::field {

/// The mask of the valid voxels: null where the grid has none.
using ValidMask = openvdb::MaskTree::Ptr;

/// Fails (one phrase, without the file's name) when no voxel is active, none is valid or none is finite.
Result<std::shared_ptr<const ScalarGrid>> scalar_from_tree(std::string name, const Mapping& mapping, const openvdb::FloatTree& tree,
                                                           const ValidMask& valid);
Result<std::shared_ptr<const VectorGrid>> vector_from_tree(std::string name, const Mapping& mapping, const openvdb::Vec3fTree& tree,
                                                           const ValidMask& valid);

/// Statistics over the active voxels; with a mask the ranges count only the valid ones. The box is of the active voxels.
GridStats stats_of(const openvdb::FloatTree& tree, const openvdb::MaskTree* valid = nullptr);
GridStats stats_of(const openvdb::Vec3fTree& tree, const openvdb::MaskTree* valid = nullptr);

/// What the grid takes in memory as NanoVDB.
std::size_t nano_bytes(const openvdb::FloatTree& tree);
std::size_t nano_bytes(const openvdb::Vec3fTree& tree);
std::size_t nano_bytes(const openvdb::MaskTree& tree);

/// And back, for writing.
openvdb::FloatGrid::Ptr open_grid(const ScalarGrid& grid);
openvdb::Vec3SGrid::Ptr open_grid(const VectorGrid& grid);
/// The valid voxels; null where the grid has no mask.
openvdb::MaskTree::Ptr open_mask(const ScalarGrid& grid);
openvdb::MaskTree::Ptr open_mask(const VectorGrid& grid);

}  // namespace catena::field
