// SPDX-License-Identifier: MIT
#include "engine/scene/ruler.h"

#include <algorithm>

#include "engine/base/text.h"
#include "engine/geometry/flow/curve.h"
#include "engine/geometry/geodesics/geodesics.h"
#include "engine/schema/values.h"

namespace catena::scene {
namespace {

using How = RulerMeasure::PathKind;
constexpr std::size_t kMaxPoints = 4096;

/// Object along which a ruler measures; at most one of the pointers is set.
struct Track {
  flow::CurvePtr curve;
  field::ScalarFieldPtr surface;
  double level = 0;
  mesh::MeshPtr mesh;
  std::string note;
  bool is_same(const Track& other) const {
    return curve == other.curve && surface == other.surface && level == other.level && mesh == other.mesh && note == other.note;
  }
};

/// Cached data of a ruler.
struct MadeRuler {
  widget::Pose pose;
  Track track;
  RulerMeasure measure;
};

/// Returns the widget that a link's key names instead of a value; a null entity if it names none.
Entity named_widget(const Scene& scene, const json::Node* value) {
  const json::Node* name = value == nullptr ? nullptr : value->find("widget");
  return name == nullptr || name->kind != json::Kind::string ? Entity{} : find_widget(scene, name->string);
}

Result<Track> curve_track(Scene& scene, const Link& link) {
  Track track;
  const json::Node* seed_node = link.node.find("seed");
  CATENA_TRY(const std::string name, json::require_string(link.node, "field"));
  CATENA_TRY(const field::AnyField any, resolve_field(scene, name, *link.node.find("field")));
  if (!any.vector) return json::error_at(*link.node.find("field"), "a streamline needs a vector field");
  flow::Flow flow{any.vector.get()};
  CATENA_CHECK(schema::read_value(schema::line_kind_key(), link.node, flow.is_line_field));
  CATENA_TRY(flow.min_speed, json::get_number(link.node, "min_speed", 0, json::NumberRange::non_negative));
  Vec3 seed;
  if (const Entity widget = named_widget(scene, seed_node)) {
    seed = scene.entities.get<Widget>(widget).report.pose.points[0];
  } else {
    CATENA_TRY(seed, json::as_vec3(*seed_node, "seed"));
  }
  auto curve = resolve_streamline(scene, flow, seed, *seed_node);
  if (curve)
    track.curve = *curve;
  else
    track.note = curve.error().message;
  return track;
}

Result<Track> level_track(Scene& scene, const Link& link) {
  const char* field_key = level_field_key(link.node);
  CATENA_TRY(const std::string name, json::require_string(link.node, field_key));
  CATENA_TRY(const field::AnyField any, resolve_field(scene, name, *link.node.find(field_key)));
  if (!any.scalar) return json::error_at(*link.node.find(field_key), "an isosurface needs a scalar field");
  Track track;
  track.surface = any.scalar;
  if (const Entity widget = named_widget(scene, link.node.find("level"))) {
    CATENA_CHECK(resolve_widget(scene, widget));
    track.level = std::clamp(scene.entities.get<Widget>(widget).report.value, any.scalar->min_value(), any.scalar->max_value());
  } else {
    CATENA_TRY(track.level, json::require_number(link.node, "level"));
  }
  return track;
}

/// Returns the link with this name, or the preset that generates a link of this name (NAME_...).
Link link_of(const Scene& scene, const std::string& name) {
  Link found;
  scene.entities.each<Link>([&](Entity, const Link& link) {
    if (link.name == name || (found.name.empty() && name.starts_with(link.name + "_"))) found = link;
  });
  return found;
}

Result<Track> track_of(Scene& scene, const Widget& ruler) {
  std::vector<Link> links;
  for (const std::string& name : ruler.along_links) links.push_back(link_of(scene, name));
  for (const Link& link : links)
    if (find_link_feature(link.node) == LinkFeature::curve) return curve_track(scene, link);
  for (const Link& link : links) {
    if (find_link_feature(link.node) == LinkFeature::level) return level_track(scene, link);
    if (find_link_feature(link.node) != LinkFeature::mesh) continue;
    Track track;
    CATENA_TRY(const std::string name, json::require_string(link.node, "mesh"));
    CATENA_TRY(track.mesh, resolve_mesh(scene, name, *link.node.find("mesh")));
    return track;
  }
  Track none;
  if (!links.empty())
    none.note = "measured along the straight line, because none of the ruler's links has a seed, a level or a mesh to measure along";
  return none;
}

RulerMeasure straight_measure(const Vec3& from, const Vec3& to, std::string note) {
  return {How::straight, {from, to}, norm(to - from), std::move(note)};
}

RulerMeasure measure(const Track& track, const Vec3& from, const Vec3& to) {
  if (track.curve) return measure_along(track.curve, from, to);
  if (!track.surface && !track.mesh) return straight_measure(from, to, track.note);
  RulerMeasure out;
  out.path_kind = track.mesh ? How::mesh : How::isosurface;
  out.points =
      track.mesh ? geodesics::path_on_mesh(*track.mesh, from, to) : geodesics::path_on_level(*track.surface, track.level, from, to);
  if (out.points.empty()) return straight_measure(from, to, "no path along the surface connects the two ends");
  out.length = geodesics::path_length(out.points);
  return out;
}

}  // namespace

RulerMeasure measure_along(const flow::CurvePtr& curve, const Vec3& from, const Vec3& to) {
  const flow::NearestOnCurve nearest(curve);
  double a = nearest.find(from).s, b = nearest.find(to).s;
  const bool reversed = a > b;
  if (reversed) std::swap(a, b);
  // the other part of a closed curve, which contains the first knot
  const double period = curve->period();
  const bool wrapped = curve->is_closed() && b - a > 0.5 * period;
  if (wrapped) {
    a += period;
    std::swap(a, b);
  }
  RulerMeasure out;
  out.path_kind = How::streamline;
  out.length = b - a;
  std::vector<double> positions{a};
  const std::vector<flow::Knot>& knots = curve->knots();
  for (const double shift : {0.0, period}) {
    if (shift > 0 && !curve->is_closed()) break;
    const auto by_s = [&](double s, const flow::Knot& knot) { return s < knot.s + shift; };
    for (auto k = std::upper_bound(knots.begin(), knots.end(), positions.back(), by_s); k != knots.end() && k->s + shift < b; ++k)
      positions.push_back(k->s + shift);
  }
  positions.push_back(b);
  const std::size_t stride = 1 + positions.size() / kMaxPoints;
  for (std::size_t i = 0; i + 1 < positions.size(); i += stride) out.points.push_back(curve->position(positions[i]));
  out.points.push_back(curve->position(b));
  // the points go from the first end to the second
  if (reversed != wrapped) std::reverse(out.points.begin(), out.points.end());
  return out;
}

Result<RulerMeasure> resolve_ruler(Scene& scene, Entity entity) {
  CATENA_ASSERT(scene.entities.get<Widget>(entity).spec.kind == widget::Kind::ruler);
  CATENA_TRY(Track track, track_of(scene, scene.entities.get<Widget>(entity)));
  const widget::Pose& pose = scene.entities.get<Widget>(entity).report.pose;
  if (!scene.cache.has<MadeRuler>(entity)) scene.cache.emplace<MadeRuler>(entity);
  MadeRuler& made = scene.cache.get<MadeRuler>(entity);
  if (made.measure.points.empty() || made.pose != pose || !made.track.is_same(track)) {
    RulerMeasure measured = measure(track, pose.points[0], pose.points[1]);
    made = {pose, std::move(track), std::move(measured)};
  }
  return made.measure;
}

const RulerMeasure* find_ruler_measure(const Scene& scene, Entity ruler) {
  return scene.cache.has<MadeRuler>(ruler) ? &scene.cache.get<MadeRuler>(ruler).measure : nullptr;
}

LinkFeature find_link_feature(const json::Node& link) {
  if (link.find("seed") != nullptr && link.find("field") != nullptr) return LinkFeature::curve;
  if (!level_field_name(link).empty()) return LinkFeature::level;
  return link.find("mesh") != nullptr ? LinkFeature::mesh : LinkFeature::none;
}

const char* level_field_key(const json::Node& link) { return link.find("surface") != nullptr ? "surface" : "field"; }

std::string level_field_name(const json::Node& link) {
  if (link.find("level") == nullptr) return {};
  const json::Node* field = link.find(level_field_key(link));
  return field != nullptr && field->kind == json::Kind::string ? field->string : std::string();
}

}  // namespace catena::scene
