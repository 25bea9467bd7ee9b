// SPDX-License-Identifier: MIT
/// GPU copy of a scalar grid, built from its NanoVDB data on the CPU, keyed by (grid version, texel format), immutable, can be discarded at
/// any time.
///   dense: one 3D image over the index box; always used for a cubic grid (field::Interpolation), then padded by one voxel on each side,
///          with the grid's halo samples in place of missing ones, so that the 4^3 samples of every valid cell are in the image
///   atlas: the 8^3 leaves as 9^3 bricks (halo of +1) in one 3D image; constant leaves of the same value share a brick
/// Positions are *local*: local = index - origin, voxel centers at integers; the domain is box_lo..box_hi. value = offset + scale * texel.
/// R32F: 0 and 1, exact. R16F: 0 and a power of two (rounded like half floats), unless the values span less than half of their largest
/// magnitude: then the texels span 0..1 from the minimum value. A cell that the grid's `valid` mask excludes, or with a corner that is not
/// finite, is 0 in the mask image and is not rendered. A grid that does not fit is downsampled to 1/downsample_factor of its resolution:
/// the resident grid is then a copy of `downsampled`, a grid with its own transform, and everything above refers to that one; only its part
/// within domain_lo..domain_hi is rendered. Minimum and maximum are kept per brick of 8^3 cells, on the host, over the corners of the
/// brick's valid cells (min > max: none); for a cubic grid over their 4^3 samples, widened by the overshoot of a cubic.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "engine/base/export.h"
#include "engine/field/derived/box_downsample.h"
#include "render/vk/resources.h"

namespace catena::render {

inline constexpr int kBrickSize = 8;  ///< Cells along the edge of a brick.
/// Voxels along the edge of a stored brick, including the border shared with its neighbors.
inline constexpr int kPaddedBrickSize = kBrickSize + 1;

/// Layout of the texels on the device. automatic: see ResidencyOptions::layout.
enum class GridLayout { automatic, dense, atlas };

/// Options for building a resident grid.
struct ResidencyOptions {
  bool use_float32 = false;                   ///< 32-bit texels; false: 16-bit texels
  GridLayout layout = GridLayout::automatic;  ///< automatic: dense unless less than about a third of the leaves would be stored
};

/// Minimum and maximum value of a brick.
struct BrickRange {
  float min = 1, max = 0;  ///< in the field's unit
  /// Returns whether the brick has no valid cell.
  bool empty() const { return min > max; }
};

/// Resident grid: the device images of one grid. Frame thread.
struct ResidentGrid {
  bool is_drawable = false;                ///< false: thinner than one cell along some axis; no other member is set
  bool atlas = false;                      ///< brick atlas; false: one dense image
  bool masked = false;                     ///< `mask` is set
  bool nearest = false;                    ///< nearest interpolation: value of the nearest voxel center (field::Interpolation)
  bool cubic = false;                      ///< cubic interpolation of 4^3 samples
  field::Index3 origin;                    ///< index = origin + local
  Vec3 box_lo{0.0}, box_hi{0.0};           ///< domain, local
  std::array<std::int32_t, 3> bricks{};    ///< bricks per axis
  float offset = 0, scale = 1;             ///< value = offset + scale * texel
  vk::Image values;                        ///< texels
  vk::Sampler point_sampler;               ///< set if `nearest`: reads a single texel, without interpolation
  vk::Image mask;                          ///< R8_UINT per cell: dense like `values`; for an atlas in 8^3 bricks at the same slots
  std::vector<BrickRange> brick_ranges;    ///< per brick, x fastest
  std::vector<std::uint32_t> brick_slots;  ///< atlas: slot position per brick, x | y << 8 | z << 16, in bricks

  /// Returns the index of a brick in `brick_ranges` and `brick_slots`.
  std::size_t brick_index(int x, int y, int z) const { return (std::size_t(z) * bricks[1] + y) * bricks[0] + x; }
  /// Returns the bytes of its images.
  std::uint64_t bytes() const { return values.bytes() + mask.bytes(); }

  int downsample_factor = 1;                             ///< 1: full resolution; 2, 4, 8: downsampled
  std::shared_ptr<const field::ScalarGrid> downsampled;  ///< source of a downsampled grid; null at full resolution
  Vec3 domain_lo{0.0}, domain_hi{0.0};                   ///< domain of the full grid, local; within box_lo..box_hi
  /// Returns the grid whose voxels these are: `grid`, or the downsampled one. Its mapping is that of the resident grid.
  const field::ScalarGrid& source(const field::ScalarGrid& grid) const { return downsampled ? *downsampled : grid; }
};

/// Returns the bytes of the images that make_resident_grid() would create; reads only which leaves are constant. nullopt if the device does
/// not support such images.
CATENA_EXPORT std::optional<std::uint64_t> resident_image_bytes(vk::Device& device, const field::ScalarGrid& grid,
                                                                const ResidencyOptions& options);

/// Returns the bytes that make_resident_grid() and the maps of a volume or a surface need, including staging; nullopt if the device cannot
/// store the grid whatever the budget.
CATENA_EXPORT std::optional<std::uint64_t> resident_grid_bytes(vk::Device& device, const field::ScalarGrid& grid,
                                                               const ResidencyOptions& options);

/// Builds the resident grid at full resolution. An Error if the device has no memory for it.
CATENA_EXPORT Result<ResidentGrid> make_resident_grid(vk::Device& device, const field::ScalarGrid& grid, const ResidencyOptions& options);
/// Builds the resident grid of a grid downsampled by `factor` (2, 4, 8).
CATENA_EXPORT Result<ResidentGrid> make_downsampled_resident_grid(vk::Device& device, const field::CoarseGrid& grid, int factor,
                                                                  const ResidencyOptions& options);

}  // namespace catena::render
