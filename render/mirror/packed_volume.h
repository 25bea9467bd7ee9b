/// Half floats, rounded to nearest even, as a texture of R16F holds them.
#pragma once
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "engine/field/grid.h"
#include "render/vk/resources.h"

namespace catena::render {

/// For finite values within +-65504 (beyond: infinity). Subnormals are kept.
inline std::uint16_t half_from_float(float value) {
  const std::uint32_t bits = std::bit_cast<std::uint32_t>(value);
  const std::uint32_t sign = bits >> 16 & 0x8000u;
  const std::uint32_t magnitude = bits & 0x7fffffffu;
  if (magnitude >= 0x47800000u) return std::uint16_t(sign | 0x7c00u);
  if (magnitude < 0x38800000u) {
    // subnormal: adding 0.5 lets the float unit align and round the bits
    const float shifted = std::bit_cast<float>(magnitude) + 0.5f;
    return std::uint16_t(sign | (std::bit_cast<std::uint32_t>(shifted) - 0x3f000000u));
  }
  const std::uint32_t rounded = magnitude + 0xfffu + (magnitude >> 13 & 1u);
  return std::uint16_t(sign | (rounded - 0x38000000u) >> 13);
}

inline float float_from_half(std::uint16_t half) {
  const std::uint32_t sign = std::uint32_t(half & 0x8000u) << 16, magnitude = half & 0x7fffu;
  if (magnitude >= 0x7c00u) return std::bit_cast<float>(sign | 0x7f800000u | (magnitude & 0x3ffu) << 13);
  if (magnitude < 0x400u) return std::bit_cast<float>(sign | std::bit_cast<std::uint32_t>(float(magnitude) * 0x1p-24f));
  return std::bit_cast<float>(sign | ((magnitude << 13) + 0x38000000u));
}

/// A scalar grid for fast raycasting: one 32-bit word a voxel that holds the codes of four neighbours, so that two fetches give a
/// whole trilinear cell.   word(x, y, z) = c(x, y, z) | c(x+1, y, z) << 8 | c(x, y+1, z) << 16 | c(x+1, y+1, z) << 24
///   value = lo + code * per_code, code 0..255; beyond the ends the end codes hold
/// The range is the least one that keeps every cell whole in which the transfer function changes: `active`, widened by the corners
/// of the cells that touch it. Outside it the picture is one colour and density, so nothing else is lost than 8-bit rounding.
/// Codes' ranges are kept a brick of 4^3 cells, on the host. Local positions: local = index - origin, the domain is 0 .. size - 1.
inline constexpr int kSmallBrick = 4;

struct CodeRange {
  std::uint8_t least = 255, greatest = 0;
};

struct ValueInterval {
  double least = 0, greatest = 0;
  bool operator==(const ValueInterval&) const = default;
};

struct PackedVolume {
  vk::Image words;  ///< R32_UINT
  field::Index3 origin, size;
  double lo = 0, per_code = 0;
  std::array<std::int32_t, 3> bricks{};  ///< an axis
  std::vector<CodeRange> ranges;         ///< x fastest
  std::uint64_t bytes() const { return words.bytes(); }
};

/// Whether a grid can be packed on this device: no masked cells, at least a cell thick, and of a size that pays.
bool can_be_packed(const vk::Device& device, const field::ScalarGrid& grid);

/// Of its words, and of gradients (render/mirror/packed_volume.h) as many again.
std::uint64_t packed_bytes(const field::ScalarGrid& grid);

Result<PackedVolume> make_packed_volume(vk::Device& device, const field::ScalarGrid& grid, const ValueInterval& active);

/// The range of values to encode (for make_packed_volume and its test): `values` x fastest.
ValueInterval range_to_encode(const field::Index3& size, const std::vector<float>& values, const ValueInterval& active);

/// Gradients for shading in the fast raycast: directions of central differences of one voxel at every voxel, R8G8B8A8_UNORM, read with
/// linear interpolation: 128 + 127 g / (3 rms |g|), the mean over the voxels whose values are in `active`, for what is not seen needs no
/// light. Longer ones are shortened, which the fourth component says (1): the light needs directions more than lengths.
/// The shading of `reference`, for 4 bytes a voxel more; without it the gradient of the cell serves. Made when first asked for.
struct GradientVolume {
  vk::Image image;
  double unit = 0;  ///< values a voxel in one count of 1 / 127
};

/// `grid` can_be_packed.
Result<GradientVolume> make_gradient_volume(vk::Device& device, const field::ScalarGrid& grid, const ValueInterval& active);

}  // namespace catena::render
