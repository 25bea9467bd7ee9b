// SPDX-License-Identifier: MIT
/// Sampling distance along a ray: the exact rays, plain and jittered, and the fast (pre-integrated) ones at every pixel.
#include <fmt/format.h>

#include "engine/app/tuning/measure/registry.h"
#include "engine/app/tuning/measure/rendering/render_workload.h"
#include "render/quality/refinement.h"

namespace catena::app::tuning {

Result<std::vector<Curve>> measure_ray_step(Workload& subject) {
  if (!subject.rendering->has_raycast) {
    subject.skipped.emplace_back("Step: nothing in the image is sampled along rays, so that --quality has no effect.");
    return std::vector<Curve>{};
  }
  Curve curve = make_rendering_curve(
      subject, "step", "Step along the rays",
      "Every pixel has a ray. Exact rays sample the values; fast rays use the transfer function integrated between two "
      "samples beforehand, optionally with smooth gradients for shading; --quality error=E and balanced choose among these.");
  const bool shaded = !subject.rendering->packet.volumes.empty() && subject.rendering->packet.volumes.front().is_shaded;
  std::vector<CandidateSetting> tried;
  for (const double step : {4.0, 2.0, 1.0, 0.5, 0.25, 0.125}) {
    if (subject.rendering->supports_fast_raycast) {
      tried.push_back({fmt::format("fast, step {:g}", step), "", "fast", render::fast_level(step, 1, 0, -1)});
      if (shaded)
        tried.push_back({fmt::format("fast, smooth gradients, step {:g}", step), "", "fast, smooth gradients",
                         render::fast_level(step, 1, 0, -1, true)});
    }
    if (step < 1.5 * subject.rendering->reference_step) continue;
    tried.push_back({fmt::format("exact, step {:g}", step), fmt::format("--quality step={:g}", step), "exact", render::exact_level(step)});
    render::RenderSettings jittered = render::exact_level(step);
    jittered.jitter = true;
    if (step >= 1)
      tried.push_back({fmt::format("exact, jittered, step {:g}", step),
                       fmt::format("`--quality step={:g}` and `\"jitter\": true` at the top level of the scene", step), "exact, jittered",
                       jittered});
  }
  CATENA_CHECK(measure_candidates(subject, tried, curve));
  return std::vector<Curve>{curve};
}

}  // namespace catena::app::tuning
