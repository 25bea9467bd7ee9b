// SPDX-License-Identifier: MIT
/// Parts of the report that `catena tradeoff --shard` writes into its folder: FOLDER/tradeoff.shard-2-of-4.part. An item is a measurement;
/// a part has a line that states the measurements of its curves, then the report of them as JSON.
#pragma once
#include <string>
#include <vector>

#include "engine/app/batch/part_file.h"
#include "engine/app/tuning/report/report.h"

namespace catena::app {

/// A report, and the measurement of each of its curves and of each sentence in Report::skipped: an index in the list of the measurements
/// that were asked for, ascending; -1: the preparation of all measurements.
struct MeasuredReport {
  tuning::Report report;
  std::vector<int> curve_items, skipped_items;
};

/// Name from which the names of a folder's parts are made, for PartWriter::open() and find_parts().
std::string tradeoff_part_base(const std::string& folder);
/// Writes the report as a part, without committing it.
void write_tradeoff_part(PartWriter& part, const MeasuredReport& measured);

/// Merges all parts in the folder into the report that one process would have written, and prints it. Error: as find_parts(), or no part
/// has a curve.
Outcome merge_tradeoff_parts(const std::string& folder);

}  // namespace catena::app
