/// The closest point of a sampled level set to the probe x, exact to the trilinear cells: one fetch is the whole polynomial,
/// with its Hessian. Many closest points lie on a face or an edge of a cell, where no single normal gives t = 0; so the walk
/// works on pieces: a cell with some of the faces through p held (active set A). On the span Q of the axes that are not held:
///   n = Q'grad s / |Q'grad s|, e = Q'(x - p), t = e - (n.e) n, (I + (n.e) Q'HQ / |Q'grad s|) u = t, then back to the level
/// At p every adjoining cell x subset of the faces through p is a piece; the steepest feasible one is followed until it
/// converges or meets a face. None left: p is the local closest point. Walls (the domain, the mask, cells with values that
/// are not finite) have no cell behind them: BOUNDARY where the probe pulls across one, with the reason.
/// So the walk keeps to the sheet it is on, and |x - p| only falls: it never meets another sheet, however near.
/// Worlds may be anisotropic, rotated, sheared. Haptic thread: bounded by the link's fetches and work (constraint.h).
#pragma once
#include "engine/field/grid.h"
#include "haptics/constraints/isosurface/level.h"
#include "haptics/constraints/isosurface/piece.h"

namespace catena::haptics {

/// A point of a grid: f in [0, 1]^3 of the cell at `base`; exactly 0 or 1 on a face.
struct CellPoint {
  field::Index3 base;
  Vec3 f{0.0};
};

/// Of a state from a file (Constraint::is_sane): far from where integers end, and a place. Cells outside the grid are
/// walls to the walk.
inline bool is_sane(const CellPoint& at) noexcept {
  constexpr std::int32_t most = 1 << 30;
  const auto near = [](std::int32_t base) { return base > -most && base < most; };
  return near(at.base.x) && near(at.base.y) && near(at.base.z) && is_finite(at.f);
}

struct WalkResult {
  Status status = Status::ok;    ///< ok, boundary, budget, critical
  Reason reason = Reason::none;  ///< of a status boundary or critical
  double residual = 0;           ///< off the level, world units
  Vec3 normal{0.0};
  bool smooth = true;  ///< the normal turned by less than 18 degrees from step to step
};

/// How far a walk may go from where it began. It is walked to its end all the same; `last` is the last point within `room`.
struct TravelLimit {
  Vec3 from{0.0};
  double room = 0;  ///< world units
  bool passed = false;
  CellPoint last{};
  Vec3 normal{0.0};
  bool passed_by(const Vec3& p) const noexcept { return norm(p - from) > room; }
};

/// The cell point of a world position (clamped to the domain).
CellPoint cell_point(const field::ScalarGrid& grid, const Vec3& world) noexcept;
Vec3 world_of(const field::ScalarGrid& grid, const CellPoint& at) noexcept;

/// Moves `at` (on the level to 1e-9 L or so) to the local closest point to the probe. `frames`: the grid's.
WalkResult walk_cells(LevelField& field, const PieceFrames& frames, const Vec3& probe, CellPoint& at,
                      TravelLimit* limit = nullptr) noexcept;

}  // namespace catena::haptics
