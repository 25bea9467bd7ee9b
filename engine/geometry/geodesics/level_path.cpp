// SPDX-License-Identifier: MIT
#include "engine/geometry/geodesics/geodesics.h"

#include <array>
#include <limits>
#include <queue>
#include <utility>

namespace catena::geodesics {
namespace {

constexpr int kMaxCells = 64;      // per axis
constexpr int kSteps = 32;         // maximum number of Newton steps to the level
constexpr double kOnLevel = 1e-7;  // tolerance, as a fraction of L

/// Moves p to the level by Newton's method along the gradient, with steps of at most `max_step`; returns false if it does not converge.
bool reach_level(const field::ScalarField& field, double level, double max_step, field::Cursor& cursor, Vec3& p) {
  Vec3 x = p;
  for (int i = 0; i < kSteps; ++i) {
    const field::ScalarSample s = field.sample(x, cursor);
    const double slope2 = dot(s.gradient, s.gradient), deviation = s.value - level;
    if (!s.inside || !(slope2 > 0) || !std::isfinite(deviation) || !std::isfinite(slope2)) return false;
    if (std::fabs(deviation) <= kOnLevel * field.domain_length() * std::sqrt(slope2)) {
      p = x;
      return true;
    }
    Vec3 step = s.gradient * (-deviation / slope2);
    if (const double length = norm(step); length > max_step) step *= max_step / length;
    x += step;
  }
  return false;
}

using Cell = std::array<int, 3>;

/// Grid of cells over the domain; corner values are sampled on demand.
class Lattice {
 public:
  Lattice(const field::ScalarField& field, double level) : field_(field), level_(level) {
    const field::Box& box = field.index_box();
    const double finest = std::max(field.is_grid() ? field.max_voxel_edge() : 0.0, field.domain_length() / kMaxCells);
    for (int a = 0; a < 3; ++a) {
      const double edge = norm(field.mapping().world_from_index_linear[a]) * (box.hi[a] - box.lo[a]);
      cells_[static_cast<std::size_t>(a)] = std::clamp(static_cast<int>(std::ceil(edge / finest)), 1, kMaxCells);
      step_[a] = (box.hi[a] - box.lo[a]) / cells_[static_cast<std::size_t>(a)];
    }
    values_.assign(index_of_corner({cells_[0], cells_[1], cells_[2]}) + 1, kUnknown);
  }
  std::size_t count() const {
    return static_cast<std::size_t>(cells_[0]) * static_cast<std::size_t>(cells_[1]) * static_cast<std::size_t>(cells_[2]);
  }
  std::size_t index_of(const Cell& c) const {
    return (static_cast<std::size_t>(c[2]) * static_cast<std::size_t>(cells_[1]) + static_cast<std::size_t>(c[1])) *
               static_cast<std::size_t>(cells_[0]) +
           static_cast<std::size_t>(c[0]);
  }
  Cell cell_of(std::size_t index) const {
    const auto nx = static_cast<std::size_t>(cells_[0]), ny = static_cast<std::size_t>(cells_[1]);
    return {static_cast<int>(index % nx), static_cast<int>(index / nx % ny), static_cast<int>(index / nx / ny)};
  }
  bool contains(const Cell& c) const {
    for (std::size_t a = 0; a < 3; ++a)
      if (c[a] < 0 || c[a] >= cells_[a]) return false;
    return true;
  }
  Cell cell_at(const Vec3& world) const {
    const Vec3 i = field_.mapping().index_from_world(world) - field_.index_box().lo;
    Cell c{};
    for (int a = 0; a < 3; ++a)
      c[static_cast<std::size_t>(a)] =
          std::clamp(static_cast<int>(std::floor(i[a] / step_[a])), 0, cells_[static_cast<std::size_t>(a)] - 1);
    return c;
  }
  Vec3 middle(const Cell& c) const { return world_at(Vec3(c[0] + 0.5, c[1] + 0.5, c[2] + 0.5)); }
  bool is_crossed(const Cell& c) {
    double lo = std::numeric_limits<double>::infinity(), hi = -lo;
    for (int k = 0; k < 8; ++k) {
      const double v = corner({c[0] + (k & 1), c[1] + (k >> 1 & 1), c[2] + (k >> 2)});
      if (std::isnan(v)) return false;
      lo = std::min(lo, v);
      hi = std::max(hi, v);
    }
    return lo <= level_ && level_ <= hi;
  }

