/// Whether rows are those of the study's design, which follows from the study and the subject's number alone (session.h): of a sheet that
/// was cut short, exchanged or changed by hand somebody must hear.
#pragma once
#include <string>
#include <vector>

#include "engine/study/trial_table.h"

namespace catena::study {

/// What a row says that this trial of its subject's session does not: "condition is drag, by the design none"; empty: nothing.
std::string find_protocol_deviation(const Study& study, const TrialRow& row, const Trial& trial);

/// A line each, by subject: trials that are missing, and rows that say something else than the design. A few of a subject, the rest
/// counted. Rows in any order; without training rows those are not missed. Empty: the rows are the design's, whole.
std::vector<std::string> find_protocol_deviations(const Study& study, const std::vector<TrialRow>& rows);

}  // namespace catena::study
