// SPDX-License-Identifier: MIT
#include "engine/scene/label_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <set>
#include <utility>

#include "engine/base/numbers.h"
#include "engine/base/text.h"
#include "engine/io/formats.h"

namespace catena::scene {
namespace {

using Cells = std::vector<std::string_view>;

constexpr std::uint64_t kMaxTableBytes = std::uint64_t{16} << 20;
constexpr std::size_t kMaxNameBytes = 200;
constexpr std::size_t kLutBytes = 768;

/// Splits a line at runs of blanks.
Cells words_of_line(std::string_view line) {
  Cells words;
  for (std::size_t at = 0; (at = line.find_first_not_of(" \t", at)) != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(" \t", at), line.size());
    words.push_back(line.substr(at, end - at));
    at = end;
  }
  return words;
}

/// Splits a line at a separator character, which is ignored within a quoted cell.
Cells cells_of_line(std::string_view line, char separator) {
  Cells cells;
  while (true) {
    const std::size_t begin = line.find_first_not_of(" \r");
    const std::size_t quote = begin != std::string_view::npos && line[begin] == '"' ? line.find('"', begin + 1) : std::string_view::npos;
    const std::size_t end = line.find(separator, quote == std::string_view::npos ? 0 : quote);
    cells.push_back(quote == std::string_view::npos ? trim(line.substr(0, end)) : line.substr(begin + 1, quote - begin - 1));
    if (end == std::string_view::npos) return cells;
    line.remove_prefix(end + 1);
  }
}

std::optional<double> number_of(std::string_view word) {
  const auto number = parse_double(word);
  return number && std::isfinite(*number) ? number : std::nullopt;
}

/// One row of the table, unchecked.
struct Row {
  std::string_view value, name;
  Cells color{};
};

/// Column indices of a table that has a header row.
struct Columns {
  char separator = ',';
  std::optional<std::size_t> value, name, red, green, blue;
};

std::optional<std::size_t> column_of(const Cells& cells, std::initializer_list<std::string_view> names) {
  for (const std::string_view name : names)
    for (std::size_t i = 0; i < cells.size(); ++i) {
      std::string lower(cells[i]);
      std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return c >= 'A' && c <= 'Z' ? c + 32 : c; });
      if (lower == name) return i;
    }
  return std::nullopt;
}

std::optional<Columns> columns_of(std::string_view line) {
  for (const char separator : {',', '\t', ';'}) {
    if (line.find(separator) == std::string_view::npos) continue;
    const Cells cells = cells_of_line(line, separator);
    if (number_of(cells[0])) continue;
    Columns columns{separator,
                    column_of(cells, {"index", "id", "value", "no", "number", "label"}),
                    column_of(cells, {"name", "label_name", "labelname", "structure", "region", "label"}),
                    column_of(cells, {"r", "red"}),
                    column_of(cells, {"g", "green"}),
                    column_of(cells, {"b", "blue"})};
    if (columns.value && columns.name && *columns.value != *columns.name) return columns;
  }
  return std::nullopt;
}

bool all_numbers(const Cells& words, std::size_t from, std::size_t to) {
  return std::all_of(words.begin() + static_cast<std::ptrdiff_t>(from), words.begin() + static_cast<std::ptrdiff_t>(to),
                     [](std::string_view word) { return number_of(word).has_value(); });
}

Row row_of_columns(std::string_view line, const Columns& columns) {
  const Cells cells = cells_of_line(line, columns.separator);
  const auto cell = [&](std::optional<std::size_t> i) { return i && *i < cells.size() ? cells[*i] : std::string_view(); };
  Row row{cell(columns.value), cell(columns.name)};
  if (columns.red && columns.green && columns.blue && !cell(columns.blue).empty())
    row.color = {cell(columns.red), cell(columns.green), cell(columns.blue)};
  return row;
}

/// Parses a line of a table without a header row.
Row row_of_words(std::string_view line) {
  const Cells words = words_of_line(line);
  Row row{words[0], {}};
  if (words.size() == 1) return row;
  // ITK-SNAP writes seven numbers and a name in quotes
  const std::size_t quote = line.find('"');
  if (quote != std::string_view::npos && words.size() >= 8 && all_numbers(words, 0, 7)) {
    row.name = line.substr(quote + 1, line.rfind('"') > quote ? line.rfind('"') - quote - 1 : std::string_view::npos);
    row.color = {words[1], words[2], words[3]};
    return row;
  }
  // FreeSurfer writes color and transparency in the last four columns
  if (words.size() >= 6 && all_numbers(words, words.size() - 4, words.size())) {
    const std::size_t last = words.size() - 4;
    row.name = line.substr(static_cast<std::size_t>(words[1].data() - line.data()),
                           static_cast<std::size_t>(words[last - 1].data() + words[last - 1].size() - words[1].data()));
    row.color = {words[last], words[last + 1], words[last + 2]};
    return row;
  }
  // other tables have a value and a name
  if (line.find('\t') != std::string_view::npos) {
    const Cells cells = cells_of_line(line, '\t');
    row.value = cells[0];
    row.name = cells[1];
    if (number_of(row.value) && !row.name.empty()) return row;
    row.value = words[0];
  }
  const std::size_t last = words.size() > 2 && number_of(words.back()) ? words.size() - 2 : words.size() - 1;
  row.name = line.substr(static_cast<std::size_t>(words[1].data() - line.data()),
                         static_cast<std::size_t>(words[last].data() + words[last].size() - words[1].data()));
  return row;
}

