// SPDX-License-Identifier: MIT
/// Reads the camera and the image: "camera", "background", "quality", "jitter", "stretch", and "clip".
#include "engine/base/camera_limits.h"
#include "engine/base/numbers.h"
#include "engine/base/text.h"
#include "engine/scene/readers.h"
#include "engine/scene/to_json.h"
#include "engine/scene/widgets.h"

namespace catena::scene {

namespace {

/// Checks constraints between several keys of the camera.
Outcome check_camera(Scene&, const json::Node& node, Camera& camera) {
  const Vec3 view = camera.target - camera.position;
  if (const std::string problem = validate_view(camera.position, camera.target); !problem.empty())
    return json::error_at(*node.find("target"), "\"target\": " + problem);
  const auto parallel = [&](const Vec3& v) { return norm(cross(direction(view), direction(v))) < 1e-9; };
  const json::Node* up = node.find("up");
  if (up != nullptr && parallel(camera.up))
    return json::error_at(*up, "\"up\" is parallel to the view direction; a vector in another direction was expected");
  if (up == nullptr && parallel(camera.up)) camera.up = {0.0, 1.0, 0.0};
  if (const std::string problem = validate_fovy(camera.fovy_deg); !problem.empty())
    return json::error_at(*node.find("fovy_deg"), "\"fovy_deg\" " + problem);
  const json::Node* height = node.find("height");
  if (!camera.orthographic && height != nullptr)
    return json::error_at(*height, "\"height\" is given without \"projection\": \"orthographic\"; \"fovy_deg\" was expected");
  if (camera.orthographic && height == nullptr) CATENA_CHECK(json::require_number(node, "height", json::NumberRange::positive));
  if (camera.orthographic && !(camera.ortho_height >= kMinOrthoHeight && camera.ortho_height <= kMaxOrthoHeight))
    return json::error_at(*height, "\"height\" is " + to_text(camera.ortho_height) + "; a length from " + to_text(kMinOrthoHeight) +
                                       " to " + to_text(kMaxOrthoHeight) + " was expected");
  camera.is_explicit = true;
  return Done{};
}

const Table<Camera>& camera_table() {
  static const auto table = [] {
    Table<Camera> t;
    t.bind(schema::vec3("position", "world", "Position of the camera.").with_range_text("to 1e15").required(), &Camera::position);
    t.bind(schema::vec3("target", "world", "Point that the camera looks at.").with_range_text("to 1e15").required(), &Camera::target);
    t.bind(
        schema::direction(
            "up", "Up direction of the image; not parallel to the view direction. A default that is parallel is replaced by `[0, 1, 0]`."),
        &Camera::up);
    t.bind(schema::number("fovy_deg", "degrees", "Vertical angle of view of a perspective camera.")
               .positive()
               .with_range_text("0.001 to 179.9"),
           &Camera::fovy_deg);
    t.bind(schema::choice("projection", {"perspective", "orthographic"}, "Projection of the image."), &Camera::orthographic);
    t.custom(
        schema::number("height", "world",
                       "Height of an orthographic image; required with, and allowed only with, `\"projection\": \"orthographic\"`.")
            .with_range_text("1e-15 to 1e15"),
        [](Scene&, const json::Node& node, Camera& camera) {
          return schema::read_value(schema::number("height", "", "").positive(), node, camera.ortho_height);
        },
        [](const Scene&, const Camera& camera) { return camera.orthographic ? schema::write_value(camera.ortho_height) : std::string(); });
    t.check(check_camera);
    return t;
  }();
  return table;
}

Outcome read_camera(Scene& scene, const json::Node& node) {
  CATENA_CHECK(json::expect_object(node, "camera"));
  return camera_table().read(scene, node, scene.camera);
}

Outcome read_background(Scene& scene, const json::Node& node) {
  if (node.kind == json::Kind::string && node.string == "transparent") {
    scene.background.transparent = true;
    return Done{};
  }
  const std::string expected = "[r, g, b] with components from 0 to 1, or \"transparent\", was expected";
  const auto color = as_color(node);
  if (!color) return json::error_at(node, "\"background\" is not a colour; " + expected);
  scene.background.color = *color;
  return Done{};
}

Outcome read_quality(Scene& scene, const json::Node& node) {
  const std::string& word = node.string;
  bool valid = node.kind == json::Kind::string && (word == "draft" || word == "balanced" || word == "reference");
  for (std::string_view prefix : {"time=", "error=", "step="})
    if (node.kind == json::Kind::string && word.starts_with(prefix)) {
      const auto value = parse_double(std::string_view(word).substr(prefix.size()));
      valid = value && std::isfinite(*value) && *value > 0 && (prefix != "step=" || (*value >= 0.01 && *value <= 100));
    }
  if (!valid)
    return json::error_at(
        node, "\"quality\" is not known; draft, balanced, reference, time=MS, error=E or step=VOXELS (0.01 to 100) was expected");
  scene.quality = word;
  scene.tuning.set_image_targets(image_targets(word));
  return Done{};
}

constexpr double kMaxStretchRatio = 1e9;

Outcome read_jitter(Scene& scene, const json::Node& node) { return read_boolean(node, scene.jitter.emplace()); }

Outcome read_stretch(Scene& scene, const json::Node& node) {
  const auto factors = json::as_vec3(node, "stretch");
  if (!factors || !(std::min({factors->x, factors->y, factors->z}) > 0))
    return json::error_at(node, "\"stretch\" is not three factors; [x, y, z], each above 0, was expected");
  const double ratio = std::max({factors->x, factors->y, factors->z}) / std::min({factors->x, factors->y, factors->z});
  if (!(ratio <= kMaxStretchRatio))
    return json::error_at(node, "the factors of \"stretch\" differ by more than 1e9; a smaller ratio was expected");
  scene.stretch = *factors;
  return Done{};
}

using schema::Section;

}  // namespace

std::optional<Color> as_color(const json::Node& node) {
  const auto color = json::as_vec3(node, node.label);
  if (!color || std::min({color->x, color->y, color->z}) < 0 || std::max({color->x, color->y, color->z}) > 1) return std::nullopt;
  return Color{static_cast<float>(color->x), static_cast<float>(color->y), static_cast<float>(color->z)};
}

TuningTargets image_targets(std::string_view quality) {
  TuningTargets targets;
  if (quality.starts_with("error=")) targets.max_image_error = parse_double(quality.substr(6));
  if (quality.starts_with("time=")) targets.max_image_ms = parse_double(quality.substr(5));
  return targets;
}

Part camera_part() {
  return {{"camera", "Camera. Default: fitted to the visible objects.", Section::Layout::object, camera_table().keys()}, read_camera};
}

Part background_part() {
  const Key key =
      schema::any_of("background", {schema::color("", ""), schema::choice("", {"transparent"}, "")}, "Background colour, or `transparent`.")
          .with_default(schema::write_value(Background{}.color));
  return {{"background", "Background of the image.", Section::Layout::value, {key}}, read_background};
}

Part quality_part() {
  const Key key =
      schema::text("quality",
                   "Quality of images: `draft`, `balanced`, `reference`, `time=MS`, `error=E` or `step=VOXELS`, as in `render --quality`.")
          .with_default("\"balanced\"");
  return {{"quality", "Quality of images, or a target for their error or time.", Section::Layout::value, {key}}, read_quality};
}

Part jitter_part() {
  const Key key =
      schema::boolean("jitter",
                      "Random offset of the ray samples in volumes: noise in place of ring artefacts. No effect on the fast raycast.")
          .with_default("set by `quality`");
  return {{"jitter", "Random offset of the ray samples in volumes.", Section::Layout::value, {key}}, read_jitter};
}

Part stretch_part() {
  const Key key = schema::vec3("stretch", "",
                               "Factors along x, y and z by which the image is stretched, for axes of different units or extents. Lengths "
                               "that are measured, and forces, stay in world units; positions of the camera are those of the image.")
                      .with_default("[1, 1, 1]");
  return {{"stretch", "Stretch of the image along the axes.", Section::Layout::value, {key}}, read_stretch};
}

std::string to_json(const Camera& camera) { return camera_table().write({}, camera); }

/// Reads "clip": planes, boxes and widgets; the intersection of the regions that they keep is rendered.

namespace {

const Table<ClipPlane>& plane_table() {
  static const auto table = [] {
    Table<ClipPlane> t;
    t.bind(schema::vec3("point", "world", "Point on the plane.").required(), &ClipPlane::point);
    t.bind(schema::direction("normal", "Normal of the plane, of any length; points to the side that is kept.").required(),
           &ClipPlane::normal);
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
    t.bind(schema::vec3("min", "world", "Minimum corner of the box.").required(), &Box::lo);
    t.bind(schema::vec3("max", "world", "Maximum corner of the box, greater than `min` on every axis.").required(), &Box::hi);
    t.check([](Scene&, const json::Node& node, Box& box) -> Outcome {
      for (int i = 0; i < 3; ++i)
        if (!(box.lo[i] < box.hi[i]))
          return json::error_at(*node.find("max"), "\"max\" is not above \"min\" on every axis; a box was expected");
      return Done{};
    });
    return t;
  }();
  return table;
}

Keys clip_keys() {
  return {schema::object("plane", plane_table().keys(), "Plane that keeps the side to which the normal points."),
          schema::object("box", box_table().keys(), "Box that keeps the inside."),
          schema::reference("widget", Role::widget, "Cutting plane or box widget that moves the clip planes."),
          schema::choice("side", {"front", "behind"},
                         "Side of the cutting plane that is kept; `front`: the side to which the normal points. For cutting planes only.")
              .with_default("\"front\"")};
}

Outcome read_plane(Scene& scene, const json::Node& node) {
  CATENA_CHECK(json::expect_object(node, "plane"));
  ClipPlane plane;
  CATENA_CHECK(plane_table().read(scene, node, plane));
  scene.clip_planes.push_back(plane);
  return Done{};
}

Outcome read_box(Scene& scene, const json::Node& node) {
  CATENA_CHECK(json::expect_object(node, "box"));
  Box box;
  CATENA_CHECK(box_table().read(scene, node, box));
  for (int i = 0; i < 3; ++i) {
    Vec3 axis(0.0);
    axis[i] = 1;
    scene.clip_planes.push_back({{box.lo, axis}});
    scene.clip_planes.push_back({{box.hi, -axis}});
  }
  return Done{};
}

/// Reads a clip item bound to a widget. A cutting plane counts as one plane, a box as six.
Outcome read_followed(Scene& scene, const json::Node& item) {
  ClipPlane plane;
  CATENA_TRY(plane.widget, read_widget_name(scene, item, {widget::Kind::cutting_plane, widget::Kind::box}, "a cutting plane or a box"));
  const widget::Spec& spec = scene.entities.get<Widget>(plane.widget).spec;
  CATENA_TRY(const int side, json::get_choice(item, "side", 0, {"front", "behind"}));
  plane.keep_back_side = side == 1;
  if (spec.kind == widget::Kind::cutting_plane) {
    scene.clip_planes.push_back(make_clip_plane(spec.pose, plane));
    return Done{};
  }
  if (const json::Node* node = item.find("side"))
    return json::error_at(*node, "\"side\" is given with a box widget; it was expected with a cutting plane only");
  for (plane.box_face = 0; plane.box_face < 6; ++plane.box_face) scene.clip_planes.push_back(make_clip_plane(spec.pose, plane));
  return Done{};
}

Outcome read_clip(Scene& scene, const json::Node& node) {
  return each_item(node, [&](const json::Node& item) -> Outcome {
    CATENA_CHECK(json::check_known_keys(item, schema::key_names(clip_keys())));
    const json::Node *plane = item.find("plane"), *box = item.find("box"), *widget = item.find("widget");
    if ((plane != nullptr) + (box != nullptr) + (widget != nullptr) != 1)
      return json::error_at(
          item,
          "a clip names none or several of a plane, a box and a widget; exactly one of \"plane\", \"box\" and \"widget\" was expected");
    if (const json::Node* side = item.find("side"); side != nullptr && widget == nullptr)
      return json::error_at(*side, "\"side\" is given without \"widget\"; the name of a cutting plane was expected beside it");
    CATENA_CHECK(plane ? read_plane(scene, *plane) : box ? read_box(scene, *box) : read_followed(scene, item));
    if (scene.clip_planes.size() > kMaxClipPlanes)
      return json::error_at(
          item, "there are more than " + std::to_string(kMaxClipPlanes) + " clip planes (a box is six); that many at most were expected");
    return Done{};
  });
}

}  // namespace

Part clip_part() {
  return {{"clip",
           "Clip planes and boxes: the intersection of the regions that they keep is rendered. A box counts as six planes; the maximum is "
           "eight.",
           schema::Section::Layout::list, clip_keys()},
          read_clip};
}

std::string to_json(const ClipPlane& plane) { return "{\"plane\": " + plane_table().write({}, plane) + "}"; }

}  // namespace catena::scene
