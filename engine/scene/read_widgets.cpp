// SPDX-License-Identifier: MIT
/// Reads "widgets": objects that the user can grab and move with the device, by type.
#include "engine/base/numbers.h"
#include "engine/base/text.h"
#include "engine/scene/reader_bindings.h"
#include "engine/scene/to_json.h"
#include "engine/scene/widgets.h"

namespace catena::scene {
namespace {

using widget::Kind;
constexpr double kUnitTolerance = 1e-6;
constexpr std::string_view kWords[] = {"cutting_plane", "seed", "rake", "isolevel", "box", "ruler"};

Result<Quat> read_orientation(const json::Node& node) {
  const std::string expected = "a unit quaternion [w, x, y, z] was expected";
  if (node.kind != json::Kind::array || node.items.size() != 4)
    return json::error_at(node, "\"orientation\" has the wrong shape; " + expected);
  double q[4];
  for (std::size_t i = 0; i < 4; ++i) {
    CATENA_TRY(q[i], json::as_number(node.items[i], "orientation"));
  }
  const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  if (!(std::fabs(length - 1) <= kUnitTolerance))
    return json::error_at(node, "\"orientation\" has the length " + to_text(length) + "; " + expected);
  return normalize_orientation({q[0], q[1], q[2], q[3]});
}

constexpr double kLargest = 1e100;

/// Reads a length; 0 if it is not given.
Result<double> read_size(const json::Node& item, std::string_view key) {
  CATENA_TRY(const double size, json::get_number(item, key, 0, json::NumberRange::positive));
  if (size > kLargest)
    return json::error_at(*item.find(key), in_quotes(key) + " is " + to_text(size) + "; a length up to 1e100 was expected");
  return size;
}

/// Key of a length for which the widget type has a default.
Key size_key(const std::string& name, const std::string& help, const std::string& default_text) {
  return schema::number(name, "world", help).with_limits({0.0, kLargest, true}).with_range_text("> 0").with_default(default_text);
}

template <class Access>
void bind_size(Table<Widget>& t, const Key& key, Access access) {
  t.custom(
      key,
      [key, access](Scene&, const json::Node& item, Widget& widget) -> Outcome {
        CATENA_TRY(std::invoke(access, widget), read_size(item, key.name));
        return Done{};
      },
      [access](const Scene&, const Widget& widget) {
        const double size = std::invoke(access, widget);
        return size > 0 ? schema::write_value(size) : std::string();
      });
}

template <int kIndex>
constexpr auto kPoint = [](auto& widget) -> auto& {
  return widget.spec.pose.points[kIndex];
};

Outcome read_facing(Scene&, const json::Node& item, Widget& widget) {
  const json::Node *normal = item.find("normal"), *orientation = item.find("orientation");
  if ((normal != nullptr) == (orientation != nullptr))
    return json::error_at(normal ? *normal : item, std::string("a cutting plane has ") + (normal ? "both" : "neither") +
                                                       " \"normal\" and \"orientation\"; exactly one of them was expected");
  if (normal) {
    Vec3 n(0.0);
    CATENA_CHECK(schema::read_value(schema::direction("normal", ""), item, n));
    widget.spec.pose.orientation = shortest_arc({0.0, 0.0, 1.0}, direction(n));
  } else {
    CATENA_TRY(widget.spec.pose.orientation, read_orientation(*orientation));
  }
  return Done{};
}

Table<Widget> cutting_plane_table() {
  Table<Widget> t;
  t.bind(schema::vec3("center", "world", "Centre of the plane and of the sphere.").required(), kPoint<0>);
  t.group({schema::direction("normal", "Normal of the plane, of any length. Exactly one of `normal` and `orientation` is required."),
           schema::vector("orientation", 4, "",
                          "Orientation of the plane as a unit quaternion `[w, x, y, z]`; the rotated z axis is the normal.")},
          read_facing, [](const Scene&, const Widget& widget) {
            return schema::Members{{"orientation", to_json(widget.spec.pose.orientation)}};
          });
  bind_size(
      t, size_key("snap", "Distance between probe and plane within which the probe snaps to the plane.", "0.02 L"),
      [](auto& widget) -> auto& { return widget.spec.snap; });
  bind_size(
      t, size_key("release", "Distance between probe and plane beyond which the plane releases the probe; greater than `snap`.", "0.05 L"),
      [](auto& widget) -> auto& { return widget.spec.release; });
  t.bind(
      schema::choice("rotation", {"any", "free", "axis"},
                     "Rotation of the sphere; `any`: about an axis if grabbed near the axis's great circle, else free; `free`: always "
                     "free; `axis`: about the nearest axis only."),
      [](auto& widget) -> auto& { return widget.spec.rotation; });
  t.bind(
      schema::boolean("rotate_on_contact", "Rotation of the sphere on contact, without the button."),
      [](auto& widget) -> auto& { return widget.spec.rotate_on_contact; });
  t.check([](Scene&, const json::Node& item, Widget& widget) -> Outcome {
    const widget::Spec& spec = widget.spec;
    if (!(spec.snap > 0 && spec.release > 0 && !(spec.release > spec.snap))) return Done{};
    return json::error_at(*item.find("release"), "\"release\" is " + to_text(spec.release) + " where \"snap\" is " + to_text(spec.snap) +
                                                     "; a distance greater than \"snap\" was expected");
  });
  return t;
}

Table<Widget> seed_table() {
  Table<Widget> t;
  t.bind(schema::vec3("position", "world", "Position of the seed.").required(), kPoint<0>);
  return t;
}

Table<Widget> rake_table() {
  Table<Widget> t;
  t.bind(schema::vec3("from", "world", "First end of the segment.").required(), kPoint<0>);
  t.bind(schema::vec3("to", "world", "Second end of the segment.").required(), kPoint<1>);
  return t;
}

/// The keys of an isolevel widget. resolve_widget() checks that the field is scalar and contains the position, because it loads the field.
Table<Widget> isolevel_table() {
  Table<Widget> t;
  bind_field(t, schema::reference("field", Role::scalar_field, "Scalar field whose value at the handle is the level.").required(),
             &Widget::field);
  t.bind(schema::vec3("position", "world", "Position of the handle.").required(), kPoint<0>);
  return t;
}

Table<Widget> box_widget_table() {
  Table<Widget> t;
  t.bind(schema::vec3("min", "world", "Minimum corner of the box.").required(), kPoint<0>);
  t.bind(schema::vec3("max", "world", "Maximum corner of the box, greater than `min` on every axis.").required(), kPoint<1>);
  t.check([](Scene&, const json::Node& item, Widget& widget) -> Outcome {
    const auto& [lo, hi] = widget.spec.pose.points;
    for (int i = 0; i < 3; ++i)
      if (!(lo[i] < hi[i])) return json::error_at(*item.find("max"), "\"max\" is not above \"min\" on every axis; a box was expected");
    return Done{};
  });
  return t;
}

/// Returns whether the chain has this link, or a preset that may generate it (NAME_...); the exact names are known only when the haptic
/// program is built.
bool is_link(const Scene& scene, std::string_view name) {
  bool found = false;
  scene.entities.each<Link>([&](Entity, const Link& link) { found = found || name == link.name || name.starts_with(link.name + "_"); });
  return found;
}

Outcome read_along(Scene& scene, const json::Node& item, Widget& widget) {
  const json::Node* along = item.find("along");
  if (along == nullptr) return Done{};
  if (along->kind != json::Kind::array || along->items.empty())
    return json::error_at(*along, "\"along\" is not a list or is empty; names of links [\"curve\", ...] were expected");
  for (const json::Node& node : along->items) {
    CATENA_TRY(const std::string name, json::as_string(node, "along"));
    if (!is_link(scene, name)) {
      std::vector<std::string_view> names;
      scene.entities.each<Link>([&](Entity, const Link& link) { names.push_back(link.name); });
      return json::error_at(node, "\"along\" names " + in_quotes(name) +
                                      ", which is not a link of the chain; one of its links was expected: " +
                                      (names.empty() ? "it has none" : join_words(names)) + suggestion(name, names));
    }
    for (const std::string& other : widget.along_links)
      if (other == name) return json::error_at(node, "\"along\" names " + in_quotes(name) + " twice; each link once was expected");
    widget.along_links.push_back(name);
  }
  return Done{};
}

Table<Widget> ruler_table() {
  Table<Widget> t = rake_table();
  t.custom(schema::texts("along",
                         "Links of the chain whose line or surface the ends stay on; the length is measured along that line or surface.")
               .with_size(1, 0)
               .with_default("none: straight distance"),
           read_along, [](const Scene&, const Widget& widget) {
             return widget.along_links.empty() ? std::string() : schema::write_value(widget.along_links);
           });
  return t;
}

struct WidgetType {
  Kind kind;
  std::string_view help;
  Table<Widget> own;
};

/// Widget types, in the order of kWords.
const std::vector<WidgetType>& types() {
  static const std::vector<WidgetType> all{
      {Kind::cutting_plane, "Plane that the probe snaps to, with a sphere that rotates the plane.", cutting_plane_table()},
      {Kind::seed, "Seed position of a streamline.", seed_table()},
      {Kind::rake, "Segment along which streamlines are seeded.", rake_table()},
      {Kind::isolevel, "Handle that sets an isolevel: the value of a scalar field at its position.", isolevel_table()},
      {Kind::box, "Box whose faces can be moved, for clipping.", box_widget_table()},
      {Kind::ruler, "Ruler that shows the length between two ends.", ruler_table()}};
  return all;
}

/// Keys common to all widget types.
const Table<Widget>& common_table() {
  static const auto table = [] {
    Table<Widget> t;
    t.companion(schema::identifier("name", "Unique name by which other items refer to the widget.").required());
    t.companion(schema::choice("type", {std::begin(kWords), std::end(kWords)}, "Type of the widget.").required());
    bind_size(
        t, size_key("radius", "Radius of the ball of a handle, or of the sphere of a cutting plane.", "0.012 L; cutting plane 0.12 L"),
        [](auto& widget) -> auto& { return widget.spec.radius; });
    bind_size(
        t,
        size_key("grab_distance", "Distance from a handle, or from the sphere of a cutting plane, within which the probe can grab.",
                 "0.03 L; cutting plane 0.02 L"),
        [](auto& widget) -> auto& { return widget.spec.grab_distance; });
    bind_size(
        t,
        size_key("step", "Dead zone of a drag on each axis: the widget moves along an axis only beyond this distance of the probe.",
                 "0.02 L"),
        [](auto& widget) -> auto& { return widget.spec.step; });
    t.bind(
        schema::integer("button", "", "Button that grabs the widget.", 1, 32), [](auto& widget) -> auto& { return widget.spec.button; });
    t.bind(schema::color("color", "Colour of the widget."), &Widget::color);
    return t;
  }();
  return table;
}

Outcome read_widget(Scene& scene, const json::Node& item) {
  CATENA_TRY(const std::string name, read_new_name<Widget>(scene, item, "widget"));
  CATENA_CHECK(json::require_string(item, "type"));
  CATENA_TRY(const int index, json::get_choice(item, "type", 0, {std::begin(kWords), std::end(kWords)}));
  const WidgetType& type = types()[static_cast<std::size_t>(index)];
  CATENA_CHECK(json::check_known_keys(item, schema::key_names(common_table().keys(), type.own.keys())));
  Widget widget;
  widget.where = item;
  widget.spec.kind = type.kind;
  CATENA_CHECK(type.own.read_own_keys(scene, item, widget));
  CATENA_CHECK(common_table().read_own_keys(scene, item, widget));
  widget.report.pose = widget.spec.pose;
  const Entity entity = scene.entities.create();
  scene.entities.emplace<Name>(entity, {name});
  scene.entities.emplace<Widget>(entity, std::move(widget));
  return Done{};
}

Outcome read_widgets(Scene& scene, const json::Node& node) {
  return each_item(node, [&](const json::Node& item) -> Outcome {
    if (scene.entities.count<Widget>() == static_cast<std::size_t>(kMaxWidgets))
      return json::error_at(item, "there are more than " + std::to_string(kMaxWidgets) + " widgets; that many at most were expected");
    return read_widget(scene, item);
  });
}

}  // namespace

const char* to_string(Kind kind) { return kWords[static_cast<std::size_t>(kind)].data(); }

std::string to_json(const Scene& scene, const std::string& name, const Widget& widget) {
  const WidgetType& type = types()[static_cast<std::size_t>(widget.spec.kind)];
  CATENA_ASSERT(type.kind == widget.spec.kind);
  const auto members = [](const std::string& object) { return object.size() > 2 ? ", " + object.substr(1, object.size() - 2) : ""; };
  return "{\"name\": " + to_json(std::string_view(name)) + ", \"type\": " + to_json(to_string(type.kind)) +
         members(type.own.write(scene, widget)) + members(common_table().write(scene, widget)) + "}";
}

Part widgets_part() {
  schema::Section component =
      make_list_component("widgets",
                          "Objects that the probe can grab and move. A slice, a clip, seeds, a level or a link follows a widget "
                          "by `{\"widget\": NAME}`. L is the longest domain among the visible fields.",
                          common_table(), kMaxWidgets);
  for (const WidgetType& type : types()) component.variants.push_back({to_string(type.kind), std::string(type.help), type.own.keys()});
  return {component, read_widgets};
}

Result<Entity> read_widget_name(const Scene& scene, const json::Node& object, std::initializer_list<Kind> kinds,
                                std::string_view expected) {
  CATENA_TRY(const std::string name, json::require_string(object, "widget"));
  const json::Node& node = *object.find("widget");
  CATENA_TRY(const Entity found, require_named<Widget>(scene, name, node, "widget", "\"widgets\""));
  const Kind kind = scene.entities.get<Widget>(found).spec.kind;
  for (const Kind k : kinds)
    if (k == kind) return found;
  return json::error_at(
      node, "widget " + in_quotes(name) + " is of type " + in_quotes(to_string(kind)) + "; " + std::string(expected) + " was expected");
}

}  // namespace catena::scene
