#include "engine/base/eye_limits.h"
#include "engine/base/numbers.h"
#include "engine/base/text.h"
#include "engine/scene/read_parts.h"

namespace catena::scene {

Outcome read_camera(Scene& scene, const json::Node& node) {
  CATENA_CHECK(json::expect_object(node, "camera"));
  CATENA_CHECK(json::only_keys(node, {"position", "target", "up", "fovy_deg", "projection", "height"}));
  Camera& camera = scene.camera;
  CATENA_TRY(camera.position, json::require_vec3(node, "position"));
  CATENA_TRY(camera.target, json::require_vec3(node, "target"));
  CATENA_TRY(const auto up, json::get_optional_vec3(node, "up"));
  const Vec3 view = camera.target - camera.position;
  if (const std::string problem = eye_problem(camera.position, camera.target); !problem.empty())
    return json::error_at(*node.find("target"), "\"target\": " + problem);
  const auto parallel = [&](const Vec3& v) { return norm(cross(direction(view), direction(v))) < 1e-9; };
  if (up && norm(*up) == 0) return json::error_at(*node.find("up"), "\"up\" is zero; a vector other than [0, 0, 0] was expected");
  if (up && parallel(*up)) return json::error_at(*node.find("up"), "\"up\" is parallel to the view; a vector across it was expected");
  if (up) camera.up = *up;
  if (!up && parallel(camera.up)) camera.up = {0.0, 1.0, 0.0};

  CATENA_TRY(camera.fovy_deg, json::get_number(node, "fovy_deg", camera.fovy_deg, json::Range::positive));
  if (const std::string problem = fovy_problem(camera.fovy_deg); !problem.empty())
    return json::error_at(*node.find("fovy_deg"), "\"fovy_deg\" " + problem);
  CATENA_TRY(const int projection, json::get_choice(node, "projection", 0, {"perspective", "orthographic"}));
  camera.orthographic = projection == 1;
  if (camera.orthographic) {
    CATENA_TRY(camera.height, json::require_number(node, "height", json::Range::positive));
    if (!(camera.height >= kLeastEyeHeight && camera.height <= kMostEyeHeight))
      return json::error_at(*node.find("height"), "\"height\" is " + to_text(camera.height) + "; a length from " +
                                                      to_text(kLeastEyeHeight) + " to " + to_text(kMostEyeHeight) + " was expected");
  } else if (const json::Node* height = node.find("height")) {
    return json::error_at(*height, "\"height\" is given without \"projection\": \"orthographic\"; \"fovy_deg\" was expected");
  }
  camera.given = true;
  return Done{};
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

}  // namespace catena::scene
