// SPDX-License-Identifier: MIT
// Work of a chain along slow closed loops of the hand, in units of K gap^2: by the paper's sum of spring forces, and by virtual work, the
// gradient of an energy. The work is integrated by the trapezoid rule over the loop's parameter, refined until halving the step changes
// it by less than 1e-10 K gap^2; gap is the hand's maximum distance from the last proxy.
#include "haptics/constraints/common/link_schema.h"
#include "tests/haptics/chain/chain_driver.h"
#include "tests/haptics/constraints/constraint_fixture.h"

namespace catena::haptics::tests::energy_test {

constexpr double kStiffness = 100;

Fields fields() {
  Fields made = scalars({{"sphere", analytic_field("sphere")},
                         {"torus", analytic_field("torus")},
                         {"torus_grid", sampled_field("torus", 33)},
                         {"slope", cube_grid(9, [](const Vec3& p) { return p.x; })}});
  made.proxy_tolerance = 1e-10;  // tolerance of a conservative chain
  for (const char* name : {"circle", "helix"}) made.named[name].vector = field::make_analytic(name)->vector;
  return made;
}

/// A closed path of the hand about `centre`.
struct Loop {
  Vec3 centre, a, b, c;

  Vec3 at(double part) const {
    const double u = 2 * 3.14159265358979323846 * part;
    return centre + a * std::cos(u) + b * std::sin(u) + c * (0.3 * std::sin(2 * u));
  }
  /// Derivative of the position by `part`.
  Vec3 velocity(double part) const {
    const double turn = 2 * 3.14159265358979323846, u = turn * part;
    return (b * std::cos(u) - a * std::sin(u) + c * (0.6 * std::cos(2 * u))) * turn;
  }
};

struct Result {
  double work = 0;  ///< in units of K gap^2
  double left_out = 0;
  bool converged = false;
};

Result work_of(const std::vector<std::string>& links, CouplingForce force, const Loop& loop, int maximum = 1 << 14) {
  static const Fields all = fields();
  catena::test::ChainDriver fresh;
  for (const std::string& text : links) fresh.add(build(R"({"name": "a", )" + text + "}", all), kStiffness);
  fresh.program.coupling.force = force;
  Result result;
  double before = 0;
  for (int n = 64; n <= maximum; n *= 2) {
    catena::test::ChainDriver hand = fresh;
    double gap = 0, work = 0, left = 0;
    // one lap to settle, one to measure
    for (int k = 0; k <= 2 * n; ++k) {
      const Vec3 next = loop.at(static_cast<double>(k % n) / n);
      hand.step(next);
      if (k == n) left = hand.out.omitted_work_j;
      if (k > n) {
        work += dot(hand.out.force_n, loop.velocity(static_cast<double>(k % n) / n)) / n;
        gap = std::max(gap, norm(hand.link(links.size() - 1).proxy - next));
      }
    }
    const double unit = kStiffness * gap * gap;
    result = {work / unit, (hand.out.omitted_work_j - left) / unit, n > 64 && std::fabs(work - before) <= 1e-10 * unit};
    if (result.converged) break;
    before = work;
  }
  return result;
}

std::string plane(const Vec3& n, double height = 0) {
  const Vec3 p = direction(n) * height;
  return R"("type": "plane", "point": )" + to_json(p) + R"(, "normal": )" + to_json(n);
}
std::string line(const Vec3& p, const Vec3& d) { return R"("type": "line", "point": )" + to_json(p) + R"(, "direction": )" + to_json(d); }
const std::string kSphere = R"("type": "sphere", "center": [0, 0, 0], "radius": 1.5)";
const std::string kBall = R"("type": "isosurface", "field": "sphere", "level": 1.5)";
const std::string kTorus = R"("type": "isosurface", "field": "torus", "level": 0.4)";
const std::string kCircle = R"("type": "streamline", "field": "circle", "seed": [1.5, 0, 0])";
const std::string kHelix = R"("type": "streamline", "field": "helix", "seed": [1.5, 0, 0])";
const std::string kOnline = R"("type": "streamline", "field": "circle", "seed": [1.5, 0, 0], "follow": "online")";

/// A loop near the circle of radius 1.5 in z = 0, where the closest point of every link is unique and smooth.
Loop near_the_circle(Random& random) {
  const Vec3 centre = Vec3(1.65, 0.1, 0.1) + random.box(0.05), a = random.box(0.15), b = random.box(0.15);
  return {centre, a, b, random.box(0.1)};
}
/// The chain conserves energy along the loop, without a jump.
void expect_conservative(const std::vector<std::string>& links, const Loop& loop) {
  const Result result = work_of(links, CouplingForce::conservative, loop);
  EXPECT_LE(std::fabs(result.work), 1e-9);
  EXPECT_EQ(result.left_out, 0);
}

TEST(Energy, TwoPlanesAt45DegreesGainEnergyByThePaperAndNoneByVirtualWork) {
  const double s = std::sqrt(0.5);
  const std::vector<std::string> planes{plane({0, 0, 1}), plane({s, 0, s})};
  double maximum = 0;
  Random random(1);
  for (int i = 0; i < 20; ++i) {
    const Loop loop{random.box(0.1), random.box(0.3), random.box(0.3), Vec3(0.0)};
    const Result paper = work_of(planes, CouplingForce::paper, loop), virtual_work = work_of(planes, CouplingForce::conservative, loop);
    maximum = std::max(maximum, std::fabs(paper.work));
    EXPECT_LE(std::fabs(virtual_work.work), 1e-9);
  }
  EXPECT_GT(maximum, 0.1) << "the paper's form is not conservative";
}

TEST(Energy, SmoothProjectionsOverRandomLoops) {
  Random random(2);
  const std::vector<std::string> links{
      plane({1, 2, 3}, 0.3), line({0.2, 0.1, 0}, {1, 0.5, -0.3}), kSphere, kBall, kTorus, kCircle, kHelix, kOnline};
  for (const std::string& a : links)
    for (const std::string& b : links) {
      SCOPED_TRACE(a + ", " + b);
      expect_conservative({a, b}, near_the_circle(random));
    }
}

TEST(Energy, ThreeLinks) {
  Random random(3);
  const std::vector<std::vector<std::string>> chains{{kSphere, plane({1, 2, 3}, 0.3), line({0, 0, 0}, {1, 0.2, 0})},
                                                     {kTorus, kSphere, kCircle},
                                                     {kHelix, plane({0, 1, 1}), kSphere},
                                                     {plane({1, 0, 1}), plane({0, 1, 1}), plane({1, 1, 0})}};
  for (const auto& chain : chains)
    for (int i = 0; i < 3; ++i) expect_conservative(chain, near_the_circle(random));
}

TEST(Energy, JumpsAtConcaveCornersAreExcludedFromTheLedger) {
  // an arc of straight segments with the hand on its inner side: the proxy jumps at each corner
  std::string points;
  for (int i = -30; i <= 30; ++i) points += fmt::format("{}[{}, {}, 0]", i > -30 ? ", " : "", std::cos(0.04 * i), std::sin(0.04 * i));
  const std::vector<std::string> links{R"("type": "polyline", "points": [)" + points + "]", plane({0.3, 1, 0.2})};
  for (const double way : {1.0, -1.0}) {
    const Loop loop{Vec3(0.75, 0, 0), Vec3(0.15, 0, 0), Vec3(0, way * 0.15, 0), Vec3(0.0)};
    const Result result = work_of(links, CouplingForce::conservative, loop);
    EXPECT_GT(std::fabs(result.work), 1e-3);
    EXPECT_LE(std::fabs(result.work + result.left_out), 1e-4 * std::fabs(result.work));
  }
}

TEST(Energy, TemporaryContactsAndGridCells) {
  Random random(4);
  const std::string one_sided = plane({0, 0, 1}, 0.1) + R"(, "free": "above")";
  const std::string grid = R"("type": "isosurface", "field": "torus_grid", "level": 0.4)";
  const std::vector<std::vector<std::string>> chains{{one_sided, plane({1, 0, 1}, 0.2)},
                                                     {plane({1, 0, 1}, 0.2), one_sided},
                                                     {grid, plane({1, 2, 3}, 0.3)},
                                                     {plane({1, 2, 3}, 0.3), grid},
                                                     {grid, kCircle}};
  for (const auto& chain : chains) {
    // the force jumps where a contact begins, so that the sum over the loop is only first order in its step
    const Result result = work_of(chain, CouplingForce::conservative, near_the_circle(random), 1 << 19);
    EXPECT_LE(std::fabs(result.work + result.left_out), 1e-6) << chain[0] << " " << chain[1];
  }
}

TEST(Energy, AStiffnessThatFollowsAField) {
  static const Fields all = fields();
  auto node = json::parse(R"({"k": {"field": "slope", "map": [[-2, 50], [2, 300]]}})", "s.json");
  const auto map = get_parameter(*node, "k", 0.0, json::NumberRange::non_negative, all.context());
  ASSERT_TRUE(map);
  for (const CouplingForce force : {CouplingForce::paper, CouplingForce::conservative}) {
    catena::test::ChainDriver hand;
    hand.add(build(R"({"name": "a", )" + plane({0, 0, 1}) + "}")).stiffness_n_per_m = *map;
    hand.program.coupling.force = force;
    const Loop loop{Vec3(0.1, 0, 0.3), Vec3(0.3, 0, 0), Vec3(0, 0, 0.2), Vec3(0.0)};
    double work = 0;
    Vec3 x(0.0), f(0.0);
    const int n = 1 << 14;
    for (int k = 0; k <= 2 * n; ++k) {
      const Vec3 next = loop.at(static_cast<double>(k % n) / n);
      hand.step(next);
      if (k > n) work += 0.5 * dot(hand.out.force_n + f, next - x);
      x = next;
      f = hand.out.force_n;
    }
    if (force == CouplingForce::paper)
      EXPECT_GT(std::fabs(work), 0.01 * 175 * 0.25);
    else
      EXPECT_LE(std::fabs(work), 1e-6 * 175 * 0.25);
  }
}

}  // namespace catena::haptics::tests::energy_test
