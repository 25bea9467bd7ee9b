#include "engine/base/numbers.h"
#include "engine/base/text.h"
#include "engine/scene/lines.h"
#include "engine/scene/read_parts.h"
#include "engine/scene/widgets.h"

namespace catena::scene {
namespace {

constexpr int kMostSeeds = 100000;

Result<int> read_count(const json::Node& object) {
  if (object.find("count") == nullptr) return json::error_at(object, "\"count\" is missing; how many seeds was expected");
  return json::get_integer(object, "count", 1, 1, kMostSeeds);
}

Result<std::vector<Vec3>> read_points(const json::Node& node, std::string_view what) {
  if (node.kind != json::Kind::array || node.items.empty())
    return json::error_at(node, in_quotes(what) + " is no list of places or empty; at least one [x, y, z] was expected");
  std::vector<Vec3> points;
  points.reserve(node.items.size());
  for (const json::Node& item : node.items) {
    CATENA_TRY(const Vec3 p, json::as_vec3(item, what));
    points.push_back(p);
  }
  return points;
}

Outcome read_line(const Scene&, const json::Node& node, SeedPattern& out) {
  CATENA_CHECK(json::only_keys(node, {"from", "to", "count"}));
  CATENA_TRY(out.origin, json::require_vec3(node, "from"));
  CATENA_TRY(out.u, json::require_vec3(node, "to"));
  CATENA_TRY(out.count, read_count(node));
  return Done{};
}

Outcome read_plane(const Scene&, const json::Node& node, SeedPattern& out) {
  CATENA_CHECK(json::only_keys(node, {"origin", "u", "v", "count"}));
  CATENA_TRY(out.origin, json::require_vec3(node, "origin"));
  CATENA_TRY(out.u, json::require_vec3(node, "u"));
  CATENA_TRY(out.v, json::require_vec3(node, "v"));
  const json::Node* count = node.find("count");
  const auto whole = [](const json::Node& n) {
    return n.kind == json::Kind::number && n.number >= 1 && n.number <= 1000 && n.number == static_cast<int>(n.number);
  };
  if (count == nullptr || count->kind != json::Kind::array || count->items.size() != 2 || !whole(count->items[0]) ||
      !whole(count->items[1]))
    return json::error_at(count == nullptr ? node : *count,
                          "\"count\" of a plane is missing or wrong; [along u, along v], whole numbers from 1 to 1000, was expected");
  out.count = static_cast<int>(count->items[0].number);
  out.count_v = static_cast<int>(count->items[1].number);
  return Done{};
}

Outcome read_sphere(const Scene&, const json::Node& node, SeedPattern& out) {
  CATENA_CHECK(json::only_keys(node, {"center", "radius", "count", "inside"}));
  CATENA_TRY(out.origin, json::require_vec3(node, "center"));
  CATENA_TRY(out.radius, json::require_number(node, "radius", json::Range::positive));
  CATENA_TRY(out.count, read_count(node));
  CATENA_TRY(out.inside, json::get_boolean(node, "inside", false));
  return Done{};
}

Outcome read_isosurface(const Scene& scene, const json::Node& node, SeedPattern& out) {
  CATENA_CHECK(json::only_keys(node, {"field", "level", "count"}));
  CATENA_TRY(out.field, read_field_name(scene, node));
  CATENA_TRY(out.level, json::require_number(node, "level"));
  CATENA_TRY(out.count, read_count(node));
  return Done{};
}

Outcome read_evenly_spaced(const Scene&, const json::Node& node, SeedPattern& out) {
  CATENA_CHECK(json::only_keys(node, {"distance", "test", "start", "count"}));
  CATENA_TRY(out.distance, json::require_number(node, "distance", json::Range::positive));
  CATENA_TRY(out.test, json::get_number(node, "test", out.test, json::Range::positive));
  if (out.test > 1)
    return json::error_at(*node.find("test"), "\"test\" is " + to_text(out.test) + "; a share of the distance, at most 1, was expected");
  CATENA_TRY(out.count, json::get_integer(node, "count", 20000, 1, kMostSeeds));
  if (const json::Node* start = node.find("start")) {
    CATENA_TRY(out.start, read_points(*start, "start"));
  }
  return Done{};
}

/// {"widget": NAME}: of a rake with "count".
Result<Seeds> read_followed(const Scene& scene, const json::Node& node) {
  CATENA_CHECK(json::only_keys(node, {"widget", "count"}));
  Seeds seeds;
  CATENA_TRY(seeds.widget, read_widget_name(scene, node, {widget::Kind::seed, widget::Kind::rake}, "a seed or a rake"));
  const widget::Spec& spec = scene.world.get<Widget>(seeds.widget).spec;
  if (spec.kind == widget::Kind::rake) {
    CATENA_TRY(seeds.count, read_count(node));
  } else if (const json::Node* count = node.find("count")) {
    return json::error_at(*count, "\"count\" is given with a seed, which is one place; it belongs to a rake");
  }
  seeds.points = seeds_of(spec.kind, spec.pose, seeds.count);
  return seeds;
}

}  // namespace

Result<Seeds> read_seeds(const Scene& scene, const json::Node& node) {
  Seeds seeds;
  if (node.kind != json::Kind::object) {
    if (node.kind != json::Kind::array || node.items.empty())
      return json::error_at(node, "\"seeds\" is missing or empty; at least one seed [x, y, z], or a pattern, was expected");
    CATENA_TRY(seeds.points, read_points(node, "seeds"));
    return seeds;
  }
  if (node.find("widget") != nullptr) return read_followed(scene, node);
  struct Reader {
    std::string_view key;
    SeedPattern::Kind kind;
    Outcome (*read)(const Scene&, const json::Node&, SeedPattern&);
  };
  constexpr Reader readers[] = {{"line", SeedPattern::Kind::line, read_line},
                                {"plane", SeedPattern::Kind::plane, read_plane},
                                {"sphere", SeedPattern::Kind::sphere, read_sphere},
                                {"isosurface", SeedPattern::Kind::isosurface, read_isosurface},
                                {"evenly_spaced", SeedPattern::Kind::evenly_spaced, read_evenly_spaced}};
  std::vector<std::string_view> keys;
  for (const Reader& reader : readers) keys.push_back(reader.key);
  CATENA_CHECK(json::only_keys(node, keys));
  if (node.members.size() != 1)
    return json::error_at(node,
                          "\"seeds\" names " + std::to_string(node.members.size()) + " patterns; one of " + joined(keys) + " was expected");
  for (const Reader& reader : readers) {
    const json::Node* pattern = node.find(reader.key);
    if (pattern == nullptr) continue;
    CATENA_CHECK(json::expect_object(*pattern, reader.key));
    seeds.pattern.emplace();
    seeds.pattern->kind = reader.kind;
    seeds.pattern->where = *pattern;
    CATENA_CHECK(reader.read(scene, *pattern, *seeds.pattern));
  }
  return seeds;
}

}  // namespace catena::scene
