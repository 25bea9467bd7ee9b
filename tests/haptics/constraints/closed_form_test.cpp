// SPDX-License-Identifier: MIT
// Common properties of all closed-form constraints: hostile probes and sizes, a proxy on its feature up to round-off, energy,
// primitives.
#include "tests/haptics/constraints/constraint_fixture.h"

namespace catena::haptics::tests::closed_form_test {

struct Kind {
  const char* type;
  const char* body;
};
const Kind kKinds[] = {
    {"point", R"("position": [0.3, -0.2, 0.1])"},
    {"line", R"("point": [0.3, -0.2, 0.1], "direction": [1, 2, 3])"},
    {"segment", R"("from": [0.3, -0.2, 0.1], "to": [-1, 2, 0.7])"},
    {"polyline", R"("points": [[0.3, -0.2, 0.1], [-1, 2, 0.7], [1, 1, 1], [0, 0, 2]])"},
    {"polyline", R"("points": [[0.3, -0.2, 0.1], [-1, 2, 0.7], [1, 1, 1], [0, 0, 2]], "closed": true)"},
    {"plane", R"("point": [0.3, -0.2, 0.1], "normal": [1, 2, 3])"},
    {"sphere", R"("center": [0.3, -0.2, 0.1], "radius": 0.7)"},
    {"box", R"("center": [0.3, -0.2, 0.1], "size": [1, 0.5, 2], "rotation": {"axis": [1, 2, 3], "angle_deg": 50})"},
};

ConstraintPtr make(const Kind& kind, const std::string& more = "") {
  return build(std::string(R"({"name": "a", "type": ")") + kind.type + "\", " + kind.body + more + "}");
}

/// Any finite number: all magnitudes, both signs, zeros and denormals.
double hostile(Random& random) {
  static const double some[] = {0.0, -0.0, 5e-324, -5e-324, 2e-308, 1e-160, 1e-16, 0.5, 1, -1, 1e16, 1e154, 1e160, 1e300, -1e300};
  const double pick = random.uniform(0, 1);
  if (pick < 0.4) return some[static_cast<std::size_t>(random.uniform(0, 15))];
  if (pick < 0.7) return random.uniform(-3, 3);
  const double exponent = random.uniform(-320, 300);
  return (random.uniform(0, 1) < 0.5 ? -1 : 1) * std::pow(10.0, exponent);
}

TEST(ClosedFormProjections, HostileProbesGiveAFeaturePointUpToRoundOff) {
  for (const Kind& kind : kKinds) {
    Random random(17);
    Rig rig(make(kind));
    for (int i = 0; i < 20000; ++i) {
      const Vec3 probe(hostile(random), hostile(random), hostile(random)), proxy = rig.tick(probe).proxy;
      ASSERT_TRUE(is_finite(proxy)) << kind.type << " " << i;
      ASSERT_EQ(rig.state.status, LinkStatus::ok) << kind.type << " " << i;
      ASSERT_LE(rig.state.residual, 1e-15 * std::max(1.0, norm(proxy))) << kind.type << " " << i;
      ASSERT_EQ(rig.state.evaluations, 0);
      ASSERT_TRUE(bitwise_equal(rig.tick(probe).proxy, proxy)) << kind.type << " " << i;
    }
  }
}

TEST(ClosedFormProjections, HostileProbesOnReleasingAndOneSidedLinks) {
  for (const Kind& kind : kKinds)
    for (const std::string more : {R"(, "release": 0.4)", R"(, "free": "above")", R"(, "free": "below", "release": 1e100)"}) {
      const std::string type = kind.type;
      if (type != "plane" && type != "sphere" && type != "box" && more.find("free") != std::string::npos) continue;
      Random random(18);
      Rig rig(make(kind, more));
      for (int i = 0; i < 20000; ++i) {
        const Vec3 probe(hostile(random), hostile(random), hostile(random));
        ASSERT_TRUE(is_finite(rig.tick(probe).proxy)) << type << more << " " << i;
        if (rig.state.status == kOk) continue;
        ASSERT_TRUE(rig.state.status == kFree || rig.state.status == kReleased);
        ASSERT_TRUE(bitwise_equal(rig.state.proxy, probe)) << type << more << " " << i;
      }
    }
}

TEST(ClosedFormProjections, ASmallClosedLoopStoresNoEnergy) {
  for (const Kind& kind : kKinds) {
    Random random(19);
    Rig rig(make(kind));
    for (int i = 0; i < 50; ++i) {
      const Vec3 centre = random.box(2), u = random.unit() * 0.002, v = random.unit() * 0.002;
      double before = 0;
      for (int k = 0; k <= 200; ++k) {
        const double angle = k * 6.283185307179586e-2;
        rig.tick(centre + u * std::cos(angle) + v * std::sin(angle));
        if (k == 100) before = norm(rig.state.proxy - (centre + u));
      }
      ASSERT_LE(norm(rig.state.proxy - (centre + u)), before + 1e-12) << kind.type;
    }
  }
}

TEST(ClosedFormProjections, ThePrimitiveTouchesTheProxyAndHoldsTheProbeThere) {
  for (const Kind& kind : kKinds) {
    Random random(20);
    Rig rig(make(kind));
    ASSERT_TRUE(rig.constraint->has_primitive()) << kind.type;
    for (int i = 0; i < 500; ++i) {
      const Vec3 probe = random.box(2);
      rig.tick(probe);
      Primitive primitive;
      ASSERT_TRUE(rig.constraint->primitive(probe, rig.state, rig.scratch, primitive)) << kind.type;
      // the projection of the probe onto it is the proxy
      Vec3 p = primitive.origin;
      const Vec3 e = probe - primitive.origin;
      if (primitive.kind == Primitive::Kind::line) p += primitive.axis * dot(primitive.axis, e);
      if (primitive.kind == Primitive::Kind::plane) p += e - primitive.axis * dot(primitive.axis, e);
      ASSERT_LE(norm(p - rig.state.proxy), 5e-15) << kind.type;
      ASSERT_NEAR(norm(primitive.axis), primitive.kind == Primitive::Kind::point ? 0 : 1, 1e-15) << kind.type;
    }
  }
}

}  // namespace catena::haptics::tests::closed_form_test
