// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "engine/scene/prepare.h"
#include "engine/scene/ruler.h"
#include "engine/scene/scene.h"
#include "haptics/build/build_program.h"
#include "tests/fuzz/mutate.h"

namespace catena::scene_fuzz_test {

const std::string kScene = R"({ // a scene that touches every reader
  "fields": {"density": {"analytic": "sphere", "scale": 1.5, "resolution": 4, "box": [-1, 1]}, "swirl": {"analytic": "circle"},
             "wind": {"analytic": "uniform", "direction": [0, 0, 1]}, "wall": {"analytic": "left-ventricle", "part": "fibre"}},
  "chain": [{"name": "a", "type": "point", "position": [0, 0, 0], "release": 0.5, "active_when": {"button": 1}},
            {"name": "b", "type": "plane", "point": [0, 0, 0], "normal": [0, 0, 1], "stiffness": 20},
            {"name": "s", "type": "isosurface", "field": "density", "level": 0.45, "free": "below", "release": 0.05}],
  "coupling": {"stiffness": 500, "damping": 1.0, "max_force": 8, "ramp_s": 0.1, "method": "balance"},
  "workspace": {"metres_per_unit": 0.05, "origin": [1, 2, 3], "rotation": {"axis": [0, 0, 1], "angle_deg": 30}},
  "camera": {"position": [8, -32, 38], "target": [8.25, 0, 29.8], "up": [0, 0, 1], "fovy_deg": 30},
  "volumes": [{"field": "density", "color": [[0.2, 0.1, 0.1, 0.4], [0.7, 0.9, 0.2, 0.1]], "opacity": [[0.2, 0.0], [0.7, 0.1]],
               "opacity_unit": 0.18, "shade": true}, {"field": "density", "extinction": [[0, 0], [1, 3]]},
              {"field": "density", "color": "cool-warm_r", "range": [-1, 2.5], "gradient_opacity": [[0, 0], [3, 1]]}],
  "isosurfaces": [{"field": "density", "level": 0.45, "color": [0.8, 0.8, 0.9], "opacity": 0.5}],
  "streamlines": [{"field": "swirl", "seeds": [[1.6, -0.57, 27.09], [1, 0, 0]], "radius": 0.02, "color": [1, 0.3, 0.2], "kind": "line"},
    {"field": "swirl", "seeds": {"line": {"from": [0.2, 0, 0], "to": [1, 0, 0], "count": 3}}, "color_by": {"field": "density", "color": [[0, 0, 0, 1], [1, 1, 0, 0]]}},
    {"field": "swirl", "seeds": {"plane": {"origin": [0, 0, 0], "u": [1, 0, 0], "v": [0, 0, 1], "count": [2, 3]}}, "color_by": {"quantity": "speed", "color": "magma", "range": [0, 2]}, "arrows": 0.5},
    {"field": "swirl", "seeds": {"sphere": {"center": [0, 0, 0], "radius": 0.5, "count": 4, "inside": true}}, "animated_bands": 0.3, "tolerance": 1e-6},
    {"field": "swirl", "seeds": {"isosurface": {"field": "density", "level": 0.4, "count": 5}}, "min_speed": 0.01},
    {"field": "swirl", "seeds": {"evenly_spaced": {"distance": 0.5, "termination_ratio": 0.6, "start": [[1, 0, 0]], "count": 9}}, "length": 3}],
  "slices": [{"field": "density", "axis": "z", "at": 0}],
  "glyphs": [{"field": "swirl", "on": {"slice": 0}, "spacing": 0.3, "scale": "constant", "color_by": {"quantity": "speed", "range": [0, 1]}},
    {"field": "swirl", "on": {"plane": {"point": [0, 0, 1], "normal": [0, 1, 1]}}, "length": 0.2, "reference_speed": 2, "radius": 0.01, "anchor": "tail"},
    {"field": "swirl", "on": {"box": {"min": [0, 0, 0], "max": [1, 1, 1]}}, "min_speed": 0.1, "kind": "line", "color": [0, 1, 0], "clip": false}],
  "indicator": {"field": "swirl", "length": 0.4, "radius": 0.01, "color": [1, 1, 0]},
  "cursor": {"probe": [0, 0, 1], "size": 0.1},
  /* done */ "background": [0, 0, 0], "quality": "time=8" })";

