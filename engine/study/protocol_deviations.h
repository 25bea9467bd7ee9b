// SPDX-License-Identifier: MIT
/// Checks whether rows match the study's design, which follows from the study and the subject's number alone (session.h), so that a data
/// file that was truncated, exchanged or edited is reported.
#pragma once
#include <string>
#include <vector>

#include "engine/study/trial_table.h"

namespace catena::study {

/// Returns the first value in which a row differs from this trial of its subject's session: "condition is drag, by the design none"; empty:
/// it matches.
std::string find_protocol_deviation(const Study& study, const TrialRow& row, const Trial& trial);

/// Returns one line per deviation, ordered by subject: missing trials, and rows that differ from the design. At most three differing rows
/// per subject are listed, the others are counted. Rows may be in any order. If a subject has no training rows at all, those are not
/// reported as missing. Empty: the rows match the design completely.
std::vector<std::string> find_protocol_deviations(const Study& study, const std::vector<TrialRow>& rows);

}  // namespace catena::study
