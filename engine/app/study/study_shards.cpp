// SPDX-License-Identifier: MIT
#include "engine/app/study/study_shards.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "engine/base/json.h"
#include "engine/base/output_file.h"
#include "engine/base/system_failure.h"

namespace catena::app {

namespace {

namespace fs = std::filesystem;

/// Files of shards are named as the parts of this file.
std::string shard_file_base(const std::string& folder) { return (fs::path(folder) / "simulated.json").string(); }

/// The division that a file states.
struct Division {
  std::size_t count = 0;
  int subjects = 0;
  bool operator==(const Division&) const = default;
};

/// Collects the shards whose files are in the folder.
Outcome add_shards_in(const std::string& folder, std::optional<Division>& division, std::set<std::size_t>& shards) {
  std::error_code code;
  for (fs::directory_iterator it(folder, code), end; !code && it != end; it.increment(code)) {
    const auto shard = shard_of_part(shard_file_base(folder), it->path().filename().string());
    if (!shard) continue;
    CATENA_TRY(const json::Node root, json::read(it->path().string()));
    CATENA_TRY(const int subjects, json::get_integer(root, "subjects", 0, 1, study::kMaxSubject));
    const Division one{shard->count, subjects};
    if (division && *division != one)
      return Error{
          fmt::format("{}: has shard {} of {} subjects, another folder has one of {} shards of {} subjects; one division was expected",
                      folder, shard->text(), subjects, division->count, division->subjects)};
    division = one;
    shards.insert(shard->index);
  }
  if (code) return system_error(folder + ": cannot read the folder", code.value());
  return Done{};
}

}  // namespace

Outcome write_shard_file(const std::string& folder, const Shard& shard, int subjects) {
  CATENA_TRY(OutputFile file, OutputFile::open(part_path(shard_file_base(folder), shard)));
  file.write(fmt::format("{{\"shard\": \"{}\", \"subjects\": {}}}\n", shard.text(), subjects));
  return file.commit();
}

Outcome check_study_shards(const std::vector<std::string>& folders, const study::Study& study,
                           const std::map<int, std::size_t>& trial_counts) {
  std::optional<Division> division;
  std::set<std::size_t> shards;
  for (const std::string& folder : folders) CATENA_CHECK(add_shards_in(folder, division, shards));
  if (!division) return Done{};
  for (std::size_t index = 1; index <= division->count; ++index)
    if (!shards.contains(index))
      return Error{fmt::format("shard {} is in none of the folders; the folders of all {} shards were expected",
                               Shard{index, division->count}.text(), division->count)};
  for (int subject = 1; subject <= division->subjects; ++subject) {
    const auto trials = study::make_session(study, subject);
    const auto expected = static_cast<std::size_t>(std::ranges::count(trials, false, &study::Trial::training));
    const auto found = trial_counts.find(subject);
    const std::size_t there = found == trial_counts.end() ? 0 : found->second;
    if (there != expected)
      return Error{fmt::format("subject {} has {} of {} trials; shard {} was expected to be finished, which goes on if it is run again",
                               subject, there, expected,
                               Shard{(static_cast<std::size_t>(subject) - 1) % division->count + 1, division->count}.text())};
  }
  return Done{};
}

Outcome copy_recordings(const std::string& from, const std::string& to, const std::vector<study::TrialRow>& rows) {
  for (const study::TrialRow& row : rows) {
    study::Trial trial;
    trial.subject = row.subject;
    trial.index = row.index;
    const std::string source = study::recording_file(from, trial), place = study::recording_file(to, trial);
    std::error_code code;
    if (!fs::is_regular_file(source, code)) continue;
    CATENA_CHECK(study::make_folder(study::recordings_folder(to)));
    remove_stale_temporaries(place);
    const std::string copy = temporary_name(place);
    fs::copy_file(source, copy, code);
    if (!code) fs::rename(copy, place, code);
    if (!code) continue;
    std::error_code ignored;
    fs::remove(copy, ignored);
    return system_error(place + ": cannot copy " + source, code.value());
  }
  return Done{};
}

}  // namespace catena::app
