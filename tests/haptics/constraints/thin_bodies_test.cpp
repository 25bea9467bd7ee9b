// SPDX-License-Identifier: MIT
// A one-sided link holds the hand on the sheet of entry until `release`, for any thickness, tilt and curvature of the body, any speed of
// the hand and any rate.
#include "tests/haptics/constraints/constraint_fixture.h"

namespace catena::haptics::tests::thin_bodies_test {

constexpr double kReleaseAt = 0.3;

/// A spherical shell, or a plate if the radius is infinite: positive within half its thickness.
struct Shell {
  Vec3 outward;  ///< normal of the middle surface's front at the origin
  double thickness = 0, radius = std::numeric_limits<double>::infinity();

  double value(const Vec3& x) const { return 0.5 * thickness - std::fabs(height(x)); }
  /// Signed height above the middle surface.
  double height(const Vec3& x) const { return std::isfinite(radius) ? norm(x + outward * radius) - radius : dot(outward, x); }
  Vec3 up(const Vec3& x) const { return std::isfinite(radius) ? direction(x + outward * radius) : outward; }
};

class ShellFormula final : public field::ScalarField {
 public:
  explicit ShellFormula(const Shell& shell) : shell_(shell) {
    set_domain("shell", field::Mapping::from_linear(Mat3(1.0), Vec3(0.0)), {Vec3(-2.0), Vec3(2.0)});
  }
  field::ScalarSample sample(const Vec3& x, field::Cursor&) const noexcept override {
    return {shell_.value(x), shell_.up(x) * (shell_.height(x) < 0 ? 1.0 : -1.0), true};
  }
  double min_value() const noexcept override { return -std::numeric_limits<double>::infinity(); }
  double max_value() const noexcept override { return 0.5 * shell_.thickness; }

 private:
  Shell shell_;
};

/// Pushes from the front through the body: in steps of `slow` near the body, then of `fast` until release. `is_inside`: true inside the
/// sampled body.
template <class Inside>
void push(const ConstraintPtr& link, const Shell& shell, const Vec3& way, double slow, double fast, double dt, const Inside& is_inside,
          const std::string& what) {
  Rig rig(link);
  rig.state.max_probe_step = kMaxProbeSpeed * dt;
  const double cosine = -dot(way, shell.outward);
  double at = -0.5 * shell.thickness - 0.02;
  Vec3 x = way * (at / cosine);
  rig.tick(x);
  bool inside = false;
  for (int i = 0; i < 20000; ++i) {
    at += std::fabs(at) < 0.5 * shell.thickness + 2 * slow ? slow : fast;
    const Vec3 last = x;
    x = way * (at / cosine);
    rig.tick(x);
    for (int k = 1; k <= 64 && !inside; ++k) inside = is_inside(last + (x - last) * (k / 64.0));
    if (!inside) continue;
    if (rig.state.released) {
      EXPECT_GE(shell.thickness * 0.5 - shell.height(x), kReleaseAt * 0.7) << what;
      return;
    }
    ASSERT_TRUE(rig.state.status == LinkStatus::ok || rig.state.status == LinkStatus::budget)
        << what << ": " << to_string(rig.state.status) << " at a depth of " << 0.5 * shell.thickness - shell.height(x);
    ASSERT_LT(norm(rig.state.proxy - x), kReleaseAt) << what;
    const bool on_far_side = dot(rig.state.proxy - x, shell.up(rig.state.proxy)) <= -1e-9;
    ASSERT_FALSE(rig.state.status == LinkStatus::ok && on_far_side) << what;
  }
  FAIL() << what << ": it never let go";
}

class ThinBodies : public testing::TestWithParam<int> {};

TEST_P(ThinBodies, HoldOnTheirFrontSheet) {
  Random random(static_cast<std::uint64_t>(100 + GetParam()));
  for (int i = 0; i < 40; ++i) {
    Shell shell{random.unit(), std::pow(10, random.uniform(-3, -1))};
    if (i % 2) shell.radius = random.uniform(0.8, 3);
    const double rate = std::array{100.0, 1000.0, 8000.0}[static_cast<std::size_t>(i % 3)];
    const double speed = std::pow(10, random.uniform(-2, 1));
    const double step = speed / rate, fast = std::max(step, 0.01);
    const Vec3 way = direction(direction(cross(shell.outward, random.unit())) * random.uniform(0, 0.6) - shell.outward);
    const double slow = std::max(step, shell.thickness / 500);
    const double voxel = shell.thickness * random.uniform(0.6, 3);
    const std::string what = fmt::format("{}: thickness {:.4f}, radius {:.2f}, voxel {:.4f}, {:.3f} m/s at {} Hz", i, shell.thickness,
                                         shell.radius, voxel, speed, rate);
    const auto in_shell = [&](const Vec3& x) { return shell.value(x) > 1e-6; };
    const std::string rules = fmt::format(R"(, "release": {})", kReleaseAt), below = R"(, "free": "below")" + rules;
    if (GetParam() == 0) {
      push(isosurface(std::make_shared<ShellFormula>(shell), 0, below), shell, way, slow, fast, 1 / rate, in_shell, "formula " + what);
    } else if (GetParam() == 1) {
      // a grid along its own axes, fine enough across the body to contain it
      if (voxel < 0.012) continue;
      const auto half = static_cast<int>(std::min(0.7 / voxel, 40.0));
      const double edge = std::max(voxel, 0.7 / 40);
      if (shell.thickness < 1.2 * edge) shell.thickness = 1.2 * edge;
      const auto mapping = field::Mapping::from_linear(Mat3(edge), Vec3(-edge * half));
      const auto grid =
          sample_scalar_grid(mapping, {2 * half + 1, 2 * half + 1, 2 * half + 1}, [&](const Vec3& x) { return shell.value(x); });
      const auto in_grid = [&](const Vec3& x) {
        field::Cursor cursor;
        return grid->sample(x, cursor).value > 1e-6;
      };
      push(isosurface(grid, 0, below), shell, way, slow, fast, 1 / rate, in_grid, "grid " + what);
    } else {
      shell.radius = std::numeric_limits<double>::infinity();
      const Vec3 a = direction(cross(shell.outward, random.unit()));
      const Mat3 rows = glm::transpose(Mat3(a, cross(shell.outward, a), shell.outward));
      const std::string box = fmt::format(
          R"({{"name": "a", "type": "box", "center": [0, 0, 0], "size": [3, 3, {}], "rotation": [{}, {}, {}], "free": "above"{}}})",
          shell.thickness, to_json(rows[0]), to_json(rows[1]), to_json(rows[2]), rules);
      push(build(box), shell, way, slow, fast, 1 / rate, in_shell, "box " + what);
    }
    if (HasFatalFailure()) return;
  }
}

INSTANTIATE_TEST_SUITE_P(Of, ThinBodies, testing::Values(0, 1, 2));

// A body thinner than a voxel, and steps of the hand that pass both sheets.
TEST(ThinBodies, AFastHandIsHeldByAnyThickness) {
  Random random(7);
  for (int i = 0; i < 300; ++i) {
    const double peak = std::pow(10, random.uniform(-4, -0.5));  // the body's thickness is 2 peak voxels
    const auto mapping = field::Mapping::from_linear(Mat3(0.1), Vec3(-1.0));
    const auto body = sample_scalar_grid(mapping, {21, 21, 21}, [&](const Vec3& x) { return peak - std::fabs(x.z) / 0.1; });
    Rig rig(isosurface(body, 0, R"(, "free": "below")"));
    rig.state.max_probe_step = 0.2;
    const double before = random.uniform(0.001, 0.03), after = random.uniform(0.001, 0.03);
    const Vec3 place(random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), 0),
        slant(random.uniform(-0.02, 0.02), random.uniform(-0.02, 0.02), 0);
    rig.tick(place + Vec3(0, 0, 0.1 * peak + before));
    ASSERT_EQ(rig.tick(place + slant - Vec3(0, 0, 0.1 * peak + after)).status, LinkStatus::ok) << peak;
    ASSERT_NEAR(rig.state.proxy.z, 0.1 * peak, 1e-7);
    ASSERT_EQ(rig.tick(place + slant + Vec3(0, 0, 0.1 * peak + after)).status, LinkStatus::free);
  }
}

