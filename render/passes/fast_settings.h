/// How the fast raycast of one volume (render/passes/fast_volume.h) trades error for time.
#pragma once
#include <cstdint>

namespace catena::render {

struct FastSettings {
  double step_voxels = 4;         ///< in smallest voxel edges
  std::uint32_t spacing = 1;      ///< pixels between the first rays: 1, 2 or 4
  double refine_half_255 = 0;     ///< spacing 4: marches every 2nd pixel where interpolation is expected to err by more; < 0: nowhere
  double refine_full_255 = -1;    ///< the same for every pixel
  bool smooth_gradients = false;  ///< shading by central differences, as the exact raycast has it, for 4 bytes a voxel more
  double termination = 1.0 / 512;
  bool skip = true;
  std::uint64_t most_bytes = std::uint64_t(1) << 30;  ///< on the device, for packed words and gradients; what needs more is drawn exactly
  /// The last step to every pixel is interpolation alone.
  bool ends_at_half() const { return spacing > 1 && refine_full_255 < 0; }
  bool operator==(const FastSettings&) const = default;
};

}  // namespace catena::render
