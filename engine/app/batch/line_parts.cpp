// SPDX-License-Identifier: MIT
#include "engine/app/batch/line_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <queue>
#include <utility>

#include "engine/app/cli/io_conflicts.h"
#include "engine/base/numbers.h"
#include "engine/io/curves/write_polylines.h"

namespace catena::app {

namespace {

constexpr std::size_t kBuffers = std::size_t{64} << 20;  // bytes of the buffers of all parts together
constexpr std::size_t kMinBuffer = 4096, kMaxBuffer = std::size_t{1} << 20, kWrittenBlock = std::size_t{1} << 20;

/// The rows of a part, one after the other.
class SeedRows {
 public:
  SeedRows(Part part, std::size_t block_bytes) : lines_(std::move(part), block_bytes) {}

  /// Reads and checks the header.
  Outcome open() {
    std::string_view header;
    CATENA_TRY(const bool is_there, lines_.next(header));
    is_timed_ = is_there && std::string(header) + "\n" == curves::kTimedPolylineTableHeader;
    if (!is_there || (!is_timed_ && std::string(header) + "\n" != curves::kPolylineTableHeader))
      return wrong("the header of a table of lines");
    return advance();
  }
  /// Goes to the next row. Error: its seed is not one of the shard, or precedes that of the row before.
  Outcome advance() {
    std::string_view row;
    CATENA_TRY(has_row_, lines_.next(row));
    if (!has_row_) return Done{};
    const std::size_t comma = row.find(',');
    const auto seed = parse_integer(row.substr(0, comma));
    if (comma == std::string_view::npos || !seed || *seed < 0 || !lines_.part().shard.has(static_cast<std::size_t>(*seed)) ||
        static_cast<std::size_t>(*seed) < seed_)
      return wrong("a row of a seed of shard " + lines_.part().shard.text());
    seed_ = static_cast<std::size_t>(*seed);
    cells_ = row.substr(comma);
    return Done{};
  }
  bool has_row() const { return has_row_; }
  bool is_timed() const { return is_timed_; }  ///< The rows have times.
  std::size_t seed() const { return seed_; }
  /// The cells after the first, with the comma before them; valid until advance().
  std::string_view cells() const { return cells_; }

 private:
  Error wrong(const std::string& expected) const {
    return Error{lines_.part().path + ": is no part of a table of lines; " + expected + " was expected"};
  }

  PartLines lines_;
  bool has_row_ = false, is_timed_ = false;
  std::size_t seed_ = 0;
  std::string_view cells_;
};

}  // namespace

void write_line_part(PartWriter& part, const SeededLines& lines) {
  part.write(curves::polyline_table_header(lines.curves));
  std::string rows;
  for (std::size_t i = 0; i < lines.curves.size(); ++i) {
    rows.clear();
    curves::append_polyline_rows(rows, lines.seeds[i], *lines.curves[i]);
    part.write(rows);
  }
}

Result<MergedLines> merge_line_parts(const std::string& path) {
  CATENA_TRY(const std::vector<Part> parts, find_parts(path, "trace"));
  IoConflictChecker files;
  for (const Part& part : parts) files.add_input(part.path);
  files.add_output("OUTPUT", path);
  CATENA_CHECK(files.check());

  using Next = std::pair<std::size_t, std::size_t>;  // seed, index of the part
  std::priority_queue<Next, std::vector<Next>, std::greater<>> queue;
  std::vector<SeedRows> rows;
  rows.reserve(parts.size());
  const std::size_t block = std::clamp(kBuffers / parts.size(), kMinBuffer, kMaxBuffer);
  for (const Part& part : parts) {
    SeedRows& one = rows.emplace_back(part, block);
    CATENA_CHECK(one.open());
    if (one.has_row()) queue.emplace(one.seed(), rows.size() - 1);
  }
  if (queue.empty()) return Error{path + ": no seed of any part starts a line; seeds within the flow were expected"};

  CATENA_TRY(OutputFile out, OutputFile::open(path));
  MergedLines merged{0, 0, parts.size()};
  const bool is_timed = std::ranges::any_of(rows, [](const SeedRows& part) { return part.is_timed(); });
  std::string text = is_timed ? curves::kTimedPolylineTableHeader : curves::kPolylineTableHeader;
  for (; !queue.empty(); ++merged.lines) {
    const auto [seed, index] = queue.top();
    queue.pop();
    SeedRows& part = rows[index];
    const std::string number = std::to_string(merged.lines);
    for (; part.has_row() && part.seed() == seed; ++merged.rows) {
      text.append(number).append(part.cells()).push_back('\n');
      CATENA_CHECK(part.advance());
    }
    if (part.has_row()) queue.emplace(part.seed(), index);
    if (text.size() >= kWrittenBlock) out.write(std::exchange(text, {}));
  }
  out.write(text);
  CATENA_CHECK(out.commit());
  return merged;
}

}  // namespace catena::app
