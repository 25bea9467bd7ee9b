/// "clip": [{"plane": {"point", "normal"}}, {"box": {"lo", "hi"}}, {"widget": NAME, "side": "front|behind"}]: what every one of them
/// keeps is drawn.
#include "engine/base/text.h"
#include "engine/scene/read_parts.h"
#include "engine/scene/widgets.h"

namespace catena::scene {
namespace {

Outcome read_plane(Scene& scene, const json::Node& node) {
  CATENA_CHECK(json::expect_object(node, "plane"));
  CATENA_CHECK(json::only_keys(node, {"point", "normal"}));
  ClipPlane plane;
  CATENA_TRY(plane.point, json::require_vec3(node, "point"));
  CATENA_TRY(plane.normal, json::require_vec3(node, "normal"));
  if (max_abs(plane.normal) == 0)
    return json::error_at(*node.find("normal"), "\"normal\" is zero; a vector other than [0, 0, 0] was expected");
  scene.clip.push_back(plane);
  return Done{};
}

Outcome read_box(Scene& scene, const json::Node& node) {
  CATENA_CHECK(json::expect_object(node, "box"));
  CATENA_CHECK(json::only_keys(node, {"lo", "hi"}));
  CATENA_TRY(const Vec3 lo, json::require_vec3(node, "lo"));
  CATENA_TRY(const Vec3 hi, json::require_vec3(node, "hi"));
  for (int i = 0; i < 3; ++i)
    if (!(lo[i] < hi[i])) return json::error_at(*node.find("hi"), "\"hi\" is not above \"lo\" on every axis; a box was expected");
  for (int i = 0; i < 3; ++i) {
    Vec3 axis(0.0);
    axis[i] = 1;
    scene.clip.push_back({lo, axis});
    scene.clip.push_back({hi, -axis});
  }
  return Done{};
}

/// A cutting plane is one plane, a box six.
Outcome read_followed(Scene& scene, const json::Node& item) {
  CATENA_CHECK(json::only_keys(item, {"widget", "side"}));
  ClipPlane plane;
  CATENA_TRY(plane.widget, read_widget_name(scene, item, {widget::Kind::cutting_plane, widget::Kind::box}, "a cutting plane or a box"));
  const widget::Spec& spec = scene.world.get<Widget>(plane.widget).spec;
  CATENA_TRY(const int side, json::get_choice(item, "side", 0, {"front", "behind"}));
  plane.behind = side == 1;
  if (spec.kind == widget::Kind::cutting_plane) {
    scene.clip.push_back(clip_of(spec.pose, plane));
    return Done{};
  }
  if (const json::Node* node = item.find("side"))
    return json::error_at(*node, "\"side\" is given with a box, which keeps its inside; it belongs to a cutting plane");
  for (plane.box_face = 0; plane.box_face < 6; ++plane.box_face) scene.clip.push_back(clip_of(spec.pose, plane));
  return Done{};
}

}  // namespace

Outcome read_clip(Scene& scene, const json::Node& node) {
  if (node.kind != json::Kind::array) return json::error_at(node, "\"clip\" is no array; an array of objects was expected");
  for (const json::Node& item : node.items) {
    CATENA_CHECK(json::expect_object(item, item.label));
    CATENA_CHECK(json::only_keys(item, {"plane", "box", "widget", "side"}));
    const json::Node *plane = item.find("plane"), *box = item.find("box"), *widget = item.find("widget");
    if ((plane != nullptr) + (box != nullptr) + (widget != nullptr) != 1)
      return json::error_at(item, "a clip names a plane, a box or a widget; one of \"plane\", \"box\" and \"widget\" was expected");
    if (const json::Node* side = item.find("side"); side != nullptr && widget == nullptr)
      return json::error_at(*side, "\"side\" is given without \"widget\"; the name of a cutting plane was expected beside it");
    CATENA_CHECK(plane ? read_plane(scene, *plane) : box ? read_box(scene, *box) : read_followed(scene, item));
    if (scene.clip.size() > kMostClipPlanes)
      return json::error_at(
          item, "there are more than " + std::to_string(kMostClipPlanes) + " clip planes (a box is six); that many at most were expected");
  }
  return Done{};
}

}  // namespace catena::scene
