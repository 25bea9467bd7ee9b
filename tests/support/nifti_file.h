// SPDX-License-Identifier: MIT
/// NIfTI-1 files, written field by field: 348 bytes of header, 4 bytes of padding, and the voxels.
#pragma once
#include <array>
#include <cstdint>
#include <cstring>
#include <string>

namespace catena::test {

struct NiftiFile {
  std::string header = std::string(352, '\0'), voxels{};

  /// A grid with voxels of edge 1 and no transform; `datatype`: 2 for 8-bit integers, 16 for floats.
  NiftiFile(const std::array<int, 3>& size, std::int16_t datatype, std::int16_t bits) {
    put(0, std::int32_t{348});
    const int dimensions[] = {3, size[0], size[1], size[2], 1, 1, 1, 1};
    for (std::size_t d = 0; d < 8; ++d) put(40 + 2 * d, static_cast<std::int16_t>(dimensions[d]));
    put(70, datatype);
    put(72, bits);
    for (std::size_t d = 0; d < 8; ++d) put(76 + 4 * d, 1.f);
    put(108, 352.f);
    std::memcpy(header.data() + 344, "n+1", 4);
  }
  template <class T>
  void put(std::size_t at, T value) {
    std::memcpy(header.data() + at, &value, sizeof value);
  }
  template <class T>
  void append(T value) {
    voxels.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  std::string bytes() const { return header + voxels; }
};

}  // namespace catena::test
