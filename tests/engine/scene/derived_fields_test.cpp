// SPDX-License-Identifier: MIT
/// Derived fields in a scene: chains of them, units, changed time steps, reloading, what is refused.
#include "engine/scene/derived_fields.h"

#include "engine/scene/time_steps.h"
#include "engine/scene/units.h"
#include "tests/engine/scene/scene_fixture.h"

namespace catena::scene::derived_fields_test {

field::AnyField resolved(Scene& scene, const std::string& name) {
  auto any = resolve_field(scene, name, {});
  EXPECT_TRUE(any) << (any ? "" : any.error().message);
  return any ? *any : field::AnyField{};
}

double value_at(Scene& scene, const std::string& name, const Vec3& p) {
  field::Cursor cursor;
  return resolved(scene, name).scalar->sample(p, cursor).value;
}

TEST(DerivedFields, AreMadeOfEachOtherWhenNeeded) {
  Scene scene = parsed(R"({"unit_length": "m", "fields": {
    "speed": {"derived": "magnitude", "source": "w"},
    "w": {"derived": "vorticity", "source": "v"},
    "v": {"analytic": "abc", "unit": "m/s"},
    "vx": {"derived": "component", "source": "v", "component": "x"},
    "grid": {"expression": "a + x", "variables": {"a": "vx"}, "resolution": 33, "box": [-1, 1]},
    "smoothed": {"derived": "smooth", "source": "grid", "sigma": 0.01},
    "moved": {"derived": "resample", "source": "v", "on": "grid"},
    "again": {"derived": "vector", "source": ["grid", "grid", "grid"]}}})");
  EXPECT_FALSE(scene.entities.get<FieldSource>(find_field(scene, "w")).loaded.get());
  const Vec3 p(0.25, -0.5, 0.75);
  field::Cursor cursor;
  const Vec3 v = resolved(scene, "v").vector->sample(p, cursor).value;
  EXPECT_NEAR(value_at(scene, "speed", p), norm(v), 1e-10);
  EXPECT_NEAR(value_at(scene, "grid", p), v.x + p.x, 1e-6);
  EXPECT_NEAR(value_at(scene, "smoothed", p), v.x + p.x, 1e-6);
  field::Cursor other;
  EXPECT_LT(norm(resolved(scene, "moved").vector->sample(p, other).value - v), 1e-6);
  EXPECT_NEAR(resolved(scene, "again").vector->sample(p, other).value.z, v.x + p.x, 1e-6);
  EXPECT_EQ(unit_of(scene, find_field(scene, "w")), "1/s");
  EXPECT_EQ(unit_of(scene, find_field(scene, "speed")), "1/s");
  EXPECT_EQ(source_text(scene.entities.get<FieldSource>(find_field(scene, "w"))), "vorticity of v");
  EXPECT_TRUE(is_derived_from(scene, find_field(scene, "speed"), find_field(scene, "v")));
  EXPECT_FALSE(is_derived_from(scene, find_field(scene, "v"), find_field(scene, "speed")));
}

TEST(DerivedFields, FollowTheTimeStep) {
  Scene scene = parsed(R"({"fields": {"e": {"expression": "t * x", "resolution": 3, "box": [0, 2]}}})");
  EXPECT_EQ(value_at(scene, "e", {1, 1, 1}), 0);
  set_step(scene, 3);
  EXPECT_EQ(value_at(scene, "e", {1, 1, 1}), 3);
}

TEST(DerivedFields, ErrorsSayWhatWasExpected) {
  const auto expect_fault = [](const std::string& field, const std::string& part) {
    auto scene = parse_scene(R"({"fields": {"v": {"analytic": "abc"}, "s": {"analytic": "sphere"}, )"
                             "\n"
                             R"("e": )" +
                                 field + "}}",
                             "s.json");
    if (!scene) return expect_error(scene, "s.json:2: ", {part});
    expect_error(resolve_field(*scene, "e", {}), "s.json:2: ", {part});
  };
  expect_fault(R"({"derived": "vortices", "source": "v"})", "is \"vortices\"");
  expect_fault(R"({"derived": "vorticity", "source": "s"})", "a scalar field has no \"vorticity\"; a vector field was expected");
  expect_fault(R"({"derived": "vorticity", "source": "w"})", "unknown field \"w\"");
  expect_fault(R"({"derived": "vorticity", "source": "v", "sigma": 1})", "\"sigma\" does not belong to \"vorticity\"");
  expect_fault(R"({"derived": "vorticity", "source": "v", "order": 3})", "2 or 4 was expected");
  expect_fault(R"({"derived": "magnitude", "source": "e"})", "is derived from itself");
  expect_fault(R"({"derived": "vector", "source": "v"})", "three scalar fields were expected");
  expect_fault(R"({"derived": "component", "source": "v", "component": "w"})", "\"x\", \"y\" or \"z\" was expected");
  expect_fault(R"({"derived": "smooth", "source": "s", "sigma": 1})", "a field on a grid was expected");
  expect_fault(R"({"derived": "resample", "source": "s"})", "key \"on\" is missing");
  expect_fault(R"({"derived": "resample", "source": "s", "on": "v"})", "a field on a grid was expected");
  expect_fault(R"({"expression": "a +", "variables": {"a": "s"}})", "expression \"a +\", column 4: ");
  expect_fault(R"({"expression": "a", "variables": {"a": "v"}})", "a component like \"v.x\" was expected");
  expect_fault(R"({"expression": "a", "variables": {"a": "s.x"}})", "is a scalar field");
  expect_fault(R"({"expression": "a", "variables": {"a": "v.w"}})", "has no such component");
  expect_fault(R"({"expression": "1", "variables": {"t": "s"}})", "is the position or the time");
  expect_fault(R"({"expression": "1/0"})", "it is not finite at");
  expect_fault(R"({"expression": "1", "analytic": "abc"})", "exactly one of them was expected");
}

}  // namespace catena::scene::derived_fields_test
