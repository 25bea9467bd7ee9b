/// Curves with known answers, and plans of them.
#pragma once
#include <gtest/gtest.h>

#include "engine/app/plan/eye_plan.h"
#include "engine/app/plan/hand_plan.h"
#include "render/quality/refinement.h"

namespace plan_test {

using namespace catena;
using namespace catena::app::plan;
using app::tradeoff::Point;

inline Point made(double error, double time, const std::string& setting = "", double spread = 0.01) {
  Point p;
  p.setting = setting;
  p.error = error;
  p.time = {time, time * (1 - spread), time * (1 + spread), 9};
  return p;
}

inline Curve four() {
  Curve curve;
  curve.id = "eye-plan";
  curve.part = "eye";
  curve.points = {made(8, 1), made(2, 5), made(0.9, 10), made(0.1, 20), made(3, 12)};
  return curve;
}

inline EyeCurve eye() {
  EyeCurve made_curve{four(), {}};
  made_curve.curve.points.pop_back();
  for (const double step : {4.0, 2.0, 1.0, 0.5}) made_curve.settings.push_back(render::exact_rung(step));
  return made_curve;
}

inline scene::Plan wants(const char* words) {
  const auto plan = scene::parse_plan(words);
  EXPECT_TRUE(plan) << words;
  return plan ? *plan : scene::Plan();
}

inline LinkCurve link(const std::string& name, double length, std::vector<Point> points) {
  LinkCurve one;
  one.link = name;
  one.length = length;
  for (Point& p : points) one.keys.push_back({{"method", "\"" + p.setting + "\""}});
  one.curve.points = std::move(points);
  return one;
}

inline HandCurves two_links() {
  return {{link("a", 2, {made(1e-2, 300, "euler"), made(1e-4, 500, "rk2"), made(1e-8, 1500, "rk4")}),
           link("b", 1, {made(1e-3, 300, "euler"), made(1e-5, 600, "rk2"), made(1e-9, 1100, "rk4")})},
          400,
          100};
}

}  // namespace plan_test
