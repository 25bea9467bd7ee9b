// SPDX-License-Identifier: MIT
/// Reads the spatial references "bounding_box", "axes", "ground", "fog" (each true, false or an object), and the list "lights".
#include "engine/base/camera_limits.h"
#include "engine/base/numbers.h"
#include "engine/base/text.h"
#include "engine/scene/readers.h"
#include "engine/scene/to_json.h"

namespace catena::scene {
namespace {

using schema::Section;

/// Reads an annotation: true (defaults), false (none) or an object.
template <class T>
Outcome read_on_off(Scene& scene, const json::Node& node, const Table<T>& table, std::optional<T>& out) {
  if (node.kind == json::Kind::boolean && !node.boolean) return Done{};
  if (node.kind != json::Kind::boolean && node.kind != json::Kind::object)
    return json::error_at(node, in_quotes(node.label) + " is neither true, false nor an object; one of them was expected");
  T made;
  if constexpr (requires { made.where; }) made.where = node;
  if (node.kind == json::Kind::object) CATENA_CHECK(table.read(scene, node, made));
  out = std::move(made);
  return Done{};
}

const Table<BoundingBox>& bounding_box_table() {
  static const auto table = [] {
    Table<BoundingBox> t;
    bind_field(t, schema::reference("field", Role::any_field, "Whose box.").with_default("all that is drawn"), &BoundingBox::field);
    t.bind(schema::color("color", "Of its edges."), &BoundingBox::color);
    t.bind(schema::number("radius", "world", "Of its edges.").positive().with_default("fitted"), &BoundingBox::radius);
    return t;
  }();
  return table;
}

const Table<Axes>& axes_table() {
  static const auto table = [] {
    Table<Axes> t;
    bind_field(t, schema::reference("field", Role::any_field, "Along whose box.").with_default("all that is drawn"), &Axes::field);
    t.bind(schema::texts("names", "Of the axes x, y and z.").with_size(3, 3), &Axes::names);
    t.bind(schema::color("color", "Of the axes."), &Axes::color);
    t.bind(schema::integer("ticks", "", "About so many along an axis.", 2, 50), &Axes::ticks);
    t.bind(schema::number("radius", "world", "Of the axes.").positive().with_default("fitted"), &Axes::radius);
    return t;
  }();
  return table;
}

const Table<Ground>& ground_table() {
  static const auto table = [] {
    Table<Ground> t;
    t.bind(schema::number("height", "world", "Its z.").with_default("just below what is drawn"), &Ground::z);
    t.bind(schema::number("size", "world", "Edge of the ground.").positive().with_default("fitted"), &Ground::size);
    t.bind(schema::number("tile", "world", "Edge of a tile; at most 1000 tiles each way.").positive().with_default("fitted"),
           &Ground::tile_size);
    t.bind(
        schema::color("color", "Of every other tile."), [](auto& ground) -> auto& { return ground.colors[0]; });
    t.bind(
        schema::color("second_color", "Of the tiles between."), [](auto& ground) -> auto& { return ground.colors[1]; });
    t.check([](Scene&, const json::Node& node, Ground& ground) -> Outcome {
      if (!(ground.size > 0 && ground.tile_size > 0 && ground.size / ground.tile_size > 1000)) return Done{};
      return json::error_at(*node.find("tile"), "\"tile\" is " + to_text(ground.tile_size) + " on a ground of " + to_text(ground.size) +
                                                    "; at most 1000 tiles each way were expected");
    });
    return t;
  }();
  return table;
}

const Table<Fog>& fog_table() {
  static const auto table = [] {
    Table<Fog> t;
    t.bind(schema::color("color", "What far things turn to.").with_default("the background's"), &Fog::color);
    t.bind(schema::number("near", "world", "View depth from which the fog thickens.").non_negative().with_default("the nearest thing"),
           &Fog::near);
    t.bind(schema::number("far", "world", "View depth at which it is thickest.").positive().with_default("the farthest thing"), &Fog::far);
    t.bind(schema::number("max_opacity", "", "Share of the fog at its end.").within(0, 1), &Fog::max_opacity);
    t.check([](Scene&, const json::Node& node, Fog& fog) -> Outcome {
      if (!fog.near || !fog.far || *fog.near < *fog.far) return Done{};
      return json::error_at(*node.find("far"), "\"far\" of the fog is not beyond its \"near\"; a greater view depth was expected");
    });
    return t;
  }();
  return table;
}

const Table<Light>& light_table() {
  static const auto table = [] {
    Table<Light> t;
    t.bind(schema::direction("direction", "Towards the light.").required(), &Light::direction);
    t.bind(schema::color("color", "Its colour."), &Light::color);
    t.bind(schema::number("intensity", "", "Its strength.").non_negative(), &Light::intensity);
    const Key fixed =
        schema::choice("fixed_to", {"scene", "camera"}, "What it goes with; a camera's light is given as right, up, towards the eye.");
    t.bind(fixed, &Light::follows_camera);
    return t;
  }();
  return table;
}

Outcome read_lights(Scene& scene, const json::Node& node) {
  return each_item(node, [&](const json::Node& item) -> Outcome {
    if (scene.lights.size() == kMaxLights)
      return json::error_at(item, "there are more than " + std::to_string(kMaxLights) + " lights; that many at most were expected");
    Light light;
    CATENA_CHECK(light_table().read(scene, item, light));
    scene.lights.push_back(light);
    return Done{};
  });
}

}  // namespace

Part bounding_box_part() {
  return {{"bounding_box", "The edges of a box.", Section::Layout::on_off, bounding_box_table().keys()},
          [](Scene& scene, const json::Node& node) { return read_on_off(scene, node, bounding_box_table(), scene.bounding_box); }};
}

Part axes_part() {
  return {
      {"axes", "Three edges of a box with ticks and numbers, of its outline in the picture.", Section::Layout::on_off, axes_table().keys()},
      [](Scene& scene, const json::Node& node) { return read_on_off(scene, node, axes_table(), scene.axes); }};
}

Part ground_part() {
  return {{"ground", "A checkerboard across z.", Section::Layout::on_off, ground_table().keys()},
          [](Scene& scene, const json::Node& node) { return read_on_off(scene, node, ground_table(), scene.ground); }};
}

Part fog_part() {
  return {{"fog", "Depth cue: colours turn to the fog's with their depth.", Section::Layout::on_off, fog_table().keys()},
          [](Scene& scene, const json::Node& node) { return read_on_off(scene, node, fog_table(), scene.fog); }};
}

Part lights_part() {
  return {make_list_component("lights", "Lights from far away. Without one the scene has a headlight.", light_table(),
                              static_cast<int>(kMaxLights)),
          read_lights};
}

std::string to_json(const Light& light) { return light_table().write({}, light); }

}  // namespace catena::scene
