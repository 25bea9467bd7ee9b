// SPDX-License-Identifier: MIT
// Endurance: no allocation in a million ticks of a chain, and only finite outputs in ten million hostile ticks over every constraint type
// of the conformance table, on valid fields, fields with NaN, and fields scaled to the limits of doubles.
#include "engine/base/memory_limit.h"
#include "tests/acceptance/chain_fixture.h"
#include "tests/acceptance/reference_numerics.h"
#include "tests/haptics/constraints/examples.h"

namespace catena::acceptance::endurance_test {

using haptics::tests::all_examples;
using haptics::tests::ConstraintPtr;
using haptics::tests::Example;
using haptics::tests::Fields;
using haptics::tests::Random;

#ifdef CATENA_SANITIZED
constexpr int kHostileTicks = 100000, kQuietTicks = 100000;
#else
constexpr int kHostileTicks = 10000000, kQuietTicks = 1000000;
#endif
constexpr int kParts = 20;  ///< number of test cases that share the hostile ticks

std::string text_of(const Example& e) { return R"({"name": "a", "type": ")" + e.type + "\", " + e.body + "}"; }

/// The table's fields, sampled coarsely with every fifteenth voxel NaN or infinite.
const Fields& ridden_fields() {
  static const Fields all = [] {
    Fields made;
    Random random(404);
    const auto mapping = field::Mapping::from_linear(Mat3(0.2), Vec3(-2.0));
    const auto spoil = [&] {
      const double v = random.uniform(0, 1);
      return v < 0.05   ? std::numeric_limits<float>::quiet_NaN()
             : v < 0.06 ? std::numeric_limits<float>::infinity()
             : v < 0.07 ? -std::numeric_limits<float>::infinity()
             : v < 0.08 ? 3e38f
                        : 0.0f;
    };
    for (const auto& [name, any] : haptics::tests::fields().named) {
      std::vector<float> values;
      field::Cursor cursor;
      for (int z = 0; z < 21; ++z)
        for (int y = 0; y < 21; ++y)
          for (int x = 0; x < 21; ++x) {
            const Vec3 p = mapping.world_from_index(Vec3(x, y, z));
            if (any.scalar) values.push_back(static_cast<float>(any.scalar->sample(p, cursor).value) + spoil());
            if (!any.vector) continue;
            const Vec3 v = any.vector->sample(p, cursor).value;
            for (int a = 0; a < 3; ++a) values.push_back(static_cast<float>(v[a]) + spoil());
          }
      if (any.scalar)
        made.named[name].scalar = field::make_scalar_grid("ridden", mapping, {21, 21, 21}, values);
      else
        made.named[name].vector = field::make_vector_grid("ridden", mapping, {21, 21, 21}, values);
    }
    return made;
  }();
  return all;
}

/// The table's analytic vector fields scaled to the limits of doubles; scalar fields unchanged.
Fields scaled_fields(double scale) {
  Fields made = haptics::tests::fields();
  for (auto& [name, any] : made.named) {
    if (!any.vector || !field::is_analytic(name)) continue;
    any.vector = catena::test::analytic_vector(name, scale);
  }
  return made;
}

/// Every example that can be built, on all these fields, and isosurfaces of scaled fields with scaled levels.
const std::vector<ConstraintPtr>& constraints() {
  static const std::vector<ConstraintPtr> all = [] {
    std::vector<ConstraintPtr> made;
    const Fields tiny = scaled_fields(1e-300), huge = scaled_fields(1e300);
    for (const Fields* fields : {&haptics::tests::fields(), &ridden_fields(), &tiny, &huge})
      for (const Example& example : all_examples()) {
        const bool names_field = example.body.find("\"field\"") != std::string::npos;
        if (fields != &haptics::tests::fields() && !names_field) continue;
        auto constraint = haptics::tests::try_build(text_of(example), *fields);
        if (constraint) made.push_back(*constraint);
        // on valid fields every example builds
        if (fields == &haptics::tests::fields()) {
          EXPECT_TRUE(constraint) << text_of(example);
        }
      }
    for (const char* name : {"sphere", "torus", "gaussian", "tanh"})
      for (const double scale : {1e-300, 1e-30, 1e30, 1e300})
        for (const char* more : {"", R"(, "free": "above")", R"(, "free": "below", "release": 0.2)"})
          made.push_back(haptics::tests::isosurface(haptics::tests::analytic_field(name, scale), 0.4 * scale, more));
    return made;
  }();
  return all;
}

