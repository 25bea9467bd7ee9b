/// What a ruler measures: the straight way between its ends, or the way along what its "along" names.
///   streamline   arc length on the link's curve, between its places nearest to the ends; on a closed line the shorter way round
///   isosurface   a shortest path on the level set (engine/geometry/geodesics)
///   mesh         a shortest path on the mesh (engine/geometry/geodesics)
/// Which of them a link is, its keys say. Of several the first streamline counts, or else the first surface. World units.
/// Frame thread, off the tick.
#pragma once
#include <string>

#include "engine/base/json.h"
#include "engine/scene/scene.h"

namespace catena::scene {

struct RulerMeasure {
  enum class PathKind { straight, streamline, isosurface, mesh } path_kind = PathKind::straight;
  std::vector<Vec3> points;  ///< at least two: to draw
  double length = 0;
  std::string note;  ///< why it is straight where "along" names something else; else empty
};

/// Of the widget's pose as it is; measured again only when an end, or what it is measured along, has moved.
Result<RulerMeasure> resolve_ruler(Scene& scene, Entity ruler);

/// As resolve_ruler measured it last; nullptr: it has not.
const RulerMeasure* find_ruler_measure(const Scene& scene, Entity ruler);

/// Between the places of the curve nearest to the ends.
RulerMeasure measure_along(const flow::CurvePtr& curve, const Vec3& from, const Vec3& to);

/// What of the scene a link of the chain lies on. Its keys say it, whatever its type: `seed` with `field` is a streamline, `level` with
/// `surface` or `field` a level of that field, `mesh` a mesh. A new constraint that has these keys is measured along, follows and is
/// followed like the others. Pure.
enum class LinkFeature { none, curve, level, mesh };

LinkFeature find_link_feature(const json::Node& link);
/// Which key names the field of the link's level: "surface", or else "field".
const char* level_field_key(const json::Node& link);
/// The name of that field; empty: the link lies on no level.
std::string level_field_name(const json::Node& link);

}  // namespace catena::scene