// The sheet is one voxel before the end of the valid data: the hand's step leads from its front to invalid data.
TEST(ThinBodies, AFastHandIsHeldBeforeMaskedCellsAndNonFiniteValues) {
  const auto mapping = field::Mapping::from_linear(Mat3(0.1), Vec3(-1.0));
  for (const bool masked : {true, false}) {
    std::vector<std::uint8_t> valid;
    for (int i = 0; i < 21 * 21 * 21; ++i) valid.push_back(i / (21 * 21) >= 9);
    const auto grid = sample_scalar_grid(
        mapping, {21, 21, 21}, [&](const Vec3& x) { return !masked && x.z < -0.15 ? std::nan("") : x.z; },
        masked ? valid : std::vector<std::uint8_t>{});
    Rig rig(isosurface(grid, 0, R"(, "free": "above")"));
    rig.state.max_probe_step = 0.5;
    rig.tick({0.1, 0.2, 0.14});
    ASSERT_EQ(rig.tick({0.12, 0.2, -0.3}).status, LinkStatus::ok) << masked;
    EXPECT_NEAR(rig.state.proxy.z, 0, 1e-6);
  }
}

// Two balls with a gap: steps of a hand lead from one towards the other, and the held ball stays held.
TEST(ThinBodies, AHandsStepNeverJumpsToAnotherBody) {
  Random random(9);
  int stayed = 0;
  ConstraintPtr link;
  for (int i = 0; i < 4000; ++i) {
    if (i % 400 == 0) {
      const double radius = 0.35, centre = radius + random.uniform(0.15, 0.4) / 2;
      const auto balls = [&](const Vec3& x) { return std::min(norm(x - Vec3(-centre, 0, 0)), norm(x - Vec3(centre, 0, 0))) - radius; };
      const auto grid = sample_scalar_grid(field::Mapping::from_linear(Mat3(0.13), Vec3(-1.5)), {24, 24, 24}, balls);
      link = isosurface(i % 800 ? *grid->as_cubic() : grid, 0);
    }
    Rig rig(link);
    rig.state.max_probe_step = 1;
    Vec3 x(random.uniform(-0.6, -0.1), random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3));
    if (rig.tick(x); !(rig.state.proxy.x < 0)) continue;
    const Vec3 way = direction(Vec3(1, random.uniform(-0.4, 0.4), random.uniform(-0.4, 0.4))) * random.uniform(0.1, 0.5);
    for (int k = 0; k < 10; ++k) {
      ASSERT_LT(rig.tick(x += k < 5 ? way : -way).proxy.x, 0) << i << " " << k;
    }
    ++stayed;
  }
  EXPECT_GT(stayed, 3000);
}

}  // namespace catena::haptics::tests::thin_bodies_test
