/// The two tables that the program reads: probe paths `t,x,y,z[,buttons]` and seeds `x,y,z`.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.h"
#include "engine/base/vec.h"

namespace catena {

/// One row of a probe path: seconds (strictly rising), world units, a mask of the buttons held (bit 0 is button 1).
struct ProbeRow {
  double t_s = 0;
  Vec3 position{0.0};
  std::uint32_t buttons = 0;
};

Result<std::vector<ProbeRow>> read_probe_path(const std::string& path);
Result<std::vector<ProbeRow>> parse_probe_path(std::string_view text, const std::string& file);

Result<std::vector<Vec3>> read_seeds(const std::string& path);
Result<std::vector<Vec3>> parse_seeds(std::string_view text, const std::string& file);

}  // namespace catena
