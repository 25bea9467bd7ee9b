// SPDX-License-Identifier: MIT
/// The folder of `catena tradeoff SCENE`: report.html, a table per curve and tradeoff.json.
#pragma once
#include "engine/app/tuning/report/report.h"
#include "engine/app/tuning/report/results_dir.h"

namespace catena::app::tuning {

/// Draws the plots, writes all files into the folder and commits them. `other`: report to compare with; may be null.
Outcome write_report(ResultsDir& folder, const Report& report, const Report* other);
/// Prints the choice of each curve, what was not measured, and the names of the files in the folder `path`.
void print_report(const ResultsDir& folder, const std::string& path, const Report& report);

}  // namespace catena::app::tuning
