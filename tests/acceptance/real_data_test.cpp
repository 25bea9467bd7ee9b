// SPDX-License-Identifier: MIT
// One minute of exploration of real data at 1 kHz: a hand wanders along and around a streamline at 0.05 to 0.2 L/s, with the chain
// streamline -> isosurface, selected and online. No tick may run out of budget; the proxy's distance from a reference streamline, by
// Dormand-Prince 5(4) on this file's own trilinear sampler, is printed and bounded. At a tolerance of 1e-12 a method without cell
// boundaries is itself 1e-10 to 2e-7 L off, because its error estimate misses the faces: both figures are printed, and the bound is
// on the distance from the same method at 1e-17 in long double.
#include "engine/io/volume/load_field.h"
#include "haptics/constraints/streamline/selected_streamline.h"
#include "tests/acceptance/chain_fixture.h"
#include "tests/acceptance/reference_numerics.h"
#include "tests/support/support.h"

namespace catena::acceptance::real_data_test {

#ifdef CATENA_SANITIZED
constexpr int kTicks = 6000;
#else
constexpr int kTicks = 60000;
#endif
constexpr int kEvery = 60;  ///< ticks between two comparisons with the reference

/// The raw voxels as a trilinear field in long double, for axis-aligned grids.
class Trilinear {
 public:
  Trilinear(const field::VectorGrid& grid, bool line) : line_(line) {
    const field::Box& box = grid.index_box();
    size_ = {static_cast<int>(box.hi.x - box.lo.x) + 1, static_cast<int>(box.hi.y - box.lo.y) + 1,
             static_cast<int>(box.hi.z - box.lo.z) + 1};
    xyz_.resize(static_cast<std::size_t>(size_.x) * size_.y * size_.z * 3);
    grid.read_block({static_cast<int>(box.lo.x), static_cast<int>(box.lo.y), static_cast<int>(box.lo.z)}, size_, xyz_);
    origin_ = Real3(grid.mapping().world_from_index(box.lo));
    const Mat3& m = grid.mapping().world_from_index_linear;
    EXPECT_EQ(max_abs(m[0] - Vec3(m[0].x, 0, 0)) + max_abs(m[1] - Vec3(0, m[1].y, 0)) + max_abs(m[2] - Vec3(0, 0, m[2].z)), 0);
    voxel_ = Real3(m[0].x, m[1].y, m[2].z);
  }
  Real3 direction(const Real3& p, const Real3& last) const {
    const Real at[3] = {(p.x - origin_.x) / voxel_.x, (p.y - origin_.y) / voxel_.y, (p.z - origin_.z) / voxel_.z};
    const int maximum[3] = {size_.x - 2, size_.y - 2, size_.z - 2};
    int b[3];
    Real f[3];
    for (int a = 0; a < 3; ++a) {
      b[a] = std::clamp(static_cast<int>(std::floor(at[a])), 0, maximum[a]);
      f[a] = at[a] - b[a];
    }
    Real3 sum;
    Real dyads[3][3] = {};
    for (int c = 0; c < 8; ++c) {
      const int x = b[0] + (c & 1), y = b[1] + (c >> 1 & 1), z = b[2] + (c >> 2);
      const float* v = &xyz_[((static_cast<std::size_t>(z) * size_.y + y) * size_.x + x) * 3];
      const Real w = (c & 1 ? f[0] : 1 - f[0]) * (c & 2 ? f[1] : 1 - f[1]) * (c & 4 ? f[2] : 1 - f[2]);
      sum = sum + w * Real3(v[0], v[1], v[2]);
      for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) dyads[i][k] += w * v[i] * v[k];
    }
    return line_ ? leading(dyads, last) : unit_direction(sum);
  }
  /// Power iteration from the last direction until convergence.
  static Real3 leading(const Real (&m)[3][3], const Real3& last) {
    Real3 u = unit_direction(last);
    for (int i = 0; i < 5000; ++i) {
      const Real3 next = unit_direction(Real3(m[0][0] * u.x + m[0][1] * u.y + m[0][2] * u.z, m[1][0] * u.x + m[1][1] * u.y + m[1][2] * u.z,
                                              m[2][0] * u.x + m[2][1] * u.y + m[2][2] * u.z));
      const Real3 change = next - u;
      u = next;
      if (dot(change, change) < 1e-38L) break;
    }
    return u;
  }

 private:
  std::vector<float> xyz_;
  field::Index3 size_{0, 0, 0};
  Real3 origin_, voxel_;
  bool line_;
};

