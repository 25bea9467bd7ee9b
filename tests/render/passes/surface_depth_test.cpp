// SPDX-License-Identifier: MIT
// Depth of every pixel of an opaque isosurface against an independent intersection in double precision: the ray is split at all cell
// faces, the cubic of a cell is fitted through four samples of the trilinear interpolant, and its first root is bisected between its
// extrema.
#include <algorithm>
#include <cmath>
#include <random>

#include "render/frame/camera.h"
#include "tests/render/support/image_fixture.h"

namespace catena::test::surface_depth_test {

using namespace catena::render;

/// Values and valid cells of a grid, read once.
struct Voxels {
  field::Index3 n;
  std::vector<float> values;
  std::vector<std::uint8_t> valid;

  explicit Voxels(const field::ScalarGrid& grid) {
    const Vec3 hi = grid.index_box().hi;
    n = {int(hi.x) + 1, int(hi.y) + 1, int(hi.z) + 1};
    values.resize(std::size_t(n.x) * n.y * n.z);
    valid.resize(values.size());
    grid.read_block({0, 0, 0}, n, values);
    grid.read_cell_validity({0, 0, 0}, n, valid);
  }
  std::size_t at(int x, int y, int z) const { return (std::size_t(z) * n.y + y) * n.x + x; }
  double value(const field::Index3& cell, const Vec3& p) const {
    double sum = 0;
    for (int c = 0; c < 8; ++c) {
      const int i = c & 1, j = c >> 1 & 1, k = c >> 2;
      const Vec3 f = p - Vec3(cell.x, cell.y, cell.z);
      sum += (i ? f.x : 1 - f.x) * (j ? f.y : 1 - f.y) * (k ? f.z : 1 - f.z) * values[at(cell.x + i, cell.y + j, cell.z + k)];
    }
    return sum;
  }
};

/// A crossing of the level along a ray: its depth, and the maximum deviation from the level behind it.
struct Crossing {
  double t = HUGE_VAL;
  double swing = 0;
};

class Truth {
 public:
  Truth(const field::ScalarGrid& grid, double level) : voxels_(grid), level_(level) {}

  /// All crossings of o + t d (index space) for t in [from, to], in order.
  std::vector<Crossing> crossings(const Vec3& o, const Vec3& d, double from, double to) const {
    std::vector<double> cuts{from, to};
    for (int axis = 0; axis < 3; ++axis) {
      const int last = (axis == 0 ? voxels_.n.x : axis == 1 ? voxels_.n.y : voxels_.n.z) - 1;
      for (int plane = 0; plane <= last; ++plane) {
        const double t = (plane - o[axis]) / d[axis];
        if (t > from && t < to) cuts.push_back(t);
      }
    }
    std::sort(cuts.begin(), cuts.end());
    std::vector<Crossing> found;
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i)
      if (cuts[i + 1] > cuts[i]) in_cell(o, d, cuts[i], cuts[i + 1], found);
    return found;
  }

  double value(const Vec3& p) const { return voxels_.value(cell_at(p), p) - level_; }

 private:
  field::Index3 cell_at(const Vec3& p) const {
    const auto base = [](double v, int n) { return std::clamp(int(std::floor(v)), 0, n - 2); };
    return {base(p.x, voxels_.n.x), base(p.y, voxels_.n.y), base(p.z, voxels_.n.z)};
  }

