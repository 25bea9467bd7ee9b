// SPDX-License-Identifier: MIT
// The preset `anisotropic_friction` (paper, section 6.1) in the whole tick: on a sphere, on sampled fields, on real data.
#include "tests/haptics/build/build_fixture.h"
#include "tests/haptics/constraints/friction_fixture.h"

namespace catena::haptics::anisotropic_friction_test {

struct Bench : test::ChainDriver {
  scene::Scene scene;

  explicit Bench(const std::string& text) : scene(build_tests::scene_of(text)) { program = *build_tests::program_of(scene); }
  void to(const Vec3& probe) { step(probe); }
  field::AnyField field(const std::string& name) { return scene::resolve_field(scene, name, json::Node{}).value(); }
  const Vec3& proxy(std::size_t i) const { return out.links[i].proxy; }
  LinkStatus status(std::size_t i) const { return out.links[i].status; }
};

/// A hand that wanders along the surface, in and out of it, with rests and jerks.
void explore(const std::string& text, const std::string& surface_name, double level, const Vec3& from, int ticks) {
  Bench bench(text);
  ASSERT_EQ(bench.program.links.size(), 3u);
  const auto surface = bench.field(surface_name).scalar;
  const double length = surface->domain_length();
  tests::Random random(5);
  Vec3 hand = from, v = random.unit();
  int on = 0, lost = 0;
  bench.to(hand);
  for (int i = 0; i < ticks; ++i) {
    const double step = i % 1000 < 100 ? 0 : i % 5000 < 4990 ? 5e-4 * length : 0.02 * length;
    v = direction(v + random.unit() * 0.2);
    hand = bench.proxy(0) + v * step + (hand - bench.proxy(0)) * 0.9;
    bench.to(hand);
    if (bench.status(0) != LinkStatus::ok) {
      v = -v;
      continue;
    }
    ++on;
    for (std::size_t k = 0; k < 3; ++k) {
      ASSERT_TRUE(is_finite(bench.proxy(k)));
      ASSERT_LE(tests::off_level(*surface, level, bench.proxy(k)) / length, 1e-9);
      ASSERT_NE(bench.status(k), LinkStatus::free);
      lost += bench.status(k) == LinkStatus::no_surface;
      const double gap = k > 0 && bench.status(k) == LinkStatus::ok ? norm(bench.proxy(k) - bench.proxy(k - 1)) : 0;
      ASSERT_LE((gap - bench.state.links[k].limit) / length, 1e-12);
    }
  }
  EXPECT_GT(on, ticks / 2);
  EXPECT_LE(lost, ticks / 500);
}
/// A preset on two grids of a file.
std::string grids_of(const std::string& path, const std::string& surface, const std::string& field, const std::string& keys) {
  return fmt::format(R"({{"fields": {{"{1}": {{"file": "{0}", "grid": "{1}"}}, "{2}": {{"file": "{0}", "grid": "{2}"}}}},
    "chain": [{{"name": "skin", "type": "anisotropic_friction", "surface": "{1}", "field": "{2}", {3}}}]}})",
                     path, surface, field, keys);
}

