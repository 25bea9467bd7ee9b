/// Transfer functions as tables for shaders: of values for the exact raycast, of pairs of codes for the fast one. Plain CPU code.
#pragma once
#include <array>
#include <cstdint>
#include <glm/vec4.hpp>
#include <vector>

#include "render/frame/frame_packet.h"
#include "render/mirror/grid_mirror.h"
#include "render/mirror/voxel_block.h"

namespace catena::render {

/// A transfer function as the shader reads it: of labels one entry for each whole number, where they are not too many; else 4096 samples
/// (r, g, b, sigma) over the values that it and the grid share, read with linear interpolation; beyond its ends the end values hold. Points
/// of the table are kept to a sample's width. Where samples would miss what is narrower (is_sampled), the entries are the function's own
/// points, and exact.
struct TransferLut {
  std::vector<glm::vec4> entries;
  std::vector<float> values;                  ///< of the entries, rising; empty: they are evenly spaced
  float lo = 0, per_value = 0;                ///< index = (value - lo) * per_value, clamped to 0..last; per_value < 0: by `values`
  std::vector<std::uint32_t> visible_before;  ///< how many entries before i have sigma > 0
  std::vector<std::uint16_t> run;             ///< equal for neighbours that are equal throughout

  /// What the shader gets: the entries, then their own values, four in a word.
  std::vector<glm::vec4> words() const;
  bool uneven() const { return !values.empty(); }
  std::uint32_t last() const { return std::uint32_t(entries.size()) - 1; }
  /// Whether some value of the range has sigma > 0.
  bool visible(const BrickRange& range) const;
  /// What make_leap_map asks: 0 where colour or sigma vary over the range, 1 where all of it is invisible, else a number of its
  /// colour and sigma.
  std::uint16_t look(const BrickRange& range) const;

 private:
  float index(float value) const;
};

/// Whether even samples, so many from lo to hi and read with linear interpolation, take every peak and every gap of the function: near each
/// of its points, a sample's width either side, they come within a tenth of what it is there and at the points beside.
bool is_sampled(const TransferTable& table, double lo, double hi, std::size_t samples);

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

/// Where the picture depends on the value: the transfer function is one colour and density (or nothing) below and above.
/// Within `values`. `shaded`: what is visible depends on the gradient too, so that only what is invisible
/// is left out, and no two codes look alike unless they are.
ValueInterval active_interval(const TransferTable& table, const ValueInterval& values, bool shaded);

/// A transfer function, integrated beforehand over pairs of codes of a packed volume (a at one end of a segment, b at the other):
///   sigma(a, b) = mean over values from a to b of sigma(v)      colour(a, b) = mean of sigma(v) colour(v) / sigma(a, b)
/// so that a segment of length L has the optical depth sigma L: the table does not depend on the step. Engel et al. 2001, without
/// the attenuation within a segment. 256 x 256 entries: sigma as float bits | red 11 bits, green 11, blue 10.
struct PreintegratedTable {
  std::vector<std::array<std::uint32_t, 2>> entries;  ///< a + 256 b
  CodeLooks looks;
  double greatest_sigma = 0;
};

/// Whether that takes all that there is in the function where codes lie from one end to the other of `active`.
bool is_packed_whole(const TransferTable& table, const ValueInterval& active);
/// `lo`, `per_code`: of the packed volume.
PreintegratedTable make_preintegrated(const TransferTable& table, double lo, double per_code, bool shaded);

}  // namespace catena::render
