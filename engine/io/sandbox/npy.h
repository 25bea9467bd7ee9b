// SPDX-License-Identifier: MIT
/// Header of an array written by NumPy (NEP 1, versions 1.0 to 3.0). Any thread.
///   shape (d0, d1, d2)   [z, y, x]: the last index is x, as is usual for images and simulations in NumPy; axes_xyz: the first is x.
///                        With fewer than three the missing ones are 1. With four, the last (axes_xyz: the first) being 2 or 3: vectors
///   order                C or Fortran; types: integers of 1 to 8 bytes, float32, float64, either byte order, float16, bool
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "engine/base/result.h"
#include "engine/field/number_type.h"
#include "engine/io/protocol.h"

namespace catena::sandbox {

/// The parsed header of a .npy file.
struct NpyHeader {
  std::size_t data_offset = 0;   ///< Offset of the values in the file, bytes.
  std::string type;              ///< Number type: "float32", "uint8", "float16", "bool".
  std::size_t number_bytes = 0;  ///< Bytes per number.
  bool is_byte_swapped = false;  ///< The byte order is not the host's.
  field::Size3 size;             ///< Voxels along x, y, z.
  int components = 1;
  /// Numbers from one voxel to the next along x, y, z, and from one component to the next.
  std::uint64_t stride[4]{};
};

/// Parses the header. `bytes`: the file, or at least its header. Returns an Error with a message fragment ("begins with ...").
Result<NpyHeader> read_npy_header(std::span<const std::byte> bytes, bool axes_xyz);

/// Converts all values to 32-bit floats, x fastest; vectors of two components get a third, 0. Where the array is flat (one voxel along an
/// axis), that voxel is written twice to give it a thickness. `numbers` must be as long as the header states, `out` npy_float_count()
/// floats. Returns the rounding loss; duplicates along y and z are counted twice.
field::RoundingLoss decode_npy(const NpyHeader& head, std::span<const std::byte> numbers, std::span<float> out);
/// Size of the resulting grid: at least 2 voxels along each axis.
field::Size3 npy_grid_size(const NpyHeader& head);
/// Number of floats of the resulting grid.
std::uint64_t npy_float_count(const NpyHeader& head);

/// Handles a request for a .npy file: describes it, or returns its values through `out`. The `error` of the response is a complete message.
class ResponseFile;
field::ReadResponse handle_npy_request(const field::ReadRequest& request, std::span<const std::byte> file, ResponseFile& out);

}  // namespace catena::sandbox
