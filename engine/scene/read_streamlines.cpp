/// "streamlines" and the "indicator": lines of the flow.
#include "engine/base/numbers.h"
#include "engine/base/text.h"
#include "engine/scene/hidden.h"
#include "engine/scene/lines.h"
#include "engine/scene/read_parts.h"

namespace catena::scene {
namespace {

/// "color", or "color_by".
Outcome read_line_color(Scene& scene, const json::Node& item, StreamlineSet& set) {
  const json::Node *by = item.find("color_by"), *color = item.find("color");
  const bool of_values =
      color != nullptr && (color->kind == json::Kind::string ||
                           (color->kind == json::Kind::array && !color->items.empty() && color->items[0].kind == json::Kind::array));
  CATENA_CHECK(read_color_by(scene, item, ColorSubjects::lines, set.color_by));
  if (by != nullptr && by->kind == json::Kind::string) return Done{};
  for (const json::Node* node : {of_values ? color : nullptr, item.find("range"), item.find("transfer")})
    if (node != nullptr)
      return json::error_at(*node, in_quotes(node->label) +
                                       (node == color && color->kind == json::Kind::array ? " is a table" : " is given") +
                                       ", but nothing says of what; it was expected within \"color_by\": {\"field\": NAME} or "
                                       "{\"quantity\": \"speed\" or \"arc_length\"}");
  return schema::read_value(schema::color("color", ""), item, set.color);
}

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
    bind_field(t, schema::named("field", Role::vector_field, "A vector field.").required(), &StreamlineSet::field);
    t.hand(seeds_key(), read_set_seeds, [](const Scene& scene, const StreamlineSet& set) { return write_seeds(scene, set.seeds); });
    t.bind(schema::number("radius", "world", "Of the tubes.").positive().by_default("0.003 diagonals of the domain"),
           &StreamlineSet::radius);
    t.hand(schema::color("color", "Of all lines, without `color_by`.").by_default(schema::write_value(StreamlineSet{}.color)),
           read_line_color,
           [](const Scene&, const StreamlineSet& set) { return set.color_by ? std::string() : schema::write_value(set.color); });
    t.beside(color_by_key(ColorSubjects::lines),
             [](const Scene& scene, const StreamlineSet& set) { return set.color_by ? text_of(scene, *set.color_by) : std::string(); });
    t.bind(schema::line_kind_key(), &StreamlineSet::line);
    t.bind(schema::number("min_speed", "value", "Speeds up to this end a line.").not_negative(), &StreamlineSet::min_speed);
    t.bind(schema::number("length", "world", "Longest arc length in each direction. Without it lines of a formula end at its `box`.")
               .positive()
               .by_default("10 L"),
           &StreamlineSet::length);
    t.bind(schema::number("tolerance", "L", "Embedded error of a step.")
               .limited({0.0, 0.01, true})
               .by_default("1e-10 for places, 1e-7 for patterns"),
           &StreamlineSet::tolerance);
    t.bind(schema::number("arrows", "world", "An arrowhead every so far along a line.").positive().by_default("none"),
           &StreamlineSet::arrows);
    t.bind(schema::number("pulse", "world", "Bands of this length run with the flow.").positive().by_default("none"),
           &StreamlineSet::pulse);
    t.bind(clip_key(), &StreamlineSet::clipped);
    t.beside(visible_key());
    t.formerly("range").formerly("transfer");  // beside "color_by" as a word
    return t;
  }();
  return table;
}

const Table<Indicator>& indicator_table() {
  static const auto table = [] {
    Table<Indicator> t;
    bind_field(t, schema::named("field", Role::vector_field, "A vector field.").required(), &Indicator::field);
    t.bind(schema::number("length", "world", "Of the piece.").positive().by_default("0.1 L"), &Indicator::length);
    t.bind(schema::number("radius", "world", "Of its tube.").positive().by_default("0.004 diagonals of the domain"), &Indicator::radius);
    t.bind(schema::color("color", "Its colour."), &Indicator::color);
    t.bind(schema::boolean("ahead", "It begins at the cursor and goes with the flow; false: the cursor is its middle."), &Indicator::ahead);
    return t;
  }();
  return table;
}

Outcome read_streamlines(Scene& scene, const json::Node& node) {
  return each_item(node, [&](const json::Node& item) -> Outcome {
    StreamlineSet set;
    set.where = item;
    CATENA_CHECK(streamlines_table().read(scene, item, set));
    const Entity e = scene.world.create();
    scene.world.emplace<StreamlineSet>(e, std::move(set));
    return read_visible(scene, e, item);
  });
}

Outcome read_indicator(Scene& scene, const json::Node& node) {
  CATENA_CHECK(json::expect_object(node, "indicator"));
  Indicator indicator;
  indicator.where = node;
  CATENA_CHECK(indicator_table().read(scene, node, indicator));
  scene.world.emplace<Indicator>(scene.world.create(), std::move(indicator));
  return Done{};
}

}  // namespace

std::string text_of(const Scene& scene, const StreamlineSet& set) { return streamlines_table().write(scene, set); }

Part streamlines_part() { return {list_of("streamlines", "Tubes along streamlines.", streamlines_table()), read_streamlines}; }

Part indicator_part() {
  return {{"indicator", "A short piece of the streamline through the cursor, with an arrowhead.", schema::Component::Shape::object,
           indicator_table().keys()},
          read_indicator};
}

}  // namespace catena::scene
