/// What to draw next so that a picture comes in time and becomes good while nothing moves. Pure logic: no device, no window, no clock.
///   moving: the best rung of a ladder of settings whose expected time fits the budget
///   still:  quarter -> half -> every pixel, then finished; anything that moves starts anew
/// Times are expected from measured ones (TimeModel). Frame thread.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "render/raycast/render_settings.h"

namespace catena::render {

/// What is known of what will be drawn.
struct QualityLevelOptions {
  bool can_draw_fast = true;  ///< Renderer::can_draw_fast
  bool is_shaded = false;
  bool operator==(const QualityLevelOptions&) const = default;
};

/// Every `spacing`-th pixel at that step by the fast raycast, refined where interpolation errs by more than `half` and `full` (1/255; < 0:
/// nowhere); `smooth`: shaded by central differences. The farther the rays are apart, the sooner they end.
RenderSettings fast_level(double step_voxels, std::uint32_t spacing, double half, double full, bool smooth = false);
/// By the exact raycast.
RenderSettings exact_level(double step_voxels);
/// The same for what others are measured against: rays end only where a ten-thousandth gets through.
RenderSettings converged_level(double step_voxels);

/// Of what a ray costs at step 1: its way to what is seen, whatever the step.
inline constexpr double kFixedRayCost = 0.3;
/// Of a ray whose light goes by central differences, by one whose light goes by the gradient of the cell.
inline constexpr double kSmoothGradientCost = 1.65;

/// Of drawing, in units of marching every pixel at step 1 unshaded by the fast raycast, as a CPU driver has it: good for an order and for
/// first guesses.
double relative_cost(const RenderSettings& settings, bool shaded);

/// From the cheapest settings to the best, in the order of their cost.
std::vector<RenderSettings> quality_levels(const QualityLevelOptions& kind);

/// expected(rung) = unit cost(rung) factor(rung): the unit follows the view and the machine, the factor what a rung's cost got wrong.
/// A picture that took r times what was expected moves both by sqrt(r). A rung's first picture pays for its pipelines too: it
/// counts only if it was quicker than expected. A rung that was never drawn has the factor of the nearest that was, of two the greater.
class TimeModel {
 public:
  TimeModel(std::vector<double> costs, double first_guess_ms);
  void add_measurement(std::size_t rung, double ms);
  double expected_ms(std::size_t rung) const { return unit_ms_ * levels_[rung].cost * correction_factor(rung); }

 private:
  double correction_factor(std::size_t rung) const;

  struct Level {
    double cost = 0, factor = 1;
    bool is_measured = false;
  };
  std::vector<Level> levels_;
  double unit_ms_;
};

/// Where even the cheapest picture of every pixel takes longer than the budget: every so many pixels each way, 1 to kMaxPixelScale.
/// `before`: the last choice; more pixels again only with some room, or their number would come and go.
inline constexpr std::uint32_t kMaxPixelScale = 4;
std::uint32_t choose_pixel_scale(double expected_ms, std::uint32_t before, double budget_ms);

struct RefinementStep {
  RenderSettings settings;
  double expected_ms = 0;
  bool is_final = false;  ///< nothing better comes while nothing moves
};

class Refinement {
 public:
  Refinement(double budget_ms, const QualityLevelOptions& kind);
  /// From the next picture on.
  void set_budget(double ms) { budget_ms_ = ms; }
  /// The picture to draw now; nothing where the last one is finished and nothing has `changed` (camera, scene, size) since.
  std::optional<RefinementStep> next(bool changed);
  /// What next(false) would take; nothing where it has nothing.
  std::optional<double> expected_next_ms() const;
  /// What the coarsest picture would take.
  double expected_coarsest_ms() const { return times_.expected_ms(0); }
  /// What that picture took.
  void record_render_ms(double ms);

 private:
  std::size_t best_within_budget() const;
  /// The next better stop on the way to the last rung, or the last rung itself.
  std::size_t next_stop(std::size_t rung) const;
  RefinementStep make_step(std::size_t rung);

  double budget_ms_;
  std::vector<RenderSettings> levels_;
  std::vector<std::size_t> stops_;  ///< rungs that a still picture goes through
  TimeModel times_;
  std::size_t moving_level_ = 0;           ///< the rung of moving pictures
  std::optional<std::size_t> last_level_;  ///< drawn last
  bool is_pending_ = false;                ///< a picture was asked for and its time has not come
};

}  // namespace catena::render
