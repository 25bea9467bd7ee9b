// SPDX-License-Identifier: MIT
// Edge cases: thin sheets, probes tangential to the isosurface, steps that leave the grid, and NaN on the path. Each section begins
// with the expected behaviour.
#include <limits>

#include "haptics/constraints/streamline/online_streamline.h"
#include "haptics/constraints/streamline/selected_streamline.h"
#include "tests/acceptance/chain_fixture.h"
#include "tests/acceptance/reference_numerics.h"
#include "tests/engine/geometry/flow/lambda_field.h"

namespace catena::acceptance::edge_cases_test {

using catena::test::lambda_field;
using flow::Method;
using haptics::bitwise_equal;
using haptics::tests::isosurface;
using haptics::tests::Random;
using haptics::tests::Rig;

const double kNan = std::numeric_limits<double>::quiet_NaN();

/// A scalar field from two lambdas on the box -2..2.
class LambdaScalar final : public field::ScalarField {
 public:
  using Value = std::function<double(const Vec3&, Vec3&)>;
  explicit LambdaScalar(Value value) : value_(std::move(value)) {
    set_domain("lambda", field::Mapping{}, field::Box{Vec3(-2.0), Vec3(2.0)});
  }
  field::ScalarSample sample(const Vec3& p, field::Cursor&) const noexcept override {
    field::ScalarSample out;
    out.value = value_(p, out.gradient);
    out.inside = true;
    return out;
  }
  double min_value() const noexcept override { return -1e300; }
  double max_value() const noexcept override { return 1e300; }

