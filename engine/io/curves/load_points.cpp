// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/base/numbers.h"
#include "engine/base/text.h"
#include "engine/io/curves/load_points.h"
#include "engine/io/curves/write_polylines.h"
#include "engine/io/formats.h"
#include "engine/io/parse_file.h"

namespace catena::curves {
namespace {

constexpr double kMaxPoint = 1e15;
constexpr std::size_t kMaxColumns = 256;
constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

/// Splits a line into cells at the separator; the separator ' ' stands for any run of blanks.
void split(std::string_view line, char separator, std::vector<std::string_view>& cells) {
  cells.clear();
  while (separator == ' ') {
    const std::size_t begin = line.find_first_not_of(" \t");
    if (begin == std::string_view::npos) return;
    const std::size_t end = std::min(line.find_first_of(" \t", begin), line.size());
    cells.push_back(line.substr(begin, end - begin));
    line.remove_prefix(end);
    if (cells.size() > kMaxColumns) return;
  }
  for (std::size_t end = 0; end != std::string_view::npos && cells.size() <= kMaxColumns; line.remove_prefix(end + 1)) {
    end = line.find(separator);
    cells.push_back(trim(line.substr(0, end)));
    if (end == std::string_view::npos) return;
  }
}

std::string_view unquoted(std::string_view cell) {
  return cell.size() >= 2 && cell.front() == '"' && cell.back() == '"' ? trim(cell.substr(1, cell.size() - 2)) : cell;
}

bool is_axis(std::string_view name, char lower_case) { return name.size() == 1 && (name[0] | 0x20) == lower_case; }

class TableReader {
 public:
  TableReader(std::string_view text, const std::string& name) : text_(strip_bom(text)), name_(name) {}

  Result<PointSet> read() {
    CATENA_CHECK(read_header());
    const std::size_t rows = static_cast<std::size_t>(std::count(text_.begin() + static_cast<std::ptrdiff_t>(at_), text_.end(), '\n')) + 1;
    if (rows > kMaxPoints) return failed(fmt::format("the table has {} lines; at most {} points were expected", rows, kMaxPoints));
    CATENA_CHECK(check_text_memory_available(
        one_line(fmt::format("{}: {} points", name_, rows)),
        static_cast<double>(rows) * static_cast<double>(sizeof(Vec3) + sizeof(glm::vec3) + columns_.size() * sizeof(float))));
    std::string_view line;
    while (next(line)) {
      if (trim(line).empty()) continue;
      CATENA_CHECK(read_row(line, rows));
    }
    if (places_.empty()) return failed("the table has no rows after the column names; rows of numbers were expected");
    set_.set_positions(places_);
    return std::move(set_);
  }

 private:
  struct Column {
    std::size_t cell;
    std::size_t values;
  };
  Error failed(const std::string& what) const { return Error{one_line(fmt::format("{}:{}: {}", name_, line_, what))}; }

  bool next(std::string_view& line) {
    if (at_ >= text_.size()) return false;
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    line = text_.substr(at_, end - at_);
    if (line.ends_with('\r')) line.remove_suffix(1);
    at_ = std::min(end + 1, text_.size());
    ++line_;
    return true;
  }

  Outcome read_header() {
    std::string_view line;
    while (next(line) && trim(line).empty()) {
    }
    for (const char separator : {',', ';', '\t', ' '})
      if (separator_ == 0 && line.find(separator) != std::string_view::npos) separator_ = separator;
    if (separator_ == 0) separator_ = ' ';
    if (line.starts_with('#')) line.remove_prefix(1);
    split(line, separator_, cells_);
    if (cells_.size() > kMaxColumns)
      return failed(fmt::format("the table has more than {0} columns; {0} or fewer were expected", kMaxColumns));
    for (std::string_view& cell : cells_) cell = unquoted(cell);
    for (int i = 0; i < 3; ++i) {
      const auto is = [&](std::string_view cell) { return is_axis(cell, "xyz"[i]); };
      const auto found = std::find_if(cells_.begin(), cells_.end(), is);
      if (found == cells_.end())
        return failed(fmt::format("there is no column {}: the first line is {}; a table of points with columns x, y, z was expected",
                                  "xyz"[i], in_quotes(line)));
      if (std::find_if(found + 1, cells_.end(), is) != cells_.end())
        return failed(fmt::format("there are two columns {}; one was expected", "xyz"[i]));
      axes_[i] = static_cast<std::size_t>(found - cells_.begin());
    }
    for (const std::string_view cell : cells_) names_.push_back(sanitize_for_terminal(cell));
    return Done{};
  }

