// SPDX-License-Identifier: MIT
/// Reads the seeds of streamlines: points, a pattern, or a widget.
#include "engine/base/numbers.h"
#include "engine/base/text.h"
#include "engine/scene/readers.h"
#include "engine/scene/streamlines.h"
#include "engine/scene/widgets.h"

namespace catena::scene {
namespace {

constexpr int kMaxSeeds = 100000, kMaxEvenLines = 20000;

using Pattern = SeedPattern;
using PatternTable = schema::StructSchema<Pattern, const Scene>;

/// A type of pattern: its key in the scene file with the description, its kind, and its keys.
struct PatternType {
  std::string_view word, help;
  Pattern::Kind kind;
  PatternTable table;
};

Key count_key(const std::string& help) { return schema::integer("count", "", help, 1, kMaxSeeds); }

Outcome read_count(const json::Node& object, int& count) {
  if (object.find("count") == nullptr) return json::error_at(object, "\"count\" is missing; the number of seeds was expected");
  CATENA_TRY(count, json::get_integer(object, "count", 1, 1, kMaxSeeds));
  return Done{};
}

void bind_count(PatternTable& t) {
  t.custom(
      count_key("Number of seeds.").required(),
      [](const Scene&, const json::Node& node, Pattern& out) { return read_count(node, out.count); },
      [](const Scene&, const Pattern& p) { return schema::write_value(p.count); });
}

Outcome read_counts(const Scene&, const json::Node& node, Pattern& out) {
  const json::Node* count = node.find("count");
  const auto is_count = [](const json::Node& n) {
    return n.kind == json::Kind::number && n.number >= 1 && n.number <= 1000 && n.number == static_cast<int>(n.number);
  };
  if (count == nullptr || count->kind != json::Kind::array || count->items.size() != 2 || !is_count(count->items[0]) ||
      !is_count(count->items[1]))
    return json::error_at(count == nullptr ? node : *count,
                          "\"count\" of a plane is missing or wrong; [along u, along v], whole numbers from 1 to 1000, was expected");
  out.count = static_cast<int>(count->items[0].number);
  out.count_v = static_cast<int>(count->items[1].number);
  return Done{};
}

std::vector<PatternType> made_patterns() {
  PatternTable line, plane, sphere, isosurface, even;
  line.bind(schema::vec3("from", "world", "First end of the segment.").required(), &Pattern::origin);
  line.bind(schema::vec3("to", "world", "Other end of the segment.").required(), &Pattern::u);
  bind_count(line);

  plane.bind(schema::vec3("origin", "world", "Corner of the parallelogram.").required(), &Pattern::origin);
  plane.bind(schema::vec3("u", "world", "First edge of the parallelogram, as a vector from `origin`.").required(), &Pattern::u);
  plane.bind(schema::vec3("v", "world", "Second edge of the parallelogram, as a vector from `origin`.").required(), &Pattern::v);
  plane.custom(schema::vector("count", 2, "", "Numbers of seeds along `u` and along `v`.").within(1, 1000).required(), read_counts,
               [](const Scene&, const Pattern& p) { return "[" + std::to_string(p.count) + ", " + std::to_string(p.count_v) + "]"; });

  sphere.bind(schema::vec3("center", "world", "Centre of the sphere.").required(), &Pattern::origin);
  sphere.bind(schema::number("radius", "world", "Radius of the sphere.").positive().required(), &Pattern::radius);
  bind_count(sphere);
  sphere.bind(schema::boolean("inside", "Seeds in the ball instead of on the sphere."), &Pattern::inside);

  bind_field(isosurface, schema::reference("field", Role::scalar_field, "Scalar field of the isosurface.").required(), &Pattern::field);
  isosurface.bind(schema::number("level", "value", "Field value on the isosurface.").required(), &Pattern::level);
  bind_count(isosurface);

  even.bind(schema::number("distance", "world", "Distance between neighbouring lines.").positive().required(), &Pattern::distance);
  even.bind(schema::number("termination_ratio", "",
                           "Minimum distance at which lines end near each other or themselves, as a fraction of `distance`.")
                .with_limits({0.0, 1.0, true}),
            &Pattern::termination_ratio);
  even.custom(
      count_key("Maximum number of lines.").with_default(std::to_string(kMaxEvenLines)),
      [](const Scene&, const json::Node& node, Pattern& out) -> Outcome {
        CATENA_TRY(out.count, json::get_integer(node, "count", kMaxEvenLines, 1, kMaxSeeds));
        return Done{};
      },
      [](const Scene&, const Pattern& p) { return schema::write_value(p.count); });
  even.bind(schema::points("start", "world", "Seeds of the first lines.").with_default("found automatically"), &Pattern::start_points);

  return {{"line", "Evenly spaced seeds on a segment.", Pattern::Kind::line, line},
          {"plane", "Regular grid of seeds on a parallelogram.", Pattern::Kind::plane, plane},
          {"sphere", "Seeds on a sphere, or in a ball.", Pattern::Kind::sphere, sphere},
          {"isosurface", "Seeds on an isosurface of a scalar field.", Pattern::Kind::isosurface, isosurface},
          {"evenly_spaced", "Evenly spaced streamlines, traced from automatically placed seeds.", Pattern::Kind::evenly_spaced, even}};
}

const std::vector<PatternType>& patterns() {
  static const std::vector<PatternType> all = made_patterns();
  return all;
}

/// Reads {"widget": NAME}; "count" applies to a rake.
Result<Seeds> read_followed(const Scene& scene, const json::Node& node) {
  CATENA_CHECK(json::check_known_keys(node, {"widget", "count"}));
  Seeds seeds;
  CATENA_TRY(seeds.widget, read_widget_name(scene, node, {widget::Kind::seed, widget::Kind::rake}, "a seed or a rake"));
  const widget::Spec& spec = scene.entities.get<Widget>(seeds.widget).spec;
  if (spec.kind == widget::Kind::rake) {
    CATENA_CHECK(read_count(node, seeds.count));
  } else if (const json::Node* count = node.find("count")) {
    return json::error_at(*count, "\"count\" is given with a seed widget, which is a single point; a rake was expected");
  }
  seeds.points = make_widget_seeds(spec.kind, spec.pose, seeds.count);
  return seeds;
}

}  // namespace

Key seeds_key() {
  Keys forms;
  for (const PatternType& type : patterns())
    forms.push_back(schema::object(std::string(type.word), type.table.keys(), std::string(type.help)));
  forms.push_back(schema::reference("widget", Role::widget, "Seed widget, or with `count` a rake widget, that sets the seeds."));
  forms.push_back(count_key("Number of seeds along a rake widget."));
  return schema::any_of("seeds", {schema::points("", "world", ""), schema::object("", forms, "")},
                        "Seed positions `[[x, y, z], ...]`, or an object with one of the patterns below, or with `widget`.")
      .required();
}

Result<Seeds> read_seeds(const Scene& scene, const json::Node& node) {
  Seeds seeds;
  if (node.kind != json::Kind::object) {
    if (node.kind != json::Kind::array || node.items.empty())
      return json::error_at(node, "\"seeds\" is missing or empty; at least one seed [x, y, z], or a pattern, was expected");
    CATENA_CHECK(schema::read_points(node, "seeds", seeds.points));
    return seeds;
  }
  if (node.find("widget") != nullptr) return read_followed(scene, node);
  std::vector<std::string_view> words;
  for (const PatternType& type : patterns()) words.push_back(type.word);
  CATENA_CHECK(json::check_known_keys(node, words));
  if (node.members.size() != 1)
    return json::error_at(
        node, "\"seeds\" names " + std::to_string(node.members.size()) + " patterns; one of " + join_words(words) + " was expected");
  for (const PatternType& type : patterns()) {
    const json::Node* pattern = node.find(type.word);
    if (pattern == nullptr) continue;
    CATENA_CHECK(json::expect_object(*pattern, type.word));
    seeds.pattern.emplace();
    seeds.pattern->kind = type.kind;
    seeds.pattern->where = *pattern;
    CATENA_CHECK(type.table.read(scene, *pattern, *seeds.pattern));
  }
  return seeds;
}

std::string write_seeds(const Scene& scene, const Seeds& seeds) {
  if (seeds.widget) {
    const Widget& widget = scene.entities.get<Widget>(seeds.widget);
    return "{\"widget\": " + schema::write_value(scene.entities.get<Name>(seeds.widget).value) +
           (widget.spec.kind == widget::Kind::rake ? ", \"count\": " + std::to_string(seeds.count) : "") + "}";
  }
  if (!seeds.pattern) return schema::write_value(seeds.points);
  for (const PatternType& type : patterns())
    if (type.kind == seeds.pattern->kind) return "{\"" + std::string(type.word) + "\": " + type.table.write(scene, *seeds.pattern) + "}";
  return {};
}

}  // namespace catena::scene
