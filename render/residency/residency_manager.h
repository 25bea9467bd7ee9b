// SPDX-License-Identifier: MIT
/// Cache of the resident grids that frames use, keyed by (grid version, texel format, layout); entries are dropped when a frame does not
/// refer to them. They stay within the remaining memory budget of the device: a grid that does not fit is downsampled to 1/2, 1/4 or 1/8 of
/// its resolution, and rebuilt at full resolution when there is enough memory.
#pragma once
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "engine/base/export.h"
#include "render/residency/resident_grid.h"

namespace catena::render {

/// Report on a grid that is rendered at reduced resolution because it does not fit into the memory budget.
struct CATENA_EXPORT GridDownsampling {
  std::string grid;                                     ///< name of the grid
  int factor = 1;                                       ///< downsampling factor: 2, 4 or 8
  std::string size;                                     ///< size of the full grid: "256^3", "512 x 512 x 90"
  std::uint64_t needed_bytes = 0, available_bytes = 0;  ///< memory needed at full resolution; memory available when it was built
  /// Returns, for instance, "density: 256^3 needs 67 MB of GPU memory, 40 MB are left: drawn at half resolution".
  std::string message() const;
};

/// Owner of the resident grids. Frame thread.
class CATENA_EXPORT ResidencyManager {
 public:
  /// The device must outlive this object.
  explicit ResidencyManager(vk::Device& device) : device_(device) {}
  /// Returns the resident grid, built on the first call. An Error if there is no memory even at 1/8 resolution.
  Result<std::shared_ptr<const ResidentGrid>> get(const field::ScalarGrid& grid, const ResidencyOptions& options);
  /// Begins a frame. `reserved`: bytes of the budget for other purposes. `sharers` > 1: number of grids that share the rest.
  void begin_frame(std::uint64_t reserved, std::size_t sharers = 1);
  /// Frees the resident grids that this frame has not requested.
  void drop_unused();
  /// Frees those of `grid` that this frame has not requested so far.
  void drop_unused(const field::ScalarGrid& grid);
  /// Frees all resident grids.
  void clear() { entries_.clear(); }
  /// Returns the number of resident grids.
  std::size_t count() const { return entries_.size(); }
  /// Returns the bytes of their images.
  std::uint64_t bytes() const;
  /// Returns the total milliseconds spent on building resident grids.
  double build_ms() const { return build_ms_; }
  /// Returns the bytes of the budget available to one grid.
  std::uint64_t available_bytes() const;
  /// Returns the reports on all downsampled grids, older grids first.
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
  std::size_t remaining_sharers_ = 1;  ///< sharers whose grids have not been requested yet in this frame
  double build_ms_ = 0;
};

}  // namespace catena::render
