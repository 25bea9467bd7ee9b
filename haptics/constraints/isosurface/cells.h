/// The cells that a walk over a sampled level set has fetched in this tick, and the walls where there is none. Haptic thread.
#pragma once
#include <cmath>

#include "engine/field/grid.h"
#include "haptics/constraints/isosurface/level.h"

namespace catena::haptics {

/// Whether a grid has one layer only along axis a.
inline bool is_flat(const field::Box& box, int a) { return !(box.hi[a] > box.lo[a]); }

/// The cells fetched in this tick: each is counted once.
class Cells {
 public:
  explicit Cells(LevelField& field) : field_(field), grid_(*field.grid()) {}

  /// nullptr: a wall, of which `wall` then says the kind, or the budget is spent.
  const field::ScalarCell* find(const field::Index3& base) {
    ++field_.steps();
    const field::Box& box = grid_.index_box();
    const std::array<std::int32_t, 3> at{base.x, base.y, base.z};
    for (int a = 0; a < 3; ++a) {
      const double last = is_flat(box, a) ? box.lo[a] : box.hi[a] - 1;
      const double b = at[static_cast<std::size_t>(a)];
      if (b < box.lo[a] || b > last) {
        wall = Reason::box;
        return nullptr;
      }
    }
    for (std::size_t i = 1; i <= kCells && i <= count_; ++i) {
      const std::size_t k = (count_ - i) % kCells;
      if (keys_[k].base == base) return usable(k);
    }
    if (field_.spent()) {
      spent_ = true;
      return nullptr;
    }
    field_.count_fetch();
    const std::size_t k = count_++ % kCells;
    field::ScalarCell& cell = *new (slot(k)) field::ScalarCell(grid_.cell(base, field_.cursor()));
    cell.base = base;
    keys_[k] = {base, wall_of(cell)};
    return usable(k);
  }
  bool spent() const { return spent_; }
  Reason wall = Reason::none;

 private:
  struct Key {
    field::Index3 base;
    Reason wall;  ///< none: a cell to walk in
  };
  static Reason wall_of(const field::ScalarCell& cell) {
    for (const double c : cell.corner)
      if (!std::isfinite(c)) return Reason::not_finite;
    return cell.valid ? Reason::none : Reason::mask;
  }
  const field::ScalarCell* usable(std::size_t k) {
    if (keys_[k].wall == Reason::none) return slot(k);
    wall = keys_[k].wall;
    return nullptr;
  }
  LevelField& field_;
  const field::ScalarGrid& grid_;
  // raw bytes: most ticks need one cell, and clearing 32 would cost as much as the walk
  static constexpr std::size_t kCells = 32;
  field::ScalarCell* slot(std::size_t k) {
    return std::launder(reinterpret_cast<field::ScalarCell*>(&bytes_[k * sizeof(field::ScalarCell)]));
  }
  alignas(field::ScalarCell) std::array<std::byte, kCells * sizeof(field::ScalarCell)> bytes_;
  std::array<Key, kCells> keys_;  // NOLINT: set as cells come
  std::size_t count_ = 0;
  bool spent_ = false;
};

}  // namespace catena::haptics
