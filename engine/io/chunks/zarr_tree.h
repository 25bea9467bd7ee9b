// SPDX-License-Identifier: MIT
/// Images and arrays of a Zarr store, found by their metadata files.
///   group with "multiscales"    an image, and the images of its group "labels"
///   another group               the images and arrays in it, at most kMaxDepth groups deep
///   array without OME metadata  axes z, y, x; in front of them c, or t and c, or those that xarray names
/// Refused in a sentence: version 3 (zarr.json), a plate.
#pragma once
#include <sys/stat.h>

#include <functional>
#include <string>
#include <vector>

#include "engine/io/chunks/ome_metadata.h"
#include "engine/io/chunks/open_store.h"
#include "engine/io/chunks/zarr_array.h"

namespace catena::chunks {

/// Axes by what they mean; the values are indices into ZarrImage::axis.
enum ZarrAxis { kAxisX, kAxisY, kAxisZ, kAxisC, kAxisT };

/// An image or an array.
struct ZarrImage {
  std::string name;  ///< Path in the store; empty: the store itself is the image.
  OmeMetadata meta;  ///< Of an array: empty, apart from its only data set.
  bool is_label = false;
  std::vector<ZarrArray> levels;
  int axis[5] = {-1, -1, -1, -1, -1};  ///< Dimension of the arrays for each ZarrAxis; -1: none.

  /// Returns the number of voxels of a level along an axis; 1: the array does not have this axis.
  std::int64_t size(std::size_t level, ZarrAxis of) const { return axis[of] < 0 ? 1 : levels[level].shape[axis[of]]; }
  /// Returns the same of a chunk.
  std::int64_t chunk(std::size_t level, ZarrAxis of) const { return axis[of] < 0 ? 1 : levels[level].chunk[axis[of]]; }
};

/// Finds all images. `record` is called with each file that was read; `notes` receives what is left out.
Result<std::vector<ZarrImage>> find_zarr_images(const StorePath& path, const std::function<void(const struct stat&)>& record,
                                                std::vector<std::string>& notes);

}  // namespace catena::chunks
