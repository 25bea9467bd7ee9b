// SPDX-License-Identifier: MIT
#include "haptics/constraints/isosurface/cell_walk.h"

#include <bit>
#include <limits>

#include "haptics/constraints/equations.h"
#include "haptics/constraints/isosurface/cell_piece.h"

namespace catena::haptics {
namespace {

constexpr double kStill = 1e-13;     // fraction of L; a shorter move counts as none
constexpr double kAccepted = 1e-6;   // fraction of L; allowed residual where no piece can move further
constexpr double kWalkEnded = 3e-8;  // fraction of L; residual at which a walk has ended
constexpr int kWalkRounds = 600;
constexpr double kFarAway = 2;        // voxels
constexpr int kHalvings = 24;         // bisections to find where a path exceeds its limit
constexpr double kSmoothTurn = 0.95;  // cosine; a larger turn of the normal from step to step means that the surface is not smooth

/// Cell faces through a point: their axes, and the cells on either side.
struct Corner {
  unsigned flat = 0, faces = 0;  // bit masks of axes
  CellPoint at;

  Corner(const field::Box& box, const CellPoint& point) : at(point) {
    for (int a = 0; a < 3; ++a) {
      if (is_flat(box, a))
        flat |= 1u << a;
      else if (at.f[a] == 0 || at.f[a] == 1)
        faces |= 1u << a;
    }
  }
  /// Returns the point relative to one of its cells. Bit a of `upper`: the cell that has the point on its lower face a (f = 0).
  CellPoint seen_from(unsigned upper) const {
    CellPoint out = at;
    std::array<std::int32_t*, 3> base{&out.base.x, &out.base.y, &out.base.z};
    for (int a = 0; a < 3; ++a) {
      if (!(faces >> a & 1u)) continue;
      const bool is_upper = out.f[a] == 0, wanted = (upper >> a & 1u) != 0;
      if (is_upper == wanted) continue;
      *base[static_cast<std::size_t>(a)] += wanted ? 1 : -1;
      out.f[a] = wanted ? 0 : 1;
    }
    return out;
  }
  unsigned upper() const {
    unsigned bits = 0;
    for (int a = 0; a < 3; ++a)
      if ((faces >> a & 1u) && at.f[a] == 0) bits |= 1u << a;
    return bits;
  }
};

/// Visits the empty set first, then each other subset of `mask` in ascending order.
template <class Visit>
void for_subsets(unsigned mask, const Visit& visit) {
  unsigned subset = 0;
  do {
    visit(subset);
    subset = (subset - mask) & mask;
  } while (subset != 0);
}

/// Returns the last point of the path from..to on a piece that stays within `limit` and is no farther from the probe than `from`.
Vec3 cut_short(const LevelSetField& field, const CellPiece& piece, const Vec3& probe, const TravelLimit& limit, const PieceSample& s,
               const Vec3& from, const Vec3& to) {
  const Vec3 chord = field.trilinear_grid()->mapping().world_from_index_linear * (to - from),
             along = equation::tangential_component(chord, s.n);
  const double maximum = norm(probe - piece.world(from));
  Vec3 last_valid = from, g;
  double low = 0, high = 1;
  for (int i = 0; i < kHalvings && !field.exhausted(); ++i) {
    const double mid = 0.5 * (low + high);
    int axis;
    const bool fits = piece.retract(from, along * mid, s, g) && piece.overshoot(g, axis) <= 0 && !limit.is_exceeded_by(piece.world(g)) &&
                      norm(probe - piece.world(g)) <= maximum;
    (fits ? low : high) = mid;
    if (fits) last_valid = g;
  }
  return last_valid;
}

}  // namespace

CellPoint to_cell_point(const field::CellField& grid, const Vec3& world) noexcept {
  const Vec3 index = grid.mapping().index_from_world(world);
  CellPoint out;
  out.base = grid.cell_base(index);
  const Vec3 base(out.base.x, out.base.y, out.base.z);
  for (int a = 0; a < 3; ++a) out.f[a] = is_flat(grid.index_box(), a) ? 0 : std::min(std::max(index[a] - base[a], 0.0), 1.0);
  for (int a = 0; a < 3; ++a) {
    if (out.f[a] < kFaceTolerance) out.f[a] = 0;
    if (out.f[a] > 1 - kFaceTolerance) out.f[a] = 1;
  }
  return out;
}

Vec3 world_position(const field::CellField& grid, const CellPoint& at) noexcept {
  return grid.mapping().world_from_index({at.base.x + at.f.x, at.base.y + at.f.y, at.base.z + at.f.z});
}

PulledBackForce pull_back_cells(LevelSetField& field, const PieceFrames& frames, const Vec3& probe, const CellPoint& at,
                                const Vec3& f) noexcept {
  const field::CellField& grid = *field.trilinear_grid();
  const Corner corner(grid.index_box(), at);
  const unsigned own = corner.upper();
  CellCache cells(field);
  struct {
    double size = std::numeric_limits<double>::infinity();
    bool closest = false;
    int held = 4;
    unsigned axes = 0;
    CellPoint here;
  } best;
  for_subsets(corner.faces, [&](unsigned flip) {
    const CellPoint here = corner.seen_from(own ^ flip);
    const field::ScalarCell* cell = cells.fetch(here.base);
    if (cell == nullptr) return;
    for_subsets(corner.faces, [&](unsigned held) {
      const CellPiece piece(grid.mapping(), *cell, field.level(), frames.by_held_axes[held | corner.flat], field.steps());
      const PieceSample s = piece.sample(here.f);
      const int count = std::popcount(held);
      if (!s.usable) return;
      const double size = norm(piece.tangential_component(here.f, probe, s));
      const bool closest = size <= kWalkEnded * field.length();
      const bool better = closest != best.closest ? closest : closest && count != best.held ? count < best.held : size < best.size;
      if (better) best = {size, closest, count, held, here};
    });
  });
  const field::ScalarCell* cell = best.held < 4 ? cells.fetch(best.here.base) : nullptr;
  if (cell == nullptr) return {};
  const CellPiece piece(grid.mapping(), *cell, field.level(), frames.by_held_axes[best.axes | corner.flat], field.steps());
  return piece.pull_back(best.here.f, probe, f);
}

WalkResult walk_cells(LevelSetField& field, const PieceFrames& frames, const Vec3& probe, CellPoint& at, TravelLimit* limit) noexcept {
  const field::CellField& grid = *field.trilinear_grid();
  const field::Mapping& mapping = grid.mapping();
  const double length = field.length();
  CellCache cells(field);
  WalkResult result;
  std::uint64_t exhausted = 0;
  bool steepest = false;
  SampleStatus wall = SampleStatus::ok;
  double remaining = 0;
  Vec3 last_normal(0.0);
  const auto turn_to = [&](const Vec3& n) {
    if (max_abs(last_normal) > 0 && dot(n, last_normal) < kSmoothTurn) result.smooth = false;
    last_normal = n;
  };

  for (int round = 0; round < kWalkRounds; ++round) {
    // the piece with the steepest feasible descent among all pieces that meet the point
    const Corner corner(grid.index_box(), at);
    const unsigned own = corner.upper();
    struct {
      double size;
      unsigned upper, held;
      const field::ScalarCell* cell;
      PieceSample s;
      Vec3 t;
    } best{kMinDescent * length, 0, 0, nullptr, {}, Vec3(0.0)};
    bool usable = false, pulled = false, found = false;
    remaining = 0;
    for_subsets(corner.faces, [&](unsigned flip) {
      const unsigned upper = own ^ flip;
      const CellPoint here = corner.seen_from(upper);
      const field::ScalarCell* cell = cells.fetch(here.base);
      if (!cell) return;
      found = true;
      for_subsets(corner.faces, [&](unsigned held) {
        const CellPiece piece(mapping, *cell, field.level(), frames.by_held_axes[held | corner.flat], field.steps());
        const PieceSample s = piece.sample(here.f);
        if (!s.usable) return;
        if (!usable || (flip == 0 && held == 0)) {
          result.residual = std::fabs(s.distance);
          result.normal = s.n;
        }
        usable = true;
        const Vec3 t = piece.tangential_component(here.f, probe, s);
        const double size = norm(t);
        if (!(size > kMinDescent * length)) return;
        const Vec3 d = piece.frame().index_step(mapping, t);
        bool feasible = true;
        for (int a = 0; a < 3; ++a) {
          if (!(corner.faces >> a & 1u) || (held >> a & 1u)) continue;
          if (here.f[a] == 0 ? d[a] >= 0 : d[a] <= 0) continue;
          feasible = false;
          // pulled across a face with no cell behind it
          if (held == 0 && size > 1e-7 * length && !cells.fetch(corner.seen_from(upper ^ (1u << a)).base)) {
            pulled = true;
            wall = cells.wall_reason;
          }
        }
        if (!feasible) return;
        remaining = std::max(remaining, size);
        if (size > best.size && !(exhausted >> (upper * 8 + held) & 1u)) best = {size, upper, held, cell, s, t};
      });
    });
    if (cells.out_of_budget() || field.exhausted()) {
      result.status = LinkStatus::budget;
      return result;
    }
    if (!usable) {
      result.status = LinkStatus::critical;
      result.reason = found ? SampleStatus::zero : cells.wall_reason;
      return result;
    }
    turn_to(result.normal);
    if (!best.cell) {
      const bool stuck = remaining > kAccepted * length;
      if (stuck && !steepest) {
        steepest = true;
        exhausted = 0;
        continue;
      }
      result.status = stuck ? LinkStatus::budget : pulled ? LinkStatus::boundary : LinkStatus::ok;
      result.reason = wall;
      return result;
    }

    // follows that piece
    CellPoint next = corner.seen_from(best.upper);
    best.cell = cells.fetch(next.base);  // other fetches of this round may have evicted the cell
    if (!best.cell) {
      result.status = LinkStatus::budget;
      return result;
    }
    const Vec3 before = next.f;
    const PieceSample start = best.s;
    const CellPiece piece(mapping, *best.cell, field.level(), frames.by_held_axes[best.held | corner.flat], field.steps());
    const bool crossed = best.size > kFarAway * field.voxel_edge() &&
                         cross_cell(field, frames, piece, *best.cell, best.held | corner.flat, probe, best.s, best.t, next.f);
    const FollowResult how = crossed ? FollowResult::landed : follow_piece(field, piece, probe, steepest, next.f, best.s, best.t);
    if (limit != nullptr && !limit->exceeded && limit->is_exceeded_by(piece.world(next.f))) {
      limit->exceeded = true;
      limit->last_within = next;
      limit->last_within.f = cut_short(field, piece, probe, *limit, start, before, next.f);
      limit->normal = start.n;
    }
    const unsigned faces = Corner(grid.index_box(), next).faces;
    if (how == FollowResult::converged && faces == 0 && norm(best.t) <= kMinDescent * length) {
      // inside the cell no other piece meets the point
      at = next;
      turn_to(best.s.n);
      result.status = LinkStatus::ok;
      result.residual = std::fabs(best.s.distance);
      result.normal = best.s.n;
      return result;
    }
    const bool moved = norm(mapping.world_from_index_linear * (next.f - before)) > kStill * length;
    const bool snapped = !moved && faces != corner.faces;
    if (moved || snapped) exhausted = 0;
    if (moved) steepest = false;
    if ((!moved && !snapped) || how == FollowResult::blocked) exhausted |= std::uint64_t{1} << (best.upper * 8 + best.held);
    at = next;
  }
  result.status = LinkStatus::budget;
  return result;
}

}  // namespace catena::haptics
