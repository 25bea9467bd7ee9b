// SPDX-License-Identifier: MIT
/// Spacing of the ray grid: a ray at every pixel, every 2nd or every 4th in each direction, and its refinement.
#include <fmt/format.h>

#include "engine/app/tuning/measure/registry.h"
#include "engine/app/tuning/measure/rendering/render_workload.h"
#include "render/quality/refinement.h"

namespace catena::app::tuning {

Result<std::vector<Curve>> measure_ray_grid(Workload& subject) {
  if (!subject.rendering->supports_fast_raycast) {
    subject.skipped.emplace_back(
        "Ray grid and refinement: only the fast rays of a single volume use them, and this image does not use fast rays.");
    return std::vector<Curve>{};
  }
  Curve curve = make_rendering_curve(
      subject, "lattice", "Spacing of the rays",
      "Fast rays with steps of one voxel on a regular subset of the pixels; between them the image is interpolated, and refined "
      "where the expected error exceeds the threshold.");
  const bool smooth = subject.rendering->packet.volumes.front().is_shaded;
  std::vector<CandidateSetting> tried{{"every 4th pixel", "", "every 4th", render::fast_level(1, 4, -1, -1, smooth)}};
  for (const double half : {12.0, 6.0, 3.0, 1.5})
    tried.push_back({fmt::format("every 4th, 2nd above {:g}/255", half), "", "every 4th", render::fast_level(1, 4, half, -1, smooth)});
  tried.push_back({"every 2nd pixel", "", "every 2nd", render::fast_level(1, 2, 0, -1, smooth)});
  for (const double full : {12.0, 6.0, 3.0, 1.5})
    tried.push_back({fmt::format("every 2nd, all above {:g}/255", full), "", "every 2nd", render::fast_level(1, 2, 0, full, smooth)});
  tried.push_back({"every pixel", "", "every pixel", render::fast_level(1, 1, 0, -1, smooth)});
  CATENA_CHECK(measure_candidates(subject, tried, curve));
  return std::vector<Curve>{curve};
}

}  // namespace catena::app::tuning
