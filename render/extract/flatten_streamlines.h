/// A set of streamlines as polylines with colours. Lines are traced block by block and flattened on all cores; of a large set only the
/// polylines stay. Frame thread.
#pragma once
#include <cstdint>
#include <vector>

#include "engine/scene/scene.h"
#include "render/extract/extract_internal.h"
#include "render/extract/flatten.h"

namespace catena::render {

/// What is kept beside a StreamlineSet.
struct FlattenedStreamlines {
  std::uint64_t version = 0;  ///< of the lines (scene::lines_version)
  double radius = 0;
  std::vector<TubeItem> tubes;
  std::vector<std::vector<double>> arc_lengths;  ///< by point, of a set with a pulse
  std::vector<ArrowItem> arrows;
  ColorTable colors;  ///< of "color_by"
};

/// Points of all tubes of a set, by the line, from which on errors are allowed to grow from 2 % of the radius up to 20 %. A set of few
/// lines counts as `kFewLines`. No error needs to be less than 1e-6 of the domain's length.
inline constexpr double kPointsPerLine = 150, kFewLines = 10000;

/// Errors carry the scene's file and line: those of the tracer, arrows too close, more memory than is allowed.
Result<FlattenedStreamlines> flatten_streamlines(scene::Scene& scene, scene::Entity set);

/// The diagonal of a field's box.
double domain_diagonal(const field::Field& field);

}  // namespace catena::render
