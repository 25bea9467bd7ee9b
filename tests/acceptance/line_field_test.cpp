// SPDX-License-Identifier: MIT
// Line fields: fibres of a synthetic heart with random signs, noise of 10 degrees and seams of 90 degrees.
#include <numbers>
#include <random>

#include "engine/geometry/flow/batch_tracer.h"
#include "tests/acceptance/chain_fixture.h"
#include "tests/acceptance/reference_numerics.h"

namespace catena::acceptance::line_field_test {

using haptics::tests::Random;
using haptics::tests::Rig;

#ifdef CATENA_SANITIZED
constexpr std::size_t kLines = 60;
#else
constexpr std::size_t kLines = 1000;
#endif

struct Heart {
  std::shared_ptr<const field::VectorGrid> grid;
  std::vector<float> xyz;
  std::vector<std::uint8_t> valid;
  int nodes;
  double lo, spacing;

  Vec3 at(int x, int y, int z) const {
    const std::size_t n = 3 * ((static_cast<std::size_t>(z) * nodes + y) * nodes + x);
    return {xyz[n], xyz[n + 1], xyz[n + 2]};
  }
};

struct Damage {
  double noise_deg = 0;
  bool flips = false;
  bool seams = false;  ///< true: four sectors with perpendicular fibres in every other one
};

Heart make_heart(const Damage& damage, int nodes = 72, unsigned seed = 1) {
  const field::VectorFieldPtr ideal = field::make_analytic("left-ventricle", {1, Vec3(1, 0, 0), "fibre"}).value().vector;
  Random random(seed);
  Heart heart{nullptr, {}, {}, nodes, -1.6, 3.2 / (nodes - 1)};
  field::Cursor cursor;
  for (int z = 0; z < nodes; ++z)
    for (int y = 0; y < nodes; ++y)
      for (int x = 0; x < nodes; ++x) {
        const Vec3 p = Vec3(heart.lo) + heart.spacing * Vec3(x, y, z);
        const field::VectorSample s = ideal->sample(p, cursor);
        Vec3 v = s.value;
        if (s.inside) {
          const Vec3 outward = direction(Vec3(p.x, p.y, p.z / 2.25));
          const int sector = static_cast<int>(std::floor((std::atan2(p.y, p.x) + std::numbers::pi) / (0.5 * std::numbers::pi)));
          if (damage.seams && sector % 2 == 1) v = cross(outward, v);
          // rotated by a normally distributed angle about a random perpendicular axis
          double angle = 0;
          for (int k = 0; k < 12; ++k) angle += random.uniform(-0.5, 0.5);
          angle *= damage.noise_deg * std::numbers::pi / 180;
          const Vec3 across = direction(cross(v, random.unit()));
          v = direction(std::cos(angle) * v + std::sin(angle) * across);
          if (damage.flips && random.uniform(-1, 1) < 0) v = -v;
        }
        for (int a = 0; a < 3; ++a) heart.xyz.push_back(static_cast<float>(v[a]));
        heart.valid.push_back(s.inside);
      }
  heart.grid = field::make_vector_grid("fibre", field::Mapping::from_linear(Mat3(heart.spacing), Vec3(heart.lo)), {nodes, nodes, nodes},
                                       heart.xyz, heart.valid);
  return heart;
}

/// Interpolated dyads at a position, computed from the stored numbers; the leading eigenvector by 200 iterations of squaring.
struct Truth {
  double share = 0;  ///< largest eigenvalue divided by the trace
  Vec3 axis{0.0};
  Truth(const Heart& heart, const Vec3& p) {
    const Vec3 index = (p - Vec3(heart.lo)) / heart.spacing;
    int base[3];
    double f[3];
    for (int a = 0; a < 3; ++a) {
      base[a] = std::clamp(static_cast<int>(std::floor(index[a])), 0, heart.nodes - 2);
      f[a] = index[a] - base[a];
    }
    Mat3 m(0.0);
    for (int c = 0; c < 8; ++c) {
      const Vec3 v = heart.at(base[0] + (c & 1), base[1] + (c >> 1 & 1), base[2] + (c >> 2));
      const double w = ((c & 1) ? f[0] : 1 - f[0]) * ((c >> 1 & 1) ? f[1] : 1 - f[1]) * ((c >> 2) ? f[2] : 1 - f[2]);
      for (int i = 0; i < 3; ++i) m[i] += w * v[i] * v;
    }
    const double trace = m[0][0] + m[1][1] + m[2][2];
    Mat3 power = m;
    for (int i = 0; i < 12; ++i) {
      power = power * power;
      power = power * (1 / (power[0][0] + power[1][1] + power[2][2]));
    }
    int best = 0;
    for (int i = 1; i < 3; ++i)
      if (power[i][i] > power[best][best]) best = i;
    axis = direction(power[best]);
    share = dot(axis, m * axis) / trace;
  }
};

std::vector<Vec3> seeds_in(const Heart& heart, std::size_t count) {
  Random random(7);
  field::Cursor cursor;
  std::vector<Vec3> seeds;
  while (seeds.size() < count) {
    const Vec3 p = random.box(1.6);
    const double e = norm(Vec3(p.x, p.y, p.z / 1.5)), t = (e - 0.75) / 0.4;
    if (t > 0.1 && t < 0.9 && p.z < 0.6 && p.z > -1.2 && heart.grid->sample(p, cursor).inside) seeds.push_back(p);
  }
  return seeds;
}

struct Lines {
  double median_length = 0, worst_angle = 0;
  std::map<std::string, int> ends;
  int crossed = 0;
};

Lines trace_all(const Heart& heart, const std::vector<Vec3>& seeds) {
  Lines out;
  std::vector<double> lengths;
  for (const auto& line : flow::trace_all({heart.grid.get(), true, 0}, seeds)) {
    if (!line) {
      ++out.ends["none"];
      lengths.push_back(0);
      continue;
    }
    const auto& knots = (*line)->knots();
    lengths.push_back(knots.back().s - knots.front().s);
    ++out.ends[flow::to_string((*line)->first_end().termination)];
    ++out.ends[flow::to_string((*line)->last_end().termination)];
    bool crossed = false;
    for (const flow::Knot& k : knots) {
      const Truth truth(heart, k.p);
      if (truth.share <= 0.8) continue;
      const double angle = std::acos(std::min(1.0, std::fabs(dot(k.t, truth.axis)))) * 180 / std::numbers::pi;
      out.worst_angle = std::max(out.worst_angle, angle);
      crossed = crossed || angle > 45;
    }
    out.crossed += crossed;
  }
  std::nth_element(lengths.begin(), lengths.begin() + lengths.size() / 2, lengths.end());
  out.median_length = lengths[lengths.size() / 2];
  return out;
}

TEST(LineFieldSignInvariance, NoLineCrossesToOtherFibres) {
  const Heart ideal = make_heart({}), seamed = make_heart({0, false, true});
  const std::vector<Vec3> seeds = seeds_in(ideal, kLines);
  const std::vector<Vec3> some(seeds.begin(), seeds.begin() + static_cast<std::ptrdiff_t>(kLines / 5));
  const Lines clean = trace_all(ideal, some), whole = trace_all(make_heart({10, true, false}), some),
              clean_seams = trace_all(seamed, seeds), seams = trace_all(make_heart({10, true, true}), seeds);
  for (const auto& [name, lines] :
       {std::pair{"ideal", &clean}, {"flips, 10 degrees", &whole}, {"seams", &clean_seams}, {"flips, 10 degrees, seams", &seams}}) {
    std::printf("%-28s median length %.3f, worst angle %.1f, crossed %d; ends:", name, lines->median_length, lines->worst_angle,
                lines->crossed);
    for (const auto& [word, count] : lines->ends) std::printf(" %s %d", word.c_str(), count);
    std::printf("\n");
  }
  for (const Lines* lines : {&whole, &seams}) {
    EXPECT_EQ(lines->crossed, 0);
    EXPECT_LE(lines->worst_angle, 45);
    EXPECT_EQ(lines->ends.count("CRITICAL"), 0u) << "|v| = 1 everywhere";
    EXPECT_LE(lines->ends.count("none") ? lines->ends.at("none") : 0, 10);
  }
  EXPECT_GE(whole.median_length, 0.9 * clean.median_length);
  EXPECT_GE(seams.median_length, 0.9 * clean_seams.median_length);
  EXPECT_GT(seams.ends.at("INCOHERENT"), static_cast<int>(kLines) / 2);
}

/// A hand follows a selected line; the online link starts from the same seed.
TEST(LineFieldSignInvariance, OnlineAndSelectedAgree) {
  const Heart heart = make_heart({10, true, true});
  const double length = heart.grid->domain_length();
  double worst = 0;
  int ticks = 0, critical = 0, compared = 0, held = 0;
  for (const Vec3& seed : seeds_in(heart, 40)) {
    const auto curve = flow::trace({heart.grid.get(), true, 0}, seed);
    if (!curve) continue;
    const std::string line = R"(, "kind": "line")";
    Rig selected(streamline(heart.grid, seed, line)), online(streamline(heart.grid, seed, line + R"(, "follow": "online")"));
    for (const double way : {1.0, -1.0}) {
      const double end = way > 0 ? (*curve)->knots().back().s : (*curve)->knots().front().s;
      for (double s = 0; s < std::fabs(end) - 0.01 * length && s < 2 * length; s += 5e-4 * length, ++ticks) {
        const Vec3 probe = (*curve)->position(way * s);
        selected.tick(probe);
        online.tick(probe);
        critical += online.state.status == LinkStatus::critical;
        worst = std::max(worst, norm(selected.state.proxy - online.state.proxy));
        ++compared;
      }
      // beyond the end both hold with the same status
      const flow::LineEnd& how = way > 0 ? (*curve)->last_end() : (*curve)->first_end();
      if (std::fabs(end) < 2 * length && how.termination != flow::Termination::length && how.termination != flow::Termination::lap) {
        const flow::Knot& last = way > 0 ? (*curve)->knots().back() : (*curve)->knots().front();
        for (int k = 0; k < 60; ++k)
          selected.tick(last.p + 0.03 * way * length * last.t), online.tick(last.p + 0.03 * way * length * last.t);
        const LinkStatus expected = how.termination == flow::Termination::boundary ? LinkStatus::boundary : LinkStatus::critical;
        EXPECT_EQ(selected.state.status, expected);
        EXPECT_EQ(selected.state.reason, how.status);
        EXPECT_EQ(online.state.status, expected) << flow::to_string(how.termination);
        EXPECT_EQ(online.state.reason, how.status) << to_string(how.status) << " " << to_string(online.state.reason);
        EXPECT_NE(how.status, SampleStatus::zero) << "|v| = 1 everywhere";
        EXPECT_LE(norm(online.state.proxy - selected.state.proxy), 1e-6 * length);
        ++held;
      }
      // both continue on the way back to the seed
      for (int i = 20; i >= 0; --i) {
        const Vec3 probe = (*curve)->position(way * (std::fabs(end) * i / 20));
        for (int k = 0; k < 40; ++k) selected.tick(probe), online.tick(probe);
      }
      EXPECT_EQ(online.state.status, LinkStatus::ok);
    }
  }
  std::printf("%d ticks, %d critical\n", ticks, critical);
  EXPECT_GT(compared, 10000);
  EXPECT_GT(held, 40);
  expect_at_most("online against selected, of L", worst / length, 1e-6);
  EXPECT_EQ(critical, 0);
}

}  // namespace catena::acceptance::line_field_test
