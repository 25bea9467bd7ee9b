// SPDX-License-Identifier: MIT
/// Curves of error over time with known choices.
#pragma once
#include <gtest/gtest.h>

#include "engine/app/tuning/choose/image_tuning.h"
#include "engine/app/tuning/choose/tick_tuning.h"
#include "render/quality/refinement.h"

namespace tuning_test {

using namespace catena;
using namespace catena::app::tuning;
using app::tuning::Point;

inline Point make_point(double error, double time, const std::string& setting = "", double spread = 0.01) {
  Point p;
  p.setting = setting;
  p.error = error;
  p.time = {time, time * (1 - spread), time * (1 + spread), 9};
  return p;
}

inline Curve four_point_curve() {
  Curve curve;
  curve.id = "eye-plan";
  curve.category = "eye";
  curve.points = {make_point(8, 1), make_point(2, 5), make_point(0.9, 10), make_point(0.1, 20), make_point(3, 12)};
  return curve;
}

inline ImageCurve image_curve() {
  ImageCurve made_curve{four_point_curve(), {}};
  made_curve.curve.points.pop_back();
  for (const double step : {4.0, 2.0, 1.0, 0.5}) made_curve.settings.push_back(render::exact_level(step));
  return made_curve;
}

/// The targets of a scene with this quality, or with this key of "coupling", as in "max_tick_us=5".
inline scene::TuningTargets parse_target(const std::string& words) {
  const std::string key = words.substr(0, words.find('='));
  const auto scene = scene::parse_scene(key.starts_with("max") ? "{\"coupling\": {\"" + key + "\": " + words.substr(key.size() + 1) + "}}"
                                                               : "{\"quality\": \"" + words + "\"}",
                                        "s.json");
  EXPECT_TRUE(scene) << words;
  return scene ? scene->tuning : scene::TuningTargets();
}

inline LinkCurve make_link_curve(const std::string& name, double length, std::vector<Point> points) {
  LinkCurve one;
  one.link = name;
  one.length = length;
  for (Point& p : points) one.keys.push_back({{"method", "\"" + p.setting + "\""}});
  one.curve.points = std::move(points);
  return one;
}

inline TickCurves two_link_curves() {
  return {{make_link_curve("a", 2, {make_point(1e-2, 300, "euler"), make_point(1e-4, 500, "rk2"), make_point(1e-8, 1500, "rk4")}),
           make_link_curve("b", 1, {make_point(1e-3, 300, "euler"), make_point(1e-5, 600, "rk2"), make_point(1e-9, 1100, "rk4")})},
          400,
          100};
}

}  // namespace tuning_test
