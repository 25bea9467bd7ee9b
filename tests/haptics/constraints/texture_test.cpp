// SPDX-License-Identifier: MIT
#include "tests/haptics/constraints/friction_fixture.h"

namespace catena::haptics::tests::texture_test {

std::string texture(const std::string& more) { return R"({"name": "a", "type": "texture", "threshold": 0.05)" + more + "}"; }

/// |x - p| over a sweep along `way` from `from`, at 0.001 units per tick.
std::vector<double> sweep(Rig& rig, const Vec3& from, const Vec3& way, int ticks) {
  std::vector<double> gaps;
  for (int k = 0; k < ticks; ++k) {
    const Vec3 probe = from + way * (0.001 * k);
    rig.tick(probe);
    gaps.push_back(norm(probe - rig.state.proxy));
  }
  return gaps;
}

/// The lag within `lo..hi` with the minimum squared difference of the trace from itself, after its first `skip` samples.
int period(const std::vector<double>& trace, std::size_t skip, int lo, int hi) {
  int best = 0;
  double minimum = 1e300;
  for (int lag = lo; lag <= hi; ++lag) {
    double sum = 0;
    const std::size_t count = trace.size() - skip - static_cast<std::size_t>(hi);
    for (std::size_t i = 0; i < count; ++i) {
      const double d = trace[skip + i] - trace[skip + i + static_cast<std::size_t>(lag)];
      sum += d * d;
    }
    if (sum < minimum) minimum = sum, best = lag;
  }
  return best;
}

TEST(Texture, TheForceHasThePeriodOfTheWave) {
  for (const int wavelength : {40, 100, 250}) {  // in thousandths of a unit
    Rig rig(build(texture(R"(, "amplitude": 0.6, "wavelength": )" + std::to_string(wavelength * 1e-3))));
    const auto trace = sweep(rig, {-1, 0.013, 0.007}, {1, 0, 0}, 2000);
    EXPECT_EQ(period(trace, 400, wavelength / 2, wavelength * 3 / 2), wavelength);
    // oscillates about the threshold
    double minimum = 1, maximum = 0;
    for (std::size_t i = 400; i < trace.size(); ++i) minimum = std::min(minimum, trace[i]), maximum = std::max(maximum, trace[i]);
    EXPECT_GT(maximum - minimum, 0.01);
    EXPECT_LE(maximum, 0.05 * 1.6 + 0.001);
  }
}

TEST(Texture, TheThresholdIsATriangleWave) {
  const auto at = [](const Vec3& p) {
    Rig rig(build(texture(R"(, "amplitude": 0.9, "wavelength": 0.5)")));
    rig.tick(p);
    return rig.state.limit;
  };
  EXPECT_NEAR(at({0, 0, 0}), 0.05 * 0.1, 1e-15);
  EXPECT_NEAR(at({0.25, 0.25, 0.25}), 0.05 * 1.9, 1e-15);
  EXPECT_NEAR(at({0.25, 0, 0}), 0.05 * (1 - 0.3), 1e-15);
  EXPECT_NEAR(at({0.0625, 0.25, 0.25}), 0.05 * (1 + 0.9 * 0.5), 1e-15);
  EXPECT_NEAR(at({-0.0625, 0.25, 5.25}), at({0.0625, -0.25, 0.25}), 1e-15);
  EXPECT_TRUE(std::isfinite(at({1e300, -1e300, 1})));
}

TEST(Texture, WithoutAmplitudeItEqualsDrag) {
  Rig rig(build(texture(R"(, "amplitude": 0, "wavelength": 0.1)")));
  Rig drag(build(R"({"name": "a", "type": "drag", "threshold": 0.05})"));
  Random random(3);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 probe = random.box(0.2);
    rig.tick(probe);
    ASSERT_TRUE(bitwise_equal(rig.state.proxy, drag.tick(probe).proxy));
  }
}

// the base threshold follows a field, with the wave added
TEST(Texture, TheBaseMayFollowAField) {
  Rig rig(build(R"({"name": "a", "type": "texture", "wavelength": 0.5, "amplitude": 0.5,
                    "threshold": {"field": "r", "map": [[0, 0], [2, 0.2]]}})",
                scalars({{"r", analytic_field("sphere")}})));
  EXPECT_NEAR(rig.tick({0.75, 0, 0}).limit, 0.075 * (1 + 0.5 * (-1.0 / 3)), 1e-15);
}

TEST(Texture, OnASurfaceTheProxyStaysOnIt) {
  const auto torus = sampled_field("torus", 48);
  Rig rig(build(texture(R"(, "wavelength": 0.1, "surface": "s", "level": 0.4)"), scalars({{"s", torus}})));
  for (const Vec3& probe : walk_on_surface(torus, 0.4, {1, 0.1, 0.4}, 0.004, 4000, 2)) {
    ASSERT_EQ(rig.tick(probe).status, LinkStatus::ok);
    ASSERT_LE(off_level(*torus, 0.4, rig.state.proxy), 5e-12);
    ASSERT_LE(norm(probe - rig.state.proxy) - rig.state.limit, 1e-12);
  }
}

TEST(Texture, RefusesBadKeys) {
  expect_refused(texture(""), 1, {"wavelength"});
  expect_refused(texture(R"(, "wavelength": 0)"), 1, {"wavelength"});
  expect_refused(texture(R"(, "wavelength": 1, "amplitude": 1.5)"), 1, {"amplitude"});
  expect_refused(R"({"name": "a", "type": "texture", "wavelength": 1})", 1, {"threshold"});
}

}  // namespace catena::haptics::tests::texture_test
