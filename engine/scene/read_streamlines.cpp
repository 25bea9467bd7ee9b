// SPDX-License-Identifier: MIT
/// Reads "streamlines" and the "indicator".
#include "engine/base/numbers.h"
#include "engine/base/text.h"
#include "engine/scene/drawable_rows.h"
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
    bind_field(t, schema::reference("field", Role::vector_field, "A vector field.").required(), &StreamlineSet::field);
    t.custom(seeds_key(), read_set_seeds, [](const Scene& scene, const StreamlineSet& set) { return write_seeds(scene, set.seeds); });
    t.bind(schema::number("radius", "world", "Of the tubes.").positive().with_default("0.003 diagonals of the domain"),
           &StreamlineSet::radius);
    t.custom(
        schema::color("color", "Of all lines, without `color_by`.").with_default(schema::write_value(StreamlineSet{}.color)),
        [](Scene&, const json::Node& item, StreamlineSet& set) { return read_plain_color(item, set.color); },
        [](const Scene&, const StreamlineSet& set) { return set.color_by ? std::string() : schema::write_value(set.color); });
    bind_color_by(t, ColorTarget::lines, &StreamlineSet::color_by);
    t.bind(schema::line_kind_key(), &StreamlineSet::is_line_field);
    t.bind(schema::number("min_speed", "value", "Speeds up to this end a line.").non_negative(), &StreamlineSet::min_speed);
    t.bind(schema::number("length", "world", "Longest arc length in each direction. Without it lines of a formula end at its `box`.")
               .positive()
               .with_default("10 L"),
           &StreamlineSet::length);
    t.bind(schema::number("tolerance", "L", "Embedded error of a step.")
               .with_limits({0.0, 0.01, true})
               .with_default("1e-10 for places, 1e-7 for patterns"),
           &StreamlineSet::tolerance);
    t.bind(schema::number("arrows", "world", "An arrowhead every so far along a line.").positive().with_default("none"),
           &StreamlineSet::arrow_spacing);
    t.bind(schema::number("animated_bands", "world", "Bands of this length run with the flow.").positive().with_default("none"),
           &StreamlineSet::band_length);
    t.bind(clip_key(), &StreamlineSet::clipped);
    t.companion(visible_key());
    return t;
  }();
  return table;
}

const Table<Indicator>& indicator_table() {
  static const auto table = [] {
    Table<Indicator> t;
    bind_field(t, schema::reference("field", Role::vector_field, "A vector field.").required(), &Indicator::field);
    t.bind(schema::number("length", "world", "Of the piece.").positive().with_default("0.1 L"), &Indicator::length);
    t.bind(schema::number("radius", "world", "Of its tube.").positive().with_default("0.004 diagonals of the domain"), &Indicator::radius);
    t.bind(schema::color("color", "Its colour."), &Indicator::color);
    t.bind(schema::choice("anchor", {"center", "tail"}, "Where the cursor is: in its middle, or at its upstream end."),
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
  return {make_list_component("streamlines", "Tubes along streamlines.", streamlines_table()), read_streamlines};
}

static Outcome load_streamlines(Scene& scene) {
  return load_visible<StreamlineSet>(scene, [&](Entity, const StreamlineSet& set) { return load_color_field(scene, set.color_by); });
}

Drawable streamlines() {
  return make_drawable<StreamlineSet>(streamlines_part, "streamlines", "streamline set", "streamline sets", "streamlines",
                                      load_streamlines);
}

Part indicator_part() {
  return {{"indicator", "A short piece of the streamline through the cursor, with an arrowhead.", schema::Section::Layout::object,
           indicator_table().keys()},
          read_indicator};
}

}  // namespace catena::scene
