/// A scalar field seen from one level: value, slope and distance in one counted fetch.
///   sigma = s - level,  n = grad s / |grad s|,  distance = sigma / |grad s|  (signed, a length)
/// Grids are read at the nearest point of their domain. Haptic thread.
#pragma once
#include "haptics/chain/constraint.h"

namespace catena::haptics {

struct LevelPoint {
  Vec3 p{0.0};  ///< world
  double sigma = 0;
  Vec3 n{0.0};
  double distance = 0;   ///< 0 on a plateau
  double slope = 0;      ///< |grad s|
  double round_off = 0;  ///< a distance below this is noise
  bool valid = false;    ///< finite, and inside the domain and mask
  bool finite = false;
  bool plateau = false;  ///< no usable gradient
};

/// Of a state from a file: see Constraint::is_valid_state.
inline bool is_sane(const LevelPoint& at) noexcept { return are_valid_bools(at.valid, at.finite, at.plateau); }

class LevelSetField {
 public:
  LevelSetField(const field::ScalarField& field, double level, field::Cursor& cursor, LinkState& state)
      : field_(field), grid_(field.grid()), level_(level), cursor_(cursor), state_(state) {
    if (grid_ == nullptr) return;
    linear_ = field.interpolation() != field::Interpolation::cubic;
    cell_work_ = linear_ ? kCellWork : kCubicWork;
  }

  /// One evaluation. Costs nothing and is not valid when the budget is spent.
  LevelPoint at(const Vec3& world) noexcept;
  /// Fewer than `reserve` fetches are left, or no work.
  bool out_of_budget(int reserve = 0) const noexcept {
    return state_.evaluations + reserve >= kMaxEvaluations || state_.exhausted(reserved_work_ + reserve * (kFetchWork + cell_work_));
  }
  /// Counts one fetch.
  void count_fetch() noexcept {
    ++state_.evaluations;
    state_.other_work += cell_work_;
  }

  /// Less work than `reserve` is left, whatever fetches are.
  bool exhausted(int reserve = 0) const noexcept { return state_.exhausted(reserved_work_ + reserve); }
  /// A tick that takes long: the rest of it need not be as exact on its way as at its end.
  bool is_running_long() const noexcept { return state_.work() > kMaxWork / 8; }
  const LinkState& state() const noexcept { return state_; }

  /// The nearest point of a grid's box, in index space; a formula has no walls.
  Vec3 clamped(const Vec3& world) const noexcept {
    if (grid_ == nullptr) return world;
    const Vec3 index = field_.mapping().index_from_world(world);
    return field_.index_box().contains(index) ? world : nearest(index);
  }
  double level() const noexcept { return level_; }
  double length() const noexcept { return field_.domain_length(); }
  /// Half a voxel; a 256th of L for formulas.
  double march_step() const noexcept;
  /// The longest edge of a voxel; 0 for formulas.
  double voxel_edge() const noexcept { return grid_ ? field_.max_voxel_edge() : 0; }
  const field::ScalarField& field() const noexcept { return field_; }
  const field::ScalarGrid* grid() const noexcept { return grid_; }
  /// The grid where its cells are trilinear, so that the surface is exact within each of them (cell_walk.h); else none.
  const field::ScalarGrid* trilinear_grid() const noexcept { return linear_ ? grid_ : nullptr; }

  /// The same samples in trilinear cells, whose surface lies near the cubic's: for a walk.
  LevelSetField with_trilinear_cells() const noexcept {
    LevelSetField linear = *this;
    linear.linear_ = grid_ != nullptr;
    linear.cell_work_ = kCellWork;
    return linear;
  }
  /// This one is spent while so many fetches are left for others.
  void reserve_fetches(int fetches) noexcept { reserved_work_ = fetches * (kFetchWork + kCubicWork); }

  /// From now on places lie on a wall: of the axes whose bits are set, the index is held. The gradient is that on the wall.
  void constrain_to_wall(unsigned axes, const Vec3& index) noexcept;
  /// The place on the wall nearest to `world`, where one is held.
  Vec3 project_to_wall(const Vec3& world) const noexcept;
  field::Cursor& cursor() noexcept { return cursor_; }
  std::int32_t& evaluations() noexcept { return state_.evaluations; }
  std::int32_t& steps() const noexcept { return state_.other_work; }

 private:
  Vec3 nearest(const Vec3& index) const noexcept;
  Vec3 wall_component(const Vec3& v) const noexcept;
  const field::ScalarField& field_;
  const field::ScalarGrid* grid_;  ///< the same, or none
  bool linear_ = false;
  int cell_work_ = 0, reserved_work_ = 0;
  unsigned held_axes_ = 0;
  Vec3 wall_{0.0}, wall_direction_{0.0};  ///< indices held; the wall's normal, or where two axes are held the edge's direction
  double level_;
  field::Cursor& cursor_;
  LinkState& state_;
};

/// An orthonormal pair across the unit vector n; the same bits for the same n.
void make_tangent_basis(const Vec3& n, Vec3& a, Vec3& b) noexcept;

}  // namespace catena::haptics
