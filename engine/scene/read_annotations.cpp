// SPDX-License-Identifier: MIT
/// Reads the overlay of the image: "scalar_bars", "labels", "title", "orientation_marker", "status", "overlay".
#include "engine/base/numbers.h"
#include "engine/base/text.h"
#include "engine/scene/readers.h"

namespace catena::scene {

Result<std::size_t> read_index(const json::Node& object, std::string_view key, std::string_view what, std::size_t count,
                               const std::string& whose) {
  if (count == 0) return json::error_at(*object.find(key), "the scene has no " + std::string(what) + "; one was expected for " + whose);
  CATENA_TRY(const int index, json::get_integer(object, key, 0, 0, static_cast<int>(count) - 1));
  return static_cast<std::size_t>(index);
}

namespace {

constexpr double kMaxPoints = 576;  // points along the shorter side of the image

/// Whether the entity has colors that a scalar bar can show, visible or hidden.
bool has_colors(const EntityStore& world, Entity e) {
  const Drawable* kind = find_drawable(world, e);
  return kind != nullptr && kind->has_colors(world, e);
}

/// The first entity with colors that shows the field: volumes and slices before others.
Entity shown_field(const EntityStore& world, Entity field) {
  std::vector<const Drawable*> kinds;
  for (const Drawable& kind : drawables()) kinds.push_back(&kind);
  std::ranges::stable_partition(kinds, [](const Drawable* kind) { return kind->name == "volumes" || kind->name == "slices"; });
  for (const Drawable* kind : kinds)
    for (const auto& [e, where] : kind->items(world))
      if (kind->has_colors(world, e) && kind->color_field(world, e) == field) return e;
  return {};
}

/// The kinds whose items a scalar bar can name.
std::vector<const Drawable*> named_kinds() {
  std::vector<const Drawable*> kinds;
  for (const Drawable& kind : drawables())
    if (!kind.bar_key.empty()) kinds.push_back(&kind);
  return kinds;
}

/// Finds the item of a list that the member `kind.bar_key` states by its index.
Result<Entity> read_item(const Scene& scene, const json::Node& item, const Drawable& kind) {
  const std::string key(kind.bar_key);
  const std::vector<DrawableItem> all = kind.items(scene.entities);
  CATENA_TRY(const std::size_t index, read_index(item, key, kind.name, all.size(), "a scalar bar"));
  const Entity shown = all[index].first;
  if (has_colors(scene.entities, shown)) return shown;
  return json::error_at(*item.find(key),
                        "this " + std::string(kind.singular) + " shows no values; one with \"color_by\" was expected for a scalar bar");
}

Result<Entity> read_shown(const Scene& scene, const json::Node& item) {
  const std::vector<const Drawable*> kinds = named_kinds();
  int given = item.find("field") != nullptr ? 1 : 0;
  std::string choices;
  for (const Drawable* kind : kinds) {
    given += item.find(kind->bar_key) != nullptr ? 1 : 0;
    choices += in_quotes(kind->bar_key) + ": INDEX, ";
  }
  if (given != 1)
    return json::error_at(item, "a scalar bar names " + std::string(given == 0 ? "nothing" : "several things") + "; one of " + choices +
                                    "\"field\": NAME was expected");
  for (const Drawable* kind : kinds)
    if (item.find(kind->bar_key) != nullptr) return read_item(scene, item, *kind);
  CATENA_TRY(const Entity field, read_field_name(scene, item));
  const Entity shown = shown_field(scene.entities, field);
  if (!shown)
    return json::error_at(*item.find("field"), "no volume, slice, coloured isosurface, coloured streamlines or glyphs show " +
                                                   in_quotes(scene.entities.get<Name>(field).value) +
                                                   "; a field with colours was expected");
  return shown;
}

/// Whether the text is a printf format of one number: text, %, an optional precision, one of e f g, text; no other printf syntax.
bool is_format(std::string_view text) {
  const std::size_t at = text.find('%');
  if (at == std::string_view::npos || text.size() > 40) return false;
  std::size_t k = at + 1;
  if (k < text.size() && text[k] == '.') {
    ++k;
    const std::size_t digits = k;
    while (k < text.size() && text[k] >= '0' && text[k] <= '9') ++k;
    if (k == digits || k > digits + 2) return false;
  }
  return k < text.size() && (text[k] == 'e' || text[k] == 'f' || text[k] == 'g') && text.find('%', k) == std::string_view::npos;
}

const Table<ScalarBar>& scalar_bar_table() {
  static const auto table = [] {
    Table<ScalarBar> t;
    Keys targets;
    for (const Drawable* kind : named_kinds())
      targets.push_back(schema::integer(std::string(kind->bar_key), "",
                                        "Shows this item of `" + std::string(kind->name) + "`, counted from 0.", 0, 1000000)
                            .with_range_text("an index"));
    targets.push_back(schema::reference("field", Role::any_field, "Or the first item that shows this field."));
    t.group(targets, [](Scene& scene, const json::Node& item, ScalarBar& bar) -> Outcome {
      CATENA_TRY(bar.target, read_shown(scene, item));
      return Done{};
    });
    t.bind(schema::text("title", "Over the bar; `{time}` and `{step}` as in `title`.").with_default("the name of what is shown"),
           &ScalarBar::title);
    t.bind(schema::choice("position", {"right", "left", "bottom", "top"}, "Where in the picture."), &ScalarBar::side);
    t.bind(schema::integer("ticks", "", "About so many.", 2, 50), &ScalarBar::ticks);
    t.bind(schema::text("format", "One number, such as `%.2f` or `%g K`.").with_default("as needed"), &ScalarBar::format);
    t.check([](Scene&, const json::Node& item, ScalarBar& bar) -> Outcome {
      const json::Node* format = item.find("format");
      if (format == nullptr || is_format(bar.format)) return Done{};
      return json::error_at(*format,
                            "\"format\" is " + in_quotes(bar.format) + "; one number like \"%.2f\", \"%.3e\" or \"%g K\" was expected");
    });
    return t;
  }();
  return table;
}

/// A size in points.
Key points_key(const std::string& name, const std::string& help) {
  return schema::number(name, "points", help).with_limits({0.0, kMaxPoints, true});
}

const Table<Label>& label_table() {
  static const auto table = [] {
    Table<Label> t;
    t.bind(schema::vec3("at", "world", "Its place.").required(), &Label::position);
    t.bind(schema::text("text", "What it says.").required(), &Label::text);
    t.bind(schema::color("color", "Of the text.").with_default("readable"), &Label::color);
    t.bind(points_key("size", "Of the text."), &Label::size_pt);
    t.bind(schema::boolean("dot", "A dot at the place."), &Label::show_dot);
    t.bind(schema::boolean("occluded", "Left out where an opaque surface stands before it."), &Label::hide_when_occluded);
    return t;
  }();
  return table;
}

const Table<OrientationMarker>& orientation_marker_table() {
  static const auto table = [] {
    Table<OrientationMarker> t;
    t.bind(schema::choice("position", {"bottom-left", "bottom-right", "top-left", "top-right"}, "Its corner."), &OrientationMarker::corner);
    t.bind(points_key("size", "Of the marker."), &OrientationMarker::size_pt);
    t.bind(schema::texts("names", "Of the axes x, y and z.").with_size(3, 3), &OrientationMarker::names);
    return t;
  }();
  return table;
}

/// Keys shared by all overlay text.
const Table<Annotations>& overlay_table() {
  static const auto table = [] {
    Table<Annotations> t;
    t.bind(schema::text("font", "Of all text.").with_default("DejaVu Sans"), &Annotations::font);
    t.bind(schema::number("scale", "", "Of all text.").with_limits({0.0, 20.0, true}), &Annotations::scale);
    t.bind(schema::color("color", "Of all text.").with_default("readable"), &Annotations::color);
    return t;
  }();
  return table;
}

Outcome read_scalar_bars(Scene& scene, const json::Node& node) {
  return each_item(node, [&](const json::Node& item) -> Outcome {
    ScalarBar bar;
    bar.where = item;
    CATENA_CHECK(scalar_bar_table().read(scene, item, bar));
    scene.annotations.scalar_bars.push_back(std::move(bar));
    return Done{};
  });
}

Outcome read_labels(Scene& scene, const json::Node& node) {
  return each_item(node, [&](const json::Node& item) -> Outcome {
    CATENA_CHECK(label_table().read(scene, item, scene.annotations.labels.emplace_back()));
    return Done{};
  });
}

Outcome read_orientation_marker(Scene& scene, const json::Node& node) {
  if (node.kind == json::Kind::boolean && !node.boolean) return Done{};
  OrientationMarker marker;
  if (node.kind != json::Kind::boolean && node.kind != json::Kind::object)
    return json::error_at(node, "\"orientation_marker\" is neither; true, false or an object was expected");
  if (node.kind == json::Kind::object) CATENA_CHECK(orientation_marker_table().read(scene, node, marker));
  scene.annotations.orientation_marker = std::move(marker);
  return Done{};
}

Outcome read_status(Scene& scene, const json::Node& node) {
  if (node.kind != json::Kind::boolean) return json::error_at(node, "\"status\" is no switch; true or false was expected");
  scene.annotations.show_status = node.boolean;
  return Done{};
}

Outcome read_title(Scene& scene, const json::Node& node) {
  CATENA_TRY(scene.annotations.title, json::as_string(node, "title"));
  return Done{};
}

Outcome read_overlay(Scene& scene, const json::Node& node) {
  CATENA_CHECK(json::expect_object(node, "overlay"));
  return overlay_table().read(scene, node, scene.annotations);
}

}  // namespace

std::optional<ScalarBar> first_scalar_bar(const EntityStore& world) {
  std::optional<ScalarBar> bar;
  const auto take = [&](Entity e) {
    if (bar || !has_colors(world, e)) return;
    bar.emplace();
    bar->target = e;
  };
  world.each<Volume>([&](Entity e, const Volume&) { take(e); });
  world.each<Slice>([&](Entity e, const Slice&) { take(e); });
  world.each<StreamlineSet>([&](Entity e, const StreamlineSet&) { take(e); });
  world.each<CurvesSource>([&](Entity e, const CurvesSource&) { take(e); });
  world.each<PointsSource>([&](Entity e, const PointsSource&) { take(e); });
  return bar;
}

Part scalar_bars_part() {
  return {make_list_component("scalar_bars", "Colours with their values, beside the picture.", scalar_bar_table()), read_scalar_bars};
}

Part labels_part() { return {make_list_component("labels", "Words at places of the scene.", label_table()), read_labels}; }

Part title_part() {
  return {{"title",
           "At the top of the picture.",
           schema::Section::Layout::value,
           {schema::text("title",
                         "At the top of the picture; `{time}` and `{step}` stand for those of the [step](#steps-in-time) that is shown.")}},
          read_title};
}

Part orientation_marker_part() {
  return {{"orientation_marker", "Three arrows in a corner: which way x, y and z point.", schema::Section::Layout::on_off,
           orientation_marker_table().keys()},
          read_orientation_marker};
}

Part status_part() {
  return {{"status",
           "The force, and the status of every link.",
           schema::Section::Layout::value,
           {schema::boolean("status", "Writes the force, and the status of every link, over the picture.").with_default("false")}},
          read_status};
}

Part overlay_part() {
  return {{"overlay", "What all text over the picture has in common.", schema::Section::Layout::object, overlay_table().keys()},
          read_overlay};
}

}  // namespace catena::scene
