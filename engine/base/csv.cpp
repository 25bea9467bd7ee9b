// SPDX-License-Identifier: MIT
#include "engine/base/csv.h"

#include <algorithm>
#include <cmath>

#include "engine/base/memory_limit.h"
#include "engine/base/numbers.h"
#include "engine/base/text.h"

namespace catena {
namespace {

constexpr std::size_t kNotAsked = static_cast<std::size_t>(-1);

/// Removes the text up to the next `separator` from the front of `remaining` and returns it.
std::string_view take_piece(std::string_view& remaining, char separator, bool& last) {
  const std::size_t at = remaining.find(separator);
  last = at == std::string_view::npos;
  const std::string_view piece = remaining.substr(0, at);
  remaining.remove_prefix(last ? remaining.size() : at + 1);
  return piece;
}

std::string expected_header(const std::vector<std::string_view>& required, const std::vector<std::string_view>& optional) {
  std::string text;
  for (std::string_view name : required) text.append(text.empty() ? "" : ",").append(name);
  for (std::string_view name : optional) text.append("[,").append(name).append("]");
  return "\"" + text + "\"";
}

/// Splits an optional group into its columns: "qw,qx" is two columns that must appear together.
std::vector<std::string_view> columns_of(std::string_view group) {
  std::vector<std::string_view> columns;
  for (bool last = false; !last;) columns.push_back(take_piece(group, ',', last));
  return columns;
}

struct Reader {
  const std::string& file;
  const std::vector<std::string_view>& required;
  const std::vector<std::string_view>& optional;
  std::vector<std::string_view> all{};  ///< names of all requested columns, in the requested order

  Error error(int line, const std::string& what) const { return Error{one_line(file + ":" + std::to_string(line) + ": " + what)}; }

