// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>

#include "engine/base/bounds.h"
#include "engine/base/random.h"
#include "engine/base/threads.h"
#include "engine/scene/uniform_sampling.h"

namespace catena::scene {
namespace {

constexpr double kFineness = 4;       ///< ratio of the spacing to that of the candidates
constexpr double kFinest = 4;         ///< candidates per step^2 of area, on very small triangles
constexpr double kMaxCells = 128;     ///< along each axis of the grid in which a level is searched
constexpr double kCellsByArea = 1.5;  ///< cells intersected by a surface with the area of one cell face, averaged over its directions
constexpr double kPacking = 0.65;     ///< approximate number of samples per spacing^2 of area
constexpr int kNewtonSteps = 8;
constexpr double kRoot = 1e-9;  ///< tolerance of a point on the level, as a fraction of a cell

struct Candidate {
  std::uint64_t order;
  Vec3 p;
};

/// The chosen points, which keep a minimum distance; hashed into cubes with edges of one spacing.
class Chosen {
 public:
  Chosen(const Vec3& origin, double spacing) : origin_(origin), spacing_(spacing) {}

  bool has_room(const Vec3& p) const {
    const Vec3 middle = cube(p);
    for (int n = 0; n < 27; ++n) {
      const auto found = cubes_.find(key(middle + Vec3(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1)));
      if (found == cubes_.end()) continue;
      for (const Vec3& other : found->second)
        if (norm(other - p) < spacing_) return false;
    }
    return true;
  }
  void add(const Vec3& p) { cubes_[key(cube(p))].push_back(p); }

 private:
  Vec3 cube(const Vec3& p) const {
    const Vec3 at = (p - origin_) / spacing_;
    return {std::floor(at.x), std::floor(at.y), std::floor(at.z)};
  }
  static std::uint64_t key(const Vec3& c) {
    const auto part = [](double x) { return static_cast<std::uint64_t>(static_cast<std::int64_t>(x)) & 0x1fffff; };
    return part(c.x) | part(c.y) << 21 | part(c.z) << 42;
  }
  Vec3 origin_;
  double spacing_;
  std::unordered_map<std::uint64_t, std::vector<Vec3>> cubes_;
};

UniformSamples chosen_of(std::vector<Candidate> candidates, double spacing, std::size_t max_count) {
  UniformSamples even;
  if (candidates.empty()) return even;
  std::stable_sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) { return a.order < b.order; });
  Bounds bounds;
  for (const Candidate& candidate : candidates) bounds.extend(candidate.p);
  Chosen chosen(bounds.lo, spacing);
  for (const Candidate& candidate : candidates) {
    if (!chosen.has_room(candidate.p)) continue;
    chosen.add(candidate.p);
    even.positions.push_back(candidate.p);
  }
  even.expected_count = static_cast<double>(even.positions.size());
  if (even.positions.size() > max_count) even.positions.clear();
  return even;
}

/// A sampling grid over the domain with the values at its nodes; finds points of a level in its cells.
class LevelCells {
 public:
  LevelCells(const field::ScalarField& field, double level, double spacing) : field_(field), level_(level), spacing_(spacing) {
    const field::Box& box = field.index_box();
    for (int a = 0; a < 3; ++a) {
      const double extent = box.hi[a] - box.lo[a];
      count_[a] = std::max(1, static_cast<int>(std::min(kMaxCells, field.is_grid() ? std::ceil(extent) : kMaxCells)));
      step_[a] = extent / count_[a];
    }
    values_.resize(nodes(0) * nodes(1) * nodes(2));
    parallel_for(nodes(2), 1, [&](std::size_t begin, std::size_t end) {
      field::Cursor cursor;
      for (std::size_t k = begin; k < end; ++k)
        for (std::size_t j = 0; j < nodes(1); ++j)
          for (std::size_t i = 0; i < nodes(0); ++i)
            values_[index(i, j, k)] = field_.sample(world(Vec3(double(i), double(j), double(k))), cursor).value;
    });
  }