/// The reference streamline as stations, from which the closest point is found by exact integration.
class Reference {
 public:
  Reference(const Trilinear& field, const Vec3& seed, const Vec3& u_seed, double back, double ahead, double length, Real tolerance)
      : field_(field), tolerance_(tolerance), spacing_(length / 1000) {
    for (const double sign : {1.0, -1.0}) {
      Station s{Real3(seed), Real3(u_seed)};
      stations_.push_back(s);
      const Real far = sign > 0 ? ahead : -back;
      for (Real done = 0; done < far; done += spacing_) {
        s = go(s, sign * spacing_);
        stations_.push_back(s);
      }
    }
  }
  double distance(const Vec3& at) const {
    const Real3 x(at);
    const Station* nearest = &stations_.front();
    for (const Station& s : stations_)
      if (dot(x - s.p, x - s.p) < dot(x - nearest->p, x - nearest->p)) nearest = &s;
    Station foot = *nearest;
    for (int i = 0; i < 4; ++i) foot = go(foot, dot(x - foot.p, foot.u));
    return static_cast<double>(length(x - foot.p));
  }

 private:
  struct Station {
    Real3 p, u;
  };
  Station go(Station s, Real way) const {
    if (way == 0) return s;
    Real h = 0;
    const auto rate = [this](const Real3& p, const Real3& last) { return field_.direction(p, last); };
    s.p = dormand_prince(rate, s.p, way, tolerance_, s.u, h);
    s.u = field_.direction(s.p, s.u);
    return s;
  }
  const Trilinear& field_;
  Real tolerance_, spacing_;
  std::vector<Station> stations_;
};

struct Quantiles {
  std::vector<double> values;
  void report(const std::string& who) {
    std::sort(values.begin(), values.end());
    for (const auto& [word, part] : {std::pair{" p50", 0.5}, std::pair{" p99", 0.99}, std::pair{" max", 1.0}})
      record_result(who + word, at(part));
  }
  double at(double part) const {
    return values.empty() ? 0 : values[static_cast<std::size_t>(part * static_cast<double>(values.size() - 1))];
  }
};

struct Data {
  std::string file, vector_grid, scalar_grid, more;  ///< `more`: further keys of the streamline
  flow::Flow flow;
  Vec3 seed{0.0};
};

field::AnyField load(const std::string& path, const std::string& grid) {
  field::LoadRequest request;
  request.path = path;
  request.grid = grid;
  auto field = field::load(request);
  EXPECT_TRUE(field) << (field ? "" : field.error().message);
  return field ? *field : field::AnyField{};
}

using scene::to_json;

