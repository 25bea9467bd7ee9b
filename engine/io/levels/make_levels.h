// SPDX-License-Identifier: MIT
/// Makes levels and index of a grid in a folder of the cache. Private to this folder. Any thread.
#pragma once
#include <memory>
#include <string>

#include "engine/io/stores/store.h"
#include "engine/io/zarr/write_zarr.h"

namespace catena::field {

/// The place of a grid at a time step in the cache.
struct CachePlace {
  std::string folder;    ///< Folder of this grid and step alone.
  std::string identity;  ///< identify_stored_grid()

  /// Returns the file with the identity.
  std::string source() const { return folder + "/source"; }
  /// Returns the file with the ranges of the store's coarsest level while the further levels are made.
  std::string ranges() const { return folder + "/ranges"; }
};

/// Makes the levels after the coarsest one of the store, or continues to do so, in a folder that the caller has locked. The Error is a
/// complete message.
Outcome make_levels(const CachePlace& place, const std::shared_ptr<Store>& store, int grid, int step, const WriteProgress& progress);

}  // namespace catena::field
