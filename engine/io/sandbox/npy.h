/// The head of an array that NumPy wrote (NEP 1, versions 1.0 to 3.0). Any thread.
///   shape (d0, d1, d2)   [z, y, x]: the last index is x, as images and simulations are indexed in NumPy; axes_xyz: the first is x.
///                        Fewer than three: the missing ones are 1. Four, the last (first with axes_xyz) of them 2 or 3: vectors
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

struct NpyHeader {
  std::size_t data_offset = 0;   ///< bytes before the numbers
  std::string type;              ///< "float32", "uint8", "float16", "bool"
  std::size_t number_bytes = 0;  ///< of one number
  bool is_byte_swapped = false;  ///< in the other byte order
  field::Size3 size;             ///< voxels along x, y, z
  int components = 1;
  /// NumberArray between neighbours along x, y, z, and between components.
  std::uint64_t stride[4]{};
};

/// `bytes`: the file, at least its head. An error is a phrase ("begins with ...").
Result<NpyHeader> read_npy_header(std::span<const std::byte> bytes, bool axes_xyz);

/// All numbers as 32-bit floats, x fastest; vectors of two get a third, 0. Where an array is flat (one voxel along an axis), that voxel is
/// written twice, which gives it a thickness. `numbers` must be as long as the head says.
/// What was rounded is counted once for every copy.
field::RoundingLoss decode_npy(const NpyHeader& head, std::span<const std::byte> numbers, std::span<float> out);
/// How many floats that are, and the size of the grid.
field::Size3 npy_grid_size(const NpyHeader& head);
std::uint64_t npy_float_count(const NpyHeader& head);

/// What a .npy file holds, for `info`, or the numbers themselves. The error of the reply is a whole sentence.
class ResponseFile;
field::ReadResponse handle_npy_request(const field::ReadRequest& request, std::span<const std::byte> file, ResponseFile& out);

}  // namespace catena::sandbox