/// Returns the name, cut to the maximum number of bytes without splitting a UTF-8 character.
std::string name_within(std::string_view name) {
  name = trim(name);
  if (name.size() > kMaxNameBytes) {
    std::size_t end = kMaxNameBytes;
    while (end > 0 && (static_cast<unsigned char>(name[end]) & 0xc0) == 0x80) --end;
    name = name.substr(0, end);
  }
  return sanitize_for_terminal(name);
}

Result<LabelTable> parse_lines(std::string_view text, const std::string& file) {
  LabelTable table;
  std::vector<std::array<double, 4>> colors;  // row index, red, green, blue
  std::set<double> known;
  std::optional<Columns> columns;
  double brightest = 0;
  bool first = true;
  int number = 0;
  text = strip_bom(text);
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view raw_line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    ++number;
    const std::string_view line = trim(raw_line);
    if (line.empty() || line.front() == '#') continue;
    const auto line_error = [&](const std::string& what) { return Error{one_line(file + ":" + std::to_string(number) + ": " + what)}; };
    if (std::exchange(first, false)) {
      columns = columns_of(line);
      if (columns) continue;
    }
    const Row row = columns ? row_of_columns(line, *columns) : row_of_words(line);
    const auto value = number_of(row.value);
    if (!value || *value != std::nearbyint(*value) || std::fabs(*value) > kMaxLabelValue)
      return line_error("the row begins with " + in_quotes(row.value) + "; an integer label of magnitude at most 16777216 was expected");
    const std::string name = name_within(row.name);
    if (name.empty()) return line_error("label " + to_text(*value) + " has no name; a name was expected after the number");
    if (!known.insert(*value).second) continue;
    if (table.size() >= kMaxLabelRows)
      return line_error("the table has more than " + std::to_string(kMaxLabelRows) + " labels; a shorter table was expected");
    if (!row.color.empty()) {
      std::array<double, 4> color{double(table.size())};
      for (std::size_t i = 0; i < 3; ++i) {
        const auto part = number_of(row.color[i]);
        if (!part || *part < 0 || *part > 255)
          return line_error("label " + to_text(*value) + " has the colour component " + in_quotes(row.color[i]) +
                            "; a number from 0 to 255 was expected");
        color[i + 1] = *part;
        brightest = std::max(brightest, *part);
      }
      colors.push_back(color);
    }
    table.push_back({*value, name});
  }
  if (table.empty()) return Error{one_line(file + ": the table has no labels; rows with a number and a name were expected")};
  const double scale = columns && brightest <= 1 ? 1 : 255;
  for (const auto& c : colors)
    table[static_cast<std::size_t>(c[0])].color = Color{float(c[1] / scale), float(c[2] / scale), float(c[3] / scale)};
  std::sort(table.begin(), table.end(), [](const LabelRow& a, const LabelRow& b) { return a.value < b.value; });
  return table;
}

/// Adds the colors of a .lut file next to the table, if the table has none.
void add_lut(const std::string& path, LabelTable& table) {
  if (std::any_of(table.begin(), table.end(), [](const LabelRow& label) { return label.color.has_value(); })) return;
  const auto bytes = read_text_file(std::filesystem::path(path).replace_extension(".lut").string(), "a table of colours", kLutBytes);
  if (!bytes || bytes->size() != kLutBytes) return;
  for (LabelRow& label : table) {
    if (label.value < 0 || label.value > 255) continue;
    const auto at = static_cast<std::size_t>(label.value);
    const auto part = [&](std::size_t i) { return float(static_cast<unsigned char>((*bytes)[i * 256 + at])) / 255; };
    const Color color{part(0), part(1), part(2)};
    if (!(color == Color{})) label.color = color;  // black entries are unset
  }
}

}  // namespace

Result<LabelTable> parse_label_table(std::string_view text, const std::string& file) { return parse_lines(text, file); }

Result<LabelTable> read_label_table(const std::string& path) {
  CATENA_TRY(const std::string text, read_text_file(path, "a table of labels", kMaxTableBytes));
  CATENA_TRY(LabelTable table, parse_lines(text, path));
  add_lut(path, table);
  return table;
}

std::string find_label_table(const std::string& path) {
  std::string stem = path;
  std::vector<std::string> stems{path};
  const auto shorten = [&](std::string_view ending) {
    if (!has_extension(stem, ending)) return false;
    stem.resize(stem.size() - ending.size());
    stems.push_back(stem);
    return true;
  };
  shorten(".gz");
  const std::vector<std::string_view> endings = io::readable_extensions(io::DataKind::volume);
  (void)std::ranges::any_of(endings, shorten);
  for (const std::string& name : stems)
    for (const char* ending : {".txt", ".ctbl", ".label", ".csv", ".tsv", ".lut"}) {
      std::error_code code;
      const std::string candidate = name + ending;
      if (std::filesystem::is_regular_file(candidate, code) && read_label_table(candidate)) return candidate;
    }
  return {};
}

}  // namespace catena::scene
