// SPDX-License-Identifier: MIT
#include "haptics/chain/offline_ticks.h"

#include <algorithm>
#include <vector>

#include "engine/base/console.h"
#include "engine/field/bricks/paged_grid.h"

namespace catena::haptics {

/// Bricks that the last ticks needed.
class OfflineTicks::Bricks {
 public:
  const field::BrickSnapshot* snapshot() const { return snapshot_.get(); }

  /// Loads the last brick that each cursor lacked. Returns false if there is none that can be read.
  bool load_missing(const HapticProgram& program, ChainScratch& scratch) {
    std::vector<field::BrickId> missing;
    for (LinkScratch& link : scratch.links)
      link.for_cursors([&](const field::Cursor& cursor) {
        const field::BrickId id{cursor.missing_grid, cursor.missing_brick};
        if (cursor.is_coarse && std::ranges::find(missing, id) == missing.end()) missing.push_back(id);
      });
    bool has_loaded = false;
    for (const field::BrickId& id : missing)
      for (const auto& grid : program.paged_grids)
        if (grid->version() == id.grid) has_loaded = load(*grid, id) || has_loaded;
    if (has_loaded) snapshot_ = std::make_shared<const field::BrickSnapshot>(++number_, bricks_);
    return has_loaded;
  }

 private:
  static constexpr std::size_t kMinBricks = 64, kMaxBytes = std::size_t{256} << 20;

  bool load(const field::PagedGrid& grid, const field::BrickId& id) {
    if (std::ranges::find(unreadable_, id) != unreadable_.end()) return false;
    auto brick = grid.read(grid.brick_at(id.number));
    if (!brick) {
      if (unreadable_.empty()) print_message("note: " + brick.error().message + "; a coarser level is felt there");
      unreadable_.push_back(id);
      return false;
    }
    bytes_ += (*brick)->bytes();
    for (; bytes_ > kMaxBytes && bricks_.size() >= kMinBricks; bricks_.erase(bricks_.begin())) bytes_ -= bricks_.front().values->bytes();
    bricks_.push_back({id, std::move(*brick)});
    return true;
  }

  std::vector<field::StoredBrick> bricks_;  ///< The last loaded ones at the end.
  std::size_t bytes_ = 0;
  std::vector<field::BrickId> unreadable_;
  std::shared_ptr<const field::BrickSnapshot> snapshot_;
  std::uint64_t number_ = 0;
};

OfflineTicks::OfflineTicks() = default;
OfflineTicks::~OfflineTicks() = default;

void OfflineTicks::run(const HapticProgram& program, const ProbeSample& probe, ChainState& state, ChainScratch& scratch, HapticState& out) {
  if (program.paged_grids.empty()) return tick(program, probe, state, scratch, out);
  constexpr int kMaxAttempts = 1024;  // each loads at least one brick
  if (!bricks_) bricks_ = std::make_unique<Bricks>();
  const ChainState before = state;
  ProbeSample input = probe;
  for (int attempt = 0;; ++attempt) {
    input.bricks = scratch.bricks = bricks_->snapshot();  // loading is no change that the hand may feel
    tick(program, input, state, scratch, out);
    if (attempt == kMaxAttempts || !bricks_->load_missing(program, scratch)) break;
    state = before;
  }
  out.brick_snapshot = 0;
}

}  // namespace catena::haptics