  /// Returns the cells that contain the level.
  std::vector<std::array<int, 3>> holders() const {
    std::vector<std::array<int, 3>> cells;
    for (int k = 0; k < count_[2]; ++k)
      for (int j = 0; j < count_[1]; ++j)
        for (int i = 0; i < count_[0]; ++i)
          if (holds(i, j, k)) cells.push_back({i, j, k});
    return cells;
  }

  /// Returns the approximate area of the level in this number of cells.
  double area(std::size_t cells) const {
    const Vec3 x = edge(0, 1), y = edge(1, 1), z = edge(2, 1);
    const double flat = std::max({norm(cross(x, y)), norm(cross(y, z)), norm(cross(z, x))});
    const double volume = std::fabs(dot(x, cross(y, z))), face = volume > 0 ? std::cbrt(volume * volume) : flat;
    return static_cast<double>(cells) * face / kCellsByArea;
  }

  void add_places(const std::array<int, 3>& cell, std::vector<Candidate>& candidates) {
    const Vec3 at(cell[0], cell[1], cell[2]);
    refine(at + 0.5, Vec3(1.0), mix_bits(mix_bits(mix_bits(std::uint64_t(cell[0])) + std::uint64_t(cell[1])) + std::uint64_t(cell[2])),
           candidates);
  }

 private:
  std::size_t nodes(int a) const { return static_cast<std::size_t>(count_[a]) + 1; }
  std::size_t index(std::size_t i, std::size_t j, std::size_t k) const { return i + nodes(0) * (j + nodes(1) * k); }
  Vec3 world(const Vec3& lattice) const {
    const Vec3 steps(step_[0], step_[1], step_[2]);
    return field_.mapping().world_from_index(field_.index_box().lo + lattice * steps);
  }
  Vec3 edge(int a, double size) const {
    Vec3 e(0.0);
    e[a] = size * step_[a];
    return field_.mapping().world_from_index_linear * e;
  }

  bool holds(int i, int j, int k) const {
    double lo = HUGE_VAL, hi = -HUGE_VAL;
    for (int c = 0; c < 8; ++c) {
      const double value = values_[index(std::size_t(i + (c & 1)), std::size_t(j + (c >> 1 & 1)), std::size_t(k + (c >> 2)))];
      if (!std::isfinite(value)) return false;
      lo = std::min(lo, value);
      hi = std::max(hi, value);
    }
    return lo <= level_ && hi >= level_ && lo < hi;
  }

  /// Halves a cell across its longest edge, recursively, down to spacing / kFineness; parts that are far from the level, judged by the
  /// gradient at their center, are skipped.
  void refine(const Vec3& centre, const Vec3& size, std::uint64_t order, std::vector<Candidate>& candidates) {
    const double lengths[3] = {norm(edge(0, size.x)), norm(edge(1, size.y)), norm(edge(2, size.z))};
    const int longest = static_cast<int>(std::max_element(lengths, lengths + 3) - lengths);
    const double radius = 0.5 * (lengths[0] + lengths[1] + lengths[2]);
    Vec3 middle = world(centre);
    if (lengths[longest] <= spacing_ / kFineness) {
      if (moves_to_level(middle, radius)) candidates.push_back({order, middle});
      return;
    }
    const field::ScalarSample sample = field_.sample(middle, cursor_);
    if (size != Vec3(1.0) && std::fabs(sample.value - level_) > 2 * radius * norm(sample.gradient)) return;
    Vec3 half = size, aside(0.0);
    half[longest] *= 0.5;
    aside[longest] = 0.5 * half[longest];
    refine(centre - aside, half, mix_bits(order), candidates);
    refine(centre + aside, half, mix_bits(order + 1), candidates);
  }

  /// Moves p to the level by Newton steps along the gradient; false if it does not converge within the distance `radius`.
  bool moves_to_level(Vec3& p, double radius) {
    const Vec3 from = p;
    for (int i = 0; i <= kNewtonSteps; ++i) {
      const field::ScalarSample sample = field_.sample(p, cursor_);
      const double slope2 = dot(sample.gradient, sample.gradient), difference = level_ - sample.value;
      if (!(slope2 > 0) || !std::isfinite(slope2) || !std::isfinite(difference)) return false;
      if (std::fabs(difference) <= kRoot * radius * std::sqrt(slope2)) return sample.inside;
      Vec3 step = difference / slope2 * sample.gradient;
      if (const double length = norm(step); length > radius) step *= radius / length;
      p += step;
      if (norm(p - from) > radius) return false;
    }
    return false;
  }

