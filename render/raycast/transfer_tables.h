// SPDX-License-Identifier: MIT
/// Lookup tables of transfer functions for the exact raycast and for coloring by another field. CPU code.
#pragma once
#include <array>
#include <cstdint>
#include <glm/vec4.hpp>
#include <span>
#include <vector>

#include "render/frame/frame_packet.h"
#include "render/residency/resident_grid.h"

namespace catena::render {

/// Lookup table of a transfer function as read by shaders/lib/tables.glsl: 4096 samples (r, g, b, sigma), evenly spaced on the function's
/// scale over the values that it and the grid share, read with linear interpolation; end values are held beyond the ends. For categorical
/// data, one entry per whole number, unless there are too many. If interpolation between two samples errs by more than the tolerance at a
/// point of the function, the interval is marked by the sign of its first sample's sigma, and values in it are evaluated from the
/// function's own points: exact at every float.
struct TransferLut {
  std::vector<glm::vec4> entries;             ///< samples; negative sigma (or -0): the interval after the sample is marked
  std::vector<glm::vec4> control_points;      ///< points of the function; empty: no interval is marked
  std::vector<float> control_values;          ///< values of these points, rising
  float lo = 0, entries_per_unit = 0;         ///< index = (s(value) - lo) * entries_per_unit, clamped to 0..last
  double linear_below = 0;                    ///< linear threshold of the scale s (engine/base/symlog_scale.h); 0: linear
  std::vector<std::uint32_t> visible_prefix;  ///< number of points (or samples, if there are no points) before i that have sigma > 0
  std::vector<std::uint32_t> run_ids;         ///< equal for neighbors between which color and sigma are constant

  /// Returns the shader data: samples, points, and the points' values packed four to a vector.
  std::vector<glm::vec4> pack_for_shader() const;
  bool has_control_points() const { return !control_points.empty(); }
  bool has_nonlinear_scale() const { return linear_below > 0; }
  std::uint32_t last_index() const { return std::uint32_t(entries.size()) - 1; }
  /// Returns whether any value of the range has sigma > 0.
  bool any_visible(const BrickRange& range) const;
  /// Returns the appearance class for make_skip_map: 0 if color or sigma vary over the range, 1 if the whole range is invisible, else a
  /// number that identifies its color and sigma.
  std::uint16_t appearance(const BrickRange& range) const;

 private:
  float sample_index(float value) const;
  float index(float value) const;  ///< index among the control points if there are any, else among the samples
};

/// Tolerance of the lookup table: for sigma, relative to sigma + 1 / length, where `length` is the path length of a ray; for a color
/// component, relative to the share of light absorbed on that path if less than all. The image then errs by less than kTableTolerance * 255
/// levels even if a whole volume has the value with the largest error. If few values lie in an interval, their share of the path is small
/// and so is their effect: sigma may err by kTableTolerance * kRareValueShare / share there, up to 16 times, colors up to 4 times
/// kTableTolerance.
inline constexpr double kTableTolerance = 1.0 / 1024, kRareValueShare = 0.02;

/// Builds the lookup table. `range`: range of the grid's values; `values`: representative sample of them (empty: any value may fill the
/// whole grid). `length`: diameter of the grid's domain, world units; irrelevant without extinctions.
TransferLut make_transfer_lut(const TransferTable& table, const BrickRange& range, double length, std::span<const float> values = {});

/// Builds the table of a factor by gradient magnitude, in the first component.
TransferLut make_gradient_factor_lut(const std::vector<std::array<double, 2>>& factors);

/// Returns the function at a value: piecewise linear, with the end values held.
double table_value(const TransferTable& table, double value, int channel);  ///< 0..2: r, g, b; 3: sigma

/// Returns the values of the function's points between lo and hi, and lo and hi; at a discontinuity also the value just before it. Rising.
std::vector<double> control_values_between(const TransferTable& table, double lo, double hi);

}  // namespace catena::render
