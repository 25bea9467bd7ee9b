// SPDX-License-Identifier: MIT
/// Reads "streamlines" and the "indicator".
#include "engine/base/numbers.h"
#include "engine/base/text.h"
#include "engine/scene/readers.h"
#include "engine/scene/streamlines.h"
#include "engine/scene/visibility.h"

namespace catena::scene {
namespace {

Outcome read_set_seeds(Scene& scene, const json::Node& item, StreamlineSet& set) {
  const json::Node* seeds = item.find("seeds");
  if (seeds == nullptr)
    return json::error_at(item, "\"seeds\" is missing or empty; at least one seed [x, y, z], or a pattern, was expected");
  CATENA_TRY(set.seeds, read_seeds(scene, *seeds));
  return Done{};
}

const Table<StreamlineSet>& streamlines_table() {
  static const auto table = [] {
    Table<StreamlineSet> t;
    bind_field(t, schema::reference("field", Role::vector_field, "Vector field of the streamlines.").required(), &StreamlineSet::field);
    t.custom(seeds_key(), read_set_seeds, [](const Scene& scene, const StreamlineSet& set) { return write_seeds(scene, set.seeds); });
    t.bind(schema::number("radius", "world", "Radius of the tubes.").positive().with_default("0.003 times the domain's diagonal"),
           &StreamlineSet::radius);
    t.custom(
        schema::color("color", "Colour of all lines if there is no `color_by`.").with_default(schema::write_value(StreamlineSet{}.color)),
        [](Scene&, const json::Node& item, StreamlineSet& set) { return read_plain_color(item, set.color); },
        [](const Scene&, const StreamlineSet& set) { return set.color_by ? std::string() : schema::write_value(set.color); });
    bind_color_by(t, ColorTarget::lines, &StreamlineSet::color_by);
    t.bind(schema::line_kind_key(), &StreamlineSet::is_line_field);
    t.bind(schema::number("min_speed", "value", "Speed at or below which a line ends.").non_negative(), &StreamlineSet::min_speed);
    t.bind(schema::number("length", "world",
                          "Maximum arc length in each direction. If it is absent, lines of a formula end at the `box` of the field.")
               .positive()
               .with_default("10 L"),
           &StreamlineSet::length);
    t.bind(schema::number("tolerance", "L", "Maximum estimated error of an integration step.")
               .with_limits({0.0, 0.01, true})
               .with_default("1e-10; for patterns and rakes 1e-7"),
           &StreamlineSet::tolerance);
    t.bind(schema::number("arrows", "world", "Distance between arrowheads along a line.").positive().with_default("none"),
           &StreamlineSet::arrow_spacing);
    t.bind(
        schema::number("animated_bands", "world", "Length of the animated bands, which move downstream.").positive().with_default("none"),
        &StreamlineSet::band_length);
    t.bind(schema::choice(
               "lines", {"stream", "path", "streak"},
               "`stream`: streamlines of one time step; `path`: ways of particles; `streak`: the particles that have passed a seed."),
           &StreamlineSet::lines);
    t.bind(schema::vector("times", 2, "time",
                          "Start and end of `path` and `streak`: release of the particle, or of the first one, and end of the lines.")
               .with_default("all times, of formulas those of `time`; `streak` ends at the current one"),
           &StreamlineSet::times);
    t.bind(schema::choice("time_interpolation", {"linear", "cubic"}, "`path` and `streak`: interpolation between time steps."),
           &StreamlineSet::is_cubic_in_time);
    t.bind(clip_key(), &StreamlineSet::clipped);
    t.companion(visible_key());
    return t;
  }();
  return table;
}

const Table<Indicator>& indicator_table() {
  static const auto table = [] {
    Table<Indicator> t;
    bind_field(t, schema::reference("field", Role::vector_field, "Vector field whose direction is shown.").required(), &Indicator::field);
    t.bind(schema::number("length", "world", "Length of the piece of streamline.").positive().with_default("0.1 L"), &Indicator::length);
    t.bind(schema::number("radius", "world", "Radius of the tube.").positive().with_default("0.004 times the domain's diagonal"),
           &Indicator::radius);
    t.bind(schema::color("color", "Colour of the indicator."), &Indicator::color);
    t.bind(schema::choice("anchor", {"center", "tail"},
                          "Position of the cursor on the piece: its middle (`center`) or its upstream end (`tail`)."),
           &Indicator::starts_at_cursor);
    return t;
  }();
  return table;
}

Outcome read_streamlines(Scene& scene, const json::Node& node) {
  return each_item(node, [&](const json::Node& item) -> Outcome {
    StreamlineSet set;
    set.where = item;
    CATENA_CHECK(streamlines_table().read(scene, item, set));
    const Entity e = scene.entities.create();
    scene.entities.emplace<StreamlineSet>(e, std::move(set));
    return read_visible(scene, e, item);
  });
}

Outcome read_indicator(Scene& scene, const json::Node& node) {
  CATENA_CHECK(json::expect_object(node, "indicator"));
  Indicator indicator;
  indicator.where = node;
  CATENA_CHECK(indicator_table().read(scene, node, indicator));
  scene.entities.emplace<Indicator>(scene.entities.create(), std::move(indicator));
  return Done{};
}

}  // namespace

std::string to_json(const Scene& scene, const StreamlineSet& set) { return streamlines_table().write(scene, set); }

static Part streamlines_part() {
  return {make_list_component("streamlines", "Streamlines of vector fields, rendered as tubes.", streamlines_table()), read_streamlines};
}

static Outcome load_streamlines(Scene& scene) {
  return load_visible<StreamlineSet>(scene, [&](Entity, const StreamlineSet& set) { return load_color_field(scene, set.color_by); });
}

Drawable streamlines() {
  return make_drawable<StreamlineSet>(streamlines_part, "streamlines", "streamline set", "streamline sets", "streamlines",
                                      load_streamlines);
}

Part indicator_part() {
  return {{"indicator", "Short piece of the streamline through the cursor, with an arrowhead.", schema::Section::Layout::object,
           indicator_table().keys()},
          read_indicator};
}

}  // namespace catena::scene
