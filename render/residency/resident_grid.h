/// A scalar grid on the GPU, made from its NanoVDB truth, keyed by (grid version, texel format), never changed, thrown away at will.
///   dense: one 3D image over the index box; of a cubic grid (field::Interpolation) always this, padded by one voxel each side, with the
///   grid's ghosts in place of missing samples, so that the 4^3 samples of every valid cell are in the image
///   atlas: the 8^3 leaves as 9^3 bricks (apron +1) in one 3D image; constant leaves of one value share a brick
/// Positions are *local*: local = index - origin, voxel centres at whole numbers; the domain is box_lo..box_hi.
/// value = offset + scale * texel. R32F: 0 and 1, exact. R16F: 0 and a power of two (texels round as halves do), unless the
/// values span less than half of their largest magnitude: then the texels span 0..1 from the least value.
/// A cell that the grid's `valid` mask excludes, or with a corner that is not finite, is 0 in the mask image and drawn by nobody.
/// A grid that does not fit is mirrored at 1/factor of its resolution: the mirror is then of `coarse`, a grid of its own with its own
/// transform, and all of the above is about that one; only the part of it within `domain` is drawn.
/// Min and max are kept a brick of 8^3 cells, on the host, over the corners of the brick's valid cells (least > greatest: none); of a
/// cubic grid over their 4^3 samples, widened by what a cubic may go beyond them.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "engine/field/derived/box_downsample.h"
#include "render/vk/resources.h"

namespace catena::render {

inline constexpr int kBrickSize = 8;                     ///< CellCache along the edge of a brick.
inline constexpr int kPaddedBrickSize = kBrickSize + 1;  ///< a brick as it is stored: with one layer of its neighbours

/// How texels lie on the device.
enum class GridLayout { automatic, dense, atlas };

/// How a grid is mirrored.
struct ResidencyOptions {
  bool use_float32 = false;                   ///< 32-bit texels; else 16
  GridLayout layout = GridLayout::automatic;  ///< automatic: dense unless less than about a third of the leaves would be stored
};

/// Least and greatest value of a brick.
struct BrickRange {
  float min = 1, max = 0;  ///< the field's unit
  /// Whether no cell of it is valid.
  bool empty() const { return min > max; }
};

/// A mirror. Frame thread.
struct ResidentGrid {
  bool is_drawable = false;                ///< false: thinner than a cell along some axis, nothing below is set
  bool atlas = false;                      ///< bricks; else one dense image
  bool masked = false;                     ///< there is a mask image
  bool nearest = false;                    ///< the value of the nearest voxel centre counts (field::Interpolation)
  bool cubic = false;                      ///< the cubic of 4^3 samples counts
  field::Index3 origin;                    ///< index = origin + local
  Vec3 box_lo{0.0}, box_hi{0.0};           ///< the domain, local
  std::array<std::int32_t, 3> bricks{};    ///< an axis
  float offset = 0, scale = 1;             ///< value = offset + scale * texel
  vk::Image values;                        ///< the texels
  vk::Sampler point_sampler;               ///< with `nearest`: reads one texel, never a mix
  vk::Image mask;                          ///< R8_UINT a cell: dense like `values`; atlas in 8^3 bricks at the same slots
  std::vector<BrickRange> brick_ranges;    ///< x fastest
  std::vector<std::uint32_t> brick_slots;  ///< atlas: x | y << 8 | z << 16, in bricks

  /// The place of a brick in `ranges` and `slots`.
  std::size_t brick_index(int x, int y, int z) const { return (std::size_t(z) * bricks[1] + y) * bricks[0] + x; }
  /// Device memory of its images.
  std::uint64_t bytes() const { return values.bytes() + mask.bytes(); }

  int downsample_factor = 1;                             ///< 2, 4, 8: coarser
  std::shared_ptr<const field::ScalarGrid> downsampled;  ///< what was mirrored then
  Vec3 domain_lo{0.0}, domain_hi{0.0};                   ///< of the whole grid, local; within box_lo..box_hi
  /// The grid whose voxels these are: `grid`, or the coarse one. Its mapping is the mirror's.
  const field::ScalarGrid& source(const field::ScalarGrid& grid) const { return downsampled ? *downsampled : grid; }
};

/// Bytes of the mirror's images, as make_resident_grid would make them; nothing is read but which blocks hold one value.
std::optional<std::uint64_t> resident_image_bytes(vk::Device& device, const field::ScalarGrid& grid, const ResidencyOptions& options);

/// What make_resident_grid and the maps of a volume or a surface need, staging included; none where the device cannot hold it at any price.
std::optional<std::uint64_t> resident_grid_bytes(vk::Device& device, const field::ScalarGrid& grid, const ResidencyOptions& options);

/// Makes the mirror at full resolution. An error where the device has no memory for it.
Result<ResidentGrid> make_resident_grid(vk::Device& device, const field::ScalarGrid& grid, const ResidencyOptions& options);
/// At 1/factor (2, 4, 8) of the resolution.
Result<ResidentGrid> make_downsampled_resident_grid(vk::Device& device, const field::CoarseGrid& grid, int factor,
                                                    const ResidencyOptions& options);

}  // namespace catena::render
