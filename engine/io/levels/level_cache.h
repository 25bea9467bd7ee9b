// SPDX-License-Identifier: MIT
/// The user's cache of levels and indices of stores: one folder per grid and time step. Any thread and any number of processes.
///   CACHE/NAME-HASH/source            identity of the data: path, sizes, times
///   CACHE/NAME-HASH/index             ranges and checksums of all bricks; complete if it is valid, and the store below is there
///   CACHE/NAME-HASH/levels.zarr       levels that the data lack; while they are made also levels.zarr.part and ranges
#pragma once
#include <functional>
#include <memory>
#include <string>

#include "engine/io/levels/cached_levels.h"
#include "engine/io/stores/store.h"

namespace catena::field {

/// Called while levels are made, with the part of the work that is done, 0 to 1, and a last time with a negative number. Any thread, one
/// call at a time for each path.
using LevelProgress = std::function<void(const std::string& path, double part)>;

/// Sets the folder of the cache, which need not exist, and the callback. Without this call nothing is cached. `folder` empty: the user has
/// no folder for caches. Call it once, before anything is read.
void set_level_cache(std::string folder, LevelProgress progress);

/// Returns the levels and the index of a grid at a time step that are in the cache; null: none. All exist in the store.
std::shared_ptr<const CachedLevels> find_cached_levels(const Store& store, int grid, int step);

/// Makes the levels after the coarsest one of the store, or continues to do so, and returns them. Waits while another process makes them.
/// The levels of changed data are replaced. The Error is a complete message; what was made stays, unless the disk is full.
Result<std::shared_ptr<const CachedLevels>> make_cached_levels(const std::shared_ptr<Store>& store, int grid, int step);

/// Adds the index of the only grid of a store that was just written, unless it has few bricks. Failures are ignored: nothing depends on the
/// index.
void cache_index(const std::string& path, const BrickIndex& index);

/// Removes the entries that were used longest ago, at least an hour ago, until the cache has at most `max_bytes`. Those that a program
/// makes stay. Returns how many were removed. make_cached_levels() calls it with a tenth of the disk.
int trim_level_cache(std::uint64_t max_bytes);

/// Returns the size of a folder's files, bytes.
std::uint64_t folder_bytes(const std::string& folder);

}  // namespace catena::field