 private:
  Value value_;
};

/// A grid of n^3 nodes from -2 to 2.
field::ScalarFieldPtr scalar_grid(int n, const std::function<double(const Vec3&)>& value) {
  return haptics::tests::sample_scalar_grid(field::Mapping::from_linear(Mat3(4.0 / (n - 1)), Vec3(-2.0)), {n, n, n}, value);
}

/// A grid of 17^3 nodes from -1 to 1.
field::VectorFieldPtr vector_grid(const std::function<Vec3(const Vec3&)>& value) {
  return catena::test::sample_vector_grid(field::Mapping::from_linear(Mat3(0.125), Vec3(-1.0)), {17, 17, 17}, value);
}

bool is_below(const std::string& side) { return side.find("below") != std::string::npos; }

// ---- thin sheets ----
// A sheet |z| <= half, free above its level on both faces. Expected: a hand of any speed is held on its face of entry until the limit of
// thin sheets (0.02 L), where it is released on the far side; the force grows with the depth and drops once.

enum class Kind { formula, grid };
constexpr double kHalf = 0.01;

field::ScalarFieldPtr sheet(Kind kind) {
  if (kind == Kind::formula)
    return std::make_shared<LambdaScalar>([](const Vec3& p, Vec3& g) {
      g = Vec3(0, 0, p.z < 0 ? -1 : 1);
      return std::fabs(p.z);
    });
  // 0.04 per voxel, nodes at z = 0: the sheet is a quarter of a voxel on each side
  return scalar_grid(101, [](const Vec3& p) { return std::fabs(p.z); });
}

const std::string kAbove = R"(, "free": "above")", kBelow = R"(, "free": "below")";

class ThinSheet : public testing::TestWithParam<std::tuple<Kind, double>> {
 protected:
  Kind kind() const { return std::get<0>(GetParam()); }
  double step() const { return std::get<1>(GetParam()); }
};

TEST_P(ThinSheet, OneSidedHoldsOnTheNearFaceAtAnyDepth) {
  Rig rig(isosurface(sheet(kind()), kHalf, kAbove));
  bool held = false;
  double last_gap = 0;
  for (double z = 0.07; z > -0.3; z -= step()) {
    const Vec3 probe(0.31, -0.27, z);
    rig.tick(probe);
    const double gap = norm(rig.state.proxy - probe), depth = kHalf - z;
    if (std::fabs(depth) < 1e-8) continue;  // within the float precision of the grid
    if (depth < 0) {
      EXPECT_EQ(rig.state.status, LinkStatus::free) << z;
      continue;
    }
    EXPECT_EQ(rig.state.status, LinkStatus::ok) << z;
    EXPECT_NEAR(rig.state.proxy.z, kHalf, 1e-8) << z;
    EXPECT_GE(gap, last_gap);
    held = true;
    last_gap = gap;
  }
  EXPECT_TRUE(held);
}

TEST_P(ThinSheet, OneSidedReturnsThroughItsFace) {
  Rig rig(isosurface(sheet(kind()), kHalf, kAbove));
  double z = 0.05;
  rig.tick({0.31, -0.27, z});
  while (z - step() > -0.06) rig.tick({0.31, -0.27, z -= step()});
  EXPECT_EQ(rig.state.status, LinkStatus::ok);
  for (; z < 0.05; z += step()) {
    rig.tick({0.31, -0.27, z});
    if (std::fabs(z - kHalf) < 1e-8) continue;
    EXPECT_EQ(rig.state.status, z < kHalf ? LinkStatus::ok : LinkStatus::free) << z;
    if (z < kHalf) {
      EXPECT_NEAR(rig.state.proxy.z, kHalf, 1e-8) << z;
    }
  }
}

TEST_P(ThinSheet, OneSidedSlidesAlongTheFaceFromBehind) {
  Rig rig(isosurface(sheet(kind()), kHalf, kAbove));
  double z = 0.05, x = -1;
  rig.tick({x, 0.2, z});
  while (z > -0.01) rig.tick({x, 0.2, z -= step()});
  for (; x < 1; x += step()) {
    rig.tick({x, 0.2, z});
    ASSERT_EQ(rig.state.status, LinkStatus::ok) << x;
    ASSERT_LE(norm(rig.state.proxy - Vec3(x, 0.2, kHalf)), 1e-7) << x;
  }
}

TEST_P(ThinSheet, OneSidedReleaseBelowTheThicknessReleasesInside) {
  // a release below the thickness acts as on any body
  Rig rig(isosurface(sheet(kind()), kHalf, R"(, "free": "above", "release": 0.015)"));
  for (double z = 0.05; z > -0.05; z -= step()) {
    const Vec3 probe(0.31, -0.27, z);
    rig.tick(probe);
    const double depth = kHalf - z;
    if (depth > 0.015 + 1e-8 && z > -kHalf + 1e-8) {
      EXPECT_EQ(rig.state.status, LinkStatus::released) << z;
      EXPECT_TRUE(bitwise_equal(rig.state.proxy, probe));
    } else if (depth > 1e-8 && depth < 0.015 - 1e-8) {
      EXPECT_EQ(rig.state.status, LinkStatus::ok) << z;
    } else if (depth <= -1e-8) {
      EXPECT_EQ(rig.state.status, LinkStatus::free) << z;
    }
  }
}

TEST_P(ThinSheet, TwoSidedStaysOnItsFace) {
  // two-sided: the face is the one at the link's start; the other face is another surface
  for (const double from : {0.05, -0.05}) {
    Rig rig(isosurface(sheet(kind()), kHalf));
    for (int k = 0; k * step() < 0.1; ++k) {
      const double z = from > 0 ? from - k * step() : from + k * step();
      rig.tick({0.31, -0.27, z});
      ASSERT_EQ(rig.state.status, LinkStatus::ok) << z;
      ASSERT_NEAR(rig.state.proxy.z, from > 0 ? kHalf : -kHalf, 1e-8) << z;
    }
  }
}

// steps per tick: 0.05 L/s, 0.2 L/s, and two that cross the sheet at once
INSTANTIATE_TEST_SUITE_P(Hands, ThinSheet,
                         testing::Combine(testing::Values(Kind::formula, Kind::grid), testing::Values(2e-4, 8e-4, 0.033, 0.061)),
                         [](const auto& test) {
                           return std::string(std::get<0>(test.param) == Kind::formula ? "Formula" : "Grid") +
                                  std::to_string(test.index % 4);
                         });

// ---- a probe tangential to the isosurface ----
// Expected: free outside, bit for bit; held inside with the gap equal to the depth, at any depth. One entry and one exit per pass over a
// convex body, no force without depth.

constexpr double kStop = 1e-8 * 4;  ///< tangential tolerance of the projector

TEST(GrazingContact, GrazingASphereIsContinuous) {
  for (const bool grid : {false, true})
    for (const bool below : {false, true})
      for (const double miss : {0.0, 1e-15, -1e-15, 1e-12, -1e-12, 1e-9, -1e-9, 1e-6, -1e-6, 1e-4, -1e-4, 3e-3, -3e-3})
        for (const double step : {2e-4, 2e-3, 3e-2}) {
          const auto f = grid ? haptics::tests::sampled_field("sphere", 65) : haptics::tests::analytic_field("sphere");
          Rig rig(isosurface(f, 1, below ? R"(, "free": "below")" : kAbove));
          field::Cursor cursor;
          int changes = 0;
          LinkStatus before = LinkStatus::free;
          for (double x = -0.4; x <= 0.4; x += step) {
            const Vec3 probe(x, 1e-3, 1 + miss);
            rig.tick(probe);
            const auto s = f->sample(probe, cursor);
            const double depth = below ? s.value - 1 : 1 - s.value, gap = norm(rig.state.proxy - probe);
            if (depth <= 0) {
              ASSERT_EQ(rig.state.status, LinkStatus::free) << miss << " " << x;
              ASSERT_TRUE(bitwise_equal(rig.state.proxy, probe));
            } else {
              ASSERT_EQ(rig.state.status, LinkStatus::ok) << miss << " " << x << " depth " << depth;
              ASSERT_LE(gap, 1.05 * depth + kStop) << miss << " " << x;
              ASSERT_GE(gap, 0.9 * depth - kStop) << miss << " " << x;
            }
            changes += x > -0.4 && rig.state.status != before;
            before = rig.state.status;
          }
          // on a formula one entry and one exit (above round-off); a sampled sphere has waves of 1e-4
          if (!grid && std::fabs(miss) >= 1e-12) {
            EXPECT_LE(changes, 2) << miss << " " << step;
          }
        }
}

TEST(GrazingContact, AProbeOnTheSurfaceKeepsItsProxy) {
  // every probe is on the level up to round-off: free or held, the proxy equals the probe within the projector's tolerance
  const auto f = haptics::tests::analytic_field("sphere");
  for (const std::string& side : {std::string(), kAbove, kBelow}) {
    Rig rig(isosurface(f, 1, side));
    double worst = 0;
    for (int i = 0; i < 20000; ++i) {
      const double a = 3e-4 * i, b = 0.4 * std::sin(1e-3 * i);
      const Vec3 probe(std::cos(a) * std::cos(b), std::sin(a) * std::cos(b), std::sin(b));
      rig.tick(probe);
      worst = std::max(worst, norm(rig.state.proxy - probe));
      ASSERT_TRUE(rig.state.status == LinkStatus::ok || rig.state.status == LinkStatus::free) << i;
    }
    expect_at_most("gap while gliding on the level" + side, worst, kStop);
  }
}

TEST(GrazingContact, ReleaseIsNotReachedByGrazing) {
  // depth between zero and the release: never released
  Rig rig(isosurface(haptics::tests::analytic_field("sphere"), 1, R"(, "free": "above", "release": 0.01)"));
  for (double x = -0.5; x <= 0.5; x += 2e-4) {
    rig.tick({x, 0, 0.995});
    ASSERT_NE(rig.state.status, LinkStatus::released) << x;
    ASSERT_LE(norm(rig.state.proxy - Vec3(x, 0, 0.995)), 0.005 + 1e-11);
  }
}

// ---- steps that leave the grid ----

// A line that turns back before the boundary although stages of a step are beyond it. Expected: the line is followed.
TEST(GridBoundary, AStageBeyondTheBoundaryDoesNotEndTheLine) {
  for (const double radius : {0.9, 0.99, 0.999, 0.99999}) {
    const auto walled = lambda_field([](const Vec3& p) { return Vec3(-p.y, p.x, 0); },
                                     [](const Vec3& p) { return std::fabs(p.x) <= 1 && std::fabs(p.y) <= 1; });
    for (const Method method : {Method::rk4, Method::rkf34, Method::dp54}) {
      haptics::OnlineStreamlineSpec spec;
      spec.field = walled;
      spec.seed = Vec3(radius, 0, 0);
      spec.method = method;
      Rig rig(haptics::make_online_streamline(spec));
      for (int i = 0; i < 400; ++i) {
        const double a = 0.05 * i;
        rig.tick({1.2 * radius * std::cos(a), 1.2 * radius * std::sin(a), 0});
        ASSERT_EQ(rig.state.status, LinkStatus::ok) << radius << " " << flow::to_string(method) << " tick " << i;
        ASSERT_NEAR(norm(rig.state.proxy), radius, 2e-5) << radius << " " << flow::to_string(method);
      }
    }
    const auto curve = flow::trace({walled.get()}, {radius, 0, 0});
    ASSERT_TRUE(curve);
    EXPECT_TRUE((*curve)->is_closed()) << radius;
  }
}

/// Expects that the proxy stops at x = wall when the probe leaves from `home` to `away`, and returns with it.
void expect_out_and_back(Rig& rig, const Vec3& home, const Vec3& away, double step, double wall, double wall_tolerance,
                         double back_tolerance) {
  const double length = norm(away - home);
  const auto at = [&](double s) { return home + (away - home) * (s / length); };
  for (int k = 0; k < 3; ++k) rig.tick(home);
  const Vec3 before = rig.state.proxy;
  EXPECT_EQ(rig.state.status, LinkStatus::ok);
  for (double s = 0; s < length; s += step) {
    rig.tick(at(s));
    ASSERT_TRUE(is_finite(rig.state.proxy) && std::isfinite(rig.state.residual)) << s;
    ASSERT_LE(rig.state.proxy.x, wall + 1e-9) << s;
  }
  for (int k = 0; k < 4; ++k) rig.tick(away);
  EXPECT_EQ(rig.state.status, LinkStatus::boundary);
  EXPECT_NEAR(rig.state.proxy.x, wall, wall_tolerance);
  for (double s = length; s > 0; s -= step) rig.tick(at(s));
  for (int k = 0; k < 4; ++k) rig.tick(home);
  EXPECT_EQ(rig.state.status, LinkStatus::ok);
  EXPECT_LE(norm(rig.state.proxy - before), back_tolerance);
}

// A probe leaves through the boundary by a jump or in steps, and returns. Expected: BOUNDARY with the proxy on it, then the same line.
TEST(GridBoundary, AStreamlineHoldsOnTheBoundaryAndReturns) {
  const auto grid = vector_grid([](const Vec3& p) { return Vec3(1, 0.5 * p.x, 0.25 * p.y); });
  for (const std::string follow : {R"(, "follow": "selected")", R"(, "follow": "online")"})
    for (const double step : {1e-3, 0.02, 0.7, 5.0}) {
      SCOPED_TRACE(follow + std::to_string(step));
      Rig rig(streamline(grid, {0.1, 0.2, 0.3}, follow));
      expect_out_and_back(rig, {0.3, 0.25, 0.3}, {2.4, 1.1, 0.5}, step, 1, 1e-8, 5e-8);
    }
}

TEST(GridBoundary, AnIsosurfaceSlidesAlongTheBoundaryAndReturns) {
  // z = 0.1 x within |x| <= 2. Expected: beyond the boundary the proxy stays in the domain and slides along it without jumps
  const auto grid = scalar_grid(17, [](const Vec3& p) { return p.z - 0.1 * p.x; });
  for (const std::string& side : {std::string(), kAbove, kBelow})
    for (const double step : {1e-3, 0.05, 0.6}) {
      Rig rig(isosurface(grid, 0, side));
      const double z = is_below(side) ? 0.6 : -0.3;
      Vec3 last(0.0);
      std::vector<Vec3> out;
      for (double x = 0; x < 3; x += step) {
        const Vec3 probe(x, 0.2, z);
        rig.tick(probe);
        out.push_back(rig.state.proxy);
        ASSERT_TRUE(is_finite(rig.state.proxy));
        ASSERT_LE(rig.state.proxy.x, 2 + 1e-12) << side << " " << x;
        ASSERT_NEAR(rig.state.proxy.z, 0.1 * rig.state.proxy.x, 1e-7) << side << " " << x;
        ASSERT_EQ(rig.state.status, x + 0.1 * (z - 0.2) > 2.1 ? LinkStatus::boundary : rig.state.status) << side << " " << x;
        if (x > 0) {
          ASSERT_LE(norm(rig.state.proxy - last), 1.5 * step + 1e-6) << side << " " << x;
        }
        last = rig.state.proxy;
      }
      for (int k = static_cast<int>(out.size()) - 1; k >= 0; --k) {
        rig.tick({k * step, 0.2, z});
        ASSERT_LE(norm(rig.state.proxy - out[static_cast<std::size_t>(k)]), 1e-6) << side << " " << k;
      }
    }
}

// ---- NaN on the path ----
// Expected: cells with a non-finite corner are outside of the domain. A line ends before them (BOUNDARY) and continues when the hand
// returns; a surface has a boundary there; no output is NaN.

TEST(NanRegion, AStreamlineEndsBeforeTheNanRegionAndReturns) {
  for (const bool formula : {false, true}) {
    const auto value = [](const Vec3& p) { return p.x > 0.55 && p.x < 0.7 ? Vec3(kNan, 1, 0) : Vec3(1, 0.3 * p.x, 0); };
    const field::VectorFieldPtr f = formula ? lambda_field(value) : vector_grid(value);
    // the last valid cell ends at 0.5; the formula is valid up to 0.55
    const double wall = formula ? 0.55 : 0.5;
    for (const std::string more : {"", R"(, "follow": "online")", R"(, "method": "dp54")", R"(, "method": "euler")", R"(, "kind": "line")"})
      for (const double step : {1e-3, 0.03, 0.9}) {
        SCOPED_TRACE(more + " " + std::to_string(step) + (formula ? " formula" : " grid"));
        Rig rig(streamline(f, {-0.5, 0.1, 0.2}, more));
        expect_out_and_back(rig, {0.2, 0.1, 0.25}, {0.95, 0.1, 0.25}, step, wall, 1e-7,
                            more.find("euler") == std::string::npos ? 1e-7 : 0.2);
      }
  }
}

field::ScalarFieldPtr grid_with_gap() {
  return scalar_grid(17, [](const Vec3& p) { return p.x > 0.4 && p.x < 0.9 ? kNan : p.z - 0.1 * p.x; });
}

TEST(NanRegion, AnIsosurfaceEndsAtTheNanRegion) {
  const auto grid = grid_with_gap();
  for (const std::string& side : {std::string(), kAbove, kBelow})
    for (const double step : {1e-3, 0.04}) {
      Rig rig(isosurface(grid, 0, side));
      const double z = is_below(side) ? 0.3 : -0.3;
      rig.tick({-0.5, 0.1, z});
      const Vec3 before = rig.state.proxy;
      EXPECT_EQ(rig.state.status, LinkStatus::ok);
      for (double x = -0.5; x < 1.5; x += step) {
        rig.tick({x, 0.1, z});
        ASSERT_TRUE(is_finite(rig.state.proxy) && std::isfinite(rig.state.residual)) << side << " " << x;
        // cells up to 0.25 are valid; behind the gap is another part of the surface
        if (rig.state.proxy.x <= 0.25 + 1e-12 && rig.state.status != LinkStatus::free) {
          ASSERT_NEAR(rig.state.proxy.z, 0.1 * rig.state.proxy.x, 1e-7) << side << " " << x;
        }
        if (x > 0.32 && x < 0.98) {
          ASSERT_TRUE(rig.state.status == LinkStatus::boundary || rig.state.status == LinkStatus::critical) << side << " " << x;
        }
      }
      for (double x = 1.5; x > -0.5; x -= step) rig.tick({x, 0.1, z});
      rig.tick({-0.5, 0.1, z});
      EXPECT_EQ(rig.state.status, LinkStatus::ok) << side << " " << step;
      EXPECT_LE(norm(rig.state.proxy - before), 1e-6) << side << " " << step;
    }
}

TEST(NanRegion, AFreeHandThroughTheNanRegionIsHeldBehindIt) {
  // free above; the probe passes through invalid voxels to the held side and is held there at once
  const auto grid = grid_with_gap();
  Rig rig(isosurface(grid, 0, kAbove));
  for (double x = 0; x < 1.6; x += 0.005) {
    const double z = x < 0.6 ? 0.3 : -0.2;  // the probe descends within the gap
    const Vec3 probe(x, 0.1, z);
    rig.tick(probe);
    ASSERT_TRUE(is_finite(rig.state.proxy));
    if (x < 0.2) {
      ASSERT_EQ(rig.state.status, LinkStatus::free) << x;
    }
    if (x > 1.1) {
      ASSERT_TRUE(rig.state.status == LinkStatus::ok || rig.state.status == LinkStatus::boundary) << x;
      ASSERT_NEAR(rig.state.proxy.z, 0.1 * rig.state.proxy.x, 1e-7);
    } else if (rig.state.status == LinkStatus::free) {
      ASSERT_TRUE(bitwise_equal(rig.state.proxy, probe)) << x;
    }
  }
}

}  // namespace catena::acceptance::edge_cases_test
