/// Strict tables of numbers: a header row with exact column names (in any order), then rows of finite numbers, separated by
/// commas. CRLF, a byte order mark, blanks around cells, a last line without its end and blank lines at the end are fine.
/// Everything else is one error "FILE:LINE: what; what was expected".
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.h"

namespace catena {

struct Table {
  std::string file;
  std::vector<std::string> columns;         ///< those asked for that the file has, in the order asked
  std::vector<std::vector<double>> values;  ///< by column, all of the same length >= 1

  std::size_t rows() const { return values.empty() ? 0 : values.front().size(); }
  int line(std::size_t row) const { return static_cast<int>(row) + 2; }  ///< blank lines occur at the end only
  const std::vector<double>* find(std::string_view column) const;        ///< nullptr if absent
};

/// An optional one may be a group, such as "qw,qx": all of its columns or none.
Result<Table> read_csv(const std::string& path, const std::vector<std::string_view>& required,
                       const std::vector<std::string_view>& optional = {});
Result<Table> parse_csv(std::string_view text, const std::string& file, const std::vector<std::string_view>& required,
                        const std::vector<std::string_view>& optional = {});

}  // namespace catena