/// A random chain of one to three constraints with switches, cues, ramps and possibly modes.
std::shared_ptr<const HapticProgram> random_program(Random& random, std::size_t first) {
  const auto pick = [&] { return static_cast<std::size_t>(random.uniform(0, static_cast<double>(constraints().size()))); };
  auto program = std::make_shared<HapticProgram>();
  const int links = 1 + static_cast<int>(random.uniform(0, 2.2));
  for (int i = 0; i < links; ++i) {
    haptics::Link link;
    link.name = std::string(1, static_cast<char>('a' + i));
    link.constraint = constraints()[i == 0 ? first : pick()];
    link.stiffness_n_per_m = random.uniform(0, 1) < 0.1 ? 1e9 : 300;
    if (random.uniform(0, 1) < 0.5) link.active_when.button = 1 + static_cast<int>(random.uniform(0, 4));
    link.active_when.toggle = link.active_when.button > 0 && random.uniform(0, 1) < 0.5;
    link.release_cue.type = static_cast<haptics::ReleaseCue::Type>(static_cast<int>(random.uniform(0, 3)));
    program->links.push_back(std::move(link));
  }
  if (random.uniform(0, 1) < 0.3) {
    haptics::Mode mode;
    mode.name = "back";
    for (int i = links - 1; i >= 0; --i) mode.links.push_back(i);
    mode.active_when.button = 5;
    program->modes.push_back(std::move(mode));
  }
  program->coupling.ramp_s = random.uniform(0, 1) < 0.5 ? 0 : 0.02;
  program->coupling.damping_ns_per_m = random.uniform(0, 1) < 0.5 ? 0 : 2;
  program->meters_per_unit = random.uniform(0, 1) < 0.1 ? 1e-3 : 0.05;
  return program;
}

std::string state_of(const HapticProgram& program, const HapticState& out) {
  std::string text;
  for (std::size_t i = 0; i < program.links.size(); ++i) {
    const LinkReport& link = out.links[i];
    text += fmt::format("[{} at {}, gap {}, weight {}, share {}]", to_string(link.status), scene::to_json(link.proxy), link.gap,
                        link.weight, scene::to_json(link.force_n));
  }
  return text;
}

/// A hostile hand: jumps, rests, 1e300, denormals, non-finite probes, random buttons, clocks that stop or run backwards.
class AdversarialProbe {
 public:
  explicit AdversarialProbe(std::uint64_t seed) : random_(seed) {}
  haptics::ProbeSample next() {
    if (ticks_left_-- <= 0) {
      behavior_ = static_cast<int>(random_.uniform(0, 9));
      ticks_left_ = static_cast<int>(random_.uniform(1, behavior_ < 4 ? 120 : 25));
    }
    Vec3 p = position_;
    const double inf = std::numeric_limits<double>::infinity();
    static constexpr double odd[] = {0.0, -0.0, 5e-324, -1e-310, 1e-300, 0.5,   1.0,    -2.0,
                                     2.0, 1e6,  -1e9,   1e154,   -1e160, 1e300, -1e300, 1.7e308};
    const auto from_odd = [&] { return odd[static_cast<std::size_t>(random_.uniform(0, 16))]; };
    switch (behavior_) {
      case 0:  // a smooth motion
      case 1:
        velocity_ = velocity_ * 0.95 + random_.box(2e-4);
        p = norm(position_ + velocity_) < 2.2 ? position_ + velocity_ : Vec3(0.3, 0.2, 0.1);
        break;
      case 2:  // a trembling motion
        p = position_ + random_.box(1e-9);
        break;
      case 3:  // at rest
        break;
      case 4:  // jumps
        p = random_.box(2.5);
        break;
      case 5:  // extreme numbers
        p = {from_odd(), from_odd(), from_odd()};
        break;
      case 6:  // far away
        p = random_.unit() * (random_.uniform(0, 1) < 0.5 ? 1e3 : 1e280);
        break;
      case 7:  // pushes on one axis
        p = position_ + Vec3(0, 0, random_.uniform(-0.05, 0.05));
        break;
      default:  // not finite
        p = {random_.uniform(0, 1) < 0.5 ? inf : position_.x, random_.uniform(0, 1) < 0.5 ? -inf : position_.y,
             std::numeric_limits<double>::quiet_NaN()};
    }
    if (is_finite(p)) position_ = norm(p) < 10 ? p : Vec3(0.4, -0.3, 0.2);
    if (random_.uniform(0, 1) < 0.01) buttons_ = static_cast<std::uint32_t>(random_.engine());
    const double clock = random_.uniform(0, 1);
    t_s_ = clock < 0.97    ? t_s_ + 1e-3
           : clock < 0.98  ? t_s_
           : clock < 0.99  ? t_s_ - random_.uniform(0, 3)
           : clock < 0.995 ? t_s_ + 1e-320
                           : t_s_ + 1e6;
    const bool broken_clock = random_.uniform(0, 1) < 1e-3;
    return {broken_clock ? -inf : t_s_, p, buttons_};
  }

 private:
  Random random_;
  Vec3 position_{0.3, 0.2, 0.1}, velocity_{0.0};
  int behavior_ = 0, ticks_left_ = 0;
  std::uint32_t buttons_ = 0;
  double t_s_ = 0;
};

