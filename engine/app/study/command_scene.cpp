// SPDX-License-Identifier: MIT
/// catena study scene STUDY.json --subject S --trial T -o SCENE.json: writes a trial as a scene, for `render` and `view`.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "engine/app/cli/io_conflicts.h"
#include "engine/app/study/study_commands.h"
#include "engine/base/text.h"
#include "engine/scene/document.h"
#include "engine/study/trial_scene.h"

namespace catena::app {

namespace {

struct StudySceneOptions {
  std::string study, output;
  int subject = 1, trial = 0;
};

Outcome write_trial_scene(const StudySceneOptions& options) {
  CATENA_TRY(const study::Study study, study::read_study(options.study));
  IoConflictChecker files;
  files.add_input(options.study);
  files.add_output("-o", options.output);
  CATENA_CHECK(files.check());
  const std::vector<study::Trial> session = study::make_session(study, options.subject);
  if (options.trial >= static_cast<int>(session.size()))
    return Error{fmt::format("--trial {}: a session has {} trials; a number from 0 to {} was expected", options.trial, session.size(),
                             session.size() - 1)};
  const study::Trial& trial = session[static_cast<std::size_t>(options.trial)];
  study::StimulusGenerator maker(study);
  CATENA_TRY(const study::Stimulus stimulus, maker.generate(trial.task, trial.seed));
  const std::string text = study::make_trial_scene(study, trial, stimulus);
  CATENA_CHECK(scene::parse_scene(text, options.study));  // errors are reported with the study's line numbers
  // remove the leading empty lines, and make file names relative to the output's folder
  CATENA_TRY(scene::Document document,
             scene::Document::create("{" + text.substr(std::min(text.find_first_not_of("{\n"), text.size() - 1)) + "\n", options.study));
  CATENA_CHECK(document.save(options.output));
  const study::Task& task = study.tasks[static_cast<std::size_t>(trial.task)];
  fmt::print("{}: subject {}, trial {}: {}, {}{}, seed {}\n", sanitize_for_terminal(options.output), trial.subject, trial.index,
             sanitize_for_terminal(task.name), sanitize_for_terminal(study.conditions[static_cast<std::size_t>(trial.condition)].name),
             trial.training ? ", training" : "", stimulus.seed);
  return Done{};
}

}  // namespace

void add_study_scene(CLI::App& study, CommandAction& chosen) {
  auto options = std::make_shared<StudySceneOptions>();
  CLI::App* command = study.add_subcommand("scene", "writes one trial of a subject as a scene");
  command->add_option("STUDY", options->study, "study (.json)")->type_name("STUDY")->required();
  command->add_option("--subject", options->subject, "number of the subject")
      ->type_name("SUBJECT")
      ->check(CLI::Range(1, study::kMaxSubject))
      ->capture_default_str();
  command->add_option("--trial", options->trial, "number of the trial in the session, counted from 0")
      ->type_name("INDEX")
      ->check(CLI::Range(0, 1000000))
      ->capture_default_str();
  command->add_option("-o,--output", options->output, "scene to write")->type_name("FILE.json")->required();
  command->callback([&chosen, options] { chosen = [options] { return write_trial_scene(*options); }; });
}

}  // namespace catena::app
