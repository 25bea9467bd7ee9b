// SPDX-License-Identifier: MIT
#include <limits>

#include "tests/haptics/constraints/constraint_fixture.h"

namespace catena::haptics::tests::gradient_force_test {

ConstraintPtr pull(field::ScalarFieldPtr f, const std::string& direction, const std::string& displacement = "0.2") {
  return build(R"({"name": "a", "type": "gradient_force", "field": "f", "displacement": )" + displacement + ", \"direction\": \"" +
                   direction + "\"}",
               scalars({{"f", std::move(f)}}));
}

TEST(GradientForce, IsProportionalToTheGradient) {
  // s = |x|^2 on a grid: |grad s| = 2 |x|, with its maximum in the centres of the outermost cells
  const auto f = cube_grid(33, [](const Vec3& p) { return dot(p, p); });
  Rig high(pull(f, "up_gradient")), low(pull(f, "down_gradient"));
  const double largest = 2 * norm(Vec3(2 - 0.0625));
  Random random(1);
  for (int i = 0; i < 300; ++i) {
    // at a cell's centre the trilinear gradient equals the formula's
    const Vec3 index(std::floor(random.uniform(0, 32)) + 0.5, std::floor(random.uniform(0, 32)) + 0.5,
                     std::floor(random.uniform(0, 32)) + 0.5);
    const Vec3 x = Vec3(-2.0) + 0.125 * index, shift = 0.2 * 2.0 * x / largest;
    high.tick(x);
    low.tick(x);
    EXPECT_LE(norm(high.state.proxy - x - shift), 1e-6);
    EXPECT_LE(norm(low.state.proxy - x + shift), 1e-6);
    EXPECT_EQ(high.state.status, LinkStatus::ok);
    EXPECT_EQ(high.state.evaluations, 1);
    EXPECT_LE(norm(high.state.proxy - x), 0.2 * (1 + 1e-12));
  }
}

TEST(GradientForce, TheScaleOfTheFieldDoesNotMatter) {
  Rig one(pull(analytic_field("gaussian"), "up_gradient"));
  Random random(2);
  std::vector<Vec3> path;
  for (int i = 0; i < 100; ++i) path.push_back(random.box(2));
  for (const double scale : {1e-300, 1e-150, 1e150, 1e300}) {
    Rig other(pull(analytic_field("gaussian", scale), "up_gradient"));
    for (const Vec3& x : path) {
      one.tick(x);
      ASSERT_LE(norm(one.state.proxy - other.tick(x).proxy), 1e-12) << scale;
      ASSERT_GT(norm(one.state.proxy - x), 0);
    }
  }
}

TEST(GradientForce, IsFreeOutsideTheDomainAndIdleOnAPlateau) {
  Rig grid(pull(sampled_field("sphere", 17), "up_gradient"));
  EXPECT_EQ(grid.tick({1, 0.1, 0}).status, LinkStatus::ok);
  EXPECT_GT(norm(grid.state.proxy - Vec3(1, 0.1, 0)), 0.1);
  for (const Vec3& out : {Vec3(2.001, 0, 0), Vec3(1e300, 0, -0.0), Vec3(0, -5, 0)}) {
    EXPECT_EQ(grid.tick(out).status, LinkStatus::free);
    EXPECT_TRUE(bitwise_equal(grid.state.proxy, out));
  }
  Rig flat(pull(analytic_field("constant"), "up_gradient"));
  expect_steps(flat, {{{-0.0, 0.5, 0}, kOk, {-0.0, 0.5, 0}}});
}

TEST(GradientForce, NonFiniteVoxelsAreFree) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto f = cube_grid(9, [&](const Vec3& p) { return norm(p) < 0.1 ? nan : p.x; });
  Rig rig(pull(f, "down_gradient"));
  expect_steps(rig, {{{0.2, 0.2, 0.2}, kFree}, {{1.2, 0.2, 0.2}, kOk}});
  EXPECT_LE(norm(rig.state.proxy - Vec3(1.0, 0.2, 0.2)), 1e-6);
}

TEST(GradientForce, RefusesBadKeys) {
  Fields fields = scalars({{"f", analytic_field("sphere")}});
  fields.named["v"].vector = field::make_analytic("circle")->vector;
  const std::tuple<const char*, int, const char*> bad[] = {
      {R"("field": "v", "displacement": 0.1, "direction": "up_gradient")", 2, "scalar field"},
      {R"("field": "f", "direction": "up_gradient")", 1, "displacement"},
      {R"("field": "f", "displacement": 0.1)", 1, "direction"},
      {R"("field": "f", "displacement": 0.1, "direction": "up")", 2, "direction"},
      {R"("field": "f", "displacement": -0.1, "direction": "down_gradient")", 2, "displacement"}};
  for (const auto& [keys, line, what] : bad)
    expect_refused("{\"name\": \"a\", \"type\": \"gradient_force\",\n" + std::string(keys) + "}", line, {what}, fields);
}

}  // namespace catena::haptics::tests::gradient_force_test