  void in_cell(const Vec3& o, const Vec3& d, double from, double to, std::vector<Crossing>& found) const {
    const field::Index3 cell = cell_at(o + 0.5 * (from + to) * d);
    if (!voxels_.valid[voxels_.at(cell.x, cell.y, cell.z)]) return;
    const auto f = [&](double u) { return voxels_.value(cell, o + (from + u * (to - from)) * d) - level_; };
    // a + b u + c u^2 + e u^3 through u = 0, 1/3, 2/3, 1
    const double y0 = f(0), y1 = f(1.0 / 3), y2 = f(2.0 / 3), y3 = f(1);
    const double b = (-11 * y0 + 18 * y1 - 9 * y2 + 2 * y3) / 2, c = (18 * y0 - 45 * y1 + 36 * y2 - 9 * y3) / 2;
    const double e = (-9 * y0 + 27 * y1 - 27 * y2 + 9 * y3) / 2;
    std::vector<double> ends{0, 1};
    const double disc = c * c - 3 * e * b;
    if (disc > 0)
      for (const double sign : {-1.0, 1.0}) {
        const double u = std::fabs(e) > 1e-14 ? (-c + sign * std::sqrt(disc)) / (3 * e) : -b / (2 * c);
        if (u > 0 && u < 1) ends.push_back(u);
      }
    std::sort(ends.begin(), ends.end());
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
      double lo = ends[i], hi = ends[i + 1];
      const double flo = f(lo), fhi = f(hi);
      if (!found.empty()) found.back().swing = std::max({found.back().swing, std::fabs(flo), std::fabs(fhi)});
      if ((flo >= 0) == (fhi >= 0)) continue;
      for (int k = 0; k < 60; ++k) {
        const double mid = 0.5 * (lo + hi);
        ((f(mid) >= 0) == (flo >= 0) ? lo : hi) = mid;
      }
      found.push_back({from + 0.5 * (lo + hi) * (to - from), std::fabs(fhi)});
    }
  }

  Voxels voxels_;
  double level_;
};

class SurfaceDepth : public ImageTest {
 protected:
  /// Draws and compares every pixel. For grazing rays (within 1e-5 of the value range from the level) both results are accepted; their
  /// number is limited.
  void compare(const FramePacket& packet, const RenderSettings& settings, const std::string& name, int min_hits) {
    const field::ScalarGrid& grid = *packet.isosurfaces[0].grid;
    const double level = packet.isosurfaces[0].level, tolerance = 1e-5 * (grid.max_value() - grid.min_value());
    draw(packet, settings, name);
    const std::vector<float> depth = depths();
    const Camera camera = make_camera(packet.view, packet.width, packet.height, Bounds{});
    const Truth truth(grid, float(level));
    int hits = 0, grazing = 0, wrong = 0;
    double worst = 0;
    for (const auto& [x, y] : pixels_of(packet)) {
      const Ray ray = pixel_ray(camera, x + 0.5, y + 0.5);
      const Vec3 forward = -camera.back;
      const double per_depth = 1 / dot(ray.direction, forward);
      // index position by view depth
      const Vec3 d = grid.mapping().index_from_world_linear * (per_depth * ray.direction);
      const Vec3 o = grid.mapping().index_from_world(ray.origin) - dot(ray.origin - camera.position, forward) * d;
      double from = 0, to = HUGE_VAL;
      for (int axis = 0; axis < 3; ++axis) {
        const double s = (grid.index_box().lo[axis] - o[axis]) / d[axis], t = (grid.index_box().hi[axis] - o[axis]) / d[axis];
        from = std::max(from, std::min(s, t));
        to = std::min(to, std::max(s, t));
      }
      const double found = depth[y * packet.width + x];
      std::vector<Crossing> all;
      if (from < to) all = truth.crossings(o, d, from, to);
      const double expected = all.empty() ? HUGE_VAL : all[0].t;
      if (!std::isfinite(found) && !std::isfinite(expected)) continue;
      const double off = std::isfinite(found) && std::isfinite(expected) ? std::fabs(found - expected) * norm(d) : HUGE_VAL;
      if (off <= 1e-3) {
        ++hits;
        worst = std::max(worst, off);
        continue;
      }
      // a tangential touch of the level was found or missed
      const bool touches =
          found < expected ? std::fabs(truth.value(o + found * d)) <= tolerance : found > expected && all[0].swing <= tolerance;
      // or the ray leaves the domain next to the crossing
      const double end = std::min(std::fabs(found - from), std::fabs(found - to)),
                   other = std::min(std::fabs(expected - from), std::fabs(expected - to));
      if (touches || std::min(end, other) * norm(d) <= 1e-4)
        ++grazing;
      else {
        ++wrong;
        if (wrong <= 5) ADD_FAILURE() << name << ": pixel " << x << " " << y << " found " << found << " expected " << expected;
      }
    }
    EXPECT_GT(hits, min_hits) << name;
    EXPECT_EQ(wrong, 0) << name;
    EXPECT_LE(grazing, 10) << name;
    RecordProperty("worst_voxels_" + name, std::to_string(worst));
    std::printf("  %-28s hits %6d  grazing %2d  worst %.2e voxel\n", name.c_str(), hits, grazing, worst);
  }
};

