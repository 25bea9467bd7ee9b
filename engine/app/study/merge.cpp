/// catena study merge DIR... -o DIR: the subjects of several data folders of one study in one.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>

#include "engine/app/study/study_command.h"
#include "engine/base/output_file.h"
#include "engine/base/text.h"
#include "engine/study/trial_table.h"

namespace catena::app {

namespace {

struct MergeOptions {
  std::vector<std::string> folders;
  std::string output;
};

Outcome merge(const MergeOptions& options) {
  namespace fs = std::filesystem;
  // all are read before anything is written
  std::optional<study::Study> study;
  std::map<int, std::pair<std::string, std::vector<study::Row>>> subjects;
  for (const std::string& folder : options.folders) {
    if (same_file(folder, options.output)) return Error{options.output + ": is one of the folders to merge; another one was expected"};
    CATENA_TRY(study::Study one, study::read_study((fs::path(folder) / "study.json").string()));
    if (study && study->text != one.text) return Error{one.path + ": differs from " + study->path + "; data of one study were expected"};
    if (!study) study.emplace(std::move(one));
    CATENA_TRY(const study::DataFolder data, study::DataFolder::open(folder, *study));
    CATENA_TRY(const std::vector<int> numbers, data.subjects());
    for (const int number : numbers) {
      CATENA_TRY(std::vector<study::Row> rows, data.rows(number));
      const auto [found, is_new] = subjects.try_emplace(number, folder, rows);
      if (!is_new && found->second.second != rows)
        return Error{fmt::format("{}: subject {} has other trials than in {}; each subject in one folder was expected", folder, number,
                                 found->second.first)};
    }
  }
  CATENA_TRY(const study::DataFolder data, study::DataFolder::open(options.output, *study));
  std::size_t trials = 0;
  for (const auto& [number, from] : subjects) {
    CATENA_TRY(const std::vector<study::Row> there, data.rows(number));
    if (!there.empty() && there != from.second)
      return Error{fmt::format("{}: subject {} is there with other trials; an empty folder was expected", options.output, number)};
    if (there.empty()) CATENA_CHECK(data.write_subject(number, from.second));
    trials += from.second.size();
  }
  if (std::any_of(options.folders.begin(), options.folders.end(), study::is_simulated)) CATENA_CHECK(data.mark_simulated());
  CATENA_CHECK(data.write_table());
  fmt::print("{}: {} subjects, {} trials\n", printable(options.output), subjects.size(), trials);
  return Done{};
}

}  // namespace

void add_study_merge(CLI::App& study, Work& chosen) {
  auto options = std::make_shared<MergeOptions>();
  CLI::App* command = study.add_subcommand("merge", "the subjects of several data folders in one");
  command->add_option("DIR", options->folders, "data folders of one study")->required();
  command->add_option("-o,--output", options->output, "the data folder to make")->required();
  command->callback([&chosen, options] { chosen = [options] { return merge(*options); }; });
}

}  // namespace catena::app