void explore(const Data& data) {
  const auto vectors = load(data.file, data.vector_grid).vector;
  const auto scalars = load(data.file, data.scalar_grid).scalar;
  ASSERT_TRUE(vectors && scalars);
  flow::Flow flow = data.flow;
  flow.field = vectors.get();
  const double domain = vectors->domain_length();
  const auto traced = flow::trace(flow, data.seed);
  ASSERT_TRUE(traced) << traced.error().message;
  const flow::Curve& curve = **traced;
  const double lo = std::max(curve.knots().front().s, -2 * domain), hi = std::min(curve.knots().back().s, 2 * domain);
  field::Cursor cursor;
  const double level = scalars->sample(data.seed, cursor).value;
  record_result("length of the line / L", curve.period() / domain);
  record_result("level of the isosurface", level);

  // the hand
  std::vector<Vec3> path;
  double s = 0, way = 1, first = 0, last = 0;
  for (int i = 0; i < kTicks; ++i) {
    const double t = 1e-3 * i;
    s += way * 1e-3 * domain * (0.125 + 0.075 * std::sin(0.44 * t));
    first = std::min(first, s);
    last = std::max(last, s);
    if (s > hi || s < lo) way = s > hi ? -1 : 1;
    path.push_back(curve.position(s) +
                   0.02 * domain * std::sin(0.3 * t) * Vec3(std::sin(2.1 * t), std::sin(1.7 * t + 1), std::sin(2.9 * t + 2)));
  }
  record_result("part of the line that the hand visits / L", (last - first) / domain);

  // the reference
  const Trilinear sampler(*vectors->grid(), flow.is_line_field);
  Vec3 at_seed, u_seed(0.0);
  curve.evaluate_interval(curve.find_interval(0), 0, at_seed, u_seed);
  const Reference reference(sampler, data.seed, u_seed, std::max(first, lo), std::min(last, hi), domain, 1e-12L * domain);
  const Reference truth(sampler, data.seed, u_seed, std::max(first, lo), std::min(last, hi), domain, 1e-17L * domain);

  // online at the default tolerance (1e-9 L per step), errors accumulate over 60 000 steps
  struct Follow {
    std::string name, keys;
    double goal;  ///< bound of the distance from the reference, in L
  };
  for (const Follow& follow : {Follow{"selected", "", 1e-10}, Follow{"online", R"(, "follow": "online")", 3e-6},
                               Follow{"online, tolerance 1e-12", R"(, "follow": "online", "tolerance": 1e-12)", 5e-8}})
    for (const std::string& side :
         {std::string(), std::string(R"(, "free": "above")"), R"(, "free": "below", "release": )" + to_json(0.01 * domain)}) {
      const auto source = [&](const std::string& grid) { return R"({"file": ")" + data.file + R"(", "grid": ")" + grid + "\"}"; };
      ChainRig chain(make_program(R"({"fields": {"v": )" + source(data.vector_grid) + R"(, "s": )" + source(data.scalar_grid) +
                                  R"(}, "chain": [{"name": "line", "type": "streamline", "field": "v", "seed": )" + to_json(data.seed) +
                                  follow.keys + data.more + R"(}, {"name": "wall", "type": "isosurface", "field": "s", "level": )" +
                                  to_json(level) + side + "}]}"));
      int budget[2] = {0, 0}, count[8] = {};
      Quantiles evaluations[2], residual, from_reference, from_truth;
      for (int i = 0; i < kTicks; ++i) {
        chain.step_to(path[static_cast<std::size_t>(i)]);
        for (std::size_t link = 0; link < 2; ++link) {
          budget[link] += chain.status(link) == LinkStatus::budget;
          evaluations[link].values.push_back(chain.evaluations(link));
          EXPECT_TRUE(is_finite(chain.proxy(link)));
        }
        ++count[static_cast<int>(chain.status(1))];
        if (chain.status(1) == LinkStatus::ok) residual.values.push_back(chain.out.links[1].residual / domain);
        if (side.empty() && i % kEvery == 0) {
          from_reference.values.push_back(reference.distance(chain.proxy(0)) / domain);
          from_truth.values.push_back(truth.distance(chain.proxy(0)) / domain);
        }
      }
      const std::string who = follow.name +
                              (side.empty()                              ? ", both sides"
                               : side.find("above") != std::string::npos ? ", free above"
                                                                         : ", free below") +
                              ": ";
      expect_at_most(who + "BUDGET streamline", budget[0], 0);
      // on a rough surface pressed beyond max_force the proxy may lag by its step limit
      expect_at_most(who + "BUDGET isosurface", budget[1], kTicks / 20);
      evaluations[0].report(who + "evaluations streamline");
      evaluations[1].report(who + "evaluations isosurface");
      residual.report(who + "isosurface residual / L");
      std::printf("    isosurface: OK %d FREE %d RELEASED %d CRITICAL %d BOUNDARY %d NO_SURFACE %d\n", count[0], count[1], count[2],
                  count[4], count[5], count[6]);
      EXPECT_LE(residual.at(1), 1e-9) << who;
      if (!side.empty()) continue;
      from_reference.report(who + "from DP5(4) at 1e-12 / L");
      from_truth.report(who + "from DP5(4) at 1e-17 / L");
      EXPECT_LE(from_truth.at(1), follow.goal) << who;
    }
}

/// The seed of a lattice with the longest line (at most 3 L in each direction).
Vec3 seed_of_longest(flow::Flow flow, const field::VectorGrid& grid) {
  flow.field = &grid;
  const field::Box& box = grid.index_box();
  flow::TraceOptions options;
  options.length = 3 * grid.domain_length();
  Vec3 best(0.0);
  double maximum = -1;
  for (int z = 1; z < 6; ++z)
    for (int y = 1; y < 6; ++y)
      for (int x = 1; x < 6; ++x) {
        const Vec3 part(x / 6.0 + 0.01, y / 6.0 + 0.02, z / 6.0 + 0.015);
        const Vec3 seed = grid.mapping().world_from_index(box.lo + part * (box.hi - box.lo));
        const auto curve = flow::trace(flow, seed, options);
        if (!curve || (*curve)->is_closed() || (*curve)->period() <= maximum) continue;
        maximum = (*curve)->period();
        best = seed;
      }
  return best;
}

/// Explores a file of the shared data from the seed of its longest line.
void explore_shared(const std::string& file, const std::string& vectors, const std::string& scalars, const std::string& more,
                    const flow::Flow& flow) {
  Data data{catena::test::shared_data(file), vectors, scalars, more, flow, Vec3(0.0)};
  if (data.file.empty()) GTEST_SKIP() << file << " of the shared data is not here";
  data.seed = seed_of_longest(flow, *load(data.file, vectors).vector->grid());
  explore(data);
}

TEST(RealDataEndurance, Combustor) { explore_shared("combustor_cfd.vdb", "velocity", "density", "", {}); }
TEST(RealDataEndurance, Carotid) { explore_shared("carotid_flow.vdb", "velocity", "density", R"(, "min_speed": 1)", {.min_speed = 1}); }
TEST(RealDataEndurance, VentricleFibres) {
  explore_shared("ideal_lv_fibres.vdb", "fibre", "transmural", R"(, "kind": "line")", {.is_line_field = true});
}

}  // namespace catena::acceptance::real_data_test
