#include "engine/base/text.h"
#include "engine/exchange/haptic_state.h"
#include "engine/scene/read_parts.h"

namespace catena::scene {
namespace {

constexpr std::size_t kMostLinks = exchange::kMaxLinks;

/// A rotation as three rows of three numbers, nine numbers (row by row), or {"axis": [x, y, z], "angle_deg": a}.
Result<Mat3> read_rotation(const json::Node& node) {
  const std::string expected = "three orthonormal rows of three numbers, or {\"axis\": [x, y, z], \"angle_deg\": a}, were expected";
  if (node.kind == json::Kind::object) {
    CATENA_CHECK(json::only_keys(node, {"axis", "angle_deg"}));
    CATENA_TRY(const Vec3 axis, json::require_vec3(node, "axis"));
    if (norm(axis) == 0) return json::error_at(*node.find("axis"), "\"axis\" is zero; a vector other than [0, 0, 0] was expected");
    CATENA_TRY(const double angle_deg, json::require_number(node, "angle_deg"));
    // Rodrigues: R e = e cos a + (u x e) sin a + u (u . e)(1 - cos a)
    const Vec3 u = direction(axis);
    const double angle = angle_deg * (3.14159265358979323846 / 180.0), c = std::cos(angle), s = std::sin(angle);
    Mat3 rotation(1.0);
    for (int i = 0; i < 3; ++i) {
      Vec3 e(0.0);
      e[i] = 1;
      rotation[i] = e * c + cross(u, e) * s + u * (u[i] * (1 - c));
    }
    return rotation;
  }
  const bool flat = node.kind == json::Kind::array && node.items.size() == 9;
  if (node.kind != json::Kind::array || (!flat && node.items.size() != 3))
    return json::error_at(node, "\"rotation\" has the wrong shape; " + expected);
  Mat3 rotation(1.0);
  for (int row = 0; row < 3; ++row) {
    Vec3 values(0.0);
    if (flat) {
      for (int i = 0; i < 3; ++i) {
        CATENA_TRY(values[i], json::as_number(node.items[static_cast<std::size_t>(3 * row + i)], "rotation"));
      }
    } else {
      CATENA_TRY(values, json::as_vec3(node.items[static_cast<std::size_t>(row)], "rotation"));
    }
    for (int column = 0; column < 3; ++column) rotation[column][row] = values[column];
  }
  double worst = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) worst = std::max(worst, std::fabs(dot(rotation[i], rotation[j]) - (i == j ? 1.0 : 0.0)));
  if (!(worst <= 1e-6) || dot(cross(rotation[0], rotation[1]), rotation[2]) < 0)
    return json::error_at(node, "\"rotation\" is no rotation; " + expected);
  return rotation;
}

}  // namespace

/// Names, types and the field that a link names are checked here; its other keys by the constraint of its type, where the
/// program for the hand is made.
Outcome read_chain(Scene& scene, const json::Node& node) {
  if (node.kind != json::Kind::array) return json::error_at(node, "\"chain\" is no array; an array of links was expected");
  for (std::size_t i = 0; i < node.items.size(); ++i) {
    const json::Node& item = node.items[i];
    if (i >= kMostLinks)
      return json::error_at(
          item, "\"chain\" has " + std::to_string(node.items.size()) + " links; at most " + std::to_string(kMostLinks) + " were expected");
    CATENA_CHECK(json::expect_object(item, item.label));
    CATENA_TRY(const std::string name, json::require_string(item, "name"));
    const json::Node& name_node = *item.find("name");
    if (!is_name(name))
      return json::error_at(name_node, "link name " + in_quotes(name) + " is not allowed; a name like [a-z][a-z0-9_]* was expected");
    if (name == "t" || name == "probe" || name == "force")
      return json::error_at(name_node,
                            "link name " + in_quotes(name) + " is taken by the tick CSV; another name than t, probe, force was expected");
    bool twice = false;
    scene.world.each<Link>([&](Entity, const Link& other) { twice = twice || other.name == name; });
    if (twice) return json::error_at(name_node, "duplicate link name " + in_quotes(name) + "; unique names were expected");
    CATENA_TRY(const std::string type, json::require_string(item, "type"));
    if (const json::Node* field = item.find("field"); field != nullptr) CATENA_CHECK(read_field_name(scene, item));
    scene.world.emplace<Link>(scene.world.create(), {name, type, item});
  }
  return Done{};
}

/// Whether its links exist is checked where the program is made: a link may stand for several.
Outcome read_modes(Scene& scene, const json::Node& node) {
  if (node.kind != json::Kind::array) return json::error_at(node, "\"modes\" is no array; an array of modes was expected");
  for (const json::Node& item : node.items) {
    CATENA_CHECK(json::expect_object(item, item.label));
    CATENA_CHECK(json::only_keys(item, {"name", "links", "on"}));
    CATENA_TRY(const std::string name, json::require_string(item, "name"));
    bool twice = false;
    scene.world.each<Mode>([&](Entity, const Mode& other) { twice = twice || other.name == name; });
    if (twice) return json::error_at(*item.find("name"), "duplicate mode name " + in_quotes(name) + "; unique names were expected");
    const json::Node* links = item.find("links");
    if (links == nullptr || links->kind != json::Kind::array)
      return json::error_at(links ? *links : item, "a mode needs \"links\": an array of link names, in the order of the chain");
    if (item.find("on") == nullptr) return json::error_at(item, "a mode needs \"on\": {\"button\": n} or {\"force_above\": N}");
    Mode mode{name, {}, item};
    for (const json::Node& link : links->items) {
      CATENA_TRY(std::string link_name, json::as_string(link, "links"));
      mode.links.push_back(std::move(link_name));
    }
    scene.world.emplace<Mode>(scene.world.create(), std::move(mode));
  }
  return Done{};
}

Outcome read_coupling(Scene& scene, const json::Node& node) {
  CATENA_CHECK(json::expect_object(node, "coupling"));
  CATENA_CHECK(json::only_keys(node, {"stiffness", "damping", "max_force", "ramp_s", "method"}));
  Coupling& c = scene.coupling;
  CATENA_TRY(c.stiffness_n_per_m, json::get_number(node, "stiffness", c.stiffness_n_per_m, json::Range::not_negative));
  CATENA_TRY(c.damping_ns_per_m, json::get_number(node, "damping", c.damping_ns_per_m, json::Range::not_negative));
  CATENA_TRY(c.max_force_n, json::get_number(node, "max_force", c.max_force_n, json::Range::not_negative));
  CATENA_TRY(c.ramp_s, json::get_optional_number(node, "ramp_s", json::Range::not_negative));
  CATENA_TRY(const int method, json::get_choice(node, "method", 0, {"chain", "pipe", "balance", "closest", "linear"}));
  c.method = static_cast<CouplingMethod>(method);
  return Done{};
}

Outcome read_workspace(Scene& scene, const json::Node& node) {
  CATENA_CHECK(json::expect_object(node, "workspace"));
  CATENA_CHECK(json::only_keys(node, {"metres_per_unit", "origin", "rotation"}));
  Workspace& w = scene.workspace;
  CATENA_TRY(w.metres_per_unit, json::get_number(node, "metres_per_unit", w.metres_per_unit, json::Range::positive));
  w.given = node.find("metres_per_unit") != nullptr;
  CATENA_TRY(w.origin, json::get_vec3(node, "origin", w.origin));
  if (const json::Node* rotation = node.find("rotation")) {
    CATENA_TRY(w.rotation, read_rotation(*rotation));
  }
  return Done{};
}

}  // namespace catena::scene
