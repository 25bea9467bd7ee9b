/// How far apart a ray's samples are: the exact rays, plain and jittered, and the fast (pre-integrated) ones at every pixel.
#include <fmt/format.h>

#include "engine/app/tradeoff/measure/eye/eye.h"
#include "engine/app/tradeoff/measure/registry.h"
#include "render/quality/refinement.h"

namespace catena::app::tradeoff {

Result<std::vector<Curve>> measure_step(Subject& subject) {
  if (!subject.eye->rays) {
    subject.left_out.emplace_back("Step: nothing in the picture is sampled along rays: --quality makes no difference.");
    return std::vector<Curve>{};
  }
  Curve curve =
      eye_curve(subject, "step", "How far apart a ray's samples are",
                "Every pixel has a ray. Exact rays sample the values; fast ones integrate the transfer function between two "
                "samples beforehand, plain or with the light of smooth gradients; --quality error=E and balanced choose among those.");
  const bool shaded = !subject.eye->packet.volumes.empty() && subject.eye->packet.volumes.front().shade;
  std::vector<Tried> tried;
  for (const double step : {4.0, 2.0, 1.0, 0.5, 0.25, 0.125}) {
    if (subject.eye->fast) {
      tried.push_back({fmt::format("fast, step {:g}", step), "", "fast", render::fast_rung(step, 1, 0, -1)});
      if (shaded)
        tried.push_back({fmt::format("fast, smooth gradients, step {:g}", step), "", "fast, smooth gradients",
                         render::fast_rung(step, 1, 0, -1, true)});
    }
    if (step < 1.5 * subject.eye->truth_step) continue;
    tried.push_back({fmt::format("exact, step {:g}", step), fmt::format("--quality step={:g}", step), "exact", render::exact_rung(step)});
    render::RenderSettings jittered = render::exact_rung(step);
    jittered.jitter = true;
    if (step >= 1)
      tried.push_back({fmt::format("exact, jittered, step {:g}", step),
                       fmt::format("`--quality step={:g}` and `\"jitter\": true` at the top level of the scene", step), "exact, jittered",
                       jittered});
  }
  CATENA_CHECK(measure_settings(subject, tried, curve));
  return std::vector<Curve>{curve};
}

}  // namespace catena::app::tradeoff
