/// A transfer function as the shader reads it: 4096 samples (r, g, b, sigma) over the values that it and the grid share, read
/// with linear interpolation; beyond its ends the end values hold. Points of the table are kept to a sample's width.
#pragma once
#include <cstdint>
#include <glm/vec4.hpp>
#include <vector>

#include "render/frame/frame_packet.h"
#include "render/mirror/grid_mirror.h"

namespace catena::render {

struct TransferLut {
  std::vector<glm::vec4> entries;
  float lo = 0, per_value = 0;                ///< index = (value - lo) * per_value, clamped to 0..last
  std::vector<std::uint32_t> visible_before;  ///< how many entries before i have sigma > 0
  std::vector<std::uint16_t> run;             ///< equal for neighbours that are equal throughout

  std::uint32_t last() const { return std::uint32_t(entries.size()) - 1; }
  /// Whether some value of the range has sigma > 0.
  bool visible(const BrickRange& range) const;
  /// What make_leap_map asks: 0 where colour or sigma vary over the range, 1 where all of it is invisible, else a number of its
  /// colour and sigma.
  std::uint16_t look(const BrickRange& range) const;

 private:
  float index(float value) const;
};

/// `range`: of the grid's values.
TransferLut make_transfer_lut(const TransferTable& table, const BrickRange& range);

/// 1024 samples of a factor over its points, in the first component. index = (gradient - lo) * per_gradient, clamped.
struct FactorLut {
  std::vector<glm::vec4> entries;
  float lo = 0, per_gradient = 0;
};
FactorLut make_factor_lut(const std::vector<std::array<double, 2>>& factors);

/// Piecewise linear with held ends; points in rising order of value. `channel` of 1, 2, ..
double table_value(const TransferTable& table, double value, int channel);  ///< 0..2: r, g, b; 3: sigma

}  // namespace catena::render
