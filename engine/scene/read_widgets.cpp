/// "widgets": [{"name", "type", its place, "radius", "near", "step", "button", "color"}], by type:
///   cutting_plane  "center", "normal" or "orientation" [w, x, y, z]; "snap", "release", "turning", "touch"
///   seed           "position"
///   rake           "from", "to"
///   isolevel       "field", "position"
///   box            "lo", "hi"
///   ruler          "from", "to", "along": names of links
#include "engine/base/numbers.h"
#include "engine/base/text.h"
#include "engine/scene/read_parts.h"
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
  return unit_orientation({q[0], q[1], q[2], q[3]});
}

constexpr double kLargest = 1e100;

/// A length, stated or 0.
Result<double> read_size(const json::Node& item, std::string_view key) {
  CATENA_TRY(const double size, json::get_number(item, key, 0, json::Range::positive));
  if (size > kLargest)
    return json::error_at(*item.find(key), in_quotes(key) + " is " + to_text(size) + "; a length up to 1e100 was expected");
  return size;
}

Outcome read_cutting_plane(const Scene&, const json::Node& item, Widget& widget) {
  widget::Spec& spec = widget.spec;
  CATENA_TRY(spec.pose.points[0], json::require_vec3(item, "center"));
  const json::Node *normal = item.find("normal"), *orientation = item.find("orientation");
  if ((normal != nullptr) == (orientation != nullptr))
    return json::error_at(normal ? *normal : item, std::string("a cutting plane has ") + (normal ? "both" : "neither") +
                                                       " \"normal\" and \"orientation\"; exactly one of them was expected");
  if (normal) {
    CATENA_TRY(const Vec3 n, json::as_vec3(*normal, "normal"));
    if (max_abs(n) == 0) return json::error_at(*normal, "\"normal\" is zero; a vector other than [0, 0, 0] was expected");
    spec.pose.orientation = shortest_arc({0.0, 0.0, 1.0}, direction(n));
  } else {
    CATENA_TRY(spec.pose.orientation, read_orientation(*orientation));
  }
  CATENA_TRY(spec.snap, read_size(item, "snap"));
  CATENA_TRY(spec.release, read_size(item, "release"));
  if (spec.snap > 0 && spec.release > 0 && !(spec.release > spec.snap))
    return json::error_at(*item.find("release"), "\"release\" is " + to_text(spec.release) + " where \"snap\" is " + to_text(spec.snap) +
                                                     "; a longer distance than snap's was expected");
  CATENA_TRY(const int turning, json::get_choice(item, "turning", 0, {"any", "free", "axis"}));
  spec.turning = static_cast<widget::Turning>(turning);
  CATENA_TRY(spec.touch, json::get_boolean(item, "touch", false));
  return Done{};
}

Outcome read_seed(const Scene&, const json::Node& item, Widget& widget) {
  CATENA_TRY(widget.spec.pose.points[0], json::require_vec3(item, "position"));
  return Done{};
}

Outcome read_rake(const Scene&, const json::Node& item, Widget& widget) {
  CATENA_TRY(widget.spec.pose.points[0], json::require_vec3(item, "from"));
  CATENA_TRY(widget.spec.pose.points[1], json::require_vec3(item, "to"));
  return Done{};
}

/// Whether the field is a scalar one, and the place within it, use_widget tells: it loads the field.
Outcome read_isolevel(const Scene& scene, const json::Node& item, Widget& widget) {
  CATENA_TRY(widget.field, read_field_name(scene, item));
  CATENA_TRY(widget.spec.pose.points[0], json::require_vec3(item, "position"));
  return Done{};
}

Outcome read_box(const Scene&, const json::Node& item, Widget& widget) {
  CATENA_TRY(const Vec3 lo, json::require_vec3(item, "lo"));
  CATENA_TRY(const Vec3 hi, json::require_vec3(item, "hi"));
  for (int i = 0; i < 3; ++i)
    if (!(lo[i] < hi[i])) return json::error_at(*item.find("hi"), "\"hi\" is not above \"lo\" on every axis; a box was expected");
  widget.spec.pose.points = {lo, hi};
  return Done{};
}

/// A link of the chain, or one that a ready-made mode of it stands for (NAME_...): which those are the program's maker knows.
bool is_link(const Scene& scene, std::string_view name) {
  bool found = false;
  scene.world.each<Link>([&](Entity, const Link& link) { found = found || name == link.name || name.starts_with(link.name + "_"); });
  return found;
}

