// SPDX-License-Identifier: MIT
/// A scalar field seen from one level: value, slope and distance in one counted field sample.
///   sigma = s - level,  n = grad s / |grad s|,  distance = sigma / |grad s|  (signed, a length)
/// Grids are sampled at the nearest point of their domain. Haptic thread.
#pragma once
#include "haptics/chain/constraint.h"

namespace catena::haptics {

/// One sample of a LevelSetField.
struct LevelPoint {
  Vec3 p{0.0};           ///< position of the sample, world units
  double sigma = 0;      ///< value - level
  Vec3 n{0.0};           ///< unit gradient direction, world; 0 on a plateau
  double distance = 0;   ///< first-order distance from the level, signed, world units; 0 on a plateau
  double slope = 0;      ///< |grad s|
  double round_off = 0;  ///< world units: a distance below it is noise
  bool valid = false;    ///< finite, and inside the domain and mask
  bool finite = false;   ///< value and gradient are finite
  bool plateau = false;  ///< the gradient is not usable
};

/// Validates a sample from a file: see Constraint::is_sane.
inline bool is_sane(const LevelPoint& at) noexcept { return are_valid_bools(at.valid, at.finite, at.plateau); }

/// A scalar field and a level, with counted access. Refers to the field, the cursor and the LinkState, which outlive it.
class LevelSetField {
 public:
  LevelSetField(const field::ScalarField& field, double level, field::Cursor& cursor, LinkState& state)
      : field_(field), grid_(field.cells()), level_(level), cursor_(cursor), state_(state) {
    if (grid_ == nullptr) return;
    linear_ = field.interpolation() != field::Interpolation::cubic;
    cell_work_ = linear_ ? kCellWork : kCubicWork;
  }

  /// Returns one sample; counted. Out of budget it costs nothing and returns an invalid sample.
  LevelPoint at(const Vec3& world) noexcept;
  /// Returns whether fewer than `reserve` field samples, or no work units, are left.
  bool out_of_budget(int reserve = 0) const noexcept {
    return state_.evaluations + reserve >= kMaxEvaluations || state_.exhausted(reserved_work_ + reserve * (kFetchWork + cell_work_));
  }
  /// Counts one field sample.
  void count_fetch() noexcept {
    ++state_.evaluations;
    state_.other_work += cell_work_;
  }

  /// Returns whether fewer than `reserve` work units are left, regardless of field samples.
  bool exhausted(int reserve = 0) const noexcept { return state_.exhausted(reserved_work_ + reserve); }
  /// Returns whether this tick has used an eighth of its work: the rest may be less exact between its start and its end.
  bool is_running_long() const noexcept { return state_.work() > kMaxWork / 8; }
  const LinkState& state() const noexcept { return state_; }

  /// Returns the nearest point of a grid's box to a world position, world units; for a formula the position itself.
  Vec3 clamped(const Vec3& world) const noexcept {
    if (grid_ == nullptr) return world;
    const Vec3 index = field_.mapping().index_from_world(world);
    return field_.index_box().contains(index) ? world : nearest(index);
  }
  double level() const noexcept { return level_; }
  double length() const noexcept { return field_.domain_length(); }
  /// Returns the step of a march along a line, world units: half a voxel; a 256th of L for formulas.
  double march_step() const noexcept;
  /// Returns the longest edge of a voxel, world units; 0 for formulas.
  double voxel_edge() const noexcept { return grid_ ? field_.max_voxel_edge() : 0; }
  const field::ScalarField& field() const noexcept { return field_; }
  const field::CellField* grid() const noexcept { return grid_; }
  /// Returns the field if its cells are trilinear, so that the surface is exact within each of them (cell_walk.h); else null.
  const field::CellField* trilinear_grid() const noexcept { return linear_ ? grid_ : nullptr; }

  /// Returns the same samples as trilinear cells, whose surface lies near the cubic's: for a walk.
  LevelSetField with_trilinear_cells() const noexcept {
    LevelSetField linear = *this;
    linear.linear_ = grid_ != nullptr;
    linear.cell_work_ = kCellWork;
    return linear;
  }
  /// Keeps so many field samples for other searches: this object is out of budget while they are left.
  void reserve_fetches(int fetches) noexcept { reserved_work_ = fetches * (kFetchWork + kCubicWork); }

  /// Constrains all further samples to a wall: for the axes whose bits are set, the index is held. The gradient is that within the wall.
  void constrain_to_wall(unsigned axes, const Vec3& index) noexcept;
  /// Returns the point on the wall nearest to `world`, if axes are held.
  Vec3 project_to_wall(const Vec3& world) const noexcept;
  field::Cursor& cursor() noexcept { return cursor_; }
  std::int32_t& evaluations() noexcept { return state_.evaluations; }
  std::int32_t& steps() const noexcept { return state_.other_work; }

 private:
  Vec3 nearest(const Vec3& index) const noexcept;
  Vec3 wall_component(const Vec3& v) const noexcept;
  const field::ScalarField& field_;
  const field::CellField* grid_;  ///< the field as cells, or null
  bool linear_ = false;
  int cell_work_ = 0, reserved_work_ = 0;
  unsigned held_axes_ = 0;
  Vec3 wall_{0.0}, wall_direction_{0.0};  ///< held indices; the wall's normal, or where two axes are held the edge's direction
  double level_;
  field::Cursor& cursor_;
  LinkState& state_;
};

/// Returns an orthonormal basis (a, b) of the plane normal to the unit vector n; the same bits for the same n.
void make_tangent_basis(const Vec3& n, Vec3& a, Vec3& b) noexcept;

}  // namespace catena::haptics
