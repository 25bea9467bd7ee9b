/// The eye and the picture: "camera", "background", "quality", "jitter".
#include "engine/base/eye_limits.h"
#include "engine/base/numbers.h"
#include "engine/base/text.h"
#include "engine/scene/scene_keys.h"
#include "engine/scene/write_values.h"

namespace catena::scene {

namespace {

/// What one key alone cannot tell.
Outcome check_camera(Scene&, const json::Node& node, Camera& camera) {
  const Vec3 view = camera.target - camera.position;
  if (const std::string problem = eye_problem(camera.position, camera.target); !problem.empty())
    return json::error_at(*node.find("target"), "\"target\": " + problem);
  const auto parallel = [&](const Vec3& v) { return norm(cross(direction(view), direction(v))) < 1e-9; };
  const json::Node* up = node.find("up");
  if (up != nullptr && parallel(camera.up)) return json::error_at(*up, "\"up\" is parallel to the view; a vector across it was expected");
  if (up == nullptr && parallel(camera.up)) camera.up = {0.0, 1.0, 0.0};
  if (const std::string problem = fovy_problem(camera.fovy_deg); !problem.empty())
    return json::error_at(*node.find("fovy_deg"), "\"fovy_deg\" " + problem);
  const json::Node* height = node.find("height");
  if (!camera.orthographic && height != nullptr)
    return json::error_at(*height, "\"height\" is given without \"projection\": \"orthographic\"; \"fovy_deg\" was expected");
  if (camera.orthographic && height == nullptr) CATENA_CHECK(json::require_number(node, "height", json::Range::positive));
  if (camera.orthographic && !(camera.height >= kLeastEyeHeight && camera.height <= kMaxEyeHeight))
    return json::error_at(*height, "\"height\" is " + to_text(camera.height) + "; a length from " + to_text(kLeastEyeHeight) + " to " +
                                       to_text(kMaxEyeHeight) + " was expected");
  camera.given = true;
  return Done{};
}

const Table<Camera>& camera_table() {
  static const auto table = [] {
    Table<Camera> t;
    t.bind(schema::vec3("position", "world", "Of the eye.").ranged("to 1e15").required(), &Camera::position);
    t.bind(schema::vec3("target", "world", "Where it looks.").ranged("to 1e15").required(), &Camera::target);
    t.bind(schema::direction("up", "What is up in the picture; not along the view."), &Camera::up);
    t.bind(schema::number("fovy_deg", "degrees", "Vertical angle of view.").positive().ranged("0.001 to 179.9"), &Camera::fovy_deg);
    t.bind(schema::word("projection", {"perspective", "orthographic"}, "How depth becomes size."), &Camera::orthographic);
    t.hand(
        schema::number("height", "world", "Height of an orthographic picture, which needs it; of no other.").ranged("1e-15 to 1e15"),
        [](Scene&, const json::Node& node, Camera& camera) {
          return schema::read_value(schema::number("height", "", "").positive(), node, camera.height);
        },
        [](const Scene&, const Camera& camera) { return camera.orthographic ? schema::write_value(camera.height) : std::string(); });
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
  const auto color = json::as_vec3(node, "background");
  const bool good = color && std::min({color->x, color->y, color->z}) >= 0 && std::max({color->x, color->y, color->z}) <= 1;
  if (!good) return json::error_at(node, "\"background\" is no colour; " + expected);
  scene.background.color = {static_cast<float>(color->x), static_cast<float>(color->y), static_cast<float>(color->z)};
  return Done{};
}

Outcome read_quality(Scene& scene, const json::Node& node) {
  const std::string& word = node.string;
  bool good = node.kind == json::Kind::string && (word == "draft" || word == "balanced" || word == "reference");
  for (std::string_view prefix : {"time=", "error="})
    if (node.kind == json::Kind::string && word.starts_with(prefix)) {
      const auto value = parse_double(std::string_view(word).substr(prefix.size()));
      good = value && std::isfinite(*value) && *value > 0;
    }
  if (!good) return json::error_at(node, "\"quality\" is not known; one of draft, balanced, reference, time=MS, error=E was expected");
  scene.quality = word;
  return Done{};
}

Outcome read_jitter(Scene& scene, const json::Node& node) {
  if (node.kind != json::Kind::boolean) return json::error_at(node, "\"jitter\" is no truth value; true or false was expected");
  scene.jitter = node.boolean;
  return Done{};
}

using schema::Component;

}  // namespace

Part camera_part() {
  return {{"camera", "The eye. Without it the picture is fitted to what is drawn.", Component::Shape::object, camera_table().keys()},
          read_camera};
}

Part background_part() {
  const Key key =
      schema::any_of("background", {schema::color("", ""), schema::word("", {"transparent"}, "")}, "A colour, or `transparent`.")
          .by_default(schema::write_value(Background{}.color));
  return {{"background", "Behind everything.", Component::Shape::value, {key}}, read_background};
}

Part quality_part() {
  const Key key = schema::text("quality", "`draft`, `balanced`, `reference`, `time=MS` or `error=E`, as of `render --quality`.")
                      .by_default("\"balanced\"");
  return {{"quality", "How good the picture is to be, and how fast.", Component::Shape::value, {key}}, read_quality};
}

Part jitter_part() {
  const Key key = schema::boolean("jitter", "Grain instead of rings in volumes.").by_default("false");
  return {{"jitter", "Grain instead of rings in volumes.", Component::Shape::value, {key}}, read_jitter};
}

std::string text_of(const Camera& camera) { return camera_table().write({}, camera); }

}  // namespace catena::scene