/// Checks the invariants after a tick: the first violated one, or null.
inline const char* find_violation(const HapticProgram& program, const haptics::ProbeSample& probe, const HapticState& out) {
  const bool bad = !is_finite(probe.position) || !std::isfinite(probe.t_s);
  if (!is_finite(out.force_n)) return "force";
  if (!(norm(out.force_n) <= program.coupling.max_force_n * (1 + 1e-12))) return "force above its limit";
  if (bad && max_abs(out.force_n) != 0) return "force of a bad probe";
  for (std::size_t i = 0; i < program.links.size(); ++i) {
    const LinkReport& link = out.links[i];
    if (!is_finite(link.proxy)) return "proxy";
    if (std::isnan(link.gap) || std::isnan(link.force_n.x) || std::isnan(link.force_n.y) || std::isnan(link.force_n.z)) return "share";
    if (!(link.residual >= 0) || !std::isfinite(link.residual)) return "residual";
    if (!(link.weight >= 0 && link.weight <= 1)) return "weight";
    if (link.evaluations < 0 || link.evaluations > haptics::kMaxEvaluations) return "evaluations";
    if (bad != (link.status == LinkStatus::bad_probe)) return "status";
  }
  return nullptr;
}

class Endurance : public testing::TestWithParam<int> {};

TEST_P(Endurance, HostileTicksKeepTheStateValid) {
  const int part = GetParam(), total = kHostileTicks / kParts;
  Random random(1000 + static_cast<std::uint64_t>(part));
  AdversarialProbe hand(2000 + static_cast<std::uint64_t>(part));
  // every constraint in turn, the same number of ticks each
  const int each = std::max(50, total / static_cast<int>(constraints().size()));
  ChainState state;
  ChainScratch scratch;
  HapticState out;
  std::shared_ptr<const HapticProgram> last;
  int done = 0, programs = 0;
  for (std::size_t k = static_cast<std::size_t>(part); done < total; ++k) {
    const auto program = random_program(random, k % constraints().size());
    ++programs;
    if (last && random.uniform(0, 1) < 0.7)
      haptics::rebind_program(*last, *program, state, scratch);
    else
      state = ChainState{}, scratch = ChainScratch{};
    last = program;
    const AllocationCounter guard;
    for (int i = 0; i < each; ++i, ++done) {
      const haptics::ProbeSample probe = hand.next();
      haptics::tick(*program, probe, state, scratch, out);
      const char* what = find_violation(*program, probe, out);
      ASSERT_EQ(what, nullptr) << what << ": constraint " << k % constraints().size() << ", tick " << i << " of program " << programs
                               << ", probe " << probe.position.x << " " << probe.position.y << " " << probe.position.z << ", "
                               << state_of(*program, out);
    }
    ASSERT_EQ(guard.count(), 0u);
  }
  record_results("", {{"hostile ticks", done}, {"chains", programs}, {"constraints", static_cast<double>(constraints().size())}});
}

INSTANTIATE_TEST_SUITE_P(Hostile, Endurance, testing::Range(0, kParts));

TEST(EnduranceNoAllocation, NoAllocationInAMillionTicksOfAChain) {
  ChainRig chain(make_program(R"({"fields": {"v": {"analytic": "hill"}, "g": {"analytic": "hill", "resolution": 48, "box": [-1.2, 1.2]},
      "s": {"analytic": "sphere"}, "t": {"analytic": "torus", "resolution": 48, "box": [-2, 2]}}, "chain": [
      {"name": "line", "type": "streamline", "field": "g", "seed": [0.5, 0, 0]},
      {"name": "online", "type": "streamline", "field": "v", "seed": [0.5, 0, 0], "follow": "online", "active_when": {"button": 1}},
      {"name": "shell", "type": "isosurface", "field": "t", "level": 0.35, "free": "above", "release": 0.05},
      {"name": "ball", "type": "isosurface", "field": "s", "level": 0.7, "active_when": {"button": 2}},
      {"name": "floor", "type": "plane", "point": [0, 0, -0.2], "normal": [0, 0, 1], "free": "above"}],
      "coupling": {"stiffness": 500, "damping": 1, "ramp_s": 0.02}})"));
  Random random(31);
  Vec3 probe(0.5, 0, 0), velocity(0.0);
  const AllocationCounter guard;
  int budget = 0;
  for (int i = 0; i < kQuietTicks; ++i) {
    velocity = velocity * 0.99 + random.box(3e-5);
    probe += velocity;
    if (norm(probe - Vec3(0.6, 0, 0)) > 0.5) velocity -= 1e-3 * (probe - Vec3(0.6, 0, 0));
    chain.step_to(probe, i / 5000 % 4);
    for (std::size_t link = 0; link < 5; ++link) budget += chain.status(link) == LinkStatus::budget;
  }
  EXPECT_EQ(guard.count(), 0u);
  record_results("", {{"ticks", kQuietTicks}, {"BUDGET among them", budget}});
}

}  // namespace catena::acceptance::endurance_test
