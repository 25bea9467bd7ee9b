/// Settings for a stated error or time, from measured residuals. The error of a setting is measured on this very picture: the pixels
/// of a sparse lattice (every 13th each way, or more, until about 6000 of them are covered) against converged rays through them.
///   RMSE: 8-bit RGB over the background (of a transparent one: over black or white, the larger), in 1/255, of the covered pixels: where
///   the picture's or the converged one's alpha, without a background, is at least 1/255 (measure.h). The estimate is three standard
///   deviations of the lattice's mean above it, and counts what is left of the converged rays' own error.
/// error=E: every ray step, lit by either gradient, whose rays alone stay below E and steady (tried on the lattice: cheap) with every plan
/// of interpolation, in the order of their expected cost; the cheapest, by the rays that it marches, whose finished picture stays below E,
/// keeps what is thin, and whose error changes by at most half of E, or of what the picture itself changes by, while the camera turns by
/// 0.2 degrees. time=MS: the ladder of refinement.h from the cheapest on, until a picture takes longer than MS; the least error among those
/// that did not; where that leaves much of it unused, every pixel's rays of longer steps, too. More time therefore never makes the error
/// worse. What the fast raycast cannot draw or cannot reach is left to the exact one. Frame thread.
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "render/passes/renderer.h"
#include "render/quality/render_timer.h"

namespace catena::render {

struct QualityGoal {
  enum class Kind { error, time } kind = Kind::error;
  double value = 0;           ///< 1/255, or ms
  bool single_image = false;  ///< of an error: one picture is drawn, once (one_picture.h)
};

struct QualityChoice {
  RenderSettings settings;
  double estimated_rmse = 0;  ///< 1/255
  double expected_ms = 0;     ///< time=MS: what the picture takes: the quicker of two, by what the processor's cores do where they draw
  bool goal_reached = true;   ///< false: nothing was good (or quick) enough; the nearest was taken
  int images_rendered = 0;    ///< drawn on the way
  bool is_empty = false;      ///< nothing of the scene is in the picture
};

/// The milliseconds of drawing a packet with these settings, once they are warm; the tests put their own in its place.
using RenderTimeFn = std::function<Result<double>(const RenderSettings&)>;

/// Told from time to time how much of the search is done, 0 to 1; it may end before.
using SearchProgress = std::function<void(double done)>;

/// Stereo: the first eye's picture is measured; the eyes share a time.
/// Draws several pictures; the caller draws the chosen one.
Result<QualityChoice> choose_quality(Renderer& renderer, const FramePacket& packet, const QualityGoal& goal,
                                     const SearchProgress& progress = nullptr, const RenderTimeFn& timer = nullptr);

/// One setting that was tried.
struct SettingsTrial {
  double ms = 0, rmse = 0;
};
/// The least error among those that took at most `ms`; where none did, the quickest.
std::size_t best_within(const std::vector<SettingsTrial>& tried, double ms);

/// The error of the picture that `settings` draw, measured the same way.
Result<double> estimate_rmse(Renderer& renderer, const FramePacket& packet, const RenderSettings& settings);

/// What half the step of exact rays changes on about 4000 pixels of the picture, 1/255: about as much they are off. Cheap beside the
/// picture.
Result<double> half_step_difference(Renderer& renderer, const FramePacket& packet, const RenderSettings& settings);

/// Errors below it are what rounding to 8 bits makes of nothing, 1/255.
inline constexpr double kMinReportedRmse = 0.4;

/// Several settings of one picture, measured the same way against one converged picture.
struct MeasuredSettings {
  std::vector<double> rmse;   ///< one a setting, as it was found: not the estimate above it
  double reference_rmse = 0;  ///< what is left of the error of the converged picture itself
};
/// `advance` is asked before each setting with the error of the one before (of the first with 0); false: the rest is left out.
Result<MeasuredSettings> measure_rmse(Renderer& renderer, const FramePacket& packet, const std::vector<RenderSettings>& settings,
                                      const std::function<bool(double last)>& go_on);

/// The same of one.
Result<double> measure_single_rmse(Renderer& renderer, const FramePacket& packet, const RenderSettings& settings);

/// "fast, step 3, every 4th pixel, every 2nd above 0.5"; "exact, step 1, 32 bits a voxel" where that is stated.
std::string describe(const RenderSettings& settings);

}  // namespace catena::render