GridPtr random_grid(const field::Index3& n, unsigned seed, double smooth, const field::Mapping& mapping = {}, double masked = 0) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  const Vec3 phase(6 * uniform(random), 6 * uniform(random), 6 * uniform(random));
  std::function<bool(const Vec3&)> valid;
  if (masked > 0) valid = [&random, uniform, masked](const Vec3&) mutable { return uniform(random) >= masked; };
  return make_grid(
      n,
      [&](const Vec3& p) {
        const double wave = std::sin(0.4 * p.x + phase.x) * std::sin(0.5 * p.y + phase.y) * std::sin(0.45 * p.z + phase.z + 0.1 * p.x);
        return smooth * (0.5 + 0.5 * wave) + (1 - smooth) * uniform(random);
      },
      mapping, valid);
}

FramePacket packet_of_surface(GridPtr grid, double level, const Vec3& towards_eye, double distance, double fovy_deg = 30) {
  const Vec3 centre = grid->mapping().world_from_index(0.5 * (grid->index_box().lo + grid->index_box().hi));
  FramePacket packet = make_packet(centre + distance * direction(towards_eye), centre, fovy_deg);
  packet.isosurfaces = {{std::move(grid), level, {0.8f, 0.8f, 0.9f}}};
  return packet;
}

TEST_F(SurfaceDepth, DepthOfWhiteNoise) {
  const auto grid = random_grid({64, 64, 64}, 1, 0);
  compare(packet_of_surface(grid, 0.5, {1, -0.7, 0.6}, 190), {}, "dense", 8000);
  compare(packet_of_surface(grid, 0.97, {-0.3, -1, 0.4}, 190), {}, "sparse level", 100);
  RenderSettings atlas{.layout = GridLayout::atlas, .fast = {}};
  compare(packet_of_surface(grid, 0.9, {1, 0.8, -0.5}, 190), atlas, "atlas", 2000);
}

TEST_F(SurfaceDepth, DepthWithoutTheCellMap) {
  const auto grid = random_grid({37, 21, 50}, 6, 0.9);
  for (const GridLayout layout : {GridLayout::dense, GridLayout::atlas}) {
    RenderSettings settings{.skip_empty = false, .fast = {}};
    settings.layout = layout;
    compare(packet_of_surface(grid, 0.85, {-1, -0.7, 0.3}, 110), settings, layout == GridLayout::dense ? "dense" : "atlas", 1000);
  }
}

TEST_F(SurfaceDepth, DepthOfSmoothNoiseOnASmallOddGrid) {
  const auto grid = random_grid({37, 21, 50}, 2, 0.97);
  compare(packet_of_surface(grid, 0.55, {1, -0.7, 0.6}, 110), {}, "smooth", 3000);
  compare(packet_of_surface(grid, 0.5, {0.02, -1, 0.01}, 110), {}, "along an axis", 3000);
  compare(packet_of_surface(grid, 0.5, {0, 1, 0}, 90), {}, "exactly along an axis", 3000);
}

TEST_F(SurfaceDepth, DepthOnRotatedAndShearedGrids) {
  const Mat3 linear = Mat3(0.8, 0.3, 0.1, -0.4, 1.1, 0.2, 0.1, 0.05, 1.7);
  const auto grid = random_grid({40, 32, 28}, 3, 0.8, field::Mapping::from_linear(linear, {-300, 40, 3}));
  compare(packet_of_surface(grid, 0.45, {1, -0.7, 0.6}, 120), {}, "perspective", 4000);
  FramePacket packet = packet_of_surface(grid, 0.45, {-1, -0.4, 0.8}, 120);
  set_orthographic(packet, 50);
  compare(packet, {}, "orthographic", 4000);
}

