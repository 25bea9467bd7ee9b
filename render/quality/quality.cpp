// SPDX-License-Identifier: MIT
#include "render/quality/quality.h"

#include <fmt/format.h>

#include "render/quality/refinement.h"
#include "render/quality/settings_search.h"

namespace catena::render {
namespace {

constexpr double kReferenceProgress = 0.25;  // progress when the reference is rendered

}  // namespace

std::size_t best_within(const std::vector<SettingsTrial>& tried, double ms) {
  CATENA_ASSERT(!tried.empty());
  std::size_t best = 0;
  const auto better = [ms](const SettingsTrial& a, const SettingsTrial& b) {
    if ((a.ms <= ms) != (b.ms <= ms)) return a.ms <= ms;
    return a.ms <= ms ? a.rmse < b.rmse : a.ms < b.ms;
  };
  for (std::size_t i = 1; i < tried.size(); ++i)
    if (better(tried[i], tried[best])) best = i;
  return best;
}

Result<QualityChoice> choose_quality(Renderer& renderer, const FramePacket& packet, const QualityGoal& goal, const SearchProgress& progress,
                                     const RenderTimeFn& timer) {
  if (packet.view_count() > 0) {
    const double share = goal.kind == QualityGoal::Kind::time ? double(packet.view_count()) : 1;
    return choose_quality(renderer, packet.first_view(), {goal.kind, goal.value / share, goal.single_image}, progress, timer);
  }
  if (!uses_raycast(packet)) return QualityChoice{balanced_settings(), 0, 0, true, 0};
  const bool has_error = goal.kind == QualityGoal::Kind::error, once = has_error && goal.single_image;
  ErrorEstimator estimator(renderer, packet, once ? EstimatorSize::reduced : EstimatorSize::full);
  CATENA_CHECK(estimator.begin(has_error ? goal.value : 0, has_error && !once));
  const SearchProgress report = [&progress](double done) {
    if (progress) progress(kReferenceProgress + (1 - kReferenceProgress) * done);
  };
  report(0);
  CATENA_TRY(QualityChoice chosen, once        ? find_settings_for_single_image(estimator, goal.value)
                                   : has_error ? find_settings_for_error(estimator, goal.value, report)
                                               : find_settings_for_time(estimator, goal.value, report, timer));
  chosen.is_empty = estimator.empty();
  return chosen;
}

Result<double> estimate_rmse(Renderer& renderer, const FramePacket& packet, const RenderSettings& settings) {
  if (packet.view_count() > 0) return estimate_rmse(renderer, packet.first_view(), settings);
  if (!uses_raycast(packet)) return 0.0;
  ErrorEstimator estimator(renderer, packet);
  // for coarse settings a reference with a longer step suffices
  CATENA_CHECK(estimator.begin(settings.fast && settings.fast->step_voxels >= 1 ? kCoarseErrorGoal : 0));
  CATENA_TRY(const ErrorEstimate error, estimator.estimate_image(settings));
  return error.upper_bound;
}

Result<double> half_step_difference(Renderer& renderer, const FramePacket& packet, const RenderSettings& settings) {
  if (packet.view_count() > 0) return half_step_difference(renderer, packet.first_view(), settings);
  if (!uses_raycast(packet)) return 0.0;
  return ErrorEstimator(renderer, packet).half_step_difference(settings);
}

Result<MeasuredSettings> measure_rmse(Renderer& renderer, const FramePacket& packet, const std::vector<RenderSettings>& settings,
                                      const std::function<bool(double last)>& should_continue) {
  if (packet.view_count() > 0) return measure_rmse(renderer, packet.first_view(), settings, should_continue);
  MeasuredSettings all;
  ErrorEstimator estimator(renderer, packet);
  CATENA_CHECK(estimator.begin(kMinReportedRmse));
  all.reference_rmse = estimator.reference_error();
  for (const RenderSettings& next : settings) {
    if (!should_continue(all.rmse.empty() ? 0 : all.rmse.back())) break;
    // an exact image consists of rays alone
    CATENA_TRY(const ErrorEstimate error, next.fast ? estimator.estimate_image(next) : estimator.estimate_rays(next));
    all.rmse.push_back(error.rmse);
  }
  return all;
}

Result<double> measure_single_rmse(Renderer& renderer, const FramePacket& packet, const RenderSettings& settings) {
  if (!uses_raycast(packet)) return 0.0;
  CATENA_TRY(const MeasuredSettings one, measure_rmse(renderer, packet, {settings}, [](double) { return true; }));
  return one.rmse.front();
}

std::string describe(const RenderSettings& settings) {
  const char* bits = settings.texel_format == TexelFormat::automatic ? ""
                     : settings.texel_format == TexelFormat::r16f    ? ", 16 bits a voxel"
                                                                     : ", 32 bits a voxel";
  if (!settings.fast) return fmt::format("exact, step {:g}{}", settings.step_voxels, bits);
  const FastSettings& f = *settings.fast;
  std::string text = fmt::format("fast, step {:g}", f.step_voxels);
  if (f.smooth_gradients) text += ", smooth gradients";
  if (f.spacing > 1) text += fmt::format(", every {} pixel", f.spacing == 2 ? "2nd" : "4th");
  if (f.spacing == 4 && f.refine_half_255 >= 0) text += fmt::format(", every 2nd above {:.2g}", f.refine_half_255);
  if (f.spacing > 1 && f.refine_full_255 >= 0) text += fmt::format(", every pixel above {:.2g}", f.refine_full_255);
  return text;
}

}  // namespace catena::render
