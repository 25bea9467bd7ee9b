// SPDX-License-Identifier: MIT
/// Storage of the grids on the device: 16 or 32 bits per texel, dense or as bricks.
#include <fmt/format.h>

#include "engine/app/tuning/measure/registry.h"
#include "engine/app/tuning/measure/rendering/render_workload.h"
#include "render/quality/refinement.h"

namespace catena::app::tuning {

Result<std::vector<Curve>> measure_texel_format(Workload& subject) {
  if (!draws_grids(subject.rendering->packet)) {
    subject.skipped.emplace_back("Texels: no grid is rendered.");
    return std::vector<Curve>{};
  }
  Curve curve =
      make_rendering_curve(subject, "texels", "Texel format of the grids",
                           "Exact rays with steps of a quarter of a voxel, so that only the storage of a voxel differs: in 16 bits (half "
                           "float) or 32 bits, in one block or in bricks without the empty ones. No option selects the format: volumes use "
                           "16 bits, surfaces and slices 32, --quality reference 32, the tuning the cheaper format for its target.");
  curve.bytes_name = "bytes on the device";
  curve.cost = CostKind::bytes;
  std::vector<CandidateSetting> tried;
  using render::GridLayout, render::TexelFormat;
  for (const auto& [format, bits] : {std::pair{TexelFormat::r16f, "16 bits"}, {TexelFormat::r32f, "32 bits"}})
    for (const auto& [layout, word] : {std::pair{GridLayout::dense, "whole"}, {GridLayout::atlas, "bricks"}}) {
      render::RenderSettings s = render::exact_level(0.25);
      s.texel_format = format;
      s.layout = layout;
      tried.push_back({fmt::format("{}, {}", bits, word), "", word, s});
    }
  CATENA_CHECK(measure_candidates(subject, tried, curve));
  return std::vector<Curve>{curve};
}

}  // namespace catena::app::tuning