 private:
  static constexpr double kUnknown = std::numeric_limits<double>::infinity();
  Vec3 world_at(const Vec3& cells) const { return field_.mapping().world_from_index(field_.index_box().lo + cells * step_); }
  std::size_t index_of_corner(const Cell& c) const {
    return (static_cast<std::size_t>(c[2]) * static_cast<std::size_t>(cells_[1] + 1) + static_cast<std::size_t>(c[1])) *
               static_cast<std::size_t>(cells_[0] + 1) +
           static_cast<std::size_t>(c[0]);
  }
  /// Returns the value at a corner; NaN where the field has no value.
  double corner(const Cell& c) {
    double& value = values_[index_of_corner(c)];
    if (value != kUnknown) return value;
    // a corner on a face of the domain must not be outside by rounding
    Vec3 at(c[0], c[1], c[2]);
    for (int a = 0; a < 3; ++a) at[a] = std::clamp(at[a], 1e-9, cells_[static_cast<std::size_t>(a)] - 1e-9);
    const field::ScalarSample s = field_.sample(world_at(at), cursor_);
    return value = s.inside && std::isfinite(s.value) ? s.value : std::numeric_limits<double>::quiet_NaN();
  }

  const field::ScalarField& field_;
  double level_;
  Cell cells_{};
  Vec3 step_{1.0};
  std::vector<double> values_;
  field::Cursor cursor_;
};

/// Calls visit for the cell and its 26 neighbors within the domain.
template <class Visit>
void each_around(const Lattice& lattice, const Cell& c, Visit&& visit) {
  for (int z = -1; z <= 1; ++z)
    for (int y = -1; y <= 1; ++y)
      for (int x = -1; x <= 1; ++x)
        if (const Cell n{c[0] + x, c[1] + y, c[2] + z}; lattice.contains(n)) visit(n);
}

/// Dijkstra's algorithm on the cells that the surface crosses, with one surface point each; returns the path without its ends.
std::vector<Vec3> coarse_path(const field::ScalarField& field, double level, const Vec3& from, const Vec3& to, bool& connected) {
  Lattice lattice(field, level);
  const double longest = field.domain_length() / kMaxCells;
  struct Visited {
    double distance = std::numeric_limits<double>::infinity();
    Vec3 place{0.0};
    std::size_t before = 0;
    bool known = false, crossed = false, done = false;
  };
  std::vector<Visited> all(lattice.count());
  field::Cursor cursor;
  const auto visit_cell = [&](const Cell& c) -> Visited& {
    Visited& v = all[lattice.index_of(c)];
    if (v.known) return v;
    v.known = true;
    v.crossed = lattice.is_crossed(c);
    if (!v.crossed) return v;
    v.place = lattice.middle(c);
    Vec3 p = v.place;
    if (reach_level(field, level, longest, cursor, p) && norm(p - v.place) < 2 * longest) v.place = p;
    return v;
  };
  using Entry = std::pair<double, std::size_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
  each_around(lattice, lattice.cell_at(from), [&](const Cell& c) {
    Visited& v = visit_cell(c);
    if (!v.crossed) return;
    v.distance = norm(v.place - from);
    v.before = none;
    queue.push({v.distance, lattice.index_of(c)});
  });
  std::vector<bool> is_goal(all.size());
  each_around(lattice, lattice.cell_at(to), [&](const Cell& c) { is_goal[lattice.index_of(c)] = true; });
  double best = std::numeric_limits<double>::infinity();
  std::size_t last = none;
  while (!queue.empty() && queue.top().first < best) {
    const auto [distance, index] = queue.top();
    queue.pop();
    Visited& current = all[index];
    if (current.done) continue;
    current.done = true;
    if (is_goal[index] && distance + norm(to - current.place) < best) {
      best = distance + norm(to - current.place);
      last = index;
    }
    each_around(lattice, lattice.cell_of(index), [&](const Cell& c) {
      Visited& next = visit_cell(c);
      if (!next.crossed || next.done) return;
      const double new_distance = distance + norm(next.place - current.place);
      if (!(new_distance < next.distance)) return;
      next.distance = new_distance;
      next.before = index;
      queue.push({new_distance, lattice.index_of(c)});
    });
  }
  connected = last != none;
  std::vector<Vec3> path;
  for (std::size_t i = last; i != none; i = all[i].before) path.push_back(all[i].place);
  return {path.rbegin(), path.rend()};
}

}  // namespace

std::vector<Vec3> path_on_level(const field::ScalarField& field, double level, const Vec3& from, const Vec3& to) {
  if (!is_finite(from) || !is_finite(to)) return {};
  field::Cursor cursor;
  const double longest = field.domain_length() / kMaxCells;
  Vec3 first = from, last = to;
  if (!reach_level(field, level, longest, cursor, first) || !reach_level(field, level, longest, cursor, last)) return {};
  bool connected = false;
  std::vector<Vec3> path = coarse_path(field, level, first, last, connected);
  if (!connected) return {};
  path.insert(path.begin(), first);
  path.push_back(last);
  return shorten_path(std::move(path), [&](Vec3& p) { return reach_level(field, level, longest, cursor, p); });
}

}  // namespace catena::geodesics
