/// Strict tables of numbers: a header row with exact column names (in any order), then rows of finite numbers, separated by
/// commas. CRLF, a byte order mark, blanks around cells, a last line without its end and blank lines at the end are fine.
/// Everything else is one error "FILE:LINE: what; what was expected".
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.h"
#include "engine/base/vec.h"

namespace catena {

struct NumberTable {
  std::string file;
  std::vector<std::string> columns;         ///< those asked for that the file has, in the order asked
  std::vector<std::vector<double>> values;  ///< by column, all of the same length >= 1

  std::size_t rows() const { return values.empty() ? 0 : values.front().size(); }
  int line_number(std::size_t row) const { return static_cast<int>(row) + 2; }  ///< blank lines occur at the end only
  const std::vector<double>* find(std::string_view column) const;               ///< nullptr if absent
};

/// An optional one may be a group, such as "qw,qx": all of its columns or none.
Result<NumberTable> read_csv(const std::string& path, const std::vector<std::string_view>& required,
                             const std::vector<std::string_view>& optional = {});
Result<NumberTable> parse_csv(std::string_view text, const std::string& file, const std::vector<std::string_view>& required,
                              const std::vector<std::string_view>& optional = {});

/// The two tables that the program reads: probe paths `t,x,y,z[,buttons][,qw,qx,qy,qz]` and seeds `x,y,z`.

/// One row of a probe path: seconds (strictly rising), world units, a mask of the buttons held (bit 0 is button 1), and the tool's
/// orientation (world axes; within 1e-3 of unit length in the file, normalised here).
struct ProbePathRow {
  double t_s = 0;
  Vec3 position{0.0};
  std::uint32_t buttons = 0;
  Quat orientation{kIdentityRotation};
  bool has_orientation = false;  ///< the same in all rows of a file
};

Result<std::vector<ProbePathRow>> read_probe_path(const std::string& path);
Result<std::vector<ProbePathRow>> parse_probe_path(std::string_view text, const std::string& file);

Result<std::vector<Vec3>> read_seeds(const std::string& path);
Result<std::vector<Vec3>> parse_seeds(std::string_view text, const std::string& file);

}  // namespace catena
