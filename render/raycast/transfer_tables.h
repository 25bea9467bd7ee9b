/// TransferEditor functions as tables for the exact raycast and for colours by another field. Plain CPU code.
#pragma once
#include <array>
#include <cstdint>
#include <glm/vec4.hpp>
#include <span>
#include <vector>

#include "render/frame/frame_packet.h"
#include "render/residency/resident_grid.h"

namespace catena::render {

/// A transfer function as the shader reads it (shaders/lib/tables.glsl): 4096 samples (r, g, b, sigma), evenly spaced on the function's
/// scale over the values that it and the grid share, read with linear interpolation; beyond the ends the end values hold. Of labels one
/// entry for each whole number, where they are not too many.
/// Where interpolation between two samples errs by more than is allowed at a point of the function, the interval is marked by the sign of
/// its first sample's sigma, and values in it are looked up among the function's own points: exact at every float.
struct TransferLut {
  std::vector<glm::vec4> entries;             ///< the samples; sigma with a minus (or -0): the interval after it is marked
  std::vector<glm::vec4> control_points;      ///< the function's own; empty: no interval is marked
  std::vector<float> control_values;          ///< of the points, rising
  float lo = 0, entries_per_unit = 0;         ///< index = (s(value) - lo) * entries_per_unit, clamped to 0..last
  double linear_below = 0;                    ///< of the scale s (engine/base/symlog_scale.h)
  std::vector<std::uint32_t> visible_prefix;  ///< how many points (samples, where there are none) before i have sigma > 0
  std::vector<std::uint32_t> run_ids;         ///< equal for neighbours that are equal throughout

  /// What the shader gets: samples, points, values four in a word.
  std::vector<glm::vec4> pack_for_shader() const;
  bool has_control_points() const { return !control_points.empty(); }
  bool has_nonlinear_scale() const { return linear_below > 0; }
  std::uint32_t last_index() const { return std::uint32_t(entries.size()) - 1; }
  /// Whether some value of the range has sigma > 0.
  bool any_visible(const BrickRange& range) const;
  /// What make_skip_map asks: 0 where colour or sigma vary over the range, 1 where all of it is invisible, else a number of its
  /// colour and sigma.
  std::uint16_t appearance(const BrickRange& range) const;

 private:
  float sample_index(float value) const;
  float index(float value) const;  ///< among the points, where there are some
};

/// The error that is allowed: of sigma as a share of sigma + 1 / length, `length` being that of a ray's way; of a colour's component, times
/// the share of light that the way takes where that is less than all. The picture then errs by less than kTableTolerance * 255 levels even
/// where all of a volume has the value that errs most. Where few of the values lie in an interval, their share of a ray's way is small, and
/// so is what their error makes of it: sigma may err by kTableTolerance * kRareValueShare / share there, up to 16 times, colours up to 4
/// times kTableTolerance.
inline constexpr double kTableTolerance = 1.0 / 1024, kRareValueShare = 0.02;

/// `range`: of the grid's values; `values`: some that stand for all (empty: any value may be that of all). `length`: of the grid's domain,
/// world units; without extinctions it does not count.
TransferLut make_transfer_lut(const TransferTable& table, const BrickRange& range, double length, std::span<const float> values = {});

/// A factor by the length of the gradient, in the first component.
TransferLut make_gradient_factor_lut(const std::vector<std::array<double, 2>>& factors);

/// Piecewise linear with held ends; points in rising order of value. `channel` of 1, 2, ..
double table_value(const TransferTable& table, double value, int channel);  ///< 0..2: r, g, b; 3: sigma

/// The values of the function's points from lo to hi, and these two; where the function leaps, the one just before, too. Rising.
std::vector<double> control_values_between(const TransferTable& table, double lo, double hi);

}  // namespace catena::render
