#include "engine/base/csv_paths.h"

#include <algorithm>
#include <cmath>

#include "engine/base/csv.h"
#include "engine/base/memory_limit.h"
#include "engine/base/numbers.h"
#include "engine/base/text.h"

namespace catena {
namespace {

Error row_error(const Table& table, std::size_t row, const std::string& what) {
  return Error{table.file + ":" + std::to_string(table.line(row)) + ": " + what};
}

Outcome read_orientation(const Table& table, std::size_t row, ProbeRow& to) {
  const std::vector<double>* w = table.find("qw");
  if (w == nullptr) return Done{};
  const Quat q((*w)[row], (*table.find("qx"))[row], (*table.find("qy"))[row], (*table.find("qz"))[row]);
  const double length = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  if (!(std::fabs(length - 1) <= 1e-3))
    return row_error(table, row, "qw,qx,qy,qz has the length " + to_text(length) + "; a unit quaternion was expected");
  to.orientation = normalised(q);
  to.has_orientation = true;
  return Done{};
}

Vec3 position_of(const Table& table, std::size_t first_column, std::size_t row) {
  return {table.values[first_column][row], table.values[first_column + 1][row], table.values[first_column + 2][row]};
}

/// Beside the table, and later without it beside what becomes of each row: a sample for the tick and the figures of that tick.
Outcome ask_for_rows(const Table& table, std::size_t row_bytes) {
  constexpr std::size_t kLater = 128;
  return ask_for_text_memory(one_line(table.file + ": a table of " + std::to_string(table.rows()) + " rows"),
                             static_cast<double>(table.rows() * (row_bytes + std::max(kLater, table.columns.size() * sizeof(double)))));
}

Result<std::vector<ProbeRow>> probe_rows(const Table& table) {
  CATENA_CHECK(ask_for_rows(table, sizeof(ProbeRow)));
  const std::vector<double>& t = table.values[0];
  const std::vector<double>* buttons = table.find("buttons");
  std::vector<ProbeRow> rows(table.rows());
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

Result<std::vector<Vec3>> seed_rows(const Table& table) {
  CATENA_CHECK(ask_for_rows(table, sizeof(Vec3)));
  std::vector<Vec3> seeds(table.rows());
  for (std::size_t i = 0; i < seeds.size(); ++i) seeds[i] = position_of(table, 0, i);
  return seeds;
}

}  // namespace

Result<std::vector<ProbeRow>> read_probe_path(const std::string& path) {
  CATENA_TRY(const Table table, read_csv(path, {"t", "x", "y", "z"}, {"buttons", "qw,qx,qy,qz"}));
  return probe_rows(table);
}

Result<std::vector<ProbeRow>> parse_probe_path(std::string_view text, const std::string& file) {
  CATENA_TRY(const Table table, parse_csv(text, file, {"t", "x", "y", "z"}, {"buttons", "qw,qx,qy,qz"}));
  return probe_rows(table);
}

Result<std::vector<Vec3>> read_seeds(const std::string& path) {
  CATENA_TRY(const Table table, read_csv(path, {"x", "y", "z"}));
  return seed_rows(table);
}

Result<std::vector<Vec3>> parse_seeds(std::string_view text, const std::string& file) {
  CATENA_TRY(const Table table, parse_csv(text, file, {"x", "y", "z"}));
  return seed_rows(table);
}

}  // namespace catena
