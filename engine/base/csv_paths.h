/// The two tables that the program reads: probe paths `t,x,y,z[,buttons][,qw,qx,qy,qz]` and seeds `x,y,z`.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.h"
#include "engine/base/rotation.h"

namespace catena {

/// One row of a probe path: seconds (strictly rising), world units, a mask of the buttons held (bit 0 is button 1), and the tool's
/// orientation (world axes; within 1e-3 of unit length in the file, normalised here).
struct ProbeRow {
  double t_s = 0;
  Vec3 position{0.0};
  std::uint32_t buttons = 0;
  Quat orientation{kNoRotation};
  bool has_orientation = false;  ///< the same in all rows of a file
};

Result<std::vector<ProbeRow>> read_probe_path(const std::string& path);
Result<std::vector<ProbeRow>> parse_probe_path(std::string_view text, const std::string& file);

Result<std::vector<Vec3>> read_seeds(const std::string& path);
Result<std::vector<Vec3>> parse_seeds(std::string_view text, const std::string& file);

}  // namespace catena