/// Every kind of key of links, modes and presets, on fields that are cheap to build.
const std::string kHand = R"({ "fields": {"s": {"analytic": "sphere"}, "v": {"analytic": "circle"}},
  "chain": [{"name": "skin", "type": "anisotropic_friction", "surface": "s", "level": 0.5, "field": "v", "kind": "line", "threshold": 0.03,
             "tau_min": 0.002, "tau_max": {"field": "s", "map": [[0, 0.01], [1, 0.05]], "quantity": "gradient", "outside": 0.02},
             "law": "as_published", "free": "above", "release": 0.4, "snap": 0.2, "release_cue": {"type": "detent", "distance": 0.1, "duration": 0.01}},
            {"name": "path", "type": "polyline", "points": [[0, 0, 0], [1, 0, 0], [1, 1, 0]], "closed": true, "active_when": {"force_above": 3, "force_below": 1}},
            {"name": "case", "type": "box", "center": [0, 0, 0], "size": [1, 2, 3], "rotation": {"axis": [1, 2, 3], "angle_deg": 40}, "free": "below",
             "align": {"axis": [0, 1, 0], "stiffness": 0.4, "sign": "same"}},
            {"name": "core", "type": "vortex_core", "field": "v", "radius": 0.2, "search_radius": 0.6, "stiffness": {"field": "v", "map": [[0, 1]]}},
            {"name": "rough", "type": "texture", "threshold": 0.01, "amplitude": 0.8, "wavelength": 0.07},
            {"name": "oil", "type": "viscosity", "time": 0.004, "active_when": {"button": 2, "toggle": true}}],
  "modes": [{"name": "one", "links": ["skin", "path"], "active_when": {"button": 1}}, {"name": "two", "links": [], "active_when": {"force_above": 2}}],
  "coupling": {"ramp_s": 0.02, "rotational_stiffness": 0.3, "rotational_damping": 0.001} })";

/// Every widget, and every object that can follow one.
const std::string kWidgets = R"({ "fields": {"s": {"analytic": "sphere", "resolution": 4, "box": [-1, 1]}, "v": {"analytic": "circle"}},
  "chain": [{"name": "curve", "type": "streamline", "field": "v", "seed": [1, 0, 0]}, {"name": "skin", "type": "isosurface", "field": "s", "level": 0.5}],
  "widgets": [{"name": "cut", "type": "cutting_plane", "center": [0, 0, 0.1], "normal": [0, 1, 1], "radius": 0.3, "snap": 0.05, "release": 0.1,
               "grab_distance": 0.04, "step": 0.03, "rotation": "axis", "rotate_on_contact": true, "button": 2, "color": [1, 0, 0]},
              {"name": "other", "type": "cutting_plane", "center": [0, 0, 0], "orientation": [0.6, 0.8, 0, 0]},
              {"name": "s", "type": "seed", "position": [1, 0, 0]}, {"name": "r", "type": "rake", "from": [0.5, 0, 0], "to": [1, 0, 0], "step": 0.1},
              {"name": "l", "type": "isolevel", "field": "s", "position": [0.5, 0, 0]}, {"name": "b", "type": "box", "min": [-1, -1, -1], "max": [1, 1, 1]},
              {"name": "u", "type": "ruler", "from": [1, 0, 0], "to": [0, 1, 0], "along": ["curve", "skin"]}],
  "slices": [{"field": "s", "widget": "cut", "contours": {"count": 3}, "lic": {"field": "v", "length": 0.5, "animated": true}}],
  "clip": [{"widget": "other", "side": "behind"}, {"widget": "b"}],
  "streamlines": [{"field": "v", "seeds": {"widget": "s"}, "lines": "streak", "times": [0, 2], "time_interpolation": "cubic"}, {"field": "v", "seeds": {"widget": "r", "count": 4}}],
  "isosurfaces": [{"field": "s", "level": {"widget": "l"}}],
  "glyphs": [{"field": "v", "on": {"plane": {"widget": "cut"}}}, {"field": "v", "on": {"isosurface": 0}}] })";

