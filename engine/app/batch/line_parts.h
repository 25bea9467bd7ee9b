// SPDX-License-Identifier: MIT
/// Parts of the table of lines that `catena trace --shard` writes. A part has the columns of the table; its column "line" is the index of
/// the seed. The whole numbers the lines from 0 in the order of their seeds, without the seeds of a pattern that start no line.
#pragma once
#include <string>
#include <vector>

#include "engine/app/batch/part_file.h"
#include "engine/geometry/flow/curve.h"

namespace catena::app {

/// Lines and the indices of their seeds among all seeds, ascending.
struct SeededLines {
  std::vector<flow::CurvePtr> curves;
  std::vector<std::size_t> seeds;
};

/// Writes the lines as the rows of a part, without committing it.
void write_line_part(PartWriter& part, const SeededLines& lines);

/// What a merged table has.
struct MergedLines {
  std::size_t lines = 0, rows = 0, parts = 0;
};
/// Merges all parts of the table `path` and writes it: the bytes of one run without shards. Memory does not grow with the number of rows.
/// Error: as find_parts(), a part that is not such a table, or no line in any part.
Result<MergedLines> merge_line_parts(const std::string& path);

}  // namespace catena::app
