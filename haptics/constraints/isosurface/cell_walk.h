// SPDX-License-Identifier: MIT
/// Walk over the trilinear cells of a sampled level set to the local closest point. Haptic thread.
#pragma once
#include <cmath>

#include "engine/field/grid/grid.h"
#include "haptics/constraints/isosurface/cell_piece.h"
#include "haptics/constraints/isosurface/level_set_field.h"

namespace catena::haptics {

/// Returns whether a grid has only one layer along axis a.
inline bool is_flat(const field::Box& box, int a) { return !(box.hi[a] > box.lo[a]); }

/// The cells fetched in this tick: each is counted as one field sample (a cell that was dropped after 32 others, once more).
class CellCache {
 public:
  explicit CellCache(LevelSetField& field) : field_(field), grid_(*field.trilinear_grid()) {}

  /// Returns the cell at `base`. Null: a domain wall, whose kind is in wall_reason, or out of budget (out_of_budget()).
  const field::ScalarCell* fetch(const field::Index3& base) {
    ++field_.steps();
    const field::Box& box = grid_.index_box();
    const std::array<std::int32_t, 3> at{base.x, base.y, base.z};
    for (int a = 0; a < 3; ++a) {
      const double last = is_flat(box, a) ? box.lo[a] : box.hi[a] - 1;
      const double b = at[static_cast<std::size_t>(a)];
      if (b < box.lo[a] || b > last) {
        wall_reason = SampleStatus::outside_box;
        return nullptr;
      }
    }
    for (std::size_t i = 1; i <= kCapacity && i <= count_; ++i) {
      const std::size_t k = (count_ - i) % kCapacity;
      if (keys_[k].base == base) return cell_or_wall(k);
    }
    if (field_.out_of_budget()) {
      out_of_budget_ = true;
      return nullptr;
    }
    field_.count_fetch();
    const std::size_t k = count_++ % kCapacity;
    field::ScalarCell& cell = *new (slot(k)) field::ScalarCell(grid_.cell(base, field_.cursor()));
    cell.base = base;
    keys_[k] = {base, classify_wall(cell)};
    return cell_or_wall(k);
  }
  bool out_of_budget() const { return out_of_budget_; }
  /// Kind of the last wall met.
  SampleStatus wall_reason = SampleStatus::ok;

 private:
  struct Key {
    field::Index3 base;
    SampleStatus wall_reason;  ///< ok: a cell to walk in
  };
  static SampleStatus classify_wall(const field::ScalarCell& cell) {
    for (const double c : cell.corner)
      if (!std::isfinite(c)) return SampleStatus::not_finite;
    return cell.valid ? SampleStatus::ok : SampleStatus::masked;
  }
  const field::ScalarCell* cell_or_wall(std::size_t k) {
    if (keys_[k].wall_reason == SampleStatus::ok) return slot(k);
    wall_reason = keys_[k].wall_reason;
    return nullptr;
  }
  LevelSetField& field_;
  const field::CellField& grid_;
  // raw bytes: most ticks need one cell, and clearing 32 would cost as much as the walk
  static constexpr std::size_t kCapacity = 32;
  field::ScalarCell* slot(std::size_t k) {
    return std::launder(reinterpret_cast<field::ScalarCell*>(&bytes_[k * sizeof(field::ScalarCell)]));
  }
  alignas(field::ScalarCell) std::array<std::byte, kCapacity * sizeof(field::ScalarCell)> bytes_;
  std::array<Key, kCapacity> keys_;  // NOLINT: filled as cells are fetched
  std::size_t count_ = 0;
  bool out_of_budget_ = false;
};

/// The closest point of a sampled level set to the probe x, exact to the trilinear cells: one field sample is the whole polynomial,
/// with its Hessian. Many closest points lie on a face or an edge of a cell, where no single normal gives t = 0; so the walk
/// works on pieces: a cell with some of the faces through p held (active set A). On the span Q of the axes that are not held:
///   n = Q'grad s / |Q'grad s|, e = Q'(x - p), t = e - (n.e) n, (I + (n.e) Q'HQ / |Q'grad s|) u = t, then back to the level
/// At p every combination of an adjoining cell and a subset of the faces through p is a piece; the steepest feasible one is followed until
/// it converges or meets a face. None left: p is the local closest point. Walls (the end of the domain, the mask, cells with values that
/// are not finite) have no cell behind them: BOUNDARY where the probe pulls across one, with the reason.
/// So the walk stays on its sheet, and |x - p| only decreases: it never jumps to another sheet, however near.
/// Grids may be anisotropic, rotated, sheared. Haptic thread: bounded by the link's samples and work units (constraint.h).

/// A point of a grid: f in [0, 1]^3 of the cell at `base`; exactly 0 or 1 on a face.
struct CellPoint {
  field::Index3 base;
  Vec3 f{0.0};
};

/// Validates a point from a file (Constraint::is_sane): indices far from integer overflow, f finite. To the walk, cells outside the grid
/// are walls.
inline bool is_sane(const CellPoint& at) noexcept {
  constexpr std::int32_t limit = 1 << 30;
  const auto near = [](std::int32_t base) { return base > -limit && base < limit; };
  return near(at.base.x) && near(at.base.y) && near(at.base.z) && is_finite(at.f);
}

/// Result of walk_cells.
struct WalkResult {
  LinkStatus status = LinkStatus::ok;      ///< ok, boundary, budget, critical
  SampleStatus reason = SampleStatus::ok;  ///< set with a status boundary or critical
  double residual = 0;                     ///< distance from the level, world units
  /// Unit normal at the end, world.
  Vec3 normal{0.0};
  bool smooth = true;  ///< the normal turned by less than 18 degrees at every step
};

/// Limit of how far a walk may go from its start. The walk is completed all the same; `last_within` is the last point within the limit.
struct TravelLimit {
  /// Start of the walk, world units.
  Vec3 from{0.0};
  double max_distance = 0;  ///< world units
  /// Set where the walk went beyond the limit; then `last_within` and `normal` are valid.
  bool exceeded = false;
  CellPoint last_within{};
  /// Unit normal at the start of the step that exceeded the limit, world.
  Vec3 normal{0.0};
  bool is_exceeded_by(const Vec3& p) const noexcept { return norm(p - from) > max_distance; }
};

/// Returns the cell point of a world position (clamped to the domain).
CellPoint to_cell_point(const field::CellField& grid, const Vec3& world) noexcept;
/// Returns the world position of a cell point.
Vec3 world_position(const field::CellField& grid, const CellPoint& at) noexcept;

/// Moves `at` (on the level to about 1e-9 L) to the local closest point to the probe. `frames`: those of the grid.
WalkResult walk_cells(LevelSetField& field, const PieceFrames& frames, const Vec3& probe, CellPoint& at,
                      TravelLimit* limit = nullptr) noexcept;

/// Returns J^T f of the projection at `at`, where a walk has ended: by the cell's exact Hessian, in the span of the axes that are not held.
/// The piece that counts is the one on which the point is a closest point, with the fewest axes held.
PulledBackForce pull_back_cells(LevelSetField& field, const PieceFrames& frames, const Vec3& probe, const CellPoint& at,
                                const Vec3& f) noexcept;

}  // namespace catena::haptics
