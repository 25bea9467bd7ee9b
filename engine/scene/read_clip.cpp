/// "clip": planes, boxes and widgets; what every one of them keeps is drawn.
#include "engine/base/text.h"
#include "engine/scene/scene_keys.h"
#include "engine/scene/widgets.h"
#include "engine/scene/write_values.h"

namespace catena::scene {
namespace {

const Table<ClipPlane>& plane_table() {
  static const auto table = [] {
    Table<ClipPlane> t;
    t.bind(schema::vec3("point", "world", "A point of the plane.").required(), &ClipPlane::point);
    t.bind(schema::direction("normal", "Points to what is kept; of any length.").required(), &ClipPlane::normal);
    return t;
  }();
  return table;
}

struct Box {
  Vec3 lo{0.0}, hi{0.0};
};

const Table<Box>& box_table() {
  static const auto table = [] {
    Table<Box> t;
    t.bind(schema::vec3("lo", "world", "Its lowest corner.").required(), &Box::lo);
    t.bind(schema::vec3("hi", "world", "Its highest corner.").required(), &Box::hi);
    t.check([](Scene&, const json::Node& node, Box& box) -> Outcome {
      for (int i = 0; i < 3; ++i)
        if (!(box.lo[i] < box.hi[i]))
          return json::error_at(*node.find("hi"), "\"hi\" is not above \"lo\" on every axis; a box was expected");
      return Done{};
    });
    return t;
  }();
  return table;
}

Keys clip_keys() {
  return {schema::object("plane", plane_table().keys(), "Keeps the side to which the normal points."),
          schema::object("box", box_table().keys(), "Keeps the inside."),
          schema::named("widget", Role::widget, "Follows a cutting plane, or a box."),
          schema::word("side", {"front", "behind"}, "Of a cutting plane that is followed: which side is kept.").by_default("\"front\"")};
}

Outcome read_plane(Scene& scene, const json::Node& node) {
  CATENA_CHECK(json::expect_object(node, "plane"));
  ClipPlane plane;
  CATENA_CHECK(plane_table().read(scene, node, plane));
  scene.clip.push_back(plane);
  return Done{};
}

Outcome read_box(Scene& scene, const json::Node& node) {
  CATENA_CHECK(json::expect_object(node, "box"));
  Box box;
  CATENA_CHECK(box_table().read(scene, node, box));
  for (int i = 0; i < 3; ++i) {
    Vec3 axis(0.0);
    axis[i] = 1;
    scene.clip.push_back({{box.lo, axis}});
    scene.clip.push_back({{box.hi, -axis}});
  }
  return Done{};
}

/// A cutting plane is one plane, a box six.
Outcome read_followed(Scene& scene, const json::Node& item) {
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

Outcome read_clip(Scene& scene, const json::Node& node) {
  return each_item(node, [&](const json::Node& item) -> Outcome {
    CATENA_CHECK(json::only_keys(item, schema::names_of(clip_keys())));
    const json::Node *plane = item.find("plane"), *box = item.find("box"), *widget = item.find("widget");
    if ((plane != nullptr) + (box != nullptr) + (widget != nullptr) != 1)
      return json::error_at(item, "a clip names a plane, a box or a widget; one of \"plane\", \"box\" and \"widget\" was expected");
    if (const json::Node* side = item.find("side"); side != nullptr && widget == nullptr)
      return json::error_at(*side, "\"side\" is given without \"widget\"; the name of a cutting plane was expected beside it");
    CATENA_CHECK(plane ? read_plane(scene, *plane) : box ? read_box(scene, *box) : read_followed(scene, item));
    if (scene.clip.size() > kMaxClipPlanes)
      return json::error_at(
          item, "there are more than " + std::to_string(kMaxClipPlanes) + " clip planes (a box is six); that many at most were expected");
    return Done{};
  });
}

}  // namespace

Part clip_part() {
  return {{"clip", "What every item keeps is drawn. A box counts as six planes, and at most eight planes are allowed.",
           schema::Component::Shape::list, clip_keys()},
          read_clip};
}

std::string text_of(const ClipPlane& plane) { return "{\"plane\": " + plane_table().write({}, plane) + "}"; }

}  // namespace catena::scene
