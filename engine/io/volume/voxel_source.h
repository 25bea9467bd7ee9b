// SPDX-License-Identifier: MIT
/// Volumes that are read in boxes of voxels, so that a writer of chunks can convert volumes that are larger than memory.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "engine/field/cell.h"
#include "engine/field/field.h"
#include "engine/field/number_type.h"
#include "engine/io/volume/load_field.h"
#include "engine/io/volume/units.h"

namespace catena::field {

/// A scalar volume. The functions may be called from any thread and hold what they need.
struct VoxelSource {
  std::string name;                               ///< Name of the grid.
  NumberType type;                                ///< Number type of the values.
  Index3 size{0, 0, 0};                           ///< Voxels along x, y, z.
  Mapping mapping{};                              ///< World from index, at voxel centers.
  Units units{};                                  ///< Units and kind.
  double fill_value = 0;                          ///< Value of voxels without data.
  std::optional<std::array<double, 2>> window{};  ///< Range to display that the file states.
  std::int32_t color = -1;                        ///< 0xRRGGBB; -1: not specified.
  std::string identity{};                         ///< Text that differs if the voxels may differ; empty: there is none.
  std::vector<std::string> notes{};               ///< On the data: sentences without a final period.
  /// Bricks along x, y, z that are best read at once, because they share what the file stores together. {1, 1, 1}: any order is as good.
  Index3 bricks_at_once{1, 1, 1};

  /// Reads the box of `size` voxels from `lo` on; `values` has exactly its bytes, x fastest. The Error is a complete message.
  std::function<Outcome(const Index3& lo, const Index3& size, std::span<std::byte> values)> read{};
  /// Returns whether a brick of kBrickEdge^3 voxels has no data: every voxel has the fill value. Empty: not known.
  std::function<bool(const Index3& brick)> is_empty{};
};

/// Opens the grid that a request names, at its time step. Data in a store, a .raw or .npy file are read in boxes; other files
/// are loaded.
Result<VoxelSource> open_voxels(const LoadRequest& request);
/// Loads the grid that a request names, and makes the source of it.
Result<VoxelSource> load_voxels(const LoadRequest& request);
/// Makes the source of a loaded scalar grid: 32-bit floats with NaN where a voxel is invalid, or 32-bit integers of a label map. Error: the
/// field is a vector field.
Result<VoxelSource> voxels_of_grid(const std::string& path, const AnyField& field, const std::string& name, const Units& units);
/// Makes the source of a formula, sampled at the nodes that try_sample_on_grid() has; NaN where the formula has no value.
Result<VoxelSource> voxels_of_formula(const AnyField& formula, int resolution, double lo, double hi);
/// Returns the source with its axes along the world axes: voxels of permuted and mirrored axes are reordered. Error (a message fragment):
/// the axes are rotated or sheared.
Result<VoxelSource> align_to_world(VoxelSource source);
/// Returns a text with the name, size and time of modification of a file or folder, for VoxelSource::identity.
std::string identify_file(const std::string& path);

}  // namespace catena::field
