// SPDX-License-Identifier: MIT
/// Reads what lights the scene: "look", "lights", "environment", "ambient_occlusion", "shadows" and "line_halos".
#include "engine/base/camera_limits.h"
#include "engine/base/text.h"
#include "engine/scene/readers.h"
#include "engine/scene/to_json.h"

namespace catena::scene {
namespace {

using schema::Section;

const Table<Light>& light_table() {
  static const auto table = [] {
    Table<Light> t;
    t.bind(schema::direction("direction", "Direction towards the light; with `\"fixed_to\": \"camera\"` as right, up, towards the camera.")
               .required(),
           &Light::direction);
    t.bind(schema::color("color", "Colour of the light."), &Light::color);
    t.bind(schema::number("intensity", "", "Factor on the colour of the light.").non_negative(), &Light::intensity);
    const Key fixed = schema::choice("fixed_to", {"scene", "camera"}, "Frame in which the direction of the light is fixed.");
    t.bind(fixed, &Light::follows_camera);
    t.bind(schema::number("angular_size", "degrees", "Diameter of the light as seen from the scene, which makes its shadows soft.")
               .within(0, 60),
           &Light::angular_size_deg);
    return t;
  }();
  return table;
}

Outcome read_lights(Scene& scene, const json::Node& node) {
  scene.illumination.has_headlight = false;
  return each_item(node, [&](const json::Node& item) -> Outcome {
    if (scene.illumination.lights.size() == kMaxLights)
      return json::error_at(item, "there are more than " + std::to_string(kMaxLights) + " lights; that many at most were expected");
    Light light;
    CATENA_CHECK(light_table().read(scene, item, light));
    scene.illumination.lights.push_back(light);
    return Done{};
  });
}

const Table<EnvironmentLight>& environment_table() {
  static const auto table = [] {
    Table<EnvironmentLight> t;
    t.bind(schema::color("sky", "Light from above (+z).").required(), &EnvironmentLight::sky);
    t.bind(schema::color("ground", "Light from below; in between the two are mixed.").required(), &EnvironmentLight::ground);
    return t;
  }();
  return table;
}

Outcome read_environment(Scene& scene, const json::Node& node) {
  EnvironmentLight light;
  if (node.kind == json::Kind::object) {
    CATENA_CHECK(environment_table().read(scene, node, light));
  } else {
    const auto color = as_color(node);
    if (!color)
      return json::error_at(node,
                            "\"environment\" is not a colour; [r, g, b] with components from 0 to 1, or an object with \"sky\" and "
                            "\"ground\", was expected");
    light.sky = light.ground = *color;
  }
  scene.illumination.environment_light = light;
  return Done{};
}

const Table<AmbientOcclusion>& ambient_occlusion_table() {
  static const auto table = [] {
    Table<AmbientOcclusion> t;
    t.bind(schema::number("reach", "world", "Distance at which an occluder counts by 1/e.")
               .positive()
               .with_default("a tenth of the diagonal of what is drawn"),
           &AmbientOcclusion::reach);
    t.bind(schema::number("strength", "", "Share of the occlusion that is applied.").within(0, 1), &AmbientOcclusion::strength);
    return t;
  }();
  return table;
}

}  // namespace

Part lights_part() {
  return {
      make_list_component("lights",
                          "Directional lights. Default: a headlight; an empty list: none. With `shadows`, the first three that are fixed "
                          "to the scene cast shadows.",
                          light_table(), static_cast<int>(kMaxLights)),
      read_lights};
}

Part environment_part() {
  const Key key =
      schema::any_of("environment",
                     {schema::color("", "Light from all sides."), schema::object("", environment_table().keys(), "Sky and ground.")},
                     "Light from all sides, as a colour or as sky and ground.")
          .with_default("gray, 0.2; with ambient occlusion 0.5");
  return {{"environment", "Light from all sides, which ambient occlusion reduces.", Section::Layout::value, {key}}, read_environment};
}

Part ambient_occlusion_part() {
  return {{"ambient_occlusion", "Darkens what is enclosed: the share of the environment's light that arrives.", Section::Layout::on_off,
           ambient_occlusion_table().keys()},
          [](Scene& scene, const json::Node& node) {
            return read_on_off(scene, node, ambient_occlusion_table(), scene.illumination.ambient_occlusion);
          }};
}

Part look_part() {
  const Key key = schema::choice("look", {"lit", "plain"},
                                 "Colours and light are added as linear radiance (`lit`) or in the encoding of the display (`plain`).")
                      .with_default("lit if the scene has environment, ambient_occlusion or shadows");
  return {{"look", "Space in which colours and light are added.", Section::Layout::value, {key}},
          [](Scene& scene, const json::Node& node) -> Outcome {
            const bool is_word = node.kind == json::Kind::string;
            if (!is_word || (node.string != "lit" && node.string != "plain"))
              return json::error_at(node, "\"look\" is not known; \"lit\" or \"plain\" was expected");
            scene.illumination.look = node.string == "plain" ? Look::plain : Look::lit;
            return Done{};
          }};
}

Part shadows_part() {
  const Key key = schema::boolean("shadows", "Shadows of the lights that are fixed to the scene.").with_default("false");
  return {{"shadows", "Shadows of lights that are fixed to the scene, of all that is drawn.", Section::Layout::value, {key}},
          [](Scene& scene, const json::Node& node) { return read_boolean(node, scene.illumination.shadows); }};
}

Part line_halos_part() {
  const Key key = schema::boolean("line_halos", "Streamlines and curves darken what lies behind them, beside them.")
                      .with_default("true with the default light of `lit`");
  return {{"line_halos", "Halos of streamlines and curves, which show what is in front.", Section::Layout::value, {key}},
          [](Scene& scene, const json::Node& node) { return read_boolean(node, scene.illumination.line_halos.emplace(false)); }};
}

std::string to_json(const Light& light) { return light_table().write({}, light); }

}  // namespace catena::scene
