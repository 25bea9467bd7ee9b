// SPDX-License-Identifier: MIT
/// Error of the light that arrives (render/light), against an integration of the field itself, at random points.
///   light_error FILE LO HI SIGMA [GRID]      a volume whose extinction rises from 0 at LO to SIGMA per voxel edge at HI
/// One line per quantity: root mean square and 99th percentile of the difference, weighted by the light that a point scatters towards an
/// eye far away (extinction times transmittance). Reference: steps of a third of a voxel, 600 directions, the stated decay with distance.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "engine/base/threads.h"
#include "engine/field/field.h"
#include "engine/io/volume/load_field.h"
#include "render/light/light_sweep.h"

namespace {

using namespace catena;
using namespace catena::render;

struct Medium {
  std::shared_ptr<const field::ScalarGrid> grid;
  double lo, hi, sigma, step;

  double extinction(const Vec3& world, field::Cursor& cursor) const {
    const field::ScalarSample sample = grid->sample(world, cursor);
    return sample.inside ? sigma * std::clamp((sample.value - lo) / (hi - lo), 0.0, 1.0) : 0;
  }
  /// Returns the light that arrives at a point from a direction: 1 - integral of extinction * transmittance * exp(-s / reach).
  double arriving(const Vec3& from, const Vec3& direction, double reach, field::Cursor& cursor) const {
    const double end = norm(grid->world_bounds().hi - grid->world_bounds().lo);
    double depth = 0, lost = 0;
    for (double s = 0.5 * step; s < end && depth < 12; s += step) {
      const double more = step * extinction(from + s * direction, cursor);
      lost += std::exp(-depth) * -std::expm1(-more) * std::exp(-s / reach);
      depth += more;
    }
    return 1 - lost;
  }
};

float lookup(const LightCells& cells, const std::vector<float>& shares, const Vec3& world) {
  const Vec3 at = (world - cells.lo) / cells.edge - Vec3(0.5);
  const int n[3] = {cells.size.x, cells.size.y, cells.size.z};
  int base[3];
  double f[3];
  for (int a = 0; a < 3; ++a) {
    base[a] = std::clamp(int(std::floor(at[a])), 0, n[a] - 2);
    f[a] = std::clamp(at[a] - base[a], 0.0, 1.0);
  }
  double sum = 0;
  for (int c = 0; c < 8; ++c) {
    double weight = 1;
    for (int a = 0; a < 3; ++a) weight *= (c >> a & 1) != 0 ? f[a] : 1 - f[a];
    sum += weight * double(shares[cells.index(base[0] + (c & 1), base[1] + (c >> 1 & 1), base[2] + (c >> 2))]);
  }
  return float(sum);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 5) {
    fmt::print(stderr, "usage: light_error FILE LO HI SIGMA [GRID]\n");
    return 2;
  }
  field::LoadRequest request;
  request.path = argv[1];
  if (argc > 5) request.grid = argv[5];
  const auto loaded = field::load(request);
  if (!loaded || !loaded->scalar || loaded->scalar->grid() == nullptr) {
    fmt::print(stderr, "{}\n", loaded ? "no scalar grid" : loaded.error().message);
    return 2;
  }
  Medium medium;
  medium.grid = std::static_pointer_cast<const field::ScalarGrid>(loaded->scalar);
  const double voxel = medium.grid->mapping().min_voxel_edge();
  medium.lo = std::atof(argv[2]), medium.hi = std::atof(argv[3]), medium.sigma = std::atof(argv[4]) / voxel, medium.step = voxel / 3;

  FramePacket packet;
  VolumeItem item;
  item.grid = medium.grid;
  item.transfer.extinctions = {{medium.lo, 0}, {medium.hi, medium.sigma}};
  packet.volumes = {item};
  packet.illumination.bounds = medium.grid->world_bounds();
  const Bounds bounds = packet.illumination.bounds;
  const double reach = 0.1 * bounds.diagonal(), infinite = std::numeric_limits<double>::infinity();
  const LightCells cells = make_light_cells(packet);
  const Vec3 light = direction(Vec3(1, -0.7, 1)), eye = direction(Vec3(0.4, -1, 0.5));
  const std::vector<float> shadow = sweep_light(cells, light), open = sweep_environment(cells, reach)[0];

  constexpr std::size_t kPoints = 1500;
  constexpr int kDirections = 600;
  struct Point {
    double weight, shadow, open;
  };
  std::vector<Point> points(kPoints);
  parallel_for(kPoints, 8, [&](std::size_t begin, std::size_t end) {
    field::Cursor cursor;
    for (std::size_t i = begin; i < end; ++i) {
      std::mt19937_64 random(i);
      std::uniform_real_distribution<double> share(0, 1);
      Vec3 p;
      double weight = 0;
      for (int tries = 0; tries < 400 && weight < 0.01 * medium.sigma; ++tries) {  // what is seen
        for (int a = 0; a < 3; ++a) p[a] = bounds.lo[a] + share(random) * (bounds.hi[a] - bounds.lo[a]);
        weight = medium.extinction(p, cursor);
        if (weight > 0) weight *= medium.arriving(p, eye, infinite, cursor);
      }
      double sum = 0;
      for (int d = 0; d < kDirections; ++d) {
        const double z = 1 - (2 * d + 1.0) / kDirections, angle = 2.399963229728653 * d, r = std::sqrt(1 - z * z);
        sum += medium.arriving(p, {r * std::cos(angle), r * std::sin(angle), z}, reach, cursor) / kDirections;
      }
      points[i] = {weight, double(lookup(cells, shadow, p)) - medium.arriving(p, light, infinite, cursor),
                   double(lookup(cells, open, p)) - sum};
    }
  });
  const auto report = [&](const char* name, double Point::*difference) {
    double all = 0, squares = 0, mean = 0;
    std::vector<double> sizes;
    for (const Point& point : points) {
      all += point.weight;
      squares += point.weight * point.*difference * (point.*difference);
      mean += point.weight * point.*difference;
      if (point.weight > 0) sizes.push_back(std::fabs(point.*difference));
    }
    std::ranges::sort(sizes);
    fmt::print("{}: rms {:.4f}, mean {:+.4f}, p99 {:.4f}, points {}\n", name, std::sqrt(squares / all), mean / all,
               sizes[std::size_t(0.99 * double(sizes.size() - 1))], sizes.size());
  };
  report("light", &Point::shadow);
  report("environment", &Point::open);
  return 0;
}
