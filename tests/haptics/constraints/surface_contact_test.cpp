// SPDX-License-Identifier: MIT
// Friction on hostile surfaces: noise, invalid voxels, masks, thin sheets, jumps from sheet to sheet.
#include "haptics/constraints/friction/friction_contact.h"

#include <limits>

#include "engine/base/memory_limit.h"
#include "tests/haptics/constraints/friction_fixture.h"

namespace catena::haptics::tests::surface_contact_test {

const field::Mapping kMapping = field::Mapping::from_linear(Mat3(0.2), Vec3(-2.0));
constexpr field::Index3 kSize{21, 21, 21};

struct Surface {
  const char* name;
  field::ScalarFieldPtr field;
  double level;
};

std::vector<Surface> surfaces() {
  Random random(31);
  std::vector<std::uint8_t> valid;
  for (int i = 0; i < 21 * 21 * 21; ++i) valid.push_back(random.uniform(0, 1) > 0.03);
  return {
      {"torus", analytic_field("torus"), 0.4},
      {"noise", sample_scalar_grid(kMapping, kSize, [&](const Vec3&) { return random.uniform(-1, 1); }), 0.1},
      {"broken",
       sample_scalar_grid(kMapping, kSize,
                          [&](const Vec3& p) { return random.uniform(0, 1) < 0.03 ? std::numeric_limits<double>::quiet_NaN() : norm(p); }),
       1.2},
      {"masked",
       sample_scalar_grid(
           kMapping, kSize, [](const Vec3& p) { return norm(p); }, valid),
       1.2},
      {"sheet", sample_scalar_grid(kMapping, kSize, [](const Vec3& p) { return std::fabs(p.z + 0.1 * p.x) < 0.15 ? 1.0 : 0.0; }), 0.5},
      {"tiny", sample_scalar_grid(kMapping, kSize, [](const Vec3& p) { return 1e-30 * norm(p); }), 1.2e-30},
      {"huge", sample_scalar_grid(kMapping, kSize, [](const Vec3& p) { return 1e30 * norm(p); }), 1.2e30}};
}

/// Positions on the level, at random starts and along a walk from each, and some off the level.
std::vector<Vec3> places(const Surface& s, std::uint64_t seed) {
  Random random(seed);
  std::vector<Vec3> out;
  for (int i = 0; i < 60; ++i) {
    const Vec3 from = random.box(1.8);
    Rig rig(isosurface(s.field, s.level));
    rig.tick(from);
    if (rig.state.status == LinkStatus::no_surface) continue;
    Vec3 way = random.unit();
    for (int k = 0; k < 20; ++k) {
      rig.tick(rig.state.proxy + way * (k % 7 == 6 ? 0.3 : 0.01));
      out.push_back(rig.state.proxy);
      if (k % 5 == 4) out.push_back(rig.state.proxy);
      way = direction(way + random.unit() * 0.3);
    }
    out.push_back(random.box(2.5));
  }
  return out;
}

TEST(SurfaceContact, HostileSurfacesKeepTheContactValid) {
  Random random(32);
  std::vector<float> vectors;
  for (int i = 0; i < 3 * 21 * 21 * 21; ++i)
    vectors.push_back(random.uniform(0, 1) < 0.01 ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(random.uniform(-1, 1)));
  const std::string types[] = {R"("type": "drag", "threshold": 0.05)", R"("type": "texture", "threshold": 0.05, "wavelength": 0.1)",
                               R"("type": "friction", "field": "v", "threshold": 0.03)",
                               R"("type": "friction", "field": "v", "kind": "line", "threshold": 0.3)",
                               R"("type": "modulated_friction", "field": "v", "tau_min": 0.01, "tau_max": 0.1)"};
  for (const Surface& s : surfaces()) {
    Fields fields = scalars({{"s", s.field}});
    fields.named["v"].vector = field::make_vector_grid("v", kMapping, kSize, vectors);
    const std::vector<Vec3> path = places(s, 33);
    ASSERT_GT(path.size(), 300u) << s.name;
    const double length = s.field->domain_length();
    for (const std::string& type : types) {
      Rig rig(build(R"({"name": "a", "surface": "s", "level": )" + to_json(s.level) + ", " + type + "}", fields));
      int held = 0;
      for (std::size_t i = 0; i < path.size(); ++i) {
        const LinkState before = rig.state;
        const bool rests = i > 0 && bitwise_equal(path[i], path[i - 1]);
        {
          const AllocationCounter guard;
          rig.tick(path[i]);
          ASSERT_EQ(guard.count(), 0u);
        }
        const LinkState& now = rig.state;
        held += now.status == LinkStatus::ok;
        ASSERT_TRUE(is_finite(now.proxy) && std::isfinite(now.residual) && std::isfinite(now.limit)) << s.name << type << i;
        ASSERT_LE(now.evaluations, kMaxEvaluations) << s.name << type << i;
        const bool passes = now.status == LinkStatus::free || now.status == LinkStatus::no_surface;
        ASSERT_TRUE(!passes || bitwise_equal(now.proxy, path[i])) << s.name << type << i;
        const bool same = bitwise_equal(now.proxy, before.proxy) && now.status == before.status && now.evaluations == 0;
        ASSERT_TRUE(!rests || before.status == LinkStatus::budget || same) << s.name << type << i;
        const double off = now.status == LinkStatus::ok ? off_level(*s.field, s.level, now.proxy) / length : 0;
        ASSERT_LE(off, 1e-9) << s.name << type;
      }
      EXPECT_GT(held, 50) << s.name << type;
    }
  }
}

// after an external change of the proxy the contact restarts at the probe
TEST(SurfaceContact, AnExternallyMovedProxyRestarts) {
  Rig rig(
      build(R"({"name": "a", "type": "drag", "threshold": 0.2, "surface": "s", "level": 1})", scalars({{"s", analytic_field("sphere")}})));
  rig.tick({0, 0, 1});
  rig.state.proxy = Vec3(3, 3, 3);
  EXPECT_LE(norm(rig.tick({0, 0.6, 0.8}).proxy - Vec3(0, 0.6, 0.8)), 1e-15);
}

// beyond the grid's boundary the field is unknown: the probe is not on the surface
TEST(SurfaceContact, OutsideTheDomainIsOffTheSurface) {
  Rig rig(build(R"({"name": "a", "type": "drag", "threshold": 0.2, "surface": "s", "level": 0})",
                scalars({{"s", sampled_field("plane", 21)}})));
  expect_steps(rig, {{{1.9, 0, 0}, kOk}, {{2.1, 0, 0}, kFree, {2.1, 0, 0}}, {{1.95, 0, 0}, kOk}});
}

}  // namespace catena::haptics::tests::surface_contact_test
