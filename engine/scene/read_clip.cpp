/// "clip": [{"plane": {"point", "normal"}}, {"box": {"lo", "hi"}}]: what every one of them keeps is drawn.
#include "engine/base/text.h"
#include "engine/scene/read_parts.h"

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

}  // namespace

Outcome read_clip(Scene& scene, const json::Node& node) {
  if (node.kind != json::Kind::array) return json::error_at(node, "\"clip\" is no array; an array of objects was expected");
  for (const json::Node& item : node.items) {
    CATENA_CHECK(json::expect_object(item, item.label));
    CATENA_CHECK(json::only_keys(item, {"plane", "box"}));
    const json::Node *plane = item.find("plane"), *box = item.find("box");
    if ((plane != nullptr) == (box != nullptr))
      return json::error_at(item, "a clip names a plane or a box; one of \"plane\" and \"box\" was expected");
    CATENA_CHECK(plane ? read_plane(scene, *plane) : read_box(scene, *box));
    if (scene.clip.size() > kMostClipPlanes)
      return json::error_at(
          item, "there are more than " + std::to_string(kMostClipPlanes) + " clip planes (a box is six); that many at most were expected");
  }
  return Done{};
}

}  // namespace catena::scene
