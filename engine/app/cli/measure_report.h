// SPDX-License-Identifier: MIT
/// Result of `catena measure`: some single values and a table, printed for people, as JSON or as CSV.
#pragma once
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace catena::app {

/// A cell: empty, a text, a count, a number (empty unless finite) or a truth value.
struct MeasureCell {
  enum class Kind { empty, text, count, number, truth };
  Kind kind = Kind::empty;
  std::string text{};
  std::uint64_t count = 0;  ///< also of a truth value: 0 or 1
  double number = 0;

  MeasureCell() = default;
  MeasureCell(std::string word) : kind(Kind::text), text(std::move(word)) {}
  MeasureCell(std::uint64_t n) : kind(Kind::count), count(n) {}
  MeasureCell(double value) : kind(std::isfinite(value) ? Kind::number : Kind::empty), number(value) {}
  MeasureCell(bool truth) : kind(Kind::truth), count(truth ? 1 : 0) {}
};

/// A named value, or the name of a column; `unit` may be empty.
struct MeasureFact {
  std::string name;
  MeasureCell value{};
  std::string unit{};
};

struct MeasureReport {
  std::string kind, file;  ///< "labels", "level", ...; data file, or empty
  std::vector<MeasureFact> facts, columns;
  std::vector<std::vector<MeasureCell>> rows;  ///< as many cells as columns
  std::vector<std::string> notes;              ///< sentences about the method and its limits

  void add(const std::string& name, MeasureCell value, const std::string& unit = {}) { facts.push_back({name, std::move(value), unit}); }
  void add_column(const std::string& name, const std::string& unit = {}) { columns.push_back({name, {}, unit}); }
};

/// Returns the report as a readable table, which ends in a newline; all text is safe to print.
std::string format_report(const MeasureReport& report);
/// Returns {"kind", "file", FACTS..., "units": {NAME: UNIT}, "rows": [{COLUMN: CELL}], "notes"} on one line; empty cells are null.
std::string report_to_json(const MeasureReport& report);
/// Returns the table as CSV with a row of column names; numbers read back exactly, empty cells are empty.
std::string report_to_csv(const MeasureReport& report);

}  // namespace catena::app
