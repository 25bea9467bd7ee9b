// SPDX-License-Identifier: MIT
/// Search for render settings by error or by time, from measured errors. The error of a setting is measured on the image itself: at the
/// pixels of a sparse sample grid (every 13th pixel in each direction, or more, until about 6000 of them are covered) against converged
/// rays.
///   RMSE: 8-bit RGB over the background (transparent: over black or white, the larger), in 1/255, of the covered pixels: where the alpha
///         of the image or of the reference, without background, is at least 1/255 (image_error.h). The estimate is an upper bound, three
///         standard deviations above the sample mean, and includes the remaining error of the reference itself.
/// error=E: every ray step, with both kinds of gradients, whose rays alone stay below E and temporally stable (tested on the sample grid,
/// which is cheap) is combined with every interpolation plan, in the order of expected cost. The result is the cheapest, by the number of
/// marched rays, whose finished image stays below E, preserves thin features, and whose error changes by at most half of E, or of the
/// change of the image itself, while the camera turns by 0.2 degrees. time=MS: the quality levels of refinement.h from the cheapest on,
/// until an image takes longer than MS; the smallest error among those that did not. If that leaves much of the time unused, rays at every
/// pixel with longer steps are tried, too. More time therefore never increases the error. What the fast raycast does not support or cannot
/// reach is left to the exact one. Frame thread.
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "render/passes/renderer.h"
#include "render/quality/render_timer.h"

namespace catena::render {

/// Goal of the search.
struct QualityGoal {
  enum class Kind { error, time } kind = Kind::error;
  double value = 0;           ///< 1/255, or milliseconds
  bool single_image = false;  ///< error goals only: the image is rendered only once (single_image_search.h)
};

/// Result of the search.
struct QualityChoice {
  RenderSettings settings;
  double estimated_rmse = 0;  ///< upper bound, 1/255
  /// time goals only: expected time of the image: the shorter of two, from processor time if a CPU driver renders.
  double expected_ms = 0;
  bool goal_reached = true;  ///< false: no settings met the goal; the closest ones were chosen
  int images_rendered = 0;   ///< number of images rendered during the search
  bool is_empty = false;     ///< no item of the scene is visible in the image
};

/// Returns the milliseconds of rendering a packet with these settings after warm-up; replaceable in tests.
using RenderTimeFn = std::function<Result<double>(const RenderSettings&)>;

/// Called from time to time with the completed fraction of the search, 0 to 1; the search may end before it reaches 1.
using SearchProgress = std::function<void(double done)>;

/// Chooses settings for the goal. Renders several images; the caller renders the final one. Stereo: the image of the first eye is measured;
/// a time goal applies to all eyes together. An Error is one of the renderer's.
Result<QualityChoice> choose_quality(Renderer& renderer, const FramePacket& packet, const QualityGoal& goal,
                                     const SearchProgress& progress = nullptr, const RenderTimeFn& timer = nullptr);

/// Time and error of settings that were tried.
struct SettingsTrial {
  double ms = 0, rmse = 0;
};
/// Returns the index of the trial with the smallest error among those that took at most `ms`; if there is none, the fastest.
std::size_t best_within(const std::vector<SettingsTrial>& tried, double ms);

/// Returns the error of the image rendered with `settings`, measured in the same way.
Result<double> estimate_rmse(Renderer& renderer, const FramePacket& packet, const RenderSettings& settings);

/// Returns the RMSE between exact rays of this step and of half the step on about 4000 pixels of the image, 1/255: about the error of the
/// rays. Cheap compared with rendering the image.
Result<double> half_step_difference(Renderer& renderer, const FramePacket& packet, const RenderSettings& settings);

/// Errors below this are caused by rounding to 8 bits alone, 1/255.
inline constexpr double kMinReportedRmse = 0.4;

/// Errors of several settings for one image, all measured against the same reference.
struct MeasuredSettings {
  std::vector<double> rmse;   ///< one per setting: the estimate itself, not its upper bound
  double reference_rmse = 0;  ///< remaining error of the reference
};
/// Measures the settings one by one. `should_continue` is called before each of them with the error of the previous one (0 for the first);
/// if it returns false, the remaining settings are left out.
Result<MeasuredSettings> measure_rmse(Renderer& renderer, const FramePacket& packet, const std::vector<RenderSettings>& settings,
                                      const std::function<bool(double last)>& should_continue);

/// Returns the error of a single setting.
Result<double> measure_single_rmse(Renderer& renderer, const FramePacket& packet, const RenderSettings& settings);

/// Returns a description such as "fast, step 3, every 4th pixel, every 2nd above 0.5" or "exact, step 1, 32 bits a voxel" (if set).
std::string describe(const RenderSettings& settings);

}  // namespace catena::render
