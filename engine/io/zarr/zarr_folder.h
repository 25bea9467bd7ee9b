// SPDX-License-Identifier: MIT
/// A Zarr store that is being written. Private to this folder.
///   PATH.part/identity   what is being written, to recognize the store of an ended program
///   PATH.part/log        the bricks that are complete (brick_log.h)
///   PATH.part/store      the store, renamed to PATH when it is complete
#pragma once
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "engine/base/folder_lock.h"
#include "engine/io/stores/store.h"
#include "engine/io/volume/voxel_source.h"
#include "engine/io/zarr/brick_log.h"

namespace catena::field {

/// The store and its bricks; created by one thread. read() and write() may be called from any thread, of different bricks.
class ZarrFolder {
 public:
  /// Creates the folder with the metadata of all levels, or opens the one of the same identity that an ended program has left. The Error is
  /// a complete message: something exists at `path`, or there is an unfinished store of other data.
  static Result<std::unique_ptr<ZarrFolder>> open(const std::string& path, const VoxelSource& source, std::vector<BrickLevel> levels);

  /// Returns the levels.
  const std::vector<BrickLevel>& levels() const { return levels_; }
  /// Returns the state of a brick.
  BrickState state(int level, const Index3& brick) const { return log_.state(level, brick); }
  /// Stores a brick, whose padding has the fill value, unless all its values are the fill value. Completes it.
  Result<BrickState> write(int level, const Index3& brick, std::span<const std::byte> values);
  /// Reads a stored brick; its padding is unchanged.
  Outcome read(int level, const Index3& brick, std::span<std::byte> values);
  /// Returns a brick of the fill value.
  std::span<const std::byte> fill_brick() const { return fill_; }
  /// Returns the index of the bricks.
  Result<BrickIndex> read_index(const VoxelSource& source) const;
  /// Writes the metadata with the range of the values, waits for the disk, and renames the store to its path.
  Outcome commit(const VoxelSource& source);
  /// Removes the unfinished store.
  void remove() const;

 private:
  ZarrFolder(std::string path, FolderLock lock, BrickLog log, std::vector<BrickLevel> levels, NumberType type, double fill);
  std::string chunk_path(int level, const Index3& brick) const;
  Outcome write_chunk(int level, const Index3& brick, std::span<const std::byte> values) const;

  const std::string path_, part_, store_path_;
  FolderLock lock_;
  BrickLog log_;
  const std::vector<BrickLevel> levels_;
  const NumberType type_;
  std::vector<std::byte> fill_;
  std::mutex mutex_;
  std::shared_ptr<Store> reader_;  ///< Of the store itself, opened when a brick is read.
};

}  // namespace catena::field
