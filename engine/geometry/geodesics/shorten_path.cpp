// SPDX-License-Identifier: MIT
#include "engine/geometry/geodesics/geodesics.h"

#include <numbers>

#include "engine/base/result.h"

namespace catena::geodesics {
namespace {

constexpr int kMaxSweeps = 400;
constexpr double kStill = 1e-6;   ///< convergence: maximum motion, as a fraction of a segment
constexpr double kLonger = 1.01;  ///< growth of the length at which a sweep counts as diverging

/// Returns the path resampled into `segments` segments of equal length.
std::vector<Vec3> resampled(const std::vector<Vec3>& path, int segments) {
  const double total_length = path_length(path);
  std::vector<Vec3> out{path.front()};
  std::size_t k = 1;
  double length_before = 0;  // length up to path[k - 1]
  for (int i = 1; i < segments; ++i) {
    const double at = total_length * i / segments;
    while (k + 1 < path.size() && length_before + norm(path[k] - path[k - 1]) < at) {
      length_before += norm(path[k] - path[k - 1]);
      ++k;
    }
    const double piece = norm(path[k] - path[k - 1]), fraction = piece > 0 ? std::clamp((at - length_before) / piece, 0.0, 1.0) : 0.0;
    out.push_back(path[k - 1] + fraction * (path[k] - path[k - 1]));
  }
  out.push_back(path.back());
  return out;
}

/// Relaxes all inner points; returns the largest distance that a point moved.
double sweep(std::vector<Vec3>& path, double factor, const ProjectToSurface& put_on_surface) {
  double max_motion = 0;
  for (std::size_t i = 1; i + 1 < path.size(); ++i) {
    Vec3 p = path[i] + factor * (0.5 * (path[i - 1] + path[i + 1]) - path[i]);
    if (!put_on_surface(p)) continue;
    max_motion = std::max(max_motion, norm(p - path[i]));
    path[i] = p;
  }
  return max_motion;
}

void relax(std::vector<Vec3>& path, const ProjectToSurface& put_on_surface) {
  const auto segments = static_cast<double>(path.size() - 1);
  double factor = 2 / (1 + std::sin(std::numbers::pi / segments));  // optimal over-relaxation for a straight string
  double length = path_length(path);
  std::vector<Vec3> best = path;
  double shortest = length;
  for (int i = 0; i < kMaxSweeps; ++i) {
    const double max_motion = sweep(path, factor, put_on_surface);
    length = path_length(path);
    if (length < shortest) {
      shortest = length;
      best = path;
    } else if (length > kLonger * shortest) {
      path = best;
      factor = 1 + 0.5 * (factor - 1);
    }
    if (!(max_motion > kStill * length / segments)) break;
  }
}

}  // namespace

double path_length(const std::vector<Vec3>& path) {
  double length = 0;
  for (std::size_t i = 1; i < path.size(); ++i) length += norm(path[i] - path[i - 1]);
  return length;
}

std::vector<Vec3> shorten_path(std::vector<Vec3> path, const ProjectToSurface& put_on_surface) {
  CATENA_ASSERT(path.size() >= 2);
  for (const int segments : {32, 64, 128}) {
    path = resampled(path, segments);
    for (std::size_t i = 1; i + 1 < path.size(); ++i)
      if (Vec3 p = path[i]; put_on_surface(p)) path[i] = p;
    relax(path, put_on_surface);
  }
  return path;
}

}  // namespace catena::geodesics
