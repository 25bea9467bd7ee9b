// SPDX-License-Identifier: MIT
/// Filters of HDF5 that are registered with the HDF Group, for reading.
#pragma once

namespace catena::chunks {

/// Registers lz4 (32004), blosc (32001) and zstd (32015) with the library, and turns its plug-ins off.
void register_hdf5_filters();

}  // namespace catena::chunks
