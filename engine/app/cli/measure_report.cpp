// SPDX-License-Identifier: MIT
#include "engine/app/cli/measure_report.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/app/cli/json_writer.h"
#include "engine/base/csv.h"
#include "engine/base/numbers.h"
#include "engine/base/text.h"

namespace catena::app {

namespace {

constexpr int kReportDigits = 7;

/// `number` converts a number; `empty` stands for an empty cell.
template <class Number>
std::string cell_text(const MeasureCell& cell, const Number& number, const std::string& empty) {
  switch (cell.kind) {
    case MeasureCell::Kind::text:
      return cell.text;
    case MeasureCell::Kind::count:
      return std::to_string(cell.count);
    case MeasureCell::Kind::number:
      return number(cell.number);
    case MeasureCell::Kind::truth:
      return cell.count != 0 ? "yes" : "no";
    case MeasureCell::Kind::empty:
      break;
  }
  return empty;
}

std::string readable_cell(const MeasureCell& cell) {
  return sanitize_for_terminal(cell_text(
      cell, [](double v) { return format_readable(v, kReportDigits); }, "-"));
}

std::string json_cell(const MeasureCell& cell) {
  if (cell.kind == MeasureCell::Kind::text) return to_json_value(cell.text);
  if (cell.kind == MeasureCell::Kind::truth) return to_json_value(cell.count != 0);
  return cell_text(
      cell, [](double v) { return to_json_value(v); }, "null");
}

std::string csv_cell(const MeasureCell& cell) {
  return quoted_csv_cell(cell_text(
      cell, [](double v) { return to_text(v); }, ""));
}

std::string with_unit(const MeasureFact& fact) { return fact.unit.empty() ? fact.name : fact.name + " [" + fact.unit + "]"; }

/// Number of characters of UTF-8 text.
std::size_t text_width(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; }));
}

}  // namespace

std::string format_report(const MeasureReport& report) {
  std::string out;
  std::size_t name_width = 0;
  for (const MeasureFact& fact : report.facts) name_width = std::max(name_width, fact.name.size());
  for (const MeasureFact& fact : report.facts) {
    const std::string unit = fact.unit.empty() ? "" : " " + sanitize_for_terminal(fact.unit);
    out += fmt::format("{:<{}}  {}{}\n", fact.name, name_width, readable_cell(fact.value), unit);
  }
  std::vector<std::vector<std::string>> lines(1);
  for (const MeasureFact& column : report.columns) lines.front().push_back(sanitize_for_terminal(with_unit(column)));
  for (const auto& row : report.rows) {
    lines.emplace_back();
    for (const MeasureCell& cell : row) lines.back().push_back(readable_cell(cell));
  }
  std::vector<std::size_t> widths(report.columns.size(), 0);
  for (const auto& line : lines)
    for (std::size_t c = 0; c < line.size(); ++c) widths[c] = std::max(widths[c], text_width(line[c]));
  if (!report.facts.empty() && !report.rows.empty()) out += '\n';
  for (const auto& line : lines) {
    if (report.rows.empty()) break;
    for (std::size_t c = 0; c < line.size(); ++c) {
      const bool is_text = !report.rows.empty() && report.rows.front()[c].kind == MeasureCell::Kind::text;
      const std::string padding(widths[c] - text_width(line[c]), ' ');
      const bool is_last = c + 1 == line.size();
      out += (c > 0 ? "  " : "") + (is_text ? line[c] + (is_last ? "" : padding) : padding + line[c]);
    }
    out += '\n';
  }
  for (const std::string& note : report.notes) out += "note: " + sanitize_for_terminal(note) + "\n";
  return out;
}

std::string report_to_json(const MeasureReport& report) {
  JsonObject out, units;
  std::vector<std::string> rows, notes;
  out.add("kind", report.kind).add_if_not_empty("file", report.file);
  for (const MeasureFact& fact : report.facts) out.add_raw(fact.name, json_cell(fact.value));
  for (const auto* named : {&report.facts, &report.columns})
    for (const MeasureFact& one : *named) units.add_if_not_empty(one.name, one.unit);
  for (const auto& row : report.rows) {
    JsonObject cells;
    for (std::size_t c = 0; c < row.size(); ++c) cells.add_raw(report.columns[c].name, json_cell(row[c]));
    rows.push_back(cells.text());
  }
  for (const std::string& note : report.notes) notes.push_back(to_json_value(note));
  return out.add_raw("units", units.text()).add_raw("rows", json_array(rows)).add_raw("notes", json_array(notes)).text();
}

std::string report_to_csv(const MeasureReport& report) {
  std::string out;
  for (std::size_t c = 0; c < report.columns.size(); ++c) out += (c > 0 ? "," : "") + report.columns[c].name;
  out += '\n';
  for (const auto& row : report.rows) {
    for (std::size_t c = 0; c < row.size(); ++c) out += (c > 0 ? "," : "") + csv_cell(row[c]);
    out += '\n';
  }
  return out;
}

}  // namespace catena::app
