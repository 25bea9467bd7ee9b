// SPDX-License-Identifier: MIT
#include "engine/io/volume/load_field.h"
#include "tests/engine/geometry/flow/analytic_cores.h"
#include "tests/haptics/constraints/constraint_fixture.h"
#include "tests/support/support.h"

namespace catena::haptics::tests::vortex_core_test {

ConstraintPtr core_of(field::VectorFieldPtr field, const std::string& more = "") {
  Fields fields;
  fields.named["v"].vector = std::move(field);
  return build(R"({"name": "a", "type": "vortex_core", "field": "v")" + more + "}", fields);
}

field::VectorFieldPtr formula(const char* name, double scale = 1) { return catena::test::analytic_vector(name, scale); }

TEST(VortexCore, OfStraightVorticesIsTheZAxis) {
  Random random(1);
  for (const char* name : {"helix", "rankine", "lamb-oseen", "circle"})
    for (const double scale : {1.0, -1.0, 1e-300, 1e300}) {
      Rig rig(core_of(formula(name, scale), R"(, "search_radius": 0.6)"));
      for (int i = 0; i < 100; ++i) {
        const Vec3 x(random.uniform(-0.4, 0.4), random.uniform(-0.4, 0.4), random.uniform(-1.5, 1.5));
        ASSERT_EQ(rig.tick(x).status, LinkStatus::ok) << name << " " << scale << " " << i;
        ASSERT_LE(norm(rig.state.proxy - Vec3(0, 0, x.z)), 4e-12 * 4) << name << " " << scale;
        ASSERT_LE(rig.state.residual, 4e-12);
        ASSERT_EQ(rig.state.limit, 0.6);
      }
    }
}

TEST(VortexCore, TheTubeIsFreeInsideAndHoldsOutside) {
  Rig rig(core_of(formula("helix"), R"(, "radius": 0.2)"));
  expect_steps(rig, {{{0.1, -0.1, 0.3}, kFree, {0.1, -0.1, 0.3}}});
  EXPECT_TRUE(rig.state.active());
  for (int i = 0; i < 100; ++i) {
    const double a = 0.0628 * i;
    const Vec3 out(std::cos(a), std::sin(a), 0);
    const Vec3 x = out * 0.35 + Vec3(0, 0, 0.01 * i);
    ASSERT_EQ(rig.tick(x).status, LinkStatus::ok);
    ASSERT_LE(norm(rig.state.proxy - (out * 0.2 + Vec3(0, 0, 0.01 * i))), 1e-11);
  }
  // too far from the core (0.1 L = 0.4)
  expect_steps(rig, {{{0.41, 0, 0}, LinkStatus::no_surface, {0.41, 0, 0}}});
}

TEST(VortexCore, OfHillsVortexIsARing) {
  // stagnation ring r = 1 / sqrt 2, z = 0
  Rig rig(core_of(formula("hill"), R"(, "search_radius": 0.3)"));
  Random random(2);
  for (int i = 0; i < 2000; ++i) {
    const double a = 0.02 * i, r = 0.7 + random.uniform(-0.15, 0.15), z = random.uniform(-0.15, 0.15);
    const Vec3 x(r * std::cos(a), r * std::sin(a), z);
    ASSERT_EQ(rig.tick(x).status, LinkStatus::ok) << i;
    const Vec3 ring = Vec3(std::cos(a), std::sin(a), 0) * std::sqrt(0.5);
    ASSERT_LE(norm(rig.state.proxy - ring), 1e-9) << i;
  }
}

TEST(VortexCore, OfASampledTiltedVortexIsItsAxis) {
  // a helical vortex about the line through c along w, on a rotated grid: linear, so that sampling is exact up to float rounding
  const Vec3 w = direction(Vec3(0.3, -0.2, 1)), c(0.2, 0.1, -0.05);
  const auto flow = [&](const Vec3& p) { return 2.0 * cross(w, p - c) + 0.5 * w; };
  Mat3 axes(Vec3(0.08, 0.06, 0) * 1.0, Vec3(-0.06, 0.08, 0), Vec3(0, 0.01, 0.11));
  const auto grid = catena::test::sample_vector_grid(field::Mapping::from_linear(axes, Vec3(-1.0, -2.2, -1.6)), {40, 40, 32}, flow);
  Rig rig(core_of(grid, R"(, "search_radius": 0.5)"));
  Random random(3);
  for (int i = 0; i < 300; ++i) {
    const double s = random.uniform(-0.5, 0.5);
    const Vec3 off = cross(w, random.unit()) * 0.3, x = c + w * s + off;
    ASSERT_EQ(rig.tick(x).status, LinkStatus::ok) << i;
    ASSERT_LE(norm(rig.state.proxy - (c + w * s)), 2e-6) << i;
  }
}

TEST(VortexCore, HoldsOnAGridInEveryTick) {
  // around and along each core, with noise: held in every tick
  for (const catena::test::AnalyticCore& known : catena::test::analytic_cores())
    for (const bool cubic : {false, true})
      for (const double noise : {0.0, 0.02}) {
        const auto grid = catena::test::sample_core_flow(known, 33, noise, 3);
        Rig rig(core_of(cubic ? field::VectorFieldPtr(*grid->as_cubic()) : grid, R"(, "search_radius": 0.6)"));
        double longest = 0;
        for (std::size_t k = 10; k + 10 < known.points.size(); ++k)
          for (int i = 0; i < 5; ++i) {
            const double t = 0.2 * i, a = 0.1 * static_cast<double>(5 * k) + 0.1 * i;
            const Vec3 x = known.points[k] * (1 - t) + known.points[k + 1] * t + Vec3(std::cos(a), std::sin(a), std::sin(2 * a)) * 0.05;
            const Vec3 before = rig.state.proxy;
            ASSERT_EQ(rig.tick(x).status, LinkStatus::ok) << known.name << " " << cubic << " " << noise << " " << k;
            ASSERT_LE(norm(rig.state.proxy - known.nearest_point(rig.state.proxy)), 2.4 / 32) << "within a voxel";
            if (k > 10) longest = std::max(longest, norm(rig.state.proxy - before));
          }
        EXPECT_LE(longest, 2.4 / 32) << known.name << ": the proxy hops";
      }
}

TEST(VortexCore, IsConservative) {
  // work over closed loops of the probe about a core, by the trapezoidal rule, as a fraction of K gap^2
  for (const catena::test::AnalyticCore& known : catena::test::analytic_cores())
    for (const bool cubic : {false, true}) {
      const auto grid = catena::test::sample_core_flow(known, 33, 0, 3);
      Rig rig(core_of(cubic ? field::VectorFieldPtr(*grid->as_cubic()) : grid, R"(, "search_radius": 0.6)"));
      const Vec3 middle = known.points[known.points.size() / 2];
      const auto at = [&](int i) {
        const double a = 6.283185307179586 * i / 4000;
        return middle + Vec3(0.2 * std::cos(a), 0.15 * std::sin(a), 0.1 * std::sin(a + 1));
      };
      double work = 0, gap = 0;
      rig.tick(at(0));
      Vec3 force = rig.state.proxy - at(0);
      for (int i = 1; i <= 4000; ++i) {
        rig.tick(at(i));
        const Vec3 next = rig.state.proxy - at(i);
        work += 0.5 * dot(force + next, at(i) - at(i - 1));
        gap = std::max(gap, norm(next));
        force = next;
      }
      EXPECT_LE(std::fabs(work), 1e-6 * gap * gap) << known.name << " " << cubic;
    }
}

TEST(VortexCore, GivesNoForceWhereEveryPointIsACore) {
  Rig rig(core_of(formula("abc"), R"(, "criterion": "vorticity", "search_radius": 2)"));
  for (int i = 0; i < 20; ++i) {
    const Vec3 x(0.1 * i - 1, 0.3, 0.2);
    EXPECT_EQ(rig.tick(x).status, LinkStatus::critical);
    EXPECT_EQ(rig.state.reason, SampleStatus::parallel);
    EXPECT_TRUE(bitwise_equal(rig.state.proxy, x));
  }
}

TEST(VortexCore, WithoutSwirlTheProbePassesThrough) {
  Random random(4);
  for (const char* name : {"uniform", "saddle", "node"})
    for (const double scale : {1.0, 1e-300, 1e300})
      for (const bool sampled : {false, true}) {
        if (sampled && scale != 1) continue;
        const auto field = formula(name, scale);
        Rig rig(core_of(sampled ? field::sample_on_grid(*field, 17, -2, 2) : field));
        for (int i = 0; i < 50; ++i) {
          const Vec3 x = random.box(1.9);
          ASSERT_EQ(rig.tick(x).status, LinkStatus::no_surface) << name << " " << scale << " " << sampled;
          ASSERT_TRUE(bitwise_equal(rig.state.proxy, x));
        }
      }
}

TEST(VortexCore, EndsAtTheDomainBoundary) {
  Rig rig(core_of(field::sample_on_grid(*formula("helix"), 17, -2, 2)));
  for (int i = 0; i <= 60; ++i) rig.tick({0.1, 0.05, 1.5 + 0.01 * i});
  EXPECT_EQ(rig.state.status, LinkStatus::boundary);
  EXPECT_LE(norm(rig.state.proxy - Vec3(0, 0, 2)), 0.02);
  EXPECT_LE(rig.state.proxy.z, 2);
  EXPECT_EQ(rig.tick({0.1, 0.05, 1.9}).status, LinkStatus::ok);
  EXPECT_LE(norm(rig.state.proxy - Vec3(0, 0, 1.9)), 1e-6);
}

TEST(VortexCore, SnapsAndReleases) {
  Rig rig(core_of(formula("helix"), R"(, "search_radius": 1, "snap": 0.1, "release": 0.3)"));
  expect_steps(rig, {{{0.2, 0, 0}, kReleased}, {{0.09, 0, 0.2}, kOk}});
  EXPECT_LE(norm(rig.state.proxy - Vec3(0, 0, 0.2)), 1e-11);
  expect_steps(rig, {{{0.29, 0, 0.2}, kOk}, {{0.31, 0, 0.2}, kReleased}});
}

TEST(VortexCore, AnotherCoreHoldsAfterOneReleasedTick) {
  // two vortices along z, at x = -0.6 and 0.6
  const auto turn = [](const Vec3& p, double x) {
    const Vec3 e(p.x - x, p.y, 0);
    return catena::test::swirl_rate(dot(e, e), 0.2) * Vec3(-e.y, e.x, 0);
  };
  const auto mapping = field::Mapping::from_linear(Mat3(0.1), Vec3(-1.2));
  const auto field = catena::test::sample_vector_grid(mapping, {25, 25, 25}, [&](const Vec3& p) { return turn(p, -0.6) + turn(p, 0.6); });
  for (const char* rules : {R"(, "search_radius": 2)", R"(, "search_radius": 2, "snap": 1, "release": 3)"}) {
    Rig rig(core_of(field, rules));
    int curve = -1, released = 0;
    for (int i = 0; i <= 400; ++i) {
      rig.tick({-0.6 + 0.003 * i, 0.05, 0.1});
      if (rig.state.status == LinkStatus::released) {
        ++released;
        EXPECT_GT(i, 200);
        EXPECT_EQ(rig.state.curve_index, -1);
        EXPECT_EQ(rig.state.proxy, Vec3(-0.6 + 0.003 * i, 0.05, 0.1));
        curve = -1;
        continue;
      }
      ASSERT_EQ(rig.state.status, LinkStatus::ok) << i;
      ASSERT_TRUE(curve < 0 || curve == rig.state.curve_index) << i;
      curve = rig.state.curve_index;
      ASSERT_NEAR(rig.state.proxy.x, released > 0 ? 0.6 : -0.6, 0.05);
    }
    EXPECT_EQ(released, 1) << rules;
  }
}

TEST(VortexCore, OnRealDataIsBoundedAndRests) {
  const std::string path = catena::test::shared_data("combustor_cfd.vdb");
  if (path.empty()) GTEST_SKIP() << "combustor_cfd.vdb is not beside the checkout";
  field::LoadRequest request;
  request.path = path;
  request.grid = "velocity";
  const auto velocity = field::load(request)->vector;
  Rig rig(core_of(velocity, R"(, "search_radius": 1)"));
  Random random(5);
  const field::Box& box = velocity->index_box();
  int max_work = 0;
  int held = 0, ticks = 0;
  for (int walk = 0; walk < 200; ++walk) {
    Vec3 x = velocity->mapping().world_from_index(
        {random.uniform(box.lo.x, box.hi.x), random.uniform(box.lo.y, box.hi.y), random.uniform(box.lo.z, box.hi.z)});
    const Vec3 way = random.unit() * 0.01;
    for (int i = 0; i < 100; ++i, x += way, ++ticks) {
      ASSERT_TRUE(is_finite(rig.tick(x).proxy));
      max_work = std::max(max_work, rig.state.work());
      held += rig.state.status != LinkStatus::no_surface;
      if (i % 10 > 0 || rig.state.status == LinkStatus::released) continue;
      const Vec3 rest = rig.state.proxy;
      ASSERT_TRUE(bitwise_equal(rig.tick(x).proxy, rest));
    }
  }
  EXPECT_LE(max_work, kMaxWork);
  EXPECT_GT(held, ticks / 100);
}

TEST(VortexCore, ThePrimitiveInTheBaselinesIsALine) {
  Rig rig(core_of(formula("helix")));
  rig.tick({0.1, 0.2, 0.3});
  Primitive line;
  ASSERT_TRUE(rig.constraint->has_primitive());
  ASSERT_TRUE(rig.constraint->primitive({0.1, 0.2, 0.3}, rig.state, rig.scratch, line));
  EXPECT_EQ(line.kind, Primitive::Kind::line);
  EXPECT_LE(norm(cross(line.axis, Vec3(0, 0, 1))), 1e-9);
  EXPECT_FALSE(core_of(formula("helix"), R"(, "radius": 0.1)")->has_primitive());
}

TEST(VortexCore, RefusesBadKeys) {
  Fields fields = scalars({{"s", analytic_field("sphere")}});
  fields.named["v"].vector = formula("helix");
  const std::pair<const char*, const char*> bad[] = {{R"("field": "s")", "vector field"},
                                                     {R"("field": "v", "radius": -1)", "radius"},
                                                     {R"("field": "v", "search_radius": 0)", "search"},
                                                     {R"("field": "v", "criterion": "q")", "sujudi-haimes"},
                                                     {R"("field": "v", "least_swirl": 2)", "least_swirl"},
                                                     {R"("field": "v", "radius": 0.3, "search_radius": 0.3)", "> \"radius\""}};
  for (const auto& [keys, what] : bad)
    expect_refused("{\"name\": \"a\", \"type\": \"vortex_core\",\n" + std::string(keys) + "}", 2, {what}, fields);
}

}  // namespace catena::haptics::tests::vortex_core_test
