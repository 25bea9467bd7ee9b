// SPDX-License-Identifier: MIT
/// Reads a box of one level of a store slice by slice, for a dense grid. Private to this folder.
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "engine/field/number_type.h"
#include "engine/io/stores/stored_levels.h"

namespace catena::field {

/// Part of a store that is loaded into one grid.
struct LevelPart {
  std::shared_ptr<const StoredLevels> stored;
  int level = 0;
  StoreBox box;

  const StoreGrid& description() const { return stored->description(); }
  const StoreLevel& at() const { return stored->at(level); }
  /// Returns the size of the loaded grid: an axis of one voxel gets two.
  Index3 grid_size() const;
};

/// Slices of a part, converted to 32-bit floats. Slabs as deep as a chunk are read by all readers of the store at once, so that each chunk
/// is decoded once. One thread; slices are requested with rising z.
class LevelReader {
 public:
  explicit LevelReader(LevelPart part);
  /// Returns the memory of a slab, bytes.
  std::uint64_t slab_bytes() const;
  /// Writes `layers` slices of the loaded grid from `z` on, x fastest.
  Outcome read(int z, int layers, std::span<float> values);
  /// Returns the accumulated loss of precision.
  std::shared_ptr<const RoundingLoss> rounding() const { return rounding_; }

 private:
  Outcome read_slab(int z);

  LevelPart part_;
  NumberType type_;
  int depth_ = 1;               ///< Slices of a slab.
  int first_ = 0, layers_ = 0;  ///< Slices in memory.
  std::vector<std::byte> slab_;
  std::shared_ptr<RoundingLoss> rounding_ = std::make_shared<RoundingLoss>();
};

}  // namespace catena::field
