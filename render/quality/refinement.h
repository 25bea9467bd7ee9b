// SPDX-License-Identifier: MIT
/// Choice of the next image's settings, so that moving images are on schedule and static ones become good. Pure logic: no device, no
/// window, no clock.
///   moving: the best of the quality levels whose expected time fits the budget
///   static: quarter -> half -> every pixel, then finished; any change starts over
/// Times are predicted from measured ones (TimeModel). Frame thread.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "render/raycast/render_settings.h"

namespace catena::render {

/// Properties of the scene that determine the quality levels.
struct QualityLevelOptions {
  bool can_draw_fast = true;  ///< Renderer::can_draw_fast
  /// Some volume is shaded.
  bool is_shaded = false;
  bool operator==(const QualityLevelOptions&) const = default;
};

/// Returns settings of the fast raycast: every `spacing`-th pixel at that step, refined where the expected interpolation error exceeds
/// `half` and `full` (1/255; < 0: nowhere); `smooth`: shaded by central differences. The larger the spacing, the sooner rays are
/// terminated.
RenderSettings fast_level(double step_voxels, std::uint32_t spacing, double half, double full, bool smooth = false);
/// Returns settings of the exact raycast at that step.
RenderSettings exact_level(double step_voxels);
/// Returns the same for reference images: rays end at a transmittance of 1e-4.
RenderSettings converged_level(double step_voxels);

/// Share of a ray's cost at step 1 that does not depend on the step: the path to the visible part.
inline constexpr double kFixedRayCost = 0.3;
/// Cost of a ray shaded by central differences, relative to one shaded by the gradient of the cell.
inline constexpr double kSmoothGradientCost = 1.65;

/// Returns the cost of rendering, relative to marching every pixel at step 1 unshaded by the fast raycast, as measured with a CPU driver:
/// for ordering and for initial guesses.
double relative_cost(const RenderSettings& settings, bool shaded);

/// Returns the settings from the cheapest to the best, in the order of their cost.
std::vector<RenderSettings> quality_levels(const QualityLevelOptions& kind);

/// Prediction of render times: expected(level) = unit cost(level) factor(level): the unit depends on the view and the machine, the factor
/// corrects the cost of a level. An image that took r times the expected time changes both by sqrt(r). The first image of a level includes
/// the creation of its pipelines: it counts only if it was faster than expected. A level that was never rendered has the factor of the
/// nearest measured one, of two the greater.
class TimeModel {
 public:
  TimeModel(std::vector<double> costs, double first_guess_ms);
  /// Updates the prediction with the measured time of an image of that level.
  void add_measurement(std::size_t level, double ms);
  /// Returns the expected time of an image of that level.
  double expected_ms(std::size_t level) const { return unit_ms_ * levels_[level].cost * correction_factor(level); }

 private:
  double correction_factor(std::size_t level) const;

  struct Level {
    double cost = 0, factor = 1;
    bool is_measured = false;
  };
  std::vector<Level> levels_;
  double unit_ms_;
};

/// Resolution reduction where even the cheapest image at every pixel exceeds the budget: returns n for every n-th pixel in each direction,
/// a power of two from 1 to kMaxPixelScale. `before`: previous choice; the resolution rises only with some headroom, to avoid oscillation.
inline constexpr std::uint32_t kMaxPixelScale = 4;
std::uint32_t choose_pixel_scale(double expected_ms, std::uint32_t before, double budget_ms);

/// Next image to render.
struct RefinementStep {
  RenderSettings settings;
  double expected_ms = 0;
  bool is_final = false;  ///< nothing better follows while nothing moves
};

/// Progressive refinement within a time budget, milliseconds per image.
class Refinement {
 public:
  Refinement(double budget_ms, const QualityLevelOptions& kind);
  /// Changes the budget, for the next image on.
  void set_budget(double ms) { budget_ms_ = ms; }
  /// Returns the image to render; nullopt if the last one was final and nothing has `changed` (camera, scene, size) since then.
  std::optional<RefinementStep> next(bool changed);
  /// Returns the expected time of next(false); nullopt if that returns nullopt.
  std::optional<double> expected_next_ms() const;
  /// Returns the expected time of an image of the lowest level.
  double expected_coarsest_ms() const { return times_.expected_ms(0); }
  /// Reports the time of the image returned by next().
  void record_render_ms(double ms);

 private:
  std::size_t best_within_budget() const;
  /// Returns the next better stop on the way to the last level, or the last level itself.
  std::size_t next_stop(std::size_t level) const;
  RefinementStep make_step(std::size_t level);

  double budget_ms_;
  std::vector<RenderSettings> levels_;
  std::vector<std::size_t> stops_;  ///< levels that a static image goes through
  TimeModel times_;
  std::size_t moving_level_ = 0;           ///< level of moving images
  std::optional<std::size_t> last_level_;  ///< level rendered last
  bool is_pending_ = false;                ///< an image was requested and its time is not yet reported
};

}  // namespace catena::render