/// Checks that the result is a value or an error in one line that starts with the file's name.
bool check(const std::string& text, bool extract) {
  auto scene = scene::parse_scene(text, "scene.json");
  std::string message;
  if (!scene) {
    message = scene.error().message;
  } else if (extract) {
    const auto program = haptics::build_program(*scene);
    if (!program) message = program.error().message;
  }
  if (!message.empty()) test::expect_error_line(message, "scene.json:", text, 1000, "");
  return message.empty();
}

bool is_read(const std::string& text) { return check(text, false); }

TEST(SceneFuzz, TheSeedsAreValid) {
  for (const std::string& seed : {kScene, kHand, kWidgets}) {
    auto scene = scene::parse_scene(seed, "scene.json");
    ASSERT_TRUE(scene) << scene.error().message;
    const auto program = haptics::build_program(*scene);
    ASSERT_TRUE(program) << program.error().message;
  }
}

TEST(SceneFuzz, EveryTruncationAndEveryByteFlip) { test::truncate_and_flip(kScene, is_read, kScene.size()); }

TEST(SceneFuzz, Mutations) {
  test::fuzz(20000, 1, [](test::Random& random, std::uint64_t) { return is_read(test::mutate(kScene, random)); });
}

TEST(SceneFuzz, MutatedChainsAreExtracted) {
  test::FuzzInputs inputs(2000, 2);
  while (inputs.next() && !HasFailure()) check(test::mutate(inputs.count() % 2 == 0 ? kHand : kScene, inputs.random), true);
}

/// Also resolves, drives and measures the widgets: each result is a value or an error in one line.
bool drive(const std::string& text) {
  auto scene = scene::parse_scene(text, "scene.json");
  if (!scene) return is_read(text);
  std::string message;
  if (const auto changes = scene::propagate_widgets(*scene); !changes) message = changes.error().message;
  std::vector<scene::Entity> rulers;
  scene->entities.each<scene::Widget>([&](scene::Entity e, const scene::Widget& w) {
    if (w.spec.kind == widget::Kind::ruler) rulers.push_back(e);
  });
  if (message.empty())
    for (const scene::Entity e : rulers)
      if (const auto measured = scene::resolve_ruler(*scene, e); !measured) message = measured.error().message;
  if (!message.empty()) test::expect_error_line(message, "scene.json:", text, 1000, "");
  return message.empty();
}

TEST(SceneFuzz, EveryTruncationOfWidgets) {
  for (std::size_t n = 0; n < kWidgets.size(); ++n) EXPECT_FALSE(is_read(kWidgets.substr(0, n))) << n;
}

TEST(SceneFuzz, MutatedWidgetsAreDriven) {
  ASSERT_TRUE(drive(kWidgets));
  test::fuzz(2000, 3, [](test::Random& random, std::uint64_t) { return drive(test::mutate(kWidgets, random)); });
}

TEST(SceneFuzz, DeepAndLongTexts) {
  for (const std::string& text :
       {std::string(1000000, '['), "{\"chain\": " + std::string(100000, '{') + "}", "{\"" + std::string(1000000, 'k') + "\": 1}",
        std::string(1000000, '\n') + "{", "{\"quality\": " + std::string(100000, '9') + "}"})
    EXPECT_FALSE(is_read(text)) << text.substr(0, 20);
}

}  // namespace catena::scene_fuzz_test
