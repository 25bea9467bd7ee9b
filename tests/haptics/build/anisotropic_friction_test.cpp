// SPDX-License-Identifier: MIT
// The preset `anisotropic_friction` (paper, section 6.1) in the whole tick: on a sphere, on sampled fields, on real data.
#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "haptics/build/build_program.h"
#include "haptics/chain/tick.h"
#include "tests/support/support.h"

namespace catena::haptics {
namespace anisotropic_friction_test {

struct Random {
  std::mt19937_64 engine;
  double in(double lo, double hi) { return lo + (hi - lo) * (static_cast<double>(engine() >> 11) * 0x1p-53); }
  Vec3 unit() {
    while (true) {
      const Vec3 v(in(-1, 1), in(-1, 1), in(-1, 1));
      if (dot(v, v) < 1 && dot(v, v) > 1e-4) return direction(v);
    }
  }
};

struct Bench {
  scene::Scene scene;
  std::shared_ptr<const HapticProgram> program;
  ChainState state;
  ChainScratch scratch;
  HapticState out;
  double t_s = 0;
  bool ok = false;

  explicit Bench(const std::string& text) {
    auto read = scene::parse_scene(text, "scene.json");
    EXPECT_TRUE(read) << read.error().message;
    if (!read) return;
    scene = std::move(*read);
    auto made = build_program(scene);
    EXPECT_TRUE(made) << made.error().message;
    if (!made) return;
    program = *made;
    ok = true;
  }
  void to(const Vec3& probe) {
    tick(*program, {t_s, probe, 0}, state, scratch, out);
    t_s += 1e-3;
  }
  field::AnyField field(const std::string& name) { return scene::resolve_field(scene, name, json::Node{}).value(); }
  const Vec3& proxy(std::size_t i) const { return out.links[i].proxy; }
  LinkStatus status(std::size_t i) const { return out.links[i].status; }
};

double off_level(const field::ScalarField& surface, double level, const Vec3& p) {
  field::Cursor cursor;
  const field::ScalarSample s = surface.sample(p, cursor);
  return std::fabs(s.value - level) / norm(s.gradient);
}

/// A hand that wanders along the surface, in and out of it, with rests and jerks.
void explore(Bench& bench, const char* name, const std::string& surface_name, double level, const Vec3& from, int ticks) {
  const auto surface = bench.field(surface_name).scalar;
  const double length = surface->domain_length();
  Random random{std::mt19937_64(5)};
  Vec3 hand = from, v = random.unit();
  double worst[3] = {0, 0, 0}, worst_residual = 0, worst_gap = 0;
  int on = 0, lost = 0, bad = 0, other = 0, budget = 0, off = 0;
  std::vector<int> evaluations[3];
  bench.to(hand);
  for (int i = 0; i < ticks; ++i) {
    const double step = i % 1000 < 100 ? 0 : i % 5000 < 4990 ? 5e-4 * length : 0.02 * length;
    v = direction(v + random.unit() * 0.2);
    hand = bench.proxy(0) + v * step + (hand - bench.proxy(0)) * 0.9;
    bench.to(hand);
    for (std::size_t k = 0; k < 3; ++k) evaluations[k].push_back(bench.out.links[k].evaluations);
    if (bench.status(0) != LinkStatus::ok) {
      ++other;
      v = -v;
      continue;
    }
    ++on;
    for (std::size_t k = 1; k < 3; ++k) {
      lost += bench.status(k) == LinkStatus::no_surface;
      budget += bench.status(k) == LinkStatus::budget;
      off += bench.status(k) == LinkStatus::free;
      bad += bench.status(k) == LinkStatus::critical || bench.status(k) == LinkStatus::boundary;
    }
    for (std::size_t k = 0; k < 3; ++k) {
      ASSERT_TRUE(is_finite(bench.proxy(k)));
      const double here = off_level(*surface, level, bench.proxy(k)) / length;
      worst[k] = std::max(worst[k], here);
      if (k > 0 && bench.status(k) == LinkStatus::ok) {
        worst_residual = std::max(worst_residual, bench.out.links[k].residual / length);
        worst_gap = std::max(worst_gap, (norm(bench.proxy(k) - bench.proxy(k - 1)) - bench.state.links[k].limit) / length);
      }
    }
  }
  std::printf(
      "%-10s on %d, other %d; off the level / L %.1e %.1e %.1e, residual %.1e, gap - tau %.1e; NO_SURFACE %d, FREE %d, BUDGET %d, "
      "CRITICAL or BOUNDARY %d; evaluations",
      name, on, other, worst[0], worst[1], worst[2], worst_residual, worst_gap, lost, off, budget, bad);
  for (std::vector<int>& e : evaluations) {
    std::sort(e.begin(), e.end());
    std::printf("  %d %d %d", e[e.size() / 2], e[e.size() * 99 / 100], e.back());
  }
  std::printf("\n");
  EXPECT_GT(on, ticks / 2);
  for (const double w : worst) EXPECT_LE(w, 1e-9);
  EXPECT_LE(worst_gap, 1e-12);
  EXPECT_LE(lost, ticks / 500);
  EXPECT_EQ(off, 0);
}

const std::string kSphere = R"({"fields": {"ball": {"analytic": "sphere"}, "swirl": {"analytic": "circle"}},
  "coupling": {"stiffness": 100, "max_force": 1e9},
  "chain": [{"name": "skin", "type": "anisotropic_friction", "surface": "ball", "level": 1, "field": "swirl")";

TEST(AnisotropicFriction, KeepsTheProxyOnASphere) {
  Bench bench(kSphere + "}]}");
  ASSERT_TRUE(bench.ok);
  ASSERT_EQ(bench.program->links.size(), 3u);
  explore(bench, "sphere", "ball", 1, {0.9, 0.3, 0.4}, 50000);
}

TEST(AnisotropicFriction, KeepsTheProxyOnSampledFields) {
  const test::TemporaryFolder folder;
  const auto torus = field::make_analytic("torus"), hill = field::make_analytic("hill");
  const field::AnyField s{field::sample_on_grid(*torus->scalar, 64, -1.2, 1.2), nullptr};
  const field::AnyField v{nullptr, field::sample_on_grid(*hill->vector, 64, -1.2, 1.2)};
  ASSERT_TRUE(field::write_vdb(folder / "a.vdb", {{s, "s"}, {v, "v"}}));
  Bench bench(
      R"({"fields": {"s": {"file": ")" + folder / "a.vdb" + R"(", "grid": "s"}, "v": {"file": ")" + folder / "a.vdb" +
      R"(", "grid": "v"}}, "chain": [{"name": "skin", "type": "anisotropic_friction", "surface": "s", "level": 0.3, "field": "v"}]})");
  ASSERT_TRUE(bench.ok);
  explore(bench, "torus 64^3", "s", 0.3, {0.9, 0.3, 0.2}, 30000);
}

