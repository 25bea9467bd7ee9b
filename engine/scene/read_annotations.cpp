#include "engine/base/numbers.h"
#include "engine/base/text.h"
#include "engine/scene/read_parts.h"

namespace catena::scene {
namespace {

constexpr double kMostPoints = 576;

/// What has colours that a bar can show; drawn or hidden.
bool has_colors(const World& world, Entity e) {
  return world.has<Volume>(e) || world.has<Slice>(e) || (world.has<StreamlineSet>(e) && world.get<StreamlineSet>(e).color_by);
}

template <class T>
std::vector<Entity> owners_of(const World& world) {
  std::vector<Entity> owners;
  world.each<T>([&](Entity e, const T&) { owners.push_back(e); });
  return owners;
}

/// Member `key` as an index into the entities that own a T.
template <class T>
Result<Entity> read_index(const Scene& scene, const json::Node& object, std::string_view key, std::string_view what) {
  const std::vector<Entity> owners = owners_of<T>(scene.world);
  const json::Node& node = *object.find(key);
  if (owners.empty()) return json::error_at(node, "the scene has no " + std::string(what) + "; one was expected for a scalar bar");
  CATENA_TRY(const int index, json::get_integer(object, key, 0, 0, static_cast<int>(owners.size()) - 1));
  return owners[static_cast<std::size_t>(index)];
}

/// The first thing with colours that shows a field.
Entity shown_field(const World& world, Entity field) {
  Entity found;
  const auto take = [&](Entity e, bool shows) {
    if (!found && shows && has_colors(world, e)) found = e;
  };
  world.each<Volume>([&](Entity e, const Volume& volume) { take(e, volume.field == field); });
  world.each<Slice>([&](Entity e, const Slice& slice) { take(e, slice.shown.field == field); });
  world.each<StreamlineSet>([&](Entity e, const StreamlineSet& set) {
    const bool other = set.color_by && set.color_by->what == ColorBy::What::field;
    take(e, (other ? set.color_by->field : set.field) == field);
  });
  return found;
}

Result<Entity> read_shown(const Scene& scene, const json::Node& item) {
  int given = 0;
  for (const char* key : {"volume", "slice", "streamlines", "field"}) given += item.find(key) != nullptr;
  if (given != 1)
    return json::error_at(item, "a scalar bar names " + std::string(given == 0 ? "nothing" : "several things") +
                                    "; one of \"volume\": INDEX, \"slice\": INDEX, \"streamlines\": INDEX, \"field\": NAME was expected");
  if (item.find("volume")) return read_index<Volume>(scene, item, "volume", "volumes");
  if (item.find("slice")) return read_index<Slice>(scene, item, "slice", "slices");
  if (const json::Node* node = item.find("streamlines")) {
    CATENA_TRY(const Entity set, read_index<StreamlineSet>(scene, item, "streamlines", "streamlines"));
    if (!has_colors(scene.world, set))
      return json::error_at(*node, "these streamlines have one colour; a set with \"color_by\" was expected for a scalar bar");
    return set;
  }
  CATENA_TRY(const Entity field, read_field_name(scene, item));
  const Entity shown = shown_field(scene.world, field);
  if (!shown)
    return json::error_at(*item.find("field"), "no volume, slice or coloured streamlines show " +
                                                   in_quotes(scene.world.get<Name>(field).value) + "; a field with colours was expected");
  return shown;
}

/// One number's format: text, %, an optional precision, one of e f g, text. Nothing else of printf.
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

Result<double> read_points(const json::Node& object, std::string_view key, double fallback) {
  CATENA_TRY(const double size, json::get_number(object, key, fallback, json::Range::positive));
  if (size > kMostPoints)
    return json::error_at(*object.find(key),
                          in_quotes(key) + " is " + to_text(size) + "; points were expected, of which the picture's shorter side has 576");
  return size;
}

Result<std::optional<Rgb>> read_optional_color(const json::Node& object) {
  if (object.find("color") == nullptr) return std::optional<Rgb>();
  CATENA_TRY(const Rgb color, read_color(object, "color", {}));
  return std::optional<Rgb>(color);
}

}  // namespace

std::optional<ScalarBar> first_scalar_bar(const World& world) {
  std::optional<ScalarBar> bar;
  const auto take = [&](Entity e) {
    if (bar || !has_colors(world, e)) return;
    bar.emplace();
    bar->shown = e;
  };
  world.each<Volume>([&](Entity e, const Volume&) { take(e); });
  world.each<Slice>([&](Entity e, const Slice&) { take(e); });
  world.each<StreamlineSet>([&](Entity e, const StreamlineSet&) { take(e); });
  return bar;
}

Outcome read_scalar_bars(Scene& scene, const json::Node& node) {
  if (node.kind != json::Kind::array) return json::error_at(node, "\"scalar_bars\" is no array; an array of objects was expected");
  for (const json::Node& item : node.items) {
    CATENA_CHECK(json::expect_object(item, item.label));
    CATENA_CHECK(json::only_keys(item, {"volume", "slice", "streamlines", "field", "title", "position", "ticks", "format"}));
    ScalarBar bar;
    bar.where = item;
    CATENA_TRY(bar.shown, read_shown(scene, item));
    if (item.find("title")) {
      CATENA_TRY(bar.title, json::require_string(item, "title"));
    }
    CATENA_TRY(const int side, json::get_choice(item, "position", 0, {"right", "left", "bottom", "top"}));
    bar.side = static_cast<PictureSide>(side);
    CATENA_TRY(bar.ticks, json::get_integer(item, "ticks", bar.ticks, 2, 50));
    CATENA_TRY(bar.format, json::get_string(item, "format", ""));
    if (item.find("format") && !is_format(bar.format))
      return json::error_at(*item.find("format"),
                            "\"format\" is " + in_quotes(bar.format) + "; one number like \"%.2f\", \"%.3e\" or \"%g K\" was expected");
    scene.annotations.scalar_bars.push_back(std::move(bar));
  }
  return Done{};
}

Outcome read_labels(Scene& scene, const json::Node& node) {
  if (node.kind != json::Kind::array) return json::error_at(node, "\"labels\" is no array; an array of objects was expected");
  for (const json::Node& item : node.items) {
    CATENA_CHECK(json::expect_object(item, item.label));
    CATENA_CHECK(json::only_keys(item, {"at", "text", "color", "size", "dot", "hidden_behind"}));
    Label label;
    CATENA_TRY(label.at, json::require_vec3(item, "at"));
    CATENA_TRY(label.text, json::require_string(item, "text"));
    CATENA_TRY(label.color, read_optional_color(item));
    CATENA_TRY(label.size_pt, read_points(item, "size", label.size_pt));
    CATENA_TRY(label.dot, json::get_boolean(item, "dot", label.dot));
    CATENA_TRY(label.hidden_behind, json::get_boolean(item, "hidden_behind", label.hidden_behind));
    scene.annotations.labels.push_back(std::move(label));
  }
  return Done{};
}

Outcome read_title(Scene& scene, const json::Node& node) {
  CATENA_TRY(scene.annotations.title, json::as_string(node, "title"));
  return Done{};
}

Outcome read_orientation_marker(Scene& scene, const json::Node& node) {
  if (node.kind == json::Kind::boolean) {
    if (node.boolean) scene.annotations.orientation_marker.emplace();
    return Done{};
  }
  if (node.kind != json::Kind::object)
    return json::error_at(node, "\"orientation_marker\" is neither; true, false or an object was expected");
  CATENA_CHECK(json::only_keys(node, {"position", "size", "names"}));
  OrientationMarker marker;
  CATENA_TRY(const int corner, json::get_choice(node, "position", 0, {"bottom-left", "bottom-right", "top-left", "top-right"}));
  marker.corner = static_cast<PictureCorner>(corner);
  CATENA_TRY(marker.size_pt, read_points(node, "size", marker.size_pt));
  if (const json::Node* names = node.find("names")) {
    if (names->kind != json::Kind::array || names->items.size() != 3)
      return json::error_at(*names, "\"names\" is no list of three; the names of x, y and z were expected");
    for (std::size_t i = 0; i < 3; ++i) {
      CATENA_TRY(marker.names[i], json::as_string(names->items[i], "names"));
    }
  }
  scene.annotations.orientation_marker = std::move(marker);
  return Done{};
}

Outcome read_status(Scene& scene, const json::Node& node) {
  if (node.kind != json::Kind::boolean) return json::error_at(node, "\"status\" is no switch; true or false was expected");
  scene.annotations.status = node.boolean;
  return Done{};
}

/// What all text has in common.
Outcome read_overlay(Scene& scene, const json::Node& node) {
  CATENA_CHECK(json::expect_object(node, "overlay"));
  CATENA_CHECK(json::only_keys(node, {"font", "scale", "color"}));
  Annotations& all = scene.annotations;
  CATENA_TRY(all.font, json::get_string(node, "font", all.font));
  CATENA_TRY(all.scale, json::get_number(node, "scale", all.scale, json::Range::positive));
  if (all.scale > 20)
    return json::error_at(*node.find("scale"), "\"scale\" is " + to_text(all.scale) + "; a factor of at most 20 was expected");
  CATENA_TRY(all.color, read_optional_color(node));
  return Done{};
}

}  // namespace catena::scene
