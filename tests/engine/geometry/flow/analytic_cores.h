// SPDX-License-Identifier: MIT
/// Flows with known vortex cores, with noise, and a score of traced cores.
#pragma once
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "engine/geometry/flow/vortex_cores.h"
#include "tests/engine/geometry/flow/lambda_field.h"

namespace catena::test {

/// A flow with a known core in the box [-1.2, 1.2]^3.
struct AnalyticCore {
  std::string name;
  std::function<Vec3(const Vec3&)> flow;
  std::function<Vec3(const Vec3&)> nearest_point;  ///< the point of the core that is nearest to a position
  std::vector<Vec3> points;                        ///< points of the core within the box
};

inline double swirl_rate(double r2, double core) { return r2 > 0 ? -std::expm1(-r2 / (core * core)) / r2 * core * core : 1; }

inline std::vector<AnalyticCore> analytic_cores() {
  std::vector<AnalyticCore> all;
  const auto within = [](const Vec3& p) { return max_abs(p) < 1.1; };
  // Vortices without and with a shear flow along the core.
  for (const double shear : {0.0, 1.5}) {
    const Vec3 axis = direction(Vec3(0.3, -0.2, 1)), through(0.11, 0.07, -0.05), side = direction(cross(axis, Vec3(0.4, 1, 0)));
    AnalyticCore burgers{shear == 0 ? "burgers" : "sheared",
                         [=](const Vec3& p) {
                           const Vec3 e = p - through, out = e - axis * dot(axis, e);
                           const Vec3 stream = axis * (shear * (0.5 + dot(side, out)));
                           return stream + 4 * swirl_rate(dot(out, out), 0.3) * cross(axis, out) - 0.3 * out + 0.6 * axis * dot(axis, e);
                         },
                         [=](const Vec3& p) { return through + axis * dot(axis, p - through); },
                         {}};
    for (int i = -200; i <= 200; ++i)
      if (const Vec3 p = through + axis * (0.01 * i); within(p)) burgers.points.push_back(p);
    all.push_back(burgers);
  }
  {
    // An arc in a tilted plane, whose center is outside the box.
    const Vec3 middle(-1.35, 0.06, -1.3), u = direction(Vec3(1, 0.15, 0)), w = direction(cross(u, Vec3(0.1, 1, 0.05))), v = cross(w, u);
    const auto foot = [=](const Vec3& p) {
      const Vec3 e = p - middle;
      return middle + 1.5 * direction(u * dot(u, e) + w * dot(w, e));
    };
    AnalyticCore bent{"bent",
                      [=](const Vec3& p) {
                        const Vec3 core = foot(p), along = cross(v, direction(core - middle)), off = p - core;
                        return 4 * swirl_rate(dot(off, off), 0.3) * cross(along, off) + 0.6 * along;
                      },
                      foot,
                      {}};
    for (int i = 0; i < 1000; ++i)
      if (const Vec3 p = middle + 1.5 * (u * std::cos(0.00628 * i) + w * std::sin(0.00628 * i)); within(p)) bent.points.push_back(p);
    all.push_back(bent);
  }
  {
    const auto hill = analytic_vector("hill");
    AnalyticCore ring{"ring",
                      [=](const Vec3& p) {
                        field::Cursor cursor;
                        return hill->sample(p, cursor).value;
                      },
                      [](const Vec3& p) { return direction(Vec3(p.x, p.y, 0)) * std::sqrt(0.5); },
                      {}};
    for (int i = 0; i < 600; ++i) ring.points.push_back(Vec3(std::cos(0.01047 * i), std::sin(0.01047 * i), 0) * std::sqrt(0.5));
    all.push_back(ring);
  }
  return all;
}

/// Samples the flow with noise: `noise` is the standard deviation at a node, divided by the maximum speed.
inline std::shared_ptr<const field::VectorGrid> sample_core_flow(const AnalyticCore& known, int nodes, double noise, std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  const double voxel = 2.4 / (nodes - 1);
  const field::Mapping mapping = field::Mapping::from_linear(Mat3(voxel), Vec3(-1.2));
  double fastest = 0;
  for (int i = 0; i < 2000; ++i) fastest = std::max(fastest, norm(known.flow(Vec3(i % 13 - 6, i / 13 % 13 - 6, i / 169 - 6) * 0.2)));
  const double amplitude = noise * fastest * std::sqrt(3.0);
  const auto any = [&] { return amplitude * (static_cast<double>(engine() >> 11) * 0x1p-52 - 1); };
  return sample_vector_grid(mapping, {nodes, nodes, nodes}, [&](const Vec3& p) { return known.flow(p) + Vec3(any(), any(), any()); });
}

/// Scores in voxels, except `recall` and `false_length`, which are fractions of length.
struct CoreScore {
  double recall = 0, rms = 0, worst = 0, false_length = 0;
};

inline CoreScore score_cores(const flow::VortexCores& cores, const AnalyticCore& known, double voxel) {
  CoreScore score;
  double found = 0, squares = 0, near = 0, all = 0;
  if (!cores.lines.empty()) {
    const flow::NearestOnCurve nearest(cores.lines);
    for (const Vec3& p : known.points) found += nearest.find_exact(p).distance2 < voxel * voxel;
  }
  score.recall = found / static_cast<double>(known.points.size());
  for (const flow::CurvePtr& line : cores.lines) {
    const double s0 = line->knots().front().s, length = line->period();
    const int pieces = std::max(8, static_cast<int>(8 * length / voxel));
    for (int i = 0; i <= pieces; ++i) {
      const Vec3 p = line->position(s0 + length * i / pieces);
      const double off = norm(p - known.nearest_point(p)) / voxel, part = length / pieces;
      all += part;
      if (off > 2) continue;
      near += part;
      squares += off * off * part;
      score.worst = std::max(score.worst, off);
    }
  }
  score.rms = std::sqrt(squares / std::max(near, 1e-300));
  const double truth = norm(known.points[1] - known.points[0]) * static_cast<double>(known.points.size());
  score.false_length = (all - near) / truth;
  return score;
}

}  // namespace catena::test