const std::string kSphere = R"({"fields": {"ball": {"analytic": "sphere"}, "swirl": {"analytic": "circle"}},
  "coupling": {"stiffness": 100, "max_force": 1e9},
  "chain": [{"name": "skin", "type": "anisotropic_friction", "surface": "ball", "level": 1, "field": "swirl")";

TEST(AnisotropicFriction, KeepsTheProxyOnASphere) { explore(kSphere + "}]}", "ball", 1, {0.9, 0.3, 0.4}, 50000); }

TEST(AnisotropicFriction, KeepsTheProxyOnSampledFields) {
  const test::TemporaryFolder folder;
  const auto torus = field::make_analytic("torus"), hill = field::make_analytic("hill");
  const field::AnyField s{field::sample_on_grid(*torus->scalar, 64, -1.2, 1.2), nullptr};
  const field::AnyField v{nullptr, field::sample_on_grid(*hill->vector, 64, -1.2, 1.2)};
  ASSERT_TRUE(field::write_vdb(folder / "a.vdb", {{s, "s"}, {v, "v"}}));
  explore(grids_of(folder / "a.vdb", "s", "v", R"("level": 0.3)"), "s", 0.3, {0.9, 0.3, 0.2}, 30000);
}

TEST(AnisotropicFriction, KeepsTheProxyOnTheCombustorsDensity) {
  const std::string path = test::shared_data("combustor_cfd.vdb");
  if (path.empty()) GTEST_SKIP() << "combustor_cfd.vdb is not beside the checkout";
  explore(grids_of(path, "density", "velocity", R"("level": 0.45)"), "density", 0.45, {8, 0, 29}, 50000);
}

TEST(AnisotropicFriction, KeepsTheProxyOnTheVentricle) {
  const std::string path = test::shared_data("ideal_lv_fibres.vdb");
  if (path.empty()) GTEST_SKIP() << "ideal_lv_fibres.vdb is not beside the checkout";
  explore(grids_of(path, "density", "fibre", R"("level": 0.5, "kind": "line")"), "density", 0.5, {30, 0, 0}, 50000);
}

// paper, figure 5: low force along the field, high force across it
TEST(AnisotropicFriction, LowForceAlongTheFieldHighForceAcross) {
  Bench bench(kSphere + R"(, "threshold": 0.05, "tau_min": 0.004, "tau_max": 0.1}]})");
  const auto at = [](double longitude, double latitude) {
    return Vec3(std::cos(latitude) * std::cos(longitude), std::cos(latitude) * std::sin(longitude), std::sin(latitude));
  };
  for (int k = 0; k <= 1000; ++k) bench.to(at(1e-3 * k, 0.3));
  EXPECT_NEAR(norm(bench.out.force_n), 100 * 0.004, 1e-6 * 100);  // K tau_min: the field is tangential
  EXPECT_LE(norm(bench.proxy(1) - bench.proxy(0)), 1e-8);
  for (int k = 0; k <= 1000; ++k) bench.to(at(1, 0.3 - 1e-3 * k));
  EXPECT_NEAR(norm(bench.out.force_n), 100 * (0.05 + 0.004), 0.01 * 100 * 0.054);
  EXPECT_NEAR(norm(bench.proxy(1) - bench.proxy(0)), 0.05, 1e-12);
  EXPECT_NEAR(norm(bench.proxy(2) - bench.proxy(1)), 0.004, 1e-12);
}

TEST(AnisotropicFriction, AFieldAlongTheNormalGivesTheMaximumThreshold) {
  // uniform z on the plane z = 0
  Bench bench(R"({"fields": {"floor": {"analytic": "plane"}, "up": {"analytic": "uniform", "direction": [0, 0, 1]}},
    "chain": [{"name": "skin", "type": "anisotropic_friction", "surface": "floor", "level": 0, "field": "up", "threshold": 0.01,
               "tau_min": 0.004, "tau_max": 0.1}]})");
  for (int k = 0; k <= 1000; ++k) bench.to(Vec3(1e-3 * k, 0, -0.1));
  EXPECT_NEAR(norm(bench.proxy(2) - bench.proxy(1)), 0.1, 1e-12);
  EXPECT_NEAR(norm(bench.proxy(1) - bench.proxy(0)), 0.01, 1e-12);  // no tangential direction: isotropic
}

// on the free side and after release there is no friction
TEST(AnisotropicFriction, PassesTheProbeThroughWhereTheSurfaceIsFreeOrReleased) {
  Bench bench(kSphere + R"(, "free": "above", "release": 0.2}]})");
  const auto passes = [&](const Vec3& probe, LinkStatus surface) {
    bench.to(probe);
    EXPECT_EQ(bench.status(0), surface);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_TRUE(bitwise_equal(bench.proxy(k), probe)) << k;
    for (std::size_t k = 1; k < 3; ++k) EXPECT_EQ(bench.status(k), LinkStatus::free);
    EXPECT_EQ(norm(bench.out.force_n), 0);
  };
  passes({0, 0, 1.3}, LinkStatus::free);
  passes({0.2, 0, 1.2}, LinkStatus::free);
  bench.to({0.5, 0, 0.7});
  EXPECT_EQ(bench.status(0), LinkStatus::ok);
  EXPECT_EQ(bench.status(2), LinkStatus::ok);
  EXPECT_NEAR(norm(bench.proxy(2)), 1, 1e-11);
  passes({0.4, 0, 0.5}, LinkStatus::released);
  passes({0.3, 0.2, 0.5}, LinkStatus::released);
  passes({0.3, 0.2, 1.5}, LinkStatus::free);
}

TEST(AnisotropicFriction, AModeNamesAllItsLinksByOneName) {
  const std::string modes = R"(}, {"name": "p", "type": "point", "position": [0, 0, 0]}],
    "modes": [{"name": "all", "links": ["p", "skin"], "active_when": {"button": 1}}, {"name": "part", "links": ["skin_friction"], "active_when": {"button": 2}}]})";
  Bench bench(kSphere + modes);
  EXPECT_EQ(bench.program.modes[0].links, (std::vector<int>{3, 0, 1, 2}));
  EXPECT_EQ(bench.program.modes[1].links, (std::vector<int>{2}));
}

TEST(AnisotropicFriction, ErrorsNameTheLine) {
  const auto refused = [](const std::string& more, int line, const char* what) { build_tests::expect_error(kSphere + more, line, {what}); };
  refused(",\n\"tau_min\": -1}]}", 4, "tau_min");
  refused(",\n\"position\": 1}]}", 4, "unknown key");
  refused(",\n\"law\": \"paper\"}]}", 4, "law");
  const std::string point = R"(, "type": "point", "position": [0, 0, 0]})";
  refused("},\n{\"name\": \"skin_friction\"" + point + "]}", 4, "duplicate link name");
  std::string many = "}";
  for (int i = 0; i < 6; ++i) many += ",\n{\"name\": \"p" + std::to_string(i) + "\"" + point;
  refused(many + "]}", 9, "too many links");
}

}  // namespace catena::haptics::anisotropic_friction_test
