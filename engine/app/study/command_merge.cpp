// SPDX-License-Identifier: MIT
/// catena study merge DIR... -o DIR: merges the subjects of several data folders of one study into one folder.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>

#include "engine/app/study/study_commands.h"
#include "engine/app/study/study_shards.h"
#include "engine/base/console.h"
#include "engine/base/output_file.h"
#include "engine/base/text.h"
#include "engine/study/protocol_deviations.h"
#include "engine/study/questionnaire_answers.h"
#include "engine/study/trial_table.h"

namespace catena::app {

namespace {

struct MergeOptions {
  std::vector<std::string> folders;
  std::string output;
};

/// A subject's questionnaire is copied with the trials.
Outcome bring_answers(const std::string& from, const std::string& to, int subject) {
  const std::string source = study::answers_file(from, subject), place = study::answers_file(to, subject);
  std::error_code code;
  if (!std::filesystem::exists(source, code)) return Done{};
  CATENA_TRY(const std::string text, read_text_file(source, "a table of answers"));
  if (std::filesystem::exists(place, code)) {
    CATENA_TRY(const std::string there, read_text_file(place, "a table of answers"));
    if (there != text) return Error{fmt::format("{}: differs from the answers in {}; an empty folder was expected", place, source)};
    return Done{};
  }
  CATENA_CHECK(study::make_folder(std::filesystem::path(place).parent_path()));
  CATENA_TRY(OutputFile file, OutputFile::open(place));
  file.write(text);
  file.sync();
  return file.commit();
}

Outcome merge(const MergeOptions& options) {
  namespace fs = std::filesystem;
  // all input is read before anything is written
  std::optional<study::Study> study;
  std::map<int, std::pair<std::string, std::vector<study::TrialRow>>> subjects;
  std::vector<std::string> notes;
  const bool simulated = study::is_simulated(options.folders.front());
  for (const std::string& folder : options.folders) {
    if (is_same_file(folder, options.output))
      return Error{options.output + ": is one of the folders to merge; another folder was expected"};
    if (is_path_within(options.output, folder))
      return Error{options.output + ": is in the folder " + folder + ", which is merged; another folder was expected"};
    if (study::is_simulated(folder) != simulated)
      return Error{fmt::format("{}: {} has trials of a model, {} has trials of people; data of one kind was expected", folder,
                               simulated ? options.folders.front() : folder, simulated ? folder : options.folders.front())};
    CATENA_TRY(study::Study one, study::read_study((fs::path(folder) / "study.json").string()));
    if (study && study->text != one.text) return Error{one.path + ": differs from " + study->path + "; data of one study was expected"};
    if (!study) study.emplace(std::move(one));
    CATENA_TRY(const std::vector<int> numbers, study::list_subjects(folder, &notes));
    for (const int number : numbers) {
      CATENA_TRY(std::vector<study::TrialRow> rows, study::read_rows(folder, number, &notes));
      const auto [found, is_new] = subjects.try_emplace(number, folder, rows);
      if (!is_new && found->second.second != rows)
        return Error{fmt::format("{}: the trials of subject {} differ from those in {}; each subject was expected in one folder only",
                                 folder, number, found->second.first)};
    }
  }
  std::map<int, std::size_t> trial_counts;
  for (const auto& [number, from] : subjects) trial_counts[number] = from.second.size();
  CATENA_CHECK(check_study_shards(options.folders, *study, trial_counts));
  CATENA_TRY(const study::DataFolder data,
             study::DataFolder::open(options.output, *study, simulated ? study::ParticipantKind::model : study::ParticipantKind::people));
  std::size_t trials = 0;
  for (const auto& [number, from] : subjects) {
    CATENA_TRY(const std::vector<study::TrialRow> there, data.rows(number));
    if (!there.empty() && there != from.second)
      return Error{fmt::format("{}: has different trials of subject {}; an empty folder was expected", options.output, number)};
    if (there.empty()) CATENA_CHECK(data.write_subject(number, from.second));
    CATENA_CHECK(bring_answers(from.first, options.output, number));
    CATENA_CHECK(copy_recordings(from.first, options.output, from.second));
    trials += from.second.size();
  }
  CATENA_CHECK(data.write_table());
  std::vector<study::TrialRow> all;
  for (const auto& [number, from] : subjects) all.insert(all.end(), from.second.begin(), from.second.end());
  for (const std::string& line : study::find_protocol_deviations(*study, all)) notes.push_back(line);
  for (const std::string& note : notes) print_message("note: " + note);
  fmt::print("{}: {} subjects, {} trials\n", sanitize_for_terminal(options.output), subjects.size(), trials);
  return Done{};
}

}  // namespace

void add_study_merge(CLI::App& study, CommandAction& chosen) {
  auto options = std::make_shared<MergeOptions>();
  CLI::App* command = study.add_subcommand("merge", "merges the subjects of several data folders into one folder");
  command->add_option("DIR", options->folders, "data folders of one study")->type_name("FOLDER")->required();
  command->add_option("-o,--output", options->output, "data folder to create")->type_name("FOLDER")->required();
  command->callback([&chosen, options] { chosen = [options] { return merge(*options); }; });
}

}  // namespace catena::app
