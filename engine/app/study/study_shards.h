// SPDX-License-Identifier: MIT
/// Shards of a simulated study. Each shard leaves a file in its data folder, simulated.shard-2-of-4.json, so that `study merge` recognizes
/// a missing or unfinished one. Folders without such files are merged as they are.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "engine/app/batch/shard.h"
#include "engine/study/trial_table.h"

namespace catena::app {

/// Writes the file of a shard of `subjects` subjects into a data folder.
Outcome write_shard_file(const std::string& folder, const Shard& shard, int subjects);

/// Checks that the folders together have all shards of one division, and all trials of all subjects. `trial_counts`: number of trials of
/// each subject in the folders. Error: what is missing, or folders of several divisions.
Outcome check_study_shards(const std::vector<std::string>& folders, const study::Study& study,
                           const std::map<int, std::size_t>& trial_counts);

/// Copies the recordings of a subject's trials, those that exist, from one data folder to another.
Outcome copy_recordings(const std::string& from, const std::string& to, const std::vector<study::TrialRow>& rows);

}  // namespace catena::app
