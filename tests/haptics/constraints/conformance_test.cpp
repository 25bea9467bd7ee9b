// What every constraint must keep, whatever it is: finite output, rest when the probe rests, bounded fetches, no allocation,
// the same bits for the same input. A type of the registry without examples here fails.
#include <limits>

#include "engine/base/allocation_guard.h"
#include "tests/haptics/constraints/rig.h"
#include "tests/support/mesh_shapes.h"

namespace catena::haptics::test {
namespace {

/// Examples by type, without name and type. Fields: see fields().
std::map<std::string, std::vector<std::string>> examples() {
  return {
      {"point", {R"("position": [0.3, -0.2, 0.1])", R"("position": [0, 0, 0], "release": 0.4)"}},
      {"plane",
       {R"("point": [0.1, 0, 0], "normal": [1, 2, 3])", R"("point": [0.1, 0, 0], "normal": [1, 2, 3], "free": "above", "release": 0.3)",
        R"("point": [0, 0, 0], "normal": [0, 0, -1], "free": "below")", R"("point": [0, 0, 0], "normal": [0, 1, 0], "release": 0.1)"}},
      {"isosurface",
       {R"("field": "sphere", "level": 1)", R"("field": "sphere", "level": 1, "free": "above")",
        R"("field": "torus", "level": 0.4, "free": "below", "release": 0.2)", R"("field": "torus", "level": 0.3)",
        R"("field": "gaussian", "level": 0.5, "release": 0.3)", R"("field": "tanh", "level": 0.9, "free": "below")",
        R"("field": "marschner-lobb", "level": 0.5)", R"("field": "constant", "level": 1)", R"("field": "sphere_grid", "level": 1)",
        R"("field": "sphere_grid", "level": 0.05)", R"("field": "torus_grid", "level": 0.4, "free": "above", "release": 0.2)",
        R"("field": "boxes_grid", "level": 0.9, "free": "below")", R"("field": "noise_grid", "level": 0.1)",
        R"("field": "noise_grid", "level": 0.1, "free": "above", "release": 0.1)", R"("field": "broken_grid", "level": 0.5)",
        R"("field": "broken_grid", "level": 0.5, "free": "above")"}},
      {"mesh",
       {R"("mesh": "box")", R"("mesh": "box", "free": "above")", R"("mesh": "box", "free": "below", "release": 0.2)",
        R"("mesh": "sheet", "free": "above", "release": 0.3)", R"("mesh": "sheet", "release": 0.1)", R"("mesh": "book", "free": "above")",
        R"("mesh": "book")", R"("mesh": "sphere", "free": "above")", R"("mesh": "sphere")", R"("mesh": "plate", "free": "above")",
        R"("mesh": "plate", "free": "below")"}},
      {"streamline",
       {R"("field": "circle", "seed": [0.5, 0, 0])", R"("field": "saddle", "seed": [0.5, 0.2, 0.1])", R"("field": "circle")",
        R"("field": "hill", "seed": [0.5, 0, 0], "follow": "online")", R"("field": "circle", "seed": [0.5, 0, 0], "method": "linear")",
        R"("field": "circle", "seed": [0.5, 0, 0], "method": "rk4")", R"("field": "circle_grid", "seed": [0.5, 0, 0])",
        R"("field": "circle_grid", "seed": [0.5, 0, 0], "follow": "online")"}},
  };
}

const Fields& fields() {
  static const Fields all = [] {
    Fields made;
    for (const char* name : {"sphere", "torus", "gaussian", "tanh", "marschner-lobb", "constant"}) made.named[name].scalar = analytic(name);
    for (const char* name : {"circle", "saddle", "hill"}) made.named[name].vector = field::make_analytic(name)->vector;
    made.named["sphere_grid"].scalar = sampled("sphere", 25);
    made.named["torus_grid"].scalar = sampled("torus", 33);
    made.named["circle_grid"].vector = field::sample_on_grid(*made.named["circle"].vector, 24, -2, 2);
    Mat3 boxes(0.0);
    boxes[0] = Vec3(0.1, 0.02, 0);
    boxes[1] = Vec3(-0.05, 0.25, 0);
    boxes[2] = Vec3(0, 0.03, 0.4);
    made.named["boxes_grid"].scalar =
        grid_of(field::Mapping::from_linear(boxes, Vec3(-1.2, -1.8, -2)), {30, 15, 10}, [](const Vec3& p) { return norm(p); });
    Random random(99);
    made.named["noise_grid"].scalar =
        grid_of(field::Mapping::from_linear(Mat3(0.2), Vec3(-2.0)), {21, 21, 21}, [&](const Vec3&) { return random.in(-1, 1); });
    made.named["broken_grid"].scalar = grid_of(field::Mapping::from_linear(Mat3(0.2), Vec3(-2.0)), {21, 21, 21}, [&](const Vec3&) {
      const double v = random.in(0, 1);
      return v < 0.03 ? std::numeric_limits<double>::quiet_NaN() : v < 0.04 ? std::numeric_limits<double>::infinity() : v;
    });
    made.meshes["box"] = catena::test::mesh_of(catena::test::box_soup());
    made.meshes["sheet"] = catena::test::mesh_of(catena::test::sheet_soup(12, 1, [](double x, double y) { return 0.3 * x * x - 0.4 * y; }));
    made.meshes["sphere"] = catena::test::mesh_of(catena::test::sphere_soup(12));
    made.meshes["plate"] = catena::test::mesh_of(catena::test::box_soup({-1, -1, -5e-4}, {1, 1, 5e-4}));
    // three leaves at one spine, one of them turned over
    mesh::Soup book;
    catena::test::add_quad(book, {0, -1, 0}, {1, -1, 0.2}, {1, 1, 0.2}, {0, 1, 0});
    catena::test::add_quad(book, {0, -1, 0}, {0, 1, 0}, {-1, 1, 0.2}, {-1, -1, 0.2});
    catena::test::add_quad(book, {0, -1, 0}, {0, -1, 1}, {0, 1, 1}, {0, 1, 0});
    made.meshes["book"] = catena::test::mesh_of(std::move(book));
    return made;
  }();
  return all;
}

struct Example {
  std::string type, body;
};
void PrintTo(const Example& e, std::ostream* out) { *out << e.type << " {" << e.body << "}"; }

std::vector<Example> all_examples() {
  std::vector<Example> out;
  const auto table = examples();
  for (const ConstraintType& type : registry()) {
    const auto it = table.find(std::string(type.type));
    if (it == table.end()) continue;
    for (const std::string& body : it->second) out.push_back({it->first, body});
  }
  return out;
}

TEST(ConformanceTable, EveryRegisteredTypeHasExamples) {
  const auto table = examples();
  for (const ConstraintType& type : registry()) EXPECT_TRUE(table.contains(std::string(type.type))) << type.type;
}

/// A hand's path with rests and pushes, then jumps, singular points, and places far outside.
const std::vector<Vec3>& probes() {
  static const std::vector<Vec3> list = [] {
    std::vector<Vec3> out;
    Random random(21);
    Vec3 p(0.6, 0.2, 0.1), v = random.unit() * 0.004;
    for (int i = 0; i < 600; ++i) {
      v = direction(v + random.unit() * 0.001) * (i % 100 < 50 ? 0.004 : 0.03);
      p = norm(p + v) > 1.9 ? p * 0.9 : p + v;
      out.push_back(p);
      if (i % 50 == 49) out.insert(out.end(), 3, p);
    }
    for (int i = 0; i < 200; ++i) out.push_back(random.box(2.5));
    const double huge = 1e6;
    for (const Vec3& q : {Vec3(0.0), Vec3(1, 0, 0), Vec3(0, 0, 1), Vec3(-0.0, 0.0, -0.0), Vec3(2, 2, 2), Vec3(-2, -2, -2), Vec3(huge, 0, 0),
                          Vec3(-huge, huge, huge), Vec3(0.0), Vec3(1e-300, 0, 0), Vec3(1e-12, 1e-12, 0), Vec3(1e150, -1e150, 1),
                          Vec3(1e300, 1e300, 1e300), Vec3(0.5, 0.5, 0.5), Vec3(huge, 1, 1), Vec3(0.3, 0.3, 0.3)})
      out.insert(out.end(), 2, q);
    return out;
  }();
  return list;
}

class Conformance : public testing::TestWithParam<Example> {
 protected:
  void SetUp() override {
    constraint_ = build(R"({"name": "a", "type": ")" + GetParam().type + "\", " + GetParam().body + "}", fields());
    ASSERT_NE(constraint_, nullptr);
  }
  ConstraintPtr constraint_;
};

TEST_P(Conformance, FiniteBoundedAndWithoutAllocation) {
  Rig rig(constraint_);
  const auto& path = probes();
  AllocationGuard guard;
  for (std::size_t i = 0; i < path.size(); ++i) {
    rig.tick(path[i]);
    const LinkState& s = rig.state;
    ASSERT_TRUE(is_finite(s.proxy)) << "tick " << i;
    ASSERT_TRUE(std::isfinite(s.residual)) << "tick " << i;
    ASSERT_GE(s.evaluations, 0);
    ASSERT_LE(s.evaluations, kEvaluationCap) << "tick " << i;
    const bool passes = s.released || s.status == Status::free || s.status == Status::released || s.status == Status::no_surface;
    if (passes) {
      ASSERT_TRUE(same_bits(s.proxy, path[i])) << "tick " << i;
    }
    ASSERT_EQ(s.released, s.status == Status::released) << "tick " << i;
    ASSERT_NE(s.status, Status::bad_probe);
  }
  EXPECT_EQ(guard.count(), 0u);
}

TEST_P(Conformance, RestsWhenTheProbeRests) {
  // Eqs. 1-2 as printed never come to rest: they are there as the baseline
  if (GetParam().body.find("\"linear\"") != std::string::npos) return;
  Rig rig(constraint_);
  const auto& path = probes();
  for (std::size_t i = 0; i < path.size(); i += 23) {
    // as many ticks as a walk out of budget may need, then nothing moves
    rig.tick(path[i]);
    for (int k = 0; k < 20 && rig.state.status == Status::budget; ++k) rig.tick(path[i]);
    if (rig.state.status == Status::budget) continue;  // a walk of 1e300 lengths
    const Vec3 rest = rig.state.proxy;
    const Status status = rig.state.status;
    for (int k = 0; k < 5; ++k) {
      rig.tick(path[i]);
      ASSERT_TRUE(same_bits(rig.state.proxy, rest)) << "probe " << i << " status " << exchange::status_word(status);
      ASSERT_EQ(rig.state.status, status) << "probe " << i;
    }
  }
}

TEST_P(Conformance, TheSameBitsAgain) {
  Rig first(constraint_), second(constraint_), fresh_scratch(constraint_), used_scratch(constraint_);
  for (const Vec3& probe : probes()) used_scratch.tick(probe);
  used_scratch.state = LinkState{};
  for (const Vec3& probe : probes()) {
    first.tick(probe);
    second.tick(probe);
    fresh_scratch.scratch = LinkScratch{};
    fresh_scratch.tick(probe);
    used_scratch.tick(probe);
    for (const Rig* other : {&second, &fresh_scratch, &used_scratch}) {
      ASSERT_TRUE(same_bits(first.state.proxy, other->state.proxy));
      ASSERT_EQ(first.state.status, other->state.status);
      ASSERT_EQ(first.state.released, other->state.released);
      ASSERT_EQ(first.state.evaluations, other->state.evaluations);
      ASSERT_EQ(std::memcmp(&first.state.residual, &other->state.residual, sizeof(double)), 0);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, Conformance, testing::ValuesIn(all_examples()),
                         [](const auto& test) { return test.param.type + "_" + std::to_string(test.index); });

}  // namespace
}  // namespace catena::haptics::test
