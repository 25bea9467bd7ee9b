// SPDX-License-Identifier: MIT
/// Reads the overlay of the image: "scalar_bars", "labels", "title", "orientation_marker", "status", "overlay".
#include "engine/base/numbers.h"
#include "engine/base/text.h"
#include "engine/scene/readers.h"

namespace catena::scene {

Result<std::size_t> read_index(const json::Node& object, std::string_view key, std::string_view what, std::size_t count,
                               const std::string& referrer) {
  if (count == 0) return json::error_at(*object.find(key), "the scene has no " + std::string(what) + "; one was expected for " + referrer);
  CATENA_TRY(const int index, json::get_integer(object, key, 0, 0, static_cast<int>(count) - 1));
  return static_cast<std::size_t>(index);
}

namespace {

constexpr double kMaxPoints = 576;  // points along the shorter side of the image

/// Returns whether the entity, visible or hidden, has colors that a scalar bar can show.
bool has_colors(const EntityStore& world, Entity e) {
  const Drawable* kind = find_drawable(world, e);
  return kind != nullptr && kind->has_colors(world, e);
}

/// Returns the first entity whose colors show the field; volumes and slices come before other kinds.
Entity shown_field(const EntityStore& world, Entity field) {
  std::vector<const Drawable*> kinds;
  for (const Drawable& kind : drawables()) kinds.push_back(&kind);
  std::ranges::stable_partition(kinds, [](const Drawable* kind) { return kind->name == "volumes" || kind->name == "slices"; });
  for (const Drawable* kind : kinds)
    for (const auto& [e, where] : kind->items(world))
      if (kind->has_colors(world, e) && kind->color_field(world, e) == field) return e;
  return {};
}

/// Returns the kinds of drawables whose items a scalar bar can name.
std::vector<const Drawable*> named_kinds() {
  std::vector<const Drawable*> kinds;
  for (const Drawable& kind : drawables())
    if (!kind.bar_key.empty()) kinds.push_back(&kind);
  return kinds;
}

/// Returns the item of a list whose index is in the member `kind.bar_key`. Error: the item has no colors by value.
Result<Entity> read_item(const Scene& scene, const json::Node& item, const Drawable& kind) {
  const std::string key(kind.bar_key);
  const std::vector<DrawableItem> all = kind.items(scene.entities);
  CATENA_TRY(const std::size_t index, read_index(item, key, kind.name, all.size(), "a scalar bar"));
  const Entity target = all[index].first;
  if (has_colors(scene.entities, target)) return target;
  return json::error_at(*item.find(key),
                        "this " + std::string(kind.singular) + " shows no values; one with \"color_by\" was expected for a scalar bar");
}

Result<Entity> read_shown(const Scene& scene, const json::Node& item) {
  const std::vector<const Drawable*> kinds = named_kinds();
  int given_count = item.find("field") != nullptr ? 1 : 0;
  std::string choices;
  for (const Drawable* kind : kinds) {
    given_count += item.find(kind->bar_key) != nullptr ? 1 : 0;
    choices += in_quotes(kind->bar_key) + ": INDEX, ";
  }
  if (given_count != 1)
    return json::error_at(item, "a scalar bar names " + std::string(given_count == 0 ? "no item" : "several items") + "; one of " +
                                    choices + "\"field\": NAME was expected");
  for (const Drawable* kind : kinds)
    if (item.find(kind->bar_key) != nullptr) return read_item(scene, item, *kind);
  CATENA_TRY(const Entity field, read_field_name(scene, item));
  const Entity target = shown_field(scene.entities, field);
  if (!target)
    return json::error_at(*item.find("field"), "no volume and no slice shows, and nothing is coloured by, " +
                                                   in_quotes(scene.entities.get<Name>(field).value) +
                                                   "; a field whose values are shown as colours was expected");
  return target;
}

/// Returns whether the text is a printf format of one number: text, %, an optional precision, one of e, f and g, text.
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
      targets.push_back(
          schema::integer(std::string(kind->bar_key), "",
                          "Index, counted from 0, of the item of `" + std::string(kind->name) + "` whose colours the bar shows.", 0,
                          1000000)
              .with_range_text("an index"));
    targets.push_back(schema::reference(
        "field", Role::any_field,
        "Field; the bar shows the colours of the first item that shows this field, instead of an item given by an index."));
    t.group(targets, [](Scene& scene, const json::Node& item, ScalarBar& bar) -> Outcome {
      CATENA_TRY(bar.target, read_shown(scene, item));
      return Done{};
    });
    t.bind(schema::text("title", "Title over the bar; may contain `{time}` and `{step}`, as the `title` of the scene.")
               .with_default("the name of the shown quantity"),
           &ScalarBar::title);
    t.bind(schema::choice("position", {"right", "left", "bottom", "top"}, "Side of the image on which the bar stands."), &ScalarBar::side);
    t.bind(schema::integer("ticks", "", "Approximate number of ticks.", 2, 50), &ScalarBar::ticks);
    t.bind(
        schema::text("format", "Printf format of the numbers, such as `%.2f` or `%g K`.").with_default("as many digits as the ticks need"),
        &ScalarBar::format);
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

/// Returns a key for a size in points of the image.
Key points_key(const std::string& name, const std::string& help) {
  return schema::number(name, "points", help).with_limits({0.0, kMaxPoints, true});
}

const Table<Label>& label_table() {
  static const auto table = [] {
    Table<Label> t;
    t.bind(schema::vec3("at", "world", "Position of the label.").required(), &Label::position);
    t.bind(schema::text("text", "Text of the label.").required(), &Label::text);
    t.bind(schema::color("color", "Colour of the text.").with_default("readable over the background"), &Label::color);
    t.bind(points_key("size", "Size of the text."), &Label::size_pt);
    t.bind(schema::boolean("dot", "Dot at the position of the label."), &Label::show_dot);
    t.bind(schema::boolean("occluded", "Omission of the label where an opaque surface occludes its position."), &Label::hide_when_occluded);
    return t;
  }();
  return table;
}

const Table<OrientationMarker>& orientation_marker_table() {
  static const auto table = [] {
    Table<OrientationMarker> t;
    t.bind(schema::choice("position", {"bottom-left", "bottom-right", "top-left", "top-right"}, "Corner of the image."),
           &OrientationMarker::corner);
    t.bind(points_key("size", "Edge length of the square that holds the marker."), &OrientationMarker::size_pt);
    t.bind(schema::texts("names", "Names of the axes x, y and z.").with_size(3, 3), &OrientationMarker::names);
    return t;
  }();
  return table;
}

/// Keys shared by all overlay text.
const Table<Annotations>& overlay_table() {
  static const auto table = [] {
    Table<Annotations> t;
    t.bind(schema::text("font", "Font family of all text.").with_default("DejaVu Sans"), &Annotations::font);
    t.bind(schema::number("scale", "", "Factor on all text sizes.").with_limits({0.0, 20.0, true}), &Annotations::scale);
    t.bind(schema::color("color", "Colour of text without a colour of its own.").with_default("readable over the background"),
           &Annotations::color);
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
    return json::error_at(node, "\"orientation_marker\" is neither a boolean nor an object; true, false or an object was expected");
  if (node.kind == json::Kind::object) CATENA_CHECK(orientation_marker_table().read(scene, node, marker));
  scene.annotations.orientation_marker = std::move(marker);
  return Done{};
}

Outcome read_status(Scene& scene, const json::Node& node) { return read_boolean(node, scene.annotations.show_status); }

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
  const auto take_first = [&](Entity e) {
    if (bar || !has_colors(world, e)) return;
    bar.emplace();
    bar->target = e;
  };
  world.each<Volume>([&](Entity e, const Volume&) { take_first(e); });
  world.each<Slice>([&](Entity e, const Slice&) { take_first(e); });
  world.each<StreamlineSet>([&](Entity e, const StreamlineSet&) { take_first(e); });
  world.each<CurvesSource>([&](Entity e, const CurvesSource&) { take_first(e); });
  world.each<PointsSource>([&](Entity e, const PointsSource&) { take_first(e); });
  return bar;
}

Part scalar_bars_part() {
  return {make_list_component("scalar_bars", "Colour legends with their values, at the sides of the image.", scalar_bar_table()),
          read_scalar_bars};
}

Part labels_part() { return {make_list_component("labels", "Texts at positions in the scene.", label_table()), read_labels}; }

Part title_part() {
  return {
      {"title",
       "Title at the top of the image.",
       schema::Section::Layout::value,
       {schema::text(
           "title",
           "Title at the top of the image; `{time}` and `{step}` stand for the time and the number of the shown [step](#steps-in-time).")}},
      read_title};
}

Part orientation_marker_part() {
  return {{"orientation_marker", "Three arrows in a corner of the image that show the directions of x, y and z.",
           schema::Section::Layout::on_off, orientation_marker_table().keys()},
          read_orientation_marker};
}

Part status_part() {
  return {{"status",
           "Force and status of every link, written over the image.",
           schema::Section::Layout::value,
           {schema::boolean("status", "Force and status of every link, written over the image.").with_default("false")}},
          read_status};
}

Part overlay_part() {
  return {{"overlay", "Font, scale and colour of all text over the image.", schema::Section::Layout::object, overlay_table().keys()},
          read_overlay};
}

}  // namespace catena::scene
