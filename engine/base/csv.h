// SPDX-License-Identifier: MIT
/// Strict reader for tables of numbers (CSV): a header row with exact column names (in any order), then rows of finite numbers separated by
/// commas. CRLF line ends, a byte order mark, blanks around cells, a last line without a line end and blank lines at the end are accepted.
/// Anything else is an Error "FILE:LINE: what; what was expected". Any thread.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.h"
#include "engine/base/vec.h"

namespace catena {

/// Table of finite numbers, stored by column.
struct NumberTable {
  std::string file;  ///< file name for messages
  /// Names of the requested columns that the file has, in the order of the request.
  std::vector<std::string> columns;
  std::vector<std::vector<double>> values;  ///< values[column][row]; all columns have the same length >= 1

  /// Returns the number of rows.
  std::size_t rows() const { return values.empty() ? 0 : values.front().size(); }
  /// Returns the 1-based line of a row in the file, for messages (blank lines are allowed at the end only).
  int line_number(std::size_t row) const { return static_cast<int>(row) + 2; }
  /// Returns the values of a column; nullptr when the table has no such column.
  const std::vector<double>* find(std::string_view column) const;
};

/// Returns the text as a cell of a CSV table: in quotes if it contains a comma, a quote or a line break.
std::string quoted_csv_cell(const std::string& text);

/// Reads a table from a file, or parses it from `text` (`file` is the name for messages). Every column of `required` must be present. An
/// entry of `optional` may be a group such as "qw,qx": all of its columns must be present or none. Errors: a column that is unknown,
/// duplicate or missing; a cell that is not a finite number; a row with the wrong number of cells; no rows; a table larger than the memory
/// budget.
Result<NumberTable> read_csv(const std::string& path, const std::vector<std::string_view>& required,
                             const std::vector<std::string_view>& optional = {});
Result<NumberTable> parse_csv(std::string_view text, const std::string& file, const std::vector<std::string_view>& required,
                              const std::vector<std::string_view>& optional = {});

/// The two kinds of tables that the program reads: probe paths `t,x,y,z[,buttons][,qw,qx,qy,qz]` and seeds `x,y,z`.

/// One row of a probe path: time in seconds (strictly increasing from row to row), position in world units, bit mask of the pressed buttons
/// (bit 0 is button 1), and orientation of the tool (rotation from tool axes to world axes; the quaternion in the file must have unit
/// length within 1e-3 and is normalized here).
struct ProbePathRow {
  double t_s = 0;
  Vec3 position{0.0};
  std::uint32_t buttons = 0;
  Quat orientation{kIdentityRotation};
  bool has_orientation = false;  ///< whether the file has an orientation; the same in all rows of a file
};

/// Reads or parses a probe path. An Error names the file, the line, the problem and what was expected.
Result<std::vector<ProbePathRow>> read_probe_path(const std::string& path);
Result<std::vector<ProbePathRow>> parse_probe_path(std::string_view text, const std::string& file);

/// Reads or parses seed positions, world units. Errors as for a probe path.
Result<std::vector<Vec3>> read_seeds(const std::string& path);
Result<std::vector<Vec3>> parse_seeds(std::string_view text, const std::string& file);

}  // namespace catena
