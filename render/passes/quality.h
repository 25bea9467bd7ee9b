/// Settings for a stated error or time, from measured residuals. The error of a setting is measured on this very picture: the pixels
/// of a sparse lattice (every 13th each way, prime to the lattices that are interpolated) against converged rays through them.
///   RMSE: 8-bit RGB over the background on black, all pixels, in 1/255; its statistical error is a few per cent
/// error=E: every ray step whose rays alone stay below E (tried on the lattice: cheap) with every plan of interpolation, in the order
/// of their expected cost; the first whose finished picture stays below E. time=MS: the least error among settings that were drawn within
/// MS. What the fast raycast cannot draw or cannot reach is left to the exact one. Frame thread.
#pragma once
#include <string>

#include "render/passes/renderer.h"

namespace catena::render {

struct QualityGoal {
  enum class Kind { error, time } kind = Kind::error;
  double value = 0;  ///< 1/255, or ms
};

struct QualityChoice {
  RenderSettings settings;
  double estimated_rmse = 0;  ///< 1/255
  bool reached = true;        ///< false: nothing was good (or quick) enough; the nearest was taken
  int pictures = 0;           ///< drawn on the way
};

/// Stereo: the first eye's picture is measured; the eyes share a time.
/// Draws several pictures; the caller draws the chosen one.
Result<QualityChoice> choose_quality(Renderer& renderer, const FramePacket& packet, const QualityGoal& goal);

/// The error of the picture that `settings` draw, measured the same way.
Result<double> estimate_rmse(Renderer& renderer, const FramePacket& packet, const RenderSettings& settings);

/// "step 3, every 4th pixel, refined to every 2nd above 0.5"
std::string describe(const RenderSettings& settings);

}  // namespace catena::render
