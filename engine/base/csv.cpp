#include "engine/base/csv.h"

#include <algorithm>
#include <cmath>

#include "engine/base/memory_limit.h"
#include "engine/base/numbers.h"
#include "engine/base/text.h"

namespace catena {
namespace {

constexpr std::size_t kNotAsked = static_cast<std::size_t>(-1);

/// Takes the text up to the next `separator` off the front.
std::string_view take(std::string_view& rest, char separator, bool& last) {
  const std::size_t at = rest.find(separator);
  last = at == std::string_view::npos;
  const std::string_view piece = rest.substr(0, at);
  rest.remove_prefix(last ? rest.size() : at + 1);
  return piece;
}

std::string header_words(const std::vector<std::string_view>& required, const std::vector<std::string_view>& optional) {
  std::string words;
  for (std::string_view name : required) words.append(words.empty() ? "" : ",").append(name);
  for (std::string_view name : optional) words.append("[,").append(name).append("]");
  return "\"" + words + "\"";
}

/// The columns of an optional group: "qw,qx" is two columns that come together.
std::vector<std::string_view> columns_of(std::string_view group) {
  std::vector<std::string_view> columns;
  for (bool last = false; !last;) columns.push_back(take(group, ',', last));
  return columns;
}

struct Reader {
  const std::string& file;
  const std::vector<std::string_view>& required;
  const std::vector<std::string_view>& optional;
  std::vector<std::string_view> all{};  ///< columns, in the order asked

  Error error(int line, const std::string& what) const { return Error{one_line(file + ":" + std::to_string(line) + ": " + what)}; }

  /// Names of the header in file order.
  Result<std::vector<std::string_view>> header(std::string_view line) const {
    const std::string expected = "; the header " + header_words(required, optional) + " was expected";
    std::vector<std::string_view> names;
    for (bool last = false; !last;) {
      const std::string_view name = trim(take(line, ',', last));
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

const std::vector<double>* Table::find(std::string_view column) const {
  for (std::size_t i = 0; i < columns.size(); ++i)
    if (columns[i] == column) return &values[i];
  return nullptr;
}

Result<Table> parse_csv(std::string_view text, const std::string& file, const std::vector<std::string_view>& required,
                        const std::vector<std::string_view>& optional) {
  Reader reader{file, required, optional};
  reader.all = required;
  for (std::string_view group : optional)
    for (std::string_view name : columns_of(group)) reader.all.push_back(name);
  text = without_bom(text);

  // blank lines at the end do not count
  while (!text.empty() && (text.back() == '\n' || text.back() == '\r' || text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  if (text.empty())
    return reader.error(1, "is empty; the header " + header_words(required, optional) + " and rows of numbers were expected");

  bool last_line = false;
  CATENA_TRY(const auto names, reader.header(take(text, '\n', last_line)));
  if (last_line) return reader.error(1, "holds a header only; at least one row of numbers was expected");

  // the table's columns in the order asked; where each cell of a row goes
  Table table;
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
  CATENA_CHECK(ask_for_text_memory(one_line(file + ": a table of " + std::to_string(rows) + " rows"),
                                   static_cast<double>(text.size() + rows * names.size() * sizeof(double))));
  for (auto& column : table.values) column.reserve(rows);

  for (int line = 2; !last_line; ++line) {
    std::string_view row = take(text, '\n', last_line);
    const auto cells = static_cast<std::size_t>(std::count(row.begin(), row.end(), ',')) + 1;
    if (trim(row).empty()) return reader.error(line, "is blank; " + std::to_string(names.size()) + " numbers were expected");
    if (cells != names.size())
      return reader.error(
          line, "has " + std::to_string(cells) + (cells == 1 ? " cell; " : " cells; ") + std::to_string(names.size()) + " were expected");
    bool last = false;
    for (std::size_t i = 0; i < cells; ++i) {
      const std::string_view cell = take(row, ',', last);
      const auto value = parse_double(cell);
      if (!value || !std::isfinite(*value))
        return reader.error(line, in_quotes(trim(cell)) + " in column " + in_quotes(names[i]) + "; a finite number was expected");
      table.values[slots[i]].push_back(*value);
    }
  }
  return table;
}

Result<Table> read_csv(const std::string& path, const std::vector<std::string_view>& required,
                       const std::vector<std::string_view>& optional) {
  CATENA_TRY(const std::string text, read_text(path, "a CSV file with the header " + header_words(required, optional)));
  return parse_csv(text, path, required, optional);
}

}  // namespace catena
