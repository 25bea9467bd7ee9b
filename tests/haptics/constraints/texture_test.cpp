// SPDX-License-Identifier: MIT
#include "tests/haptics/constraints/friction_fixture.h"

namespace catena::haptics::tests {
namespace texture_test {

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
    drag.tick(probe);
    ASSERT_TRUE(bitwise_equal(rig.state.proxy, drag.state.proxy));
  }
}

// the base threshold follows a field, with the wave added
TEST(Texture, TheBaseMayFollowAField) {
  Fields fields;
  fields.named["r"].scalar = analytic_field("sphere");
  Rig rig(build(R"({"name": "a", "type": "texture", "wavelength": 0.5, "amplitude": 0.5,
                    "threshold": {"field": "r", "map": [[0, 0], [2, 0.2]]}})",
                fields));
  rig.tick({0.75, 0, 0});
  EXPECT_NEAR(rig.state.limit, 0.075 * (1 + 0.5 * (-1.0 / 3)), 1e-15);
}

TEST(Texture, OnASurfaceTheProxyStaysOnIt) {
  const auto torus = sampled_field("torus", 48);
  Fields fields;
  fields.named["s"].scalar = torus;
  Rig rig(build(texture(R"(, "wavelength": 0.1, "surface": "s", "level": 0.4)"), fields));
  double off = 0, gap = 0;
  for (const Vec3& probe : walk_on_surface(torus, 0.4, {1, 0.1, 0.4}, 0.004, 4000, 2)) {
    rig.tick(probe);
    ASSERT_EQ(rig.state.status, LinkStatus::ok);
    off = std::max(off, off_level(*torus, 0.4, rig.state.proxy));
    gap = std::max(gap, norm(probe - rig.state.proxy) - rig.state.limit);
  }
  EXPECT_LE(off, 5e-12);
  EXPECT_LE(gap, 1e-12);
}

TEST(Texture, RefusesBadKeys) {
  const auto refused = [&](const std::string& text, const std::string& what) {
    const auto made = try_build(text);
    ASSERT_FALSE(made) << text;
    EXPECT_EQ(made.error().message.rfind("scene.json:1: ", 0), 0u) << made.error().message;
    EXPECT_NE(made.error().message.find(what), std::string::npos) << made.error().message;
  };
  refused(texture(""), "wavelength");
  refused(texture(R"(, "wavelength": 0)"), "wavelength");
  refused(texture(R"(, "wavelength": 1, "amplitude": 1.5)"), "amplitude");
  refused(R"({"name": "a", "type": "texture", "wavelength": 1})", "threshold");
}

}  // namespace texture_test
}  // namespace catena::haptics::tests
