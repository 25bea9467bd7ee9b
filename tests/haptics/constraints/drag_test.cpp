// SPDX-License-Identifier: MIT
#include "haptics/chain/tick.h"
#include "tests/haptics/constraints/friction_fixture.h"

namespace catena::haptics::tests {
namespace drag_test {

std::string drag(const std::string& threshold, const std::string& more = "") {
  return R"({"name": "a", "type": "drag", "threshold": )" + threshold + more + "}";
}

TEST(Drag, SticksExactlyAndSlidesAtTheThreshold) {
  for (const double size : {1e-9, 1.0, 1e6}) {
    const double tau = 0.05 * size;
    char text[40];
    std::snprintf(text, sizeof text, "%.17g", tau);
    Rig rig(build(drag(text)));
    Random random(4);
    Vec3 probe = random.box(size);
    rig.tick(probe);
    EXPECT_TRUE(bitwise_equal(rig.state.proxy, probe));  // starts at the link's input
    int stuck = 0, slid = 0;
    for (int i = 0; i < 5000; ++i) {
      const Vec3 before = rig.state.proxy;
      probe = probe + random.unit() * (0.01 * size);
      rig.tick(probe);
      EXPECT_EQ(rig.state.status, LinkStatus::ok);
      EXPECT_EQ(rig.state.limit, tau);
      EXPECT_EQ(rig.state.evaluations, 0);
      if (norm(probe - before) <= tau) {
        ASSERT_TRUE(bitwise_equal(rig.state.proxy, before));
        ++stuck;
      } else {
        ASSERT_NEAR(norm(probe - rig.state.proxy), tau, 1e-15 * std::max(norm(probe), tau));
        // towards the probe
        ASSERT_LE(norm(cross(rig.state.proxy - before, direction(probe - before))), 1e-15 * norm(probe));
        ++slid;
      }
    }
    EXPECT_GT(stuck, 100);
    EXPECT_GT(slid, 100);
  }
}

TEST(Drag, IsIsotropic) {
  Random random(5);
  for (int i = 0; i < 200; ++i) {
    Rig rig(build(drag("0.1")));
    rig.tick(Vec3(0.0));
    const Vec3 way = random.unit();
    rig.tick(way * 0.0999999);
    EXPECT_TRUE(bitwise_equal(rig.state.proxy, Vec3(0.0)));
    rig.tick(way * 0.3);
    EXPECT_LE(norm(rig.state.proxy - way * 0.2), 1e-16);
  }
}

TEST(Drag, AZeroThresholdGivesNoDrag) {
  Rig rig(build(drag("0")));
  Random random(6);
  for (int i = 0; i < 100; ++i) {
    const Vec3 probe = random.box(3);
    rig.tick(probe);
    EXPECT_TRUE(bitwise_equal(rig.state.proxy, probe));
  }
}

// 4 K tau (A - tau) per loop, in the whole tick
TEST(Drag, DissipatesTheWorkOfALoop) {
  constexpr double kTau = 0.02, kAmplitude = 0.1, kStiffness = 400;
  constexpr int kLoop = 20000;
  HapticProgram program;
  program.coupling.max_force_n = 1e9;
  Link link;
  link.name = "a";
  link.constraint = build(drag("0.02"));
  link.stiffness_n_per_m = kStiffness;
  program.links.push_back(link);
  const Vec3 way = direction(Vec3(1, -2, 0.5));
  ChainState state;
  ChainScratch scratch;
  HapticState out;
  double work = 0;
  Vec3 last_probe(0.0), last_force(0.0);
  for (int k = 0; k <= 2 * kLoop; ++k) {
    const Vec3 probe = way * (kAmplitude * std::sin(2 * 3.14159265358979323846 * k / kLoop));
    tick(program, {k * 1e-4, probe, 0}, state, scratch, out);
    if (k > kLoop) work -= dot(probe - last_probe, out.force_n + last_force) * 0.5;
    last_probe = probe;
    last_force = out.force_n;
  }
  const double expected = 4 * kStiffness * kTau * (kAmplitude - kTau);
  std::printf("work of a loop: %.9g J, closed form %.9g J, relative %.2g\n", work, expected, work / expected - 1);
  EXPECT_NEAR(work, expected, 1e-4 * expected);
}

TEST(Drag, TheThresholdMayFollowAField) {
  Fields fields;
  fields.named["r"].scalar = analytic_field("sphere");
  Rig rig(build(drag(R"({"field": "r", "map": [[0, 0.1], [2, 0.3]]})"), fields));
  rig.tick({1, 0, 0});
  EXPECT_EQ(rig.state.limit, 0.2);
  rig.tick({1.5, 0, 0});
  EXPECT_NEAR(rig.state.proxy.x, 1.3, 1e-15);  // the threshold at the proxy before it moved
  rig.tick({1.6, 0, 0});
  EXPECT_NEAR(rig.state.limit, 0.23, 1e-15);
}

// on a surface: sticks exactly; where it slides, |x - p| = tau on the level
TEST(Drag, OnASurfaceSticksExactlyAndSlidesAtTheThreshold) {
  struct Case {
    const char* name;
    field::ScalarFieldPtr field;
    double level;
  };
  const std::vector<Case> cases{{"sphere", analytic_field("sphere"), 1},
                                {"torus", analytic_field("torus"), 0.4},
                                {"sphere 32^3", sampled_field("sphere", 32), 1},
                                {"torus 64^3", sampled_field("torus", 64), 0.4}};
  for (const Case& c : cases) {
    Fields fields;
    fields.named["s"].scalar = c.field;
    Rig rig(build(drag("0.03", ", \"surface\": \"s\", \"level\": " + std::to_string(c.level)), fields));
    const std::vector<Vec3> path = walk_on_surface(c.field, c.level, {1, 0.1, 0.2}, 0.004, 20000, 7);
    ASSERT_GT(path.size(), 15000u);
    Quantiles evaluations;
    double worst_level = 0, worst_gap = 0;
    int stuck = 0, off = 0, lost = 0;
    for (const Vec3& probe : path) {
      const Vec3 before = rig.state.proxy;
      rig.tick(probe);
      evaluations.add(rig.state.evaluations);
      lost += rig.state.status != LinkStatus::ok;
      if (rig.state.status != LinkStatus::ok) continue;
      worst_level = std::max(worst_level, off_level(*c.field, c.level, rig.state.proxy));
      if (norm(probe - before) <= 0.03) {
        ASSERT_TRUE(bitwise_equal(rig.state.proxy, before));
        ++stuck;
      } else if (&probe != &path.front()) {
        const double error = std::fabs(norm(probe - rig.state.proxy) - 0.03);
        worst_gap = std::max(worst_gap, error);
        off += error > 1e-12;
      }
    }
    std::printf("%-12s off level %.1e, gap - tau %.1e (%d of %zu over 1e-12), stuck %d, lost %d, evaluations %d %d %d\n", c.name,
                worst_level, worst_gap, off, path.size(), stuck, lost, evaluations.at_quantile(0.5), evaluations.at_quantile(0.99),
                evaluations.at_quantile(1));
    EXPECT_EQ(lost, 0);
    EXPECT_GT(stuck, 500);
    EXPECT_LE(worst_level, 4e-12);
    EXPECT_LE(worst_gap, 1e-12);
  }
}

TEST(Drag, OffTheSurfaceThereIsNoFriction) {
  Fields fields;
  fields.named["s"].scalar = analytic_field("sphere");
  Rig rig(build(drag("0.2", R"(, "surface": "s", "level": 1)"), fields));
  EXPECT_EQ(rig.tick({0, 0, 1.2}).status, LinkStatus::free);
  EXPECT_TRUE(bitwise_equal(rig.state.proxy, Vec3(0, 0, 1.2)));
  EXPECT_EQ(rig.tick({0, 0, 1}).status, LinkStatus::ok);
  EXPECT_EQ(rig.tick({0.1, 0, std::sqrt(0.99)}).status, LinkStatus::ok);
  EXPECT_TRUE(bitwise_equal(rig.state.proxy, Vec3(0, 0, 1)));  // sticks
  EXPECT_EQ(rig.tick({0.1, 0, 1.1}).status, LinkStatus::free);
  EXPECT_TRUE(bitwise_equal(rig.state.proxy, Vec3(0.1, 0, 1.1)));
  EXPECT_EQ(rig.tick({0, 0.6, 0.8}).status, LinkStatus::ok);  // starts where the probe returns to the surface
  EXPECT_LE(norm(rig.state.proxy - Vec3(0, 0.6, 0.8)), 1e-15);
}

// two spheres without a surface between them to slide on
TEST(Drag, AJumpToAnotherSheetRestartsThere) {
  const auto two = sample_scalar_grid(field::Mapping::from_linear(Mat3(0.1), Vec3(-2.0)), {41, 41, 41},
                                      [](const Vec3& p) { return std::min(norm(p - Vec3(1, 0, 0)), norm(p + Vec3(1, 0, 0))); });
  Fields fields;
  fields.named["s"].scalar = two;
  const Vec3 left = walk_on_surface(two, 0.5, {-1.5, 0.1, 0}, 0.001, 2, 1).back(),
             right = walk_on_surface(two, 0.5, {1.5, 0.1, 0}, 0.001, 2, 1).back();
  Rig rig(build(drag("0.8", R"(, "surface": "s", "level": 0.5)"), fields));
  rig.tick(left);
  rig.tick(right);
  EXPECT_TRUE(is_finite(rig.state.proxy));
  if (rig.state.status == LinkStatus::no_surface) {
    EXPECT_TRUE(bitwise_equal(rig.state.proxy, right));
  } else {
    EXPECT_LE(norm(right - rig.state.proxy), norm(right - left));
    EXPECT_LE(off_level(*two, 0.5, rig.state.proxy), 4e-9);
  }
}

TEST(Drag, RefusesBadKeys) {
  Fields fields;
  fields.named["s"].scalar = analytic_field("sphere");
  fields.named["v"].vector = field::make_analytic("circle")->vector;
  const auto refused = [&](const std::string& text, const std::string& what) {
    const auto made = try_build(text, fields);
    ASSERT_FALSE(made) << text;
    EXPECT_EQ(made.error().message.rfind("scene.json:1: ", 0), 0u) << made.error().message;
    EXPECT_NE(made.error().message.find(what), std::string::npos) << made.error().message;
  };
  refused(R"({"name": "a", "type": "drag"})", "threshold");
  refused(drag("-1"), "threshold");
  refused(drag("1", R"(, "level": 1)"), "no \"surface\"");
  refused(drag("1", R"(, "surface": "s")"), "no \"level\"");
  refused(drag("1", R"(, "surface": "v", "level": 1)"), "vector field");
  refused(drag("1", R"(, "surface": "s", "level": -3)"), "not attained");
  refused(drag("1", R"(, "surfaces": "s")"), "unknown key");
}

}  // namespace drag_test
}  // namespace catena::haptics::tests
