// SPDX-License-Identifier: MIT
#include "tests/haptics/constraints/friction_fixture.h"

namespace catena::haptics::tests::friction_test {

constexpr double kPi = 3.14159265358979323846;

Fields fields_of(const field::VectorFieldPtr& v, const field::ScalarFieldPtr& s = nullptr) {
  Fields fields = scalars({{"s", s}});
  fields.named["v"].vector = v;
  return fields;
}

field::VectorFieldPtr vectors(const std::string& name, const Vec3& direction = Vec3(1, 0, 0), double scale = 1) {
  return field::make_analytic(name, {.scale = scale, .direction = direction, .part = {}})->vector;
}

std::string friction(double threshold, const std::string& more = "") {
  return R"({"name": "a", "type": "friction", "field": "v", "threshold": )" + to_json(threshold) + more + "}";
}

const std::string kOnS = R"(, "surface": "s", "level": )";

TEST(Friction, IsFreeAlongAndSticksAcross) {
  const Vec3 way = direction(Vec3(1, 2, -1)), across = direction(Vec3(2, -1, 0));
  Rig rig(build(friction(0.1), fields_of(vectors("uniform", way))));
  rig.tick(Vec3(0.0));
  EXPECT_LE(norm(rig.tick(way * 0.7).proxy - way * 0.7), 4e-8);
  rig.tick(way * 0.2 + across * 0.09);  // reversed along the field, still sticking across
  EXPECT_LE(norm(rig.state.proxy - way * 0.2), 1e-9);
  const Vec3 before = rig.state.proxy;
  EXPECT_TRUE(bitwise_equal(rig.tick(before + across * 0.0999).proxy, before));
  EXPECT_LE(norm(rig.tick(before + across * 0.25).proxy - (before + across * 0.15)), 1e-12);
  EXPECT_EQ(rig.state.limit, 0.1);
}

// |x - p| = tau where it slides, |e.d| <= 1e-8 L always, |x - p| <= tau always
TEST(Friction, KeepsTheThresholdAndTheLineConditionOnAWalk) {
  for (const char* name : {"circle", "hill", "abc"}) {
    SCOPED_TRACE(name);
    const auto v = vectors(name);
    Rig rig(build(friction(0.03), fields_of(v)));
    Wanderer hand{Random(8), 0.002, 0.0004, 1.2, Vec3(0.5, 0.3, 0.2)};
    double worst_along = 0;
    int slid = 0, over = 0, budget = 0, loose = 0;
    for (int i = 0; i < 20000; ++i) {
      rig.tick(hand.step());
      budget += rig.state.status == LinkStatus::budget;
      field::Cursor cursor;
      const Vec3 e = hand.probe - rig.state.proxy, d = direction(v->sample(rig.state.proxy, cursor).value);
      if (rig.state.status == LinkStatus::ok) worst_along = std::max(worst_along, std::fabs(dot(e, d)));
      loose += std::fabs(dot(e, d)) > 1e-7;
      over += norm(e) - 0.03 > 1e-12;
      slid += norm(e) - 0.03 > -1e-6;
    }
    EXPECT_GT(slid, 1000);
    EXPECT_EQ(over, 0);
    EXPECT_LE(budget, 4);  // where the line reverses within tau
    EXPECT_LE(loose, 4);
    EXPECT_LE(worst_along, 5e-8);
  }
}

// with a large threshold it equals a streamline link: drift of one lap, R = 0.05, 0.2 units/s, 1 kHz (Euler: 0.63e-3)
TEST(Friction, DriftOfALap) {
  for (const bool on_sphere : {false, true}) {
    SCOPED_TRACE(on_sphere ? "sphere" : "plane");
    const double radius = 0.05, height = on_sphere ? std::sqrt(1 - 0.05 * 0.05) : 0;
    Rig rig(build(friction(1, on_sphere ? kOnS + "1" : ""), fields_of(vectors("circle"), analytic_field("sphere"))));
    const int ticks = static_cast<int>(2 * kPi * radius / 0.2 * 1000);
    double drift = 0, behind = 0;
    for (int k = 0; k <= ticks; ++k) {
      const double a = 2 * kPi * k / ticks;
      // the hand is on the surface, a fifth of the radius off the line
      const double r = k == 0 ? radius : radius * (1 + 0.2 * std::sin(3 * a));
      ASSERT_EQ(rig.tick({r * std::cos(a), r * std::sin(a), on_sphere ? std::sqrt(1 - r * r) : 0}).status, LinkStatus::ok) << k;
      const Vec3& p = rig.state.proxy;
      drift = std::max(drift, std::fabs(std::sqrt(p.x * p.x + p.y * p.y) - radius) + std::fabs(p.z - height));
      behind = std::max(behind, norm(Vec3(p.x, p.y, 0) - Vec3(std::cos(a), std::sin(a), 0) * radius));
    }
    EXPECT_LE(drift, 4e-9);
    EXPECT_LE(behind, 1e-7);
  }
}

// no drift under the tremor of a still hand: 60 s of 1e-3 at R = 0.05 (Euler: 1.2e-3)
TEST(Friction, DoesNotDriftUnderATremor) {
  Rig rig(build(friction(1), fields_of(vectors("circle"))));
  rig.tick({0.05, 0, 0});
  for (int k = 0; k < 60000; ++k) {
    const double t = k * 1e-3;
    ASSERT_LE(std::fabs(norm(rig.tick({0.05 + 1e-3 * std::sin(57 * t), 1e-3 * std::sin(61 * t), 0}).proxy) - 0.05), 1e-8) << k;
  }
}

// without a valid field it is the isotropic drag
TEST(Friction, WithoutADirectionItEqualsDrag) {
  const auto nothing = lambda_field([](const Vec3&) { return Vec3(0.0); }), radial = lambda_field([](const Vec3&p) { return p; }),
             nan = lambda_field([](const Vec3&) { return Vec3(std::nan("")); });
  const auto sphere = analytic_field("sphere");
  const std::vector<Vec3> path = walk_on_surface(sphere, 1, {1, 0.1, 0.2}, 0.003, 4000, 9);
  for (const auto& v : {nothing, radial, nan}) {
    Rig rig(build(friction(0.02, kOnS + "1"), fields_of(v, sphere)));
    Rig drag(build(R"({"name": "a", "type": "drag", "threshold": 0.02, "surface": "s", "level": 1})", fields_of(v, sphere)));
    for (const Vec3& probe : path) {
      rig.tick(probe);
      drag.tick(probe);
      ASSERT_EQ(rig.state.status, v == nan ? LinkStatus::critical : LinkStatus::ok);
      ASSERT_LE(norm(rig.state.proxy - drag.state.proxy), 1e-12);
    }
  }
}

// the proxy is a continuous function of the field's strength
TEST(Friction, ChangesIntoDragContinuously) {
  const Vec3 probe(0.4, 0.2, 0);
  const auto at = [&](double exponent) {
    // v = strength (1, 0, 0) near the origin, 1 elsewhere: X = 1
    const double strength = std::pow(10.0, exponent);
    const auto v = lambda_field([strength](const Vec3& p) { return Vec3(norm(p) < 0.9 ? strength : 1, 0, 0); });
    Rig rig(build(friction(0.1), fields_of(v)));
    rig.tick(Vec3(0.0));
    EXPECT_NEAR(norm(probe - rig.tick(probe).proxy), 0.1, 1e-12);
    return rig.state.proxy;
  };
  EXPECT_LE(norm(at(-9) - (probe - direction(probe) * 0.1)), 1e-12);
  EXPECT_LE(norm(at(-3) - Vec3(0.4, 0.1, 0)), 1e-6);
  // continuous: twice the number of steps halves the largest step
  double largest[2] = {0, 0};
  for (int fine = 0; fine < 2; ++fine) {
    const int steps = fine ? 200 : 100;
    Vec3 last = at(-7.5);
    for (int k = 1; k <= steps; ++k) {
      const Vec3 p = at(-7.5 + 3.0 * k / steps);
      largest[fine] = std::max(largest[fine], norm(p - last));
      last = p;
    }
  }
  EXPECT_LE(largest[1], 0.6 * largest[0]);
}

TEST(Friction, TheUnitsOfTheFieldDoNotMatter) {
  std::vector<Vec3> proxies;
  for (const double scale : {1.0, 1e-300, 1e300}) {
    Rig rig(build(friction(0.03), fields_of(vectors("circle", Vec3(1, 0, 0), scale))));
    Random random(10);
    Vec3 probe(0.5, 0.3, 0.2);
    for (int i = 0; i < 3000; ++i) {
      probe = probe + random.unit() * 0.01;
      rig.tick(probe);
      if (scale == 1) proxies.push_back(rig.state.proxy);
      ASSERT_LE(norm(rig.state.proxy - proxies[static_cast<std::size_t>(i)]), 1e-9);
    }
  }
}

// line field: the path is independent of the signs of the voxels
TEST(Friction, LineFieldsAreSignInvariant) {
  Random random(11);
  const auto mapping = field::Mapping::from_linear(Mat3(0.1), Vec3(-2.0));
  const auto turn = [](const Vec3& p) { return direction(Vec3(-p.y, p.x, 0.3)); };
  const auto steady = catena::test::sample_vector_grid(mapping, {41, 41, 41}, turn);
  const auto flipped = catena::test::sample_vector_grid(mapping, {41, 41, 41},
                                                        [&](const Vec3& p) { return turn(p) * (random.uniform(-1, 1) < 0 ? -1.0 : 1.0); });
  Rig vector(build(friction(0.05), fields_of(steady))), a(build(friction(0.05, R"(, "kind": "line")"), fields_of(steady)));
  Rig b(build(friction(0.05, R"(, "kind": "line")"), fields_of(flipped)));
  Vec3 probe(1, 0.2, 0);
  Vec3 velocity(0, 0.004, 0);
  for (int i = 0; i < 5000; ++i) {
    velocity = direction(velocity + random.unit() * 0.0008) * 0.004;
    if (norm(probe + velocity) > 1.5 || std::hypot(probe.x + velocity.x, probe.y + velocity.y) < 0.5) velocity = -velocity;
    probe = probe + velocity;
    vector.tick(probe);
    a.tick(probe);
    ASSERT_LE(norm(a.state.proxy - b.tick(probe).proxy), 1e-12) << i;
    // dyads are interpolated differently from vectors
    ASSERT_LE(norm(vector.state.proxy - b.state.proxy), 1e-3) << i;
  }
}

// on a surface: the proxy follows the tangential part of the field and stays on the level
TEST(Friction, FollowsTheTangentialFieldOnASurface) {
  const auto sphere = analytic_field("sphere");
  const auto tilted = lambda_field([](const Vec3& p) { return Vec3(-p.y, p.x, 0) + p * 3.0; });
  Rig rig(build(friction(0.4, kOnS + "1"), fields_of(tilted, sphere)));
  // circles of latitude, for any normal part
  const double z = 0.6, r = 0.8;
  for (int k = 0; k <= 5000; ++k) {
    const double a = 2 * kPi * k / 5000, up = z + 0.2 * std::sin(5 * a);
    ASSERT_EQ(rig.tick(Vec3(std::sqrt(1 - up * up) * std::cos(a), std::sqrt(1 - up * up) * std::sin(a), up)).status, LinkStatus::ok);
    ASSERT_NEAR(rig.state.proxy.z, z, 1e-7);
    ASSERT_NEAR(norm(rig.state.proxy), 1, 1e-11);
    ASSERT_LE(norm(rig.state.proxy - Vec3(r * std::cos(a), r * std::sin(a), z)), 1e-6);
  }
}

// the end of the valid field holds the proxy; back inside it moves on
TEST(Friction, TheLineEndsAtTheEndOfTheField) {
  std::vector<std::uint8_t> valid;
  for (int i = 0; i < 21 * 21 * 21; ++i) valid.push_back(i % 21 <= 15);
  const auto mapping = field::Mapping::from_linear(Mat3(0.2), Vec3(-2.0));
  const auto along_x = catena::test::sample_vector_grid(
      mapping, {21, 21, 21}, [](const Vec3&) { return Vec3(1, 0, 0); }, valid);
  Rig rig(build(friction(5), fields_of(along_x)));
  rig.tick({0, 0.1, 0.1});
  for (double x = 0; x < 1.5; x += 0.01) rig.tick({x, 0.1, 0.1});
  EXPECT_EQ(rig.state.status, LinkStatus::boundary);
  EXPECT_NEAR(rig.state.proxy.x, 1, 1e-3);
  EXPECT_EQ(rig.tick({0.5, 0.1, 0.1}).status, LinkStatus::ok);
  EXPECT_NEAR(rig.state.proxy.x, 0.5, 1e-8);
}

// The normal of a sampled surface jumps at every face, and so does the line's direction: OK is reported only where e is perpendicular to
// the line, or at a corner that is the closest point.
TEST(Friction, OnACreasedSurfaceOkMeansConverged) {
  Random random(3);
  const auto bumps = sample_scalar_grid(field::Mapping::from_linear(Mat3(2.0 / 19), Vec3(-1.0)), {20, 20, 20}, [](const Vec3& p) {
    return norm(p) + 0.12 * std::sin(6 * p.x) * std::sin(5 * p.y + 1) * std::sin(7 * p.z);
  });
  const auto v = vectors("abc");
  const double length = bumps->domain_length();
  Rig surface(isosurface(bumps, 0.65));
  Rig rig(build(friction(0.06, kOnS + "0.65"), fields_of(v, bumps)));
  Vec3 probe(0.6, 0.1, 0.2), velocity = random.unit();
  int ok = 0, early = 0, waits = 0;
  for (int i = 0; i < 20000; ++i) {
    velocity = direction(velocity + random.unit() * 0.1);
    if (norm(probe) > 0.75 || norm(probe) < 0.5) velocity = direction(probe) * (norm(probe) > 0.6 ? -1.0 : 1.0);
    probe = probe + velocity * 5e-4;
    surface.tick(probe);
    rig.tick(surface.state.proxy);
    waits += rig.state.status == LinkStatus::budget;
    if (rig.state.status != LinkStatus::ok) continue;
    ++ok;
    const auto tangent = [&](const Vec3& p) {
      field::Cursor at_v, at_s;
      const Vec3 w = v->sample(p, at_v).value, n = direction(bumps->sample(p, at_s).gradient);
      return direction(w - n * dot(w, n));
    };
    const Vec3 p = rig.state.proxy, e = surface.state.proxy - p, d = tangent(p);
    const double left = dot(e, d);
    if (std::fabs(left) <= 1e-7 * length) continue;
    // a corner is the closest point if e points back slightly further along the line
    const Vec3 further = p + d * (left > 0 ? 1e-5 : -1e-5) * length;
    early += left * dot(surface.state.proxy - further, tangent(further)) > 0;
  }
  EXPECT_GT(ok, 18000);
  EXPECT_EQ(early, 0);
  EXPECT_LT(waits, 600);
}

TEST(Friction, RefusesBadKeys) {
  const Fields fields = fields_of(vectors("circle"), analytic_field("sphere"));
  const std::pair<std::string, const char*> bad[] = {{R"({"name": "a", "type": "friction"})", "field"},
                                                     {R"({"name": "a", "type": "friction", "field": "s"})", "scalar field"},
                                                     {friction(-1), "threshold"},
                                                     {friction(1, R"(, "kind": "lines")"), "kind"},
                                                     {friction(1, R"(, "level": 1)"), "no \"surface\""},
                                                     {friction(1, R"(, "surface": "v")"), "vector field"}};
  for (const auto& [text, what] : bad) expect_refused(text, 1, {what}, fields);
  const auto fine = try_build(R"({"name": "a", "type": "friction", "field": "v"})", fields);
  ASSERT_TRUE(fine);
  Rig rig(*fine);
  EXPECT_DOUBLE_EQ(rig.tick({0.5, 0, 0}).limit, 0.02);  // 0.005 L
}

}  // namespace catena::haptics::tests::friction_test
