// SPDX-License-Identifier: MIT
/// Writes a scalar volume as OME-Zarr 0.4 with levels, brick by brick: the volume may be larger than memory.
///   axes      z, y, x; a source with axes along the world axes in another order or direction is reordered
///   chunks    kBrickEdge^3 voxels, compressed by Blosc (LZ4, shuffled); a brick of the fill value only is not stored
///   levels    half the resolution of the one before, as halve_brick() computes it, up to the first that is one chunk
/// The store is built in the folder PATH.part and renamed when it is complete. What an ended program has left of the same source in that
/// folder is completed: bricks that are complete are not read again from the source. The result is the same to the byte.
/// Memory: for each of two threads a few bricks per level, and the bricks that are read at once.
#pragma once
#include <functional>
#include <string>

#include "engine/base/result.h"
#include "engine/field/bricks/brick_index.h"
#include "engine/io/volume/load_field.h"
#include "engine/io/volume/voxel_source.h"

namespace catena::field {

/// Called with the part of the work that is done, 0 to 1, from any thread, one call at a time.
using WriteProgress = std::function<void(double part)>;

/// Called with the index of all bricks before a complete store is renamed. An Error ends the writing.
using UseIndex = std::function<Outcome(BrickIndex index)>;

/// Checks that nothing exists at the path of a new store, and that its folder exists. The Error is a complete message.
Outcome check_new_store(const std::string& path);

/// Writes a volume. The Error is a complete message: something exists at `path`, an unfinished store of another source, axes that OME-Zarr
/// cannot express, a failed read, or a failed write (a system failure). The unfinished store stays if the source has an identity.
Outcome write_zarr(const std::string& path, VoxelSource source, const WriteProgress& progress = {}, const UseIndex& use_index = {});

/// Writes the grid of a file, as convert_file() does.
Result<std::string> convert_to_zarr(const LoadRequest& request, const std::string& path, const std::string& name,
                                    std::vector<std::string>* notes, const WriteProgress& progress);
/// Writes a loaded field: a VolumeWriter (engine/io/formats.h). The store cannot be completed later.
Outcome write_field_as_zarr(const std::string& path, const AnyField& field, const std::string& name, const Units& units);

}  // namespace catena::field
