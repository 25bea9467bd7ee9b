/// The mirrors that frames use, keyed by (grid version, texel format, layout), dropped when a frame no longer names them.
/// They keep within what is left of the device's memory budget: a grid that does not fit is mirrored at 1/2, 1/4 or 1/8 of its
/// resolution, and again as a whole once there is room.
#pragma once
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "render/residency/resident_grid.h"

namespace catena::render {

/// A grid that is drawn at less than its resolution because the whole does not fit into the memory budget.
struct GridDownsampling {
  std::string grid;                                     ///< its name
  int factor = 1;                                       ///< 2, 4, 8
  std::string size;                                     ///< of the grid: "256^3", "512 x 512 x 90"
  std::uint64_t needed_bytes = 0, available_bytes = 0;  ///< of the whole grid; of the budget, when it was mirrored
  /// "density: 256^3 needs 67 MB of GPU memory, 40 MB are left: drawn at half resolution"
  std::string message() const;
};

/// The mirrors. Frame thread.
class ResidencyManager {
 public:
  /// On a device that outlives this.
  explicit ResidencyManager(vk::Device& device) : device_(device) {}
  /// Builds it at the first call.
  Result<std::shared_ptr<const ResidentGrid>> get(const field::ScalarGrid& grid, const ResidencyOptions& options);
  /// `reserved` bytes of the budget are for others. `sharers` > 1: so many grids are to share the rest.
  void begin_frame(std::uint64_t reserved, std::size_t sharers = 1);
  /// Frees those that the frame has not asked for.
  void drop_unused();
  /// Those of a grid that the frame has not asked for so far.
  void drop_unused(const field::ScalarGrid& grid);
  /// Frees all.
  void clear() { entries_.clear(); }
  /// ResidencyManager that are kept.
  std::size_t count() const { return entries_.size(); }
  /// Of their images.
  std::uint64_t bytes() const;
  /// Milliseconds spent on building mirrors so far.
  double build_ms() const { return build_ms_; }
  /// Bytes of the budget that a grid may take now.
  std::uint64_t available_bytes() const;
  /// Of the grids that are mirrored now, older grids first.
  std::vector<GridDownsampling> downsampled_grids() const;

 private:
  using Key = std::tuple<std::uint64_t, bool, GridLayout>;
  struct Entry {
    std::shared_ptr<const ResidentGrid> resident;
    std::uint64_t last_used = 0;
    GridDownsampling downsampling;
  };
  Outcome build(Entry& entry, const field::ScalarGrid& grid, const ResidencyOptions& options);

  vk::Device& device_;
  std::map<Key, Entry> entries_;
  std::uint64_t frame_number_ = 0, reserved_bytes_ = 0;
  std::size_t remaining_sharers_ = 1;  ///< still to come in this frame
  double build_ms_ = 0;
};

}  // namespace catena::render
