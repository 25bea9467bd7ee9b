// SPDX-License-Identifier: MIT
/// Flattening of a streamline set to colored polylines. Lines are traced in blocks and flattened on all cores; for a large set only the
/// polylines are kept. Frame thread.
#pragma once
#include <cstdint>
#include <vector>

#include "engine/scene/scene.h"
#include "render/extract/extract_internal.h"
#include "render/extract/flatten.h"

namespace catena::render {

/// Data cached beside a StreamlineSet.
struct FlattenedStreamlines {
  std::uint64_t version = 0;  ///< version of the lines (scene::lines_version)
  double radius = 0;
  std::vector<TubeItem> tubes;
  std::vector<std::vector<double>> arc_lengths;  ///< one per tube and point; only for a set with a pulse
  std::vector<ArrowItem> arrows;
  ColorTable colors;  ///< table of "color_by"
};

/// Number of points per line of a set above which the tolerance is increased from 2 % of the radius to at most 20 %. A set of few lines
/// counts as `kMinLineCount`. The tolerance is at least 1e-6 of the domain's length.
inline constexpr double kPointsPerLine = 150, kMinLineCount = 10000;

/// Flattens the set. An Error gives the scene file's name and line: errors of the tracer, arrows too close together, more memory than
/// permitted.
Result<FlattenedStreamlines> flatten_streamlines(scene::Scene& scene, scene::Entity set);

/// Returns the diagonal of a field's bounding box.
double domain_diagonal(const field::Field& field);

}  // namespace catena::render