TEST_F(SurfaceDepth, DepthFromInside) {
  const auto grid = random_grid({64, 64, 64}, 4, 0.95);
  compare(packet_of_surface(grid, 0.5, {1, -0.3, 0.2}, 12, 70), {}, "inside", 15000);
  FramePacket packet = packet_of_surface(grid, 0.5, {1, -0.3, 0.2}, 5);
  set_orthographic(packet, 40);
  compare(packet, {}, "inside, orthographic", 15000);
}

TEST_F(SurfaceDepth, DepthWithMaskedCells) {
  const auto grid = random_grid({48, 40, 44}, 5, 0.9, {}, 0.02);
  for (const GridLayout layout : {GridLayout::dense, GridLayout::atlas}) {
    RenderSettings settings{.layout = layout, .fast = {}};
    compare(packet_of_surface(grid, 0.5, {1, -0.7, 0.6}, 140), settings, layout == GridLayout::dense ? "dense" : "atlas", 4000);
  }
}

TEST_F(SurfaceDepth, DepthOfSeveralSurfacesIsTheNearest) {
  // each surface alone, then together, with one that has no crossing and one behind the camera
  const auto ball = [](const Vec3& at) {
    return make_grid(
        {24, 24, 24}, [](const Vec3& p) { return norm(p - Vec3(11.5)); }, field::Mapping::from_linear(Mat3(1.0), at));
  };
  FramePacket packet = packet_of_surface(ball({0, 0, 0}), 9.3, {1, -0.7, 0.6}, 90, 40);
  std::vector<IsosurfaceItem> items(5, packet.isosurfaces[0]);
  items[1].grid = ball({14, -6, 3});
  items[1].color = {0.9f, 0.5f, 0.1f};
  items[2].grid = ball({-20, 12, 8});
  items[2].level = 4;
  items[3].level = 50;
  items[4].grid = ball(140.0 * direction(Vec3(1, -0.7, 0.6)));
  std::vector<float> nearest(std::size_t(packet.width) * packet.height, HUGE_VALF);
  int seen = 0;
  for (const IsosurfaceItem& item : items) {
    packet.isosurfaces = {item};
    draw(packet);
    const std::vector<float> depth = depths();
    bool any = false;
    for (std::size_t i = 0; i < nearest.size(); ++i) {
      nearest[i] = std::min(nearest[i], depth[i]);
      any = any || std::isfinite(depth[i]);
    }
    seen += any;
  }
  EXPECT_EQ(seen, 3);
  packet.isosurfaces = items;
  draw(packet, {}, "together");
  const std::vector<float> depth = depths();
  int hits = 0;
  for (std::size_t i = 0; i < nearest.size(); ++i) {
    ASSERT_EQ(std::isfinite(depth[i]), std::isfinite(nearest[i])) << i;
    if (!std::isfinite(nearest[i])) continue;
    ++hits;
    ASSERT_NEAR(depth[i], nearest[i], 1e-3) << i;
  }
  EXPECT_GT(hits, 1200);
}

TEST_F(SurfaceDepth, DepthOfASurfaceAroundOneVoxel) {
  // one voxel slightly above the level in a constant field: its surface must not be missed
  const auto grid = make_grid({20, 20, 20}, [](const Vec3& p) { return p.x == 9 && p.y == 10 && p.z == 8 ? 1.0 : 0.0; });
  FramePacket packet = packet_of_surface(grid, 0.9, {1, -0.7, 0.6}, 60, 2.5);
  packet.view.target = {9, 10, 8};
  packet.view.position = packet.view.target + 60.0 * direction(Vec3(1, -0.7, 0.6));
  compare(packet, {}, "tent", 30);
}

}  // namespace catena::test::surface_depth_test