TEST(AnisotropicFriction, KeepsTheProxyOnTheCombustorsDensity) {
  const std::string path = test::shared_data("combustor_cfd.vdb");
  if (path.empty()) GTEST_SKIP() << "combustor_cfd.vdb is not beside the checkout";
  Bench bench(R"({"fields": {"density": {"file": ")" + path + R"(", "grid": "density"}, "velocity": {"file": ")" + path +
              R"(", "grid": "velocity"}}, "chain": [{"name": "skin", "type": "anisotropic_friction", "surface": "density", "level": 0.45,
              "field": "velocity"}]})");
  ASSERT_TRUE(bench.ok);
  explore(bench, "combustor", "density", 0.45, {8, 0, 29}, 50000);
}

TEST(AnisotropicFriction, KeepsTheProxyOnTheVentricle) {
  const std::string path = test::shared_data("ideal_lv_fibres.vdb");
  if (path.empty()) GTEST_SKIP() << "ideal_lv_fibres.vdb is not beside the checkout";
  Bench bench(R"({"fields": {"density": {"file": ")" + path + R"(", "grid": "density"}, "fibre": {"file": ")" + path +
              R"(", "grid": "fibre"}}, "chain": [{"name": "skin", "type": "anisotropic_friction", "surface": "density", "level": 0.5,
              "field": "fibre", "kind": "line"}]})");
  ASSERT_TRUE(bench.ok);
  explore(bench, "ventricle", "density", 0.5, {30, 0, 0}, 50000);
}

// paper, figure 5: low force along the field, high force across it
TEST(AnisotropicFriction, LowForceAlongTheFieldHighForceAcross) {
  Bench bench(kSphere + R"(, "threshold": 0.05, "tau_min": 0.004, "tau_max": 0.1}]})");
  ASSERT_TRUE(bench.ok);
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
  ASSERT_TRUE(bench.ok);
  for (int k = 0; k <= 1000; ++k) bench.to(Vec3(1e-3 * k, 0, -0.1));
  EXPECT_NEAR(norm(bench.proxy(2) - bench.proxy(1)), 0.1, 1e-12);
  EXPECT_NEAR(norm(bench.proxy(1) - bench.proxy(0)), 0.01, 1e-12);  // no tangential direction: isotropic
}

// on the free side and after release there is no friction
TEST(AnisotropicFriction, PassesTheProbeThroughWhereTheSurfaceIsFreeOrReleased) {
  Bench bench(kSphere + R"(, "free": "above", "release": 0.2}]})");
  ASSERT_TRUE(bench.ok);
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
  ASSERT_TRUE(bench.ok);
  EXPECT_EQ(bench.program->modes[0].links, (std::vector<int>{3, 0, 1, 2}));
  EXPECT_EQ(bench.program->modes[1].links, (std::vector<int>{2}));
}

TEST(AnisotropicFriction, ErrorsNameTheLine) {
  const auto refused = [](const std::string& more, const std::string& line, const std::string& what) {
    auto scene = scene::parse_scene(kSphere + more, "scene.json");
    ASSERT_TRUE(scene) << scene.error().message;
    const auto made = build_program(*scene);
    ASSERT_FALSE(made);
    EXPECT_EQ(made.error().message.rfind("scene.json:" + line + ": ", 0), 0u) << made.error().message;
    EXPECT_NE(made.error().message.find(what), std::string::npos) << made.error().message;
  };
  refused(",\n\"tau_min\": -1}]}", "4", "tau_min");
  refused(",\n\"position\": 1}]}", "4", "unknown key");
  refused(",\n\"law\": \"paper\"}]}", "4", "law");
  const std::string point = R"(, "type": "point", "position": [0, 0, 0]})";
  refused("},\n{\"name\": \"skin_friction\"" + point + "]}", "4", "duplicate link name");
  std::string many = "}";
  for (int i = 0; i < 6; ++i) many += ",\n{\"name\": \"p" + std::to_string(i) + "\"" + point;
  refused(many + "]}", "9", "too many links");
}

}  // namespace anisotropic_friction_test
}  // namespace catena::haptics
