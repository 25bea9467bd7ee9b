// SPDX-License-Identifier: MIT
/// Stores opened in the reader process, one function per format. Each Error of these functions is a complete message that begins with the
/// path that the user gave.
#pragma once
#include <cstddef>
#include <memory>
#include <span>
#include <string>

#include "engine/base/result.h"
#include "engine/io/stores/store_protocol.h"

namespace catena::chunks {

/// Names of what is opened.
struct StorePath {
  std::string shown;  ///< As the user gave it, for messages.
  std::string real;   ///< File or folder, as the sandbox sees it.
};

/// An open store; used by one thread.
class OpenStore {
 public:
  virtual ~OpenStore() = default;
  /// Returns its contents.
  const field::StoreDescription& description() const { return description_; }
  /// Reads a box of a grid at a level and a time step, all of which exist; `values` has exactly its bytes.
  virtual Outcome read(const field::StoreRequest& request, std::span<std::byte> values) = 0;
  /// Writes one byte per brick of a level, x fastest; 0: nothing is stored for it. The implementation here writes 1 for every brick.
  virtual Outcome list(const field::StoreRequest& request, std::span<std::uint8_t> present);

 protected:
  /// Records a file that was read for the description.
  void record_file(const struct stat& about);
  field::StoreDescription description_;
};

/// Opens a Zarr store, version 2, with or without OME metadata.
Result<std::unique_ptr<OpenStore>> open_zarr(const StorePath& path);
/// Opens a TIFF file, or a folder of TIFF files that are slices, in the order of the numbers in their names.
Result<std::unique_ptr<OpenStore>> open_tiff(const StorePath& path);
/// Opens an HDF5 file, or the .xml of BigDataViewer that names one.
Result<std::unique_ptr<OpenStore>> open_hdf5(const StorePath& path);
/// Opens a .raw or .npy file, whose numbers are read where they lie.
Result<std::unique_ptr<OpenStore>> open_array(const StorePath& path, const field::ArrayLayout& layout);
/// Opens any store by the kind of its path.
Result<std::unique_ptr<OpenStore>> open_store(const StorePath& path, const field::ArrayLayout& layout);

}  // namespace catena::chunks