  /// Chooses the columns that contain numbers, by the first row.
  void choose_columns(std::size_t rows) {
    std::string words;
    for (std::size_t k = 0; k < names_.size(); ++k) {
      if (std::find(std::begin(axes_), std::end(axes_), k) != std::end(axes_)) continue;
      if (!unquoted(cells_[k]).empty() && !parse_double(unquoted(cells_[k]))) {
        words += (words.empty() ? "" : ", ") + in_quotes(names_[k]);
        continue;
      }
      columns_.push_back(k);
      set_.values.push_back({names_[k].empty() ? fmt::format("column_{}", k + 1) : names_[k], {}});
      set_.values.back().values.reserve(std::min<std::size_t>(rows, 1 << 20));
    }
    if (!words.empty()) set_.note = "columns without numbers were left out: " + words;
  }

  Outcome read_row(std::string_view line, std::size_t rows) {
    split(line, separator_, cells_);
    if (cells_.size() != names_.size())
      return failed(fmt::format("the row has {} cells; {} were expected, one for each column name", cells_.size(), names_.size()));
    if (places_.empty()) choose_columns(rows);
    Vec3 p;
    for (int i = 0; i < 3; ++i) {
      const std::string_view cell = unquoted(cells_[axes_[i]]);
      const auto number = parse_double(cell);
      if (!number || !(std::fabs(*number) <= kMaxPoint))
        return failed(fmt::format("{} is {}; a number up to 1e15 in size was expected", "xyz"[i], in_quotes(cell)));
      p[i] = *number;
    }
    for (std::size_t k = 0; k < columns_.size(); ++k) {
      const std::string_view cell = unquoted(cells_[columns_[k]]);
      const auto number = parse_double(cell);
      if (!number && !cell.empty())
        return failed(fmt::format("{} is {}; a number or an empty cell was expected", in_quotes(names_[columns_[k]]), in_quotes(cell)));
      const double value = number.value_or(kNone);
      set_.values[k].values.push_back(std::fabs(value) <= kMaxValue ? static_cast<float>(value) : kNone);
    }
    places_.push_back(p);
    return Done{};
  }

  static constexpr double kMaxValue = 1e30;
  std::string_view text_;
  const std::string& name_;
  std::size_t at_ = 0;
  int line_ = 0;
  char separator_ = 0;
  std::vector<std::string_view> cells_;
  std::vector<std::string> names_;
  std::size_t axes_[3] = {};
  std::vector<std::size_t> columns_;
  std::vector<Vec3> places_;
  PointSet set_;
};

}  // namespace

Result<PointSet> read_table(std::string_view text, const std::string& name) { return TableReader(text, name).read(); }

Result<PointSet> parse_points(std::string_view text, const std::string& name) {
  CATENA_TRY(PointSet set, read_table(text, name));
  return complete_points(std::move(set), name);
}

Result<PointSetPtr> load_points(const std::string& path, int step) {
  const io::Format* format = io::find_reader(path, io::DataKind::points);
  if (format == nullptr)
    return Error{one_line(path + ": has an unknown file type; " + io::describe_expected(io::DataKind::points) + " was expected")};
  CATENA_TRY(PointSet set, format->read_points(path, step));
  return PointSetPtr(std::make_shared<PointSet>(complete_points(std::move(set), path)));
}

}  // namespace catena::curves

namespace catena::io {

Format csv_format() {
  return {.name = "Comma-separated table",
          .extensions = {".csv"},
          .read_points = parse_file<curves::read_table, DataKind::points, 1>,
          .write_curves = curves::write_polylines_csv};
}

Format table_format() {
  return {.name = "Table with other separators",
          .extensions = {".tsv", ".xyz"},
          .read_points = parse_file<curves::read_table, DataKind::points, 1>};
}

}  // namespace catena::io