Outcome read_ruler(const Scene& scene, const json::Node& item, Widget& widget) {
  CATENA_CHECK(read_rake(scene, item, widget));
  const json::Node* along = item.find("along");
  if (along == nullptr) return Done{};
  if (along->kind != json::Kind::array || along->items.empty())
    return json::error_at(*along, "\"along\" is no list or empty; names of links [\"curve\", ...] were expected");
  for (const json::Node& node : along->items) {
    CATENA_TRY(const std::string name, json::as_string(node, "along"));
    if (!is_link(scene, name)) {
      std::vector<std::string_view> names;
      scene.world.each<Link>([&](Entity, const Link& link) { names.push_back(link.name); });
      return json::error_at(node, "\"along\" names " + in_quotes(name) +
                                      ", which is no link of the chain; one of its links was expected: " +
                                      (names.empty() ? "it has none" : joined(names)) + suggestion(name, names));
    }
    for (const std::string& other : widget.along)
      if (other == name) return json::error_at(node, "\"along\" names " + in_quotes(name) + " twice; each link once was expected");
    widget.along.push_back(name);
  }
  return Done{};
}

struct Reader {
  Kind kind;
  Outcome (*read)(const Scene&, const json::Node&, Widget&);
  std::vector<std::string_view> keys;
};

/// In the order of kWords.
const std::vector<Reader>& readers() {
  static const std::vector<Reader> all{
      {Kind::cutting_plane, read_cutting_plane, {"center", "normal", "orientation", "snap", "release", "turning", "touch"}},
      {Kind::seed, read_seed, {"position"}},
      {Kind::rake, read_rake, {"from", "to"}},
      {Kind::isolevel, read_isolevel, {"field", "position"}},
      {Kind::box, read_box, {"lo", "hi"}},
      {Kind::ruler, read_ruler, {"from", "to", "along"}}};
  return all;
}

Outcome read_widget(Scene& scene, const json::Node& item) {
  CATENA_TRY(const std::string name, json::require_string(item, "name"));
  if (!is_name(name))
    return json::error_at(*item.find("name"),
                          "widget name " + in_quotes(name) + " is not allowed; a name like [a-z][a-z0-9_]* was expected");
  if (find_widget(scene, name))
    return json::error_at(*item.find("name"), "a second widget is called " + in_quotes(name) + "; a name of its own was expected");
  CATENA_CHECK(json::require_string(item, "type"));
  CATENA_TRY(const int type, json::get_choice(item, "type", 0, {kWords[0], kWords[1], kWords[2], kWords[3], kWords[4], kWords[5]}));
  const Reader& reader = readers()[static_cast<std::size_t>(type)];
  std::vector<std::string_view> keys{"name", "type", "radius", "near", "step", "button", "color"};
  keys.insert(keys.end(), reader.keys.begin(), reader.keys.end());
  CATENA_CHECK(json::only_keys(item, keys));
  Widget widget;
  widget.where = item;
  widget.spec.kind = reader.kind;
  CATENA_CHECK(reader.read(scene, item, widget));
  CATENA_TRY(widget.spec.radius, read_size(item, "radius"));
  CATENA_TRY(widget.spec.near, read_size(item, "near"));
  CATENA_TRY(widget.spec.step, read_size(item, "step"));
  CATENA_TRY(widget.spec.button, json::get_integer(item, "button", widget.spec.button, 1, 32));
  CATENA_TRY(widget.color, read_color(item, "color", widget.color));
  widget.state.pose = widget.spec.pose;
  const Entity entity = scene.world.create();
  scene.world.emplace<Name>(entity, {name});
  scene.world.emplace<Widget>(entity, std::move(widget));
  return Done{};
}

}  // namespace

const char* kind_word(Kind kind) { return kWords[static_cast<std::size_t>(kind)].data(); }

Outcome read_widgets(Scene& scene, const json::Node& node) {
  if (node.kind != json::Kind::array) return json::error_at(node, "\"widgets\" is no array; an array of objects was expected");
  for (const json::Node& item : node.items) {
    CATENA_CHECK(json::expect_object(item, item.label));
    if (scene.world.count<Widget>() == static_cast<std::size_t>(widget::kMaxWidgets))
      return json::error_at(item,
                            "there are more than " + std::to_string(widget::kMaxWidgets) + " widgets; that many at most were expected");
    CATENA_CHECK(read_widget(scene, item));
  }
  return Done{};
}

Result<Entity> read_widget_name(const Scene& scene, const json::Node& object, std::initializer_list<Kind> kinds, std::string_view wanted) {
  CATENA_TRY(const std::string name, json::require_string(object, "widget"));
  const json::Node& node = *object.find("widget");
  if (const Entity found = find_widget(scene, name)) {
    const Kind kind = scene.world.get<Widget>(found).spec.kind;
    for (const Kind k : kinds)
      if (k == kind) return found;
    return json::error_at(
        node, "widget " + in_quotes(name) + " is of type " + in_quotes(kind_word(kind)) + "; " + std::string(wanted) + " was expected");
  }
  std::vector<std::string_view> names;
  scene.world.each<Widget>([&](Entity e, const Widget&) { names.push_back(scene.world.get<Name>(e).value); });
  return json::error_at(node, "unknown widget " + in_quotes(name) + "; one of the scene's \"widgets\" was expected: " +
                                  (names.empty() ? "it has none" : joined(names)) + suggestion(name, names));
}

}  // namespace catena::scene
