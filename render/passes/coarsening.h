/// A grid that is drawn at less than its resolution because the whole does not fit into the memory budget.
#pragma once
#include <cstdint>
#include <string>

namespace catena::render {

struct MirrorCoarsening {
  std::string grid;
  int factor = 1;                                  ///< 2, 4, 8
  std::string size;                                ///< of the grid: "256^3", "512 x 512 x 90"
  std::uint64_t needed_bytes = 0, left_bytes = 0;  ///< of the whole grid; of the budget, when it was mirrored
  /// "density: 256^3 needs 67 MB of GPU memory, 40 MB are left: drawn at half resolution"
  std::string words() const;
};

}  // namespace catena::render