  /// Returns the column names of the header line in file order; an Error if they are not the expected ones.
  Result<std::vector<std::string_view>> header(std::string_view line) const {
    const std::string expected = "; the header " + expected_header(required, optional) + " was expected";
    std::vector<std::string_view> names;
    for (bool last = false; !last;) {
      const std::string_view name = trim(take_piece(line, ',', last));
      if (std::count(all.begin(), all.end(), name) == 0) return error(1, "unknown column " + in_quotes(name) + expected);
      if (std::count(names.begin(), names.end(), name) > 0) return error(1, "duplicate column " + in_quotes(name) + expected);
      names.push_back(name);
    }
    const auto absent = [&](std::string_view name) { return std::count(names.begin(), names.end(), name) == 0; };
    const auto missing = [&](std::string_view name) { return error(1, "column " + in_quotes(name) + " is missing" + expected); };
    for (std::string_view name : required)
      if (absent(name)) return missing(name);
    for (std::string_view group : optional) {
      const std::vector<std::string_view> columns = columns_of(group);
      const auto lacking = std::find_if(columns.begin(), columns.end(), absent);
      if (lacking != columns.end() && !std::all_of(columns.begin(), columns.end(), absent)) return missing(*lacking);
    }
    return names;
  }
};

}  // namespace

const std::vector<double>* NumberTable::find(std::string_view column) const {
  for (std::size_t i = 0; i < columns.size(); ++i)
    if (columns[i] == column) return &values[i];
  return nullptr;
}

Result<NumberTable> parse_csv(std::string_view text, const std::string& file, const std::vector<std::string_view>& required,
                              const std::vector<std::string_view>& optional) {
  Reader reader{file, required, optional};
  reader.all = required;
  for (std::string_view group : optional)
    for (std::string_view name : columns_of(group)) reader.all.push_back(name);
  text = strip_bom(text);

  // blank lines at the end are ignored
  while (!text.empty() && (text.back() == '\n' || text.back() == '\r' || text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  if (text.empty())
    return reader.error(1, "is empty; the header " + expected_header(required, optional) + " and rows of numbers were expected");

  bool last_line = false;
  CATENA_TRY(const auto names, reader.header(take_piece(text, '\n', last_line)));
  if (last_line) return reader.error(1, "holds a header only; at least one row of numbers was expected");

  // columns in the requested order; `slots` maps each cell of a row to its column
  NumberTable table;
  table.file = file;
  std::vector<std::size_t> slots(names.size(), kNotAsked);
  for (std::string_view name : reader.all) {
    const auto at = std::find(names.begin(), names.end(), name);
    if (at == names.end()) continue;
    slots[static_cast<std::size_t>(at - names.begin())] = table.columns.size();
    table.columns.emplace_back(name);
  }
  table.values.resize(table.columns.size());
  const auto rows = static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')) + 1;
  CATENA_CHECK(check_text_memory_available(one_line(file + ": a table of " + std::to_string(rows) + " rows"),
                                           static_cast<double>(text.size() + rows * names.size() * sizeof(double))));
  for (auto& column : table.values) column.reserve(rows);

  for (int line = 2; !last_line; ++line) {
    std::string_view row = take_piece(text, '\n', last_line);
    const auto cells = static_cast<std::size_t>(std::count(row.begin(), row.end(), ',')) + 1;
    if (trim(row).empty()) return reader.error(line, "is blank; " + std::to_string(names.size()) + " numbers were expected");
    if (cells != names.size())
      return reader.error(
          line, "has " + std::to_string(cells) + (cells == 1 ? " cell; " : " cells; ") + std::to_string(names.size()) + " were expected");
    bool last = false;
    for (std::size_t i = 0; i < cells; ++i) {
      const std::string_view cell = take_piece(row, ',', last);
      const auto value = parse_double(cell);
      if (!value || !std::isfinite(*value))
        return reader.error(line, in_quotes(trim(cell)) + " in column " + in_quotes(names[i]) + "; a finite number was expected");
      table.values[slots[i]].push_back(*value);
    }
  }
  return table;
}

std::string quoted_csv_cell(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

Result<NumberTable> read_csv(const std::string& path, const std::vector<std::string_view>& required,
                             const std::vector<std::string_view>& optional) {
  CATENA_TRY(const std::string text, read_text_file(path, "a CSV file with the header " + expected_header(required, optional)));
  return parse_csv(text, path, required, optional);
}

namespace {

Error row_error(const NumberTable& table, std::size_t row, const std::string& what) {
  return Error{table.file + ":" + std::to_string(table.line_number(row)) + ": " + what};
}

Outcome read_orientation(const NumberTable& table, std::size_t row, ProbePathRow& to) {
  const std::vector<double>* w = table.find("qw");
  if (w == nullptr) return Done{};
  const Quat q((*w)[row], (*table.find("qx"))[row], (*table.find("qy"))[row], (*table.find("qz"))[row]);
  const double length = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  if (!(std::fabs(length - 1) <= 1e-3))
    return row_error(table, row, "qw,qx,qy,qz has the length " + to_text(length) + "; a unit quaternion was expected");
  to.orientation = normalized(q);
  to.has_orientation = true;
  return Done{};
}

Vec3 position_of(const NumberTable& table, std::size_t first_column, std::size_t row) {
  return {table.values[first_column][row], table.values[first_column + 1][row], table.values[first_column + 2][row]};
}

/// Checks the memory budget for the rows of a table. The rows exist at the same time as the table; later, without the table, at the same
/// time as at most kLater bytes for each row (a sample for the tick and the results of that tick).
Outcome ask_for_rows(const NumberTable& table, std::size_t row_bytes) {
  constexpr std::size_t kLater = 128;
  return check_text_memory_available(
      one_line(table.file + ": a table of " + std::to_string(table.rows()) + " rows"),
      static_cast<double>(table.rows() * (row_bytes + std::max(kLater, table.columns.size() * sizeof(double)))));
}

Result<std::vector<ProbePathRow>> probe_rows(const NumberTable& table) {
  CATENA_CHECK(ask_for_rows(table, sizeof(ProbePathRow)));
  const std::vector<double>& t = table.values[0];
  const std::vector<double>* buttons = table.find("buttons");
  std::vector<ProbePathRow> rows(table.rows());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (i > 0 && !(t[i] > t[i - 1]))
      return row_error(table, i, "t is " + to_text(t[i]) + " after " + to_text(t[i - 1]) + "; strictly rising t was expected");
    rows[i].t_s = t[i];
    rows[i].position = position_of(table, 1, i);
    CATENA_CHECK(read_orientation(table, i, rows[i]));
    if (buttons == nullptr) continue;
    const double mask = (*buttons)[i];
    if (!(mask >= 0 && mask <= 4294967295.0 && std::floor(mask) == mask))
      return row_error(table, i, "buttons is " + to_text(mask) + "; a whole number from 0 to 4294967295 was expected");
    rows[i].buttons = static_cast<std::uint32_t>(mask);
  }
  return rows;
}

Result<std::vector<Vec3>> seed_rows(const NumberTable& table) {
  CATENA_CHECK(ask_for_rows(table, sizeof(Vec3)));
  std::vector<Vec3> seeds(table.rows());
  for (std::size_t i = 0; i < seeds.size(); ++i) seeds[i] = position_of(table, 0, i);
  return seeds;
}

}  // namespace

Result<std::vector<ProbePathRow>> read_probe_path(const std::string& path) {
  CATENA_TRY(const NumberTable table, read_csv(path, {"t", "x", "y", "z"}, {"buttons", "qw,qx,qy,qz"}));
  return probe_rows(table);
}

Result<std::vector<ProbePathRow>> parse_probe_path(std::string_view text, const std::string& file) {
  CATENA_TRY(const NumberTable table, parse_csv(text, file, {"t", "x", "y", "z"}, {"buttons", "qw,qx,qy,qz"}));
  return probe_rows(table);
}

Result<std::vector<Vec3>> read_seeds(const std::string& path) {
  CATENA_TRY(const NumberTable table, read_csv(path, {"x", "y", "z"}));
  return seed_rows(table);
}

Result<std::vector<Vec3>> parse_seeds(std::string_view text, const std::string& file) {
  CATENA_TRY(const NumberTable table, parse_csv(text, file, {"x", "y", "z"}));
  return seed_rows(table);
}

}  // namespace catena