  const field::ScalarField& field_;
  double level_, spacing_;
  int count_[3]{};
  double step_[3]{};
  std::vector<double> values_;
  field::Cursor cursor_;
};

/// Calls visit(p) for points of a triangle in rows along its longest edge, closer together than `step`.
template <class Place>
void each_position(const std::array<Vec3, 3>& corner, double step, Place&& visit) {
  std::size_t longest = 0;
  for (std::size_t k = 1; k < 3; ++k)
    if (norm(corner[(k + 1) % 3] - corner[k]) > norm(corner[(longest + 1) % 3] - corner[longest])) longest = k;
  const Vec3 a = corner[longest], base = corner[(longest + 1) % 3] - a, side = corner[(longest + 2) % 3] - a;
  const double length = norm(base), height = norm(side - dot(side, base) / dot(base, base) * base);
  const double rows = std::max(1.0, std::ceil(height / step));
  for (double j = 0; j < rows; ++j) {
    const double t = (j + 0.5) / rows, columns = std::max(1.0, std::ceil((1 - t) * length / step));
    for (double i = 0; i < columns; ++i) visit(a + t * side + ((1 - t) * (i + 0.5) / columns) * base);
  }
}

}  // namespace

UniformSamples sample_isosurface(const field::ScalarField& field, double level, double spacing, std::size_t max_count) {
  LevelCells cells(field, level, spacing);
  const auto holders = cells.holders();
  const double expected = kPacking * cells.area(holders.size()) / (spacing * spacing);
  // factor 2, because the area is an estimate
  if (!(expected <= 2 * static_cast<double>(max_count) + 1000)) return {{}, expected};
  std::vector<Candidate> candidates;
  candidates.reserve(holders.size());
  for (const auto& cell : holders) cells.add_places(cell, candidates);
  return chosen_of(std::move(candidates), spacing, max_count);
}

UniformSamples sample_mesh(const mesh::TriangleMesh& mesh, double spacing, std::size_t max_count) {
  const double step = spacing / kFineness;
  const auto corners = [&](std::size_t f) {
    const mesh::Triangle& t = mesh.triangles()[f];
    return std::array<Vec3, 3>{mesh.vertices()[t[0]], mesh.vertices()[t[1]], mesh.vertices()[t[2]]};
  };
  // number of candidates: by area and, for slivers, by length
  double expected = 0;
  for (std::size_t f = 0; f < mesh.triangles().size(); ++f) {
    const auto c = corners(f);
    const double longest = std::max({norm(c[1] - c[0]), norm(c[2] - c[1]), norm(c[0] - c[2])});
    const double area = 0.5 * norm(cross(c[1] - c[0], c[2] - c[0])) / (spacing * spacing);
    expected += kPacking * std::max(area, longest > spacing ? longest / spacing / kFineness : 0);
  }
  if (!(expected <= 4 * static_cast<double>(max_count) + 1000)) return {{}, expected};
  std::vector<Candidate> candidates;
  for (std::size_t f = 0; f < mesh.triangles().size(); ++f) {
    const auto c = corners(f);
    // very small triangles contribute candidates in proportion to their area, so that their number does not grow with the mesh
    const double probability = kFinest * 0.5 * norm(cross(c[1] - c[0], c[2] - c[0])) / (step * step);
    if (probability < 1 && static_cast<double>(mix_bits(f)) > probability * 0x1p64) continue;
    std::uint64_t number = 0;
    each_position(c, step, [&](const Vec3& p) { candidates.push_back({mix_bits(mix_bits(f + 1) + number++), p}); });
  }
  return chosen_of(std::move(candidates), spacing, max_count);
}

}  // namespace catena::scene
