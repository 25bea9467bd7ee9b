// SPDX-License-Identifier: MIT
/// Length measured by a ruler widget: the straight distance between its ends, or the length along a link that its "along" names.
///   streamline   arc length on the link's curve between the points nearest to the ends; on a closed curve the shorter way
///   isosurface   a shortest path on the level set (engine/geometry/geodesics)
///   mesh         a shortest path on the mesh (engine/geometry/geodesics)
/// The link's keys determine its kind. Of several links the first streamline is used, else the first surface. World units.
/// Frame thread, off the tick.
#pragma once
#include <string>

#include "engine/base/json.h"
#include "engine/scene/scene.h"

namespace catena::scene {

/// Result of a measurement.
struct RulerMeasure {
  enum class PathKind { straight, streamline, isosurface, mesh } path_kind = PathKind::straight;
  std::vector<Vec3> points;  ///< The measured path, at least two points, for rendering
  double length = 0;         ///< World units
  std::string note;          ///< Reason for a straight path although "along" names links, not an error; empty: no such case
};

/// Measures at the widget's current pose. Cached: measured only if an end, or the object it is measured along, has changed.
Result<RulerMeasure> resolve_ruler(Scene& scene, Entity ruler);

/// Returns the last result of resolve_ruler; nullptr: not measured yet.
const RulerMeasure* find_ruler_measure(const Scene& scene, Entity ruler);

/// Measures along a curve between the points nearest to `from` and `to`.
RulerMeasure measure_along(const flow::CurvePtr& curve, const Vec3& from, const Vec3& to);

/// Geometric feature that a link of the chain is on. It follows from the link's keys, whatever its type: `seed` with `field` is a
/// streamline, `level` with `surface` or `field` is a level of that field, `mesh` is a mesh. Rulers and widgets handle any constraint type
/// with these keys. Pure functions.
enum class LinkFeature { none, curve, level, mesh };

/// Returns the feature of a link; `link`: its item of "chain".
LinkFeature find_link_feature(const json::Node& link);
/// Returns the key that names the field of the link's level: "surface" if present, else "field".
const char* level_field_key(const json::Node& link);
/// Returns the name of that field; empty: the link is on no level.
std::string level_field_name(const json::Node& link);

}  // namespace catena::scene
