// SPDX-License-Identifier: MIT
/// Line integral convolution (Cabral and Leedom 1993) on a plane, with reuse of streamlines (Stalling and Hege 1995):
///   I(x) = sum over i of h(i) N(s(i)) / sum over i of h(i),  i = -20 .. 20
/// s: streamline through x of the field's part in the plane, in steps of one texel; N: white noise on the texels, interpolated bilinearly,
/// a function of the index alone; h(i) = cos^2(pi i / 42). A streamline ends where the field has no value or no part in the plane,
/// or turns by more than 90 degrees in a step; the sums end there.
/// Animated textures have h times (1 + cos(2 pi (i / 21 - phase))) / 2 (periodic kernel): the phase enters by a cosine and a sine.
///   texture = mean + a + b cos(2 pi phase) + c sin(2 pi phase),  mean 1/2
/// a, b and c are scaled such that 2.5 standard deviations of I reach 0 and 1 (the contrast is equal on all planes).
/// The plane is divided into blocks, which do not depend on the number of threads, nor do the texels. Off the haptic thread.
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "engine/field/field.h"

namespace catena::flow {

/// Texels on a plane: texel (i, j) is at origin + texel_size (i u + j v).
struct LicPlane {
  Vec3 origin{0.0};                       ///< World position of the center of texel (0, 0).
  Vec3 u{1, 0, 0}, v{0, 1, 0};            ///< Orthogonal unit vectors in the plane.
  double texel_size = 1;                  ///< World units.
  int width = 0, height = 0;              ///< Number of texels along u and v.
  std::int64_t first_u = 0, first_v = 0;  ///< Index of texel (0, 0), of which the noise is a function.
  bool operator==(const LicPlane&) const = default;
};

/// A texture of streaks along a flow.
struct LicTexture {
  /// Texel as signed 16-bit fractions of 1: a, b, c; and 1 where there is a flow, 0 elsewhere.
  struct Texel {
    std::int16_t a = 0, b = 0, c = 0, presence = 0;
  };
  LicPlane plane;             ///< Place of the texels.
  std::vector<Texel> texels;  ///< Rows along u.
};

/// Half of the kernel's length, texels.
inline constexpr int kLicHalfLength = 20;
/// Distance of the noise's own values, texels: the width of a streak.
inline constexpr int kLicNoiseCell = 4;

/// Computes the texture of a field's part in the plane, on all cores. `animated`: with b and c.
std::shared_ptr<const LicTexture> compute_lic(const field::VectorField& field, const LicPlane& plane, bool animated);

}  // namespace catena::flow
