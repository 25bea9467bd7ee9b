// SPDX-License-Identifier: MIT
/// Computes and writes all bricks of a store. Private to this folder.
/// A brick is completed after the finer ones that it covers, depth first, so that a few bricks per level are in memory. Where the source is
/// best read in groups of bricks, level 0 is written first, group by group, and read back.
#pragma once
#include <atomic>
#include <functional>
#include <mutex>
#include <vector>

#include "engine/io/zarr/write_zarr.h"
#include "engine/io/zarr/zarr_folder.h"

namespace catena::field {

/// One run; used once.
class PyramidWriter {
 public:
  PyramidWriter(ZarrFolder& folder, const VoxelSource& source, const WriteProgress& progress);
  /// Completes all bricks.
  Outcome write();

 private:
  /// Buffers of a thread.
  struct Scratch {
    std::vector<std::vector<std::byte>> bricks, halved;  ///< By level.
    std::vector<std::byte> box;                          ///< Of the source.
  };
  /// A brick of level `split_`, for the levels above.
  struct Part {
    BrickState state = BrickState::missing;
    std::vector<std::byte> halved;
  };

  Scratch make_scratch() const;
  Outcome for_each(std::size_t count, const std::function<Outcome(std::size_t, Scratch&)>& body);
  Outcome write_group(const Index3& first, Scratch& scratch);
  Result<BrickState> complete(int level, const Index3& brick, Scratch& scratch);
  Result<bool> combine(int level, const Index3& brick, Scratch& scratch);
  Outcome read_source(const Index3& brick, Scratch& scratch);
  bool needs_reading(const Index3& brick) const;
  std::size_t number_in_split(const Index3& brick) const;
  void report(double work);

  ZarrFolder& folder_;
  const VoxelSource& source_;
  const WriteProgress& progress_;
  const int top_, split_;    ///< Coarsest level; level whose bricks are shared among the threads.
  const bool is_in_groups_;  ///< Level 0 is written first.
  std::vector<Part> parts_;
  std::atomic<bool> has_failed_{false};
  std::mutex progress_mutex_;
  double work_ = 0, all_work_ = 1;
};

}  // namespace catena::field
