// SPDX-License-Identifier: MIT
/// One cell piece of a sampled level set: a trilinear cell with some of its axes held. See isosurface/cell_walk.h.
#pragma once
#include "engine/field/grid/grid.h"
#include "haptics/constraints/equations.h"
#include "haptics/constraints/isosurface/level_set_field.h"

namespace catena::haptics {

/// Geometry of the free axes: an orthonormal basis of the span of their columns of J.
struct PieceFrame {
  int dimension = 0;            ///< dimension of the span
  std::array<Vec3, 3> basis{};  ///< orthonormal basis of the span; not set where dimension is 3
  std::array<bool, 3> held{};

  /// Makes the basis for the axes whose bits in `held_axes` are clear.
  PieceFrame(const field::Mapping& mapping, unsigned held_axes) noexcept;
  /// Returns the projection of a world vector onto the span.
  Vec3 project(const Vec3& v) const noexcept {
    if (dimension == 3) return v;
    Vec3 out(0.0);
    for (int k = 0; k < dimension; ++k) out += basis[static_cast<std::size_t>(k)] * dot(basis[static_cast<std::size_t>(k)], v);
    return out;
  }
  /// Returns a world vector of the span as an index step; held axes are exactly 0.
  Vec3 index_step(const field::Mapping& mapping, const Vec3& v) const noexcept {
    Vec3 d = mapping.index_from_world_linear * v;
    for (int a = 0; a < 3; ++a)
      if (held[static_cast<std::size_t>(a)]) d[a] = 0;
    return d;
  }
};

/// All eight frames of a grid, indexed by the bits of the held axes; computed at construction.
struct PieceFrames {
  std::array<PieceFrame, 8> by_held_axes;
  explicit PieceFrames(const field::Mapping& m) noexcept : by_held_axes{{{m, 0}, {m, 1}, {m, 2}, {m, 3}, {m, 4}, {m, 5}, {m, 6}, {m, 7}}} {}
};

/// Sample of the cell's polynomial at a point, restricted to the span Q.
struct PieceSample {
  double sigma = 0;     ///< value - level
  double slope = 0;     ///< |Q'grad s|
  double distance = 0;  ///< sigma / slope, world units
  Vec3 n{0.0};          ///< unit normal within the span, world
  bool usable = false;  ///< slope and distance are finite, and n is not zero
};

/// One cell piece: the trilinear polynomial of a cell, restricted to a frame. Points f are in [0, 1]^3 of the cell. Haptic thread.
class CellPiece {
 public:
  /// `steps` counts the evaluations of the cell's polynomial.
  CellPiece(const field::Mapping& mapping, const field::ScalarCell& cell, double level, const PieceFrame& frame,
            std::int32_t& steps) noexcept
      : mapping_(mapping), cell_(cell), level_(level), frame_(frame), steps_(steps) {}

  const PieceFrame& frame() const noexcept { return frame_; }
  /// Returns the world position of f.
  Vec3 world(const Vec3& f) const noexcept {
    return mapping_.world_from_index({cell_.base.x + f.x, cell_.base.y + f.y, cell_.base.z + f.z});
  }
  /// Returns value, slope and normal at f; counts one step.
  PieceSample sample(const Vec3& f) const noexcept;
  /// Returns the tangential component t = e - (n.e) n in the span, e from f to the probe; zero where the span has less than two dimensions.
  Vec3 tangential_component(const Vec3& f, const Vec3& probe, const PieceSample& s) const noexcept;
  /// Returns the Newton step on the tangent plane.
  Vec3 newton_step(const Vec3& f, const Vec3& probe, const PieceSample& s, const Vec3& t) const noexcept;
  /// Returns J^T force at f, the closest point of the piece to the probe.
  PulledBackForce pull_back(const Vec3& f, const Vec3& probe, const Vec3& force) const noexcept;
  /// Projects f + step back to the level along n (of the point f). False: no level nearby. The result may leave the cell.
  /// `along`: position on that line at which the search begins (0: at f + step), and at which it ended.
  bool retract(const Vec3& f, const Vec3& step, const PieceSample& s, Vec3& out, double& along) const noexcept;
  bool retract(const Vec3& f, const Vec3& step, const PieceSample& s, Vec3& out) const noexcept {
    double along = 0;
    return retract(f, step, s, out, along);
  }
  /// Returns which fraction of the index step d from f, a point in the cell, is in the cell; axis: that of the face that ends it, or -1.
  double fraction_inside(const Vec3& f, const Vec3& d, int& axis) const noexcept {
    double fraction = 1;
    axis = -1;
    for (int a = 0; a < 3; ++a) {
      const double face_fraction = d[a] > 0 ? (1 - f[a]) / d[a] : d[a] < 0 ? -f[a] / d[a] : 1.0;
      if (face_fraction < fraction) fraction = face_fraction, axis = a;
    }
    return fraction;
  }
  /// Returns by how much |x - p|^2 / 2 decreases from one point of the cell to another, exact where they are close.
  double gain(const Vec3& probe, const Vec3& from, const Vec3& to) const noexcept {
    const Vec3 dp = mapping_.world_from_index_linear * (to - from);
    return dot(dp, probe - world(from)) - 0.5 * dot(dp, dp);
  }
  /// Returns by how much f is outside the cell (negative: inside), over the axes that are not held; `axis`: the worst axis.
  double overshoot(const Vec3& f, int& axis) const noexcept;

 private:
  Vec3 hessian_times(const Vec3& f, const Vec3& world) const noexcept;
  const field::Mapping& mapping_;
  const field::ScalarCell& cell_;
  double level_;
  const PieceFrame& frame_;
  std::int32_t& steps_;
};

// The hot path is in the header: a walk samples a few times per tick.

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

/// Motion over one cell piece of a sampled level set: see isosurface/cell_walk.h. Haptic thread.
inline constexpr double kMinDescent = 1e-8;      // fraction of L: a smaller tangential component counts as zero
inline constexpr double kFaceTolerance = 1e-12;  // voxels: a point closer to a face is on it

/// Result of follow_piece: at the closest point; on a face of the cell; no step possible.
enum class FollowResult { converged, landed, blocked };

/// Moves f within one piece towards the closest point, until it converges or meets a face of the cell. `s` and `t` are the sample
/// and the tangential component at f, on input, and on output where it converged. `steepest`: steps along t instead of Newton's step,
/// which on a folded piece may lead out of the cell where t leads in.
FollowResult follow_piece(const LevelSetField& field, const CellPiece& piece, const Vec3& probe, bool steepest, Vec3& f, PieceSample& s,
                          Vec3& t) noexcept;

/// Moves f, far from the probe, straight along t to the face where it leaves the cell, and on that face back to the level. False: the
/// level bends too much for that, or the step is no descent.
bool cross_cell(const LevelSetField& field, const PieceFrames& frames, const CellPiece& piece, const field::ScalarCell& cell, unsigned held,
                const Vec3& probe, const PieceSample& s, const Vec3& t, Vec3& f) noexcept;

}  // namespace catena::haptics
