/// Help for the eye: "bounding_box", "axes", "ground", "fog": true or an object; "lights": a list.
#include "engine/base/numbers.h"
#include "engine/base/text.h"
#include "engine/scene/read_parts.h"

namespace catena::scene {
namespace {

/// Whether the aid is wanted; `false` leaves it out.
Result<bool> is_wanted(const json::Node& node, std::string_view what) {
  if (node.kind == json::Kind::boolean) return node.boolean;
  if (node.kind == json::Kind::object) return true;
  return json::error_at(node, in_quotes(what) + " is neither true, false nor an object; one of them was expected");
}

Outcome read_field_if_named(Scene& scene, const json::Node& node, Entity& field) {
  if (node.find("field") == nullptr) return Done{};
  CATENA_TRY(field, read_field_name(scene, node));
  return Done{};
}

}  // namespace

Outcome read_bounding_box(Scene& scene, const json::Node& node) {
  CATENA_TRY(const bool wanted, is_wanted(node, "bounding_box"));
  if (!wanted) return Done{};
  BoundingBox box;
  box.where = node;
  if (node.kind == json::Kind::object) {
    CATENA_CHECK(json::only_keys(node, {"field", "color", "radius"}));
    CATENA_CHECK(read_field_if_named(scene, node, box.field));
    CATENA_TRY(box.color, read_color(node, "color", box.color));
    CATENA_TRY(box.radius, json::get_number(node, "radius", 0, json::Range::positive));
  }
  scene.bounding_box = std::move(box);
  return Done{};
}

Outcome read_axes(Scene& scene, const json::Node& node) {
  CATENA_TRY(const bool wanted, is_wanted(node, "axes"));
  if (!wanted) return Done{};
  Axes axes;
  axes.where = node;
  if (node.kind == json::Kind::object) {
    CATENA_CHECK(json::only_keys(node, {"field", "names", "color", "ticks", "radius"}));
    CATENA_CHECK(read_field_if_named(scene, node, axes.field));
    CATENA_TRY(axes.color, read_color(node, "color", axes.color));
    CATENA_TRY(axes.ticks, json::get_integer(node, "ticks", axes.ticks, 2, 50));
    CATENA_TRY(axes.radius, json::get_number(node, "radius", 0, json::Range::positive));
    if (const json::Node* names = node.find("names")) {
      if (names->kind != json::Kind::array || names->items.size() != 3)
        return json::error_at(*names, "\"names\" is no list of three; three names, of x, y and z, were expected");
      for (std::size_t i = 0; i < 3; ++i) {
        CATENA_TRY(axes.names[i], json::as_string(names->items[i], "names"));
      }
    }
  }
  scene.axes = std::move(axes);
  return Done{};
}

Outcome read_ground(Scene& scene, const json::Node& node) {
  CATENA_TRY(const bool wanted, is_wanted(node, "ground"));
  if (!wanted) return Done{};
  Ground ground;
  if (node.kind == json::Kind::object) {
    CATENA_CHECK(json::only_keys(node, {"at", "size", "tile", "color", "second_color"}));
    CATENA_TRY(ground.at, json::get_optional_number(node, "at"));
    CATENA_TRY(ground.size, json::get_number(node, "size", 0, json::Range::positive));
    CATENA_TRY(ground.tile, json::get_number(node, "tile", 0, json::Range::positive));
    if (ground.size > 0 && ground.tile > 0 && ground.size / ground.tile > 1000)
      return json::error_at(*node.find("tile"), "\"tile\" is " + to_text(ground.tile) + " on a ground of " + to_text(ground.size) +
                                                    "; at most 1000 tiles each way were expected");
    CATENA_TRY(ground.colors[0], read_color(node, "color", ground.colors[0]));
    CATENA_TRY(ground.colors[1], read_color(node, "second_color", ground.colors[1]));
  }
  scene.ground = ground;
  return Done{};
}

Outcome read_fog(Scene& scene, const json::Node& node) {
  CATENA_TRY(const bool wanted, is_wanted(node, "fog"));
  if (!wanted) return Done{};
  Fog fog;
  if (node.kind == json::Kind::object) {
    CATENA_CHECK(json::only_keys(node, {"color", "start", "end", "most"}));
    if (node.find("color") != nullptr) {
      CATENA_TRY(fog.color, read_color(node, "color", {}));
    }
    CATENA_TRY(fog.start, json::get_optional_number(node, "start", json::Range::not_negative));
    CATENA_TRY(fog.end, json::get_optional_number(node, "end", json::Range::positive));
    if (fog.start && fog.end && !(*fog.start < *fog.end))
      return json::error_at(*node.find("end"), "\"end\" of the fog is not beyond its \"start\"; a greater view depth was expected");
    CATENA_TRY(fog.most, json::get_number(node, "most", fog.most, json::Range::not_negative));
    if (fog.most > 1) return json::error_at(*node.find("most"), "\"most\" is " + to_text(fog.most) + "; a share from 0 to 1 was expected");
  }
  scene.fog = fog;
  return Done{};
}

Outcome read_lights(Scene& scene, const json::Node& node) {
  if (node.kind != json::Kind::array) return json::error_at(node, "\"lights\" is no array; an array of objects was expected");
  for (const json::Node& item : node.items) {
    CATENA_CHECK(json::expect_object(item, item.label));
    CATENA_CHECK(json::only_keys(item, {"direction", "color", "intensity", "fixed_to"}));
    if (scene.lights.size() == kMostLights)
      return json::error_at(item, "there are more than " + std::to_string(kMostLights) + " lights; that many at most were expected");
    Light light;
    CATENA_TRY(light.direction, json::require_vec3(item, "direction"));
    if (max_abs(light.direction) == 0)
      return json::error_at(*item.find("direction"), "\"direction\" is zero; a vector other than [0, 0, 0] was expected");
    CATENA_TRY(light.color, read_color(item, "color", light.color));
    CATENA_TRY(light.intensity, json::get_number(item, "intensity", 1, json::Range::not_negative));
    CATENA_TRY(const int fixed, json::get_choice(item, "fixed_to", 0, {"scene", "camera"}));
    light.with_camera = fixed == 1;
    scene.lights.push_back(light);
  }
  return Done{};
}

}  // namespace catena::scene
