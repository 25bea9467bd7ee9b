// SPDX-License-Identifier: MIT
/// Reads the spatial references "bounding_box", "axes", "ground", "fog" (each true, false or an object).
#include "engine/base/camera_limits.h"
#include "engine/base/numbers.h"
#include "engine/base/text.h"
#include "engine/scene/readers.h"
#include "engine/scene/to_json.h"

namespace catena::scene {
namespace {

using schema::Section;

const Table<BoundingBox>& bounding_box_table() {
  static const auto table = [] {
    Table<BoundingBox> t;
    bind_field(
        t, schema::reference("field", Role::any_field, "Field whose domain box is drawn.").with_default("the box of all visible objects"),
        &BoundingBox::field);
    t.bind(schema::color("color", "Colour of the edges."), &BoundingBox::color);
    t.bind(schema::number("radius", "world", "Radius of the edges.").positive().with_default("fitted"), &BoundingBox::radius);
    return t;
  }();
  return table;
}

const Table<Axes>& axes_table() {
  static const auto table = [] {
    Table<Axes> t;
    bind_field(t,
               schema::reference("field", Role::any_field, "Field along whose domain box the axes lie.")
                   .with_default("the box of all visible objects"),
               &Axes::field);
    t.bind(schema::texts("names", "Labels of the x, y and z axes.").with_size(3, 3), &Axes::names);
    t.bind(schema::color("color", "Colour of the axes."), &Axes::color);
    t.bind(schema::integer("ticks", "", "Approximate number of ticks per axis.", 2, 50), &Axes::ticks);
    t.bind(schema::number("radius", "world", "Radius of the axes.").positive().with_default("fitted"), &Axes::radius);
    return t;
  }();
  return table;
}

const Table<Ground>& ground_table() {
  static const auto table = [] {
    Table<Ground> t;
    t.bind(schema::number("height", "world", "z coordinate of the ground.").with_default("just below the visible objects"), &Ground::z);
    t.bind(schema::number("size", "world", "Edge length of the ground.").positive().with_default("fitted"), &Ground::size);
    t.bind(schema::number("tile", "world", "Edge length of a tile; at most 1000 tiles along each edge.").positive().with_default("fitted"),
           &Ground::tile_size);
    t.bind(
        schema::color("color", "Colour of every other tile."), [](auto& ground) -> auto& { return ground.colors[0]; });
    t.bind(
        schema::color("second_color", "Colour of the remaining tiles."), [](auto& ground) -> auto& { return ground.colors[1]; });
    t.check([](Scene&, const json::Node& node, Ground& ground) -> Outcome {
      if (!(ground.size > 0 && ground.tile_size > 0 && ground.size / ground.tile_size > 1000)) return Done{};
      return json::error_at(*node.find("tile"), "\"tile\" is " + to_text(ground.tile_size) + " on a ground of " + to_text(ground.size) +
                                                    "; at most 1000 tiles along each edge were expected");
    });
    return t;
  }();
  return table;
}

const Table<Fog>& fog_table() {
  static const auto table = [] {
    Table<Fog> t;
    t.bind(schema::color("color", "Colour of the fog.").with_default("the background colour"), &Fog::color);
    t.bind(schema::number("near", "world", "View depth at which the fog begins.").non_negative().with_default("the nearest visible depth"),
           &Fog::near);
    t.bind(schema::number("far", "world", "View depth from which the fog has its maximum opacity.")
               .positive()
               .with_default("the farthest visible depth"),
           &Fog::far);
    t.bind(schema::number("max_opacity", "", "Opacity of the fog from the view depth `far` on.").within(0, 1), &Fog::max_opacity);
    t.check([](Scene&, const json::Node& node, Fog& fog) -> Outcome {
      if (!fog.near || !fog.far || *fog.near < *fog.far) return Done{};
      return json::error_at(*node.find("far"), "\"far\" of the fog is not greater than \"near\"; a greater view depth was expected");
    });
    return t;
  }();
  return table;
}

}  // namespace

Part bounding_box_part() {
  return {{"bounding_box", "Edges of a bounding box.", Section::Layout::on_off, bounding_box_table().keys()},
          [](Scene& scene, const json::Node& node) { return read_on_off(scene, node, bounding_box_table(), scene.bounding_box); }};
}

Part axes_part() {
  return {{"axes", "Axes with ticks and numbers, along three edges of a box that lie on its outline in the image.", Section::Layout::on_off,
           axes_table().keys()},
          [](Scene& scene, const json::Node& node) { return read_on_off(scene, node, axes_table(), scene.axes); }};
}

Part ground_part() {
  return {{"ground", "Checkerboard perpendicular to z.", Section::Layout::on_off, ground_table().keys()},
          [](Scene& scene, const json::Node& node) { return read_on_off(scene, node, ground_table(), scene.ground); }};
}

Part fog_part() {
  return {{"fog", "Depth cue: colours blend into the colour of the fog with increasing view depth.", Section::Layout::on_off,
           fog_table().keys()},
          [](Scene& scene, const json::Node& node) { return read_on_off(scene, node, fog_table(), scene.fog); }};
}

}  // namespace catena::scene
