/// One piece of a sampled level set: a trilinear cell with some of its axes held. See isosurface/cell_walk.h.
#pragma once
#include "engine/field/grid/grid.h"
#include "haptics/constraints/equations.h"
#include "haptics/constraints/isosurface/level_set_field.h"

namespace catena::haptics {

/// The geometry of the free axes: an orthonormal basis of the span of their columns of J.
struct PieceFrame {
  int dimension = 0;            ///< dimensions of the span
  std::array<Vec3, 3> basis{};  ///< not set where count is 3
  std::array<bool, 3> held{};

  PieceFrame(const field::Mapping& mapping, unsigned held_axes) noexcept;
  Vec3 project(const Vec3& v) const noexcept {
    if (dimension == 3) return v;
    Vec3 out(0.0);
    for (int k = 0; k < dimension; ++k) out += basis[static_cast<std::size_t>(k)] * dot(basis[static_cast<std::size_t>(k)], v);
    return out;
  }
  /// A world vector of the span as an index step: held axes exactly 0.
  Vec3 index_step(const field::Mapping& mapping, const Vec3& v) const noexcept {
    Vec3 d = mapping.index_from_world_linear * v;
    for (int a = 0; a < 3; ++a)
      if (held[static_cast<std::size_t>(a)]) d[a] = 0;
    return d;
  }
};

/// All of a grid's, by the bits of the held axes: made once.
struct PieceFrames {
  std::array<PieceFrame, 8> by_held_axes;
  explicit PieceFrames(const field::Mapping& m) noexcept : by_held_axes{{{m, 0}, {m, 1}, {m, 2}, {m, 3}, {m, 4}, {m, 5}, {m, 6}, {m, 7}}} {}
};

struct PieceSample {
  double sigma = 0;
  double slope = 0;     ///< |Q'grad s|
  double distance = 0;  ///< sigma / slope
  Vec3 n{0.0};          ///< world, in the span
  bool usable = false;
};

class CellPiece {
 public:
  /// `steps` counts the evaluations of the cell's polynomial.
  CellPiece(const field::Mapping& mapping, const field::ScalarCell& cell, double level, const PieceFrame& frame,
            std::int32_t& steps) noexcept
      : mapping_(mapping), cell_(cell), level_(level), frame_(frame), steps_(steps) {}

  const PieceFrame& frame() const noexcept { return frame_; }
  Vec3 world(const Vec3& f) const noexcept {
    return mapping_.world_from_index({cell_.base.x + f.x, cell_.base.y + f.y, cell_.base.z + f.z});
  }
  PieceSample sample(const Vec3& f) const noexcept;
  /// t = e - (n.e) n, in the span.
  Vec3 tangential_component(const Vec3& f, const Vec3& probe, const PieceSample& s) const noexcept;
  /// The Newton step on the tangent plane.
  Vec3 newton_step(const Vec3& f, const Vec3& probe, const PieceSample& s, const Vec3& t) const noexcept;
  /// J^T force at f, the closest point of the piece to the probe.
  PulledBackForce pull_back(const Vec3& f, const Vec3& probe, const Vec3& force) const noexcept;
  /// f + step, brought back to the level along n (of the point f). False: no level near by. May leave the cell.
  /// `along`: where on that line a search begins (0: at f + step), and where it ended.
  bool retract(const Vec3& f, const Vec3& step, const PieceSample& s, Vec3& out, double& along) const noexcept;
  bool retract(const Vec3& f, const Vec3& step, const PieceSample& s, Vec3& out) const noexcept {
    double along = 0;
    return retract(f, step, s, out, along);
  }
  /// How much of the index step d from f, a place in the cell, is in the cell, and the axis of the face that ends it (-1: none does).
  double fraction_inside(const Vec3& f, const Vec3& d, int& axis) const noexcept {
    double part = 1;
    axis = -1;
    for (int a = 0; a < 3; ++a) {
      const double way = d[a] > 0 ? (1 - f[a]) / d[a] : d[a] < 0 ? -f[a] / d[a] : 1.0;
      if (way < part) part = way, axis = a;
    }
    return part;
  }
  /// By how much |x - p|^2 / 2 falls from one place of the cell to another, exact where they are close.
  double gain(const Vec3& probe, const Vec3& from, const Vec3& to) const noexcept {
    const Vec3 dp = mapping_.world_from_index_linear * (to - from);
    return dot(dp, probe - world(from)) - 0.5 * dot(dp, dp);
  }
  /// By how much f is outside the cell (negative: inside), over the axes that are not held; and the worst axis.
  double overshoot(const Vec3& f, int& axis) const noexcept;

 private:
  Vec3 hessian_times(const Vec3& f, const Vec3& world) const noexcept;
  const field::Mapping& mapping_;
  const field::ScalarCell& cell_;
  double level_;
  const PieceFrame& frame_;
  std::int32_t& steps_;
};

// The hot path is in the header: a walk samples a few times a tick.

inline PieceSample CellPiece::sample(const Vec3& f) const noexcept {
  PieceSample s;
  double value;
  Vec3 g;
  ++steps_;
  cell_.value_and_gradient(f, value, g);
  const Vec3 slope = frame_.project(mapping_.world_from_index_gradient(g));
  s.sigma = value - level_;
  s.slope = norm(slope);
  s.n = direction(slope);
  s.distance = s.sigma / s.slope;
  s.usable = s.slope > 0 && std::isfinite(s.slope) && std::isfinite(s.distance) && max_abs(s.n) > 0;
  return s;
}

inline Vec3 CellPiece::tangential_component(const Vec3& f, const Vec3& probe, const PieceSample& s) const noexcept {
  if (frame_.dimension < 2) return Vec3(0.0);
  const Vec3 e = frame_.project(probe - world(f));
  return equation::tangential_component(e, s.n);
}

/// Moves over one piece of a sampled level set: see isosurface/cell_walk.h. Haptic thread.
inline constexpr double kMinDescent = 1e-8;      // of L: a smaller tangential descent is none
inline constexpr double kFaceTolerance = 1e-12;  // voxels: closer to a face than this is on it

enum class FollowResult { converged, landed, blocked };

/// Moves f within one piece towards the closest point, until it converges or meets a face of the cell. `s` and `t` are the sample
/// and the tangential part at f, on the way in, and on the way out where it converged. Steepest: by t, not by Newton's step, which
/// on a folded piece may lead out of the cell where t leads in.
FollowResult follow_piece(const LevelSetField& field, const CellPiece& piece, const Vec3& probe, bool steepest, Vec3& f, PieceSample& s,
                          Vec3& t) noexcept;

/// Far from the probe, straight along t to the face where it leaves the cell, and on that face back to the level. False: the level
/// bends too much for that, or the way is no way down.
bool cross_cell(const LevelSetField& field, const PieceFrames& frames, const CellPiece& piece, const field::ScalarCell& cell, unsigned held,
                const Vec3& probe, const PieceSample& s, const Vec3& t, Vec3& f) noexcept;

}  // namespace catena::haptics
