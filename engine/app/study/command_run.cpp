// SPDX-License-Identifier: MIT
/// catena study run STUDY.json --subject N --device NAME -o DIR: runs one subject's session in the window, with a haptic device.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <utility>

#include "engine/app/cli/options.h"
#include "engine/app/study/live_session.h"
#include "engine/app/study/study_commands.h"
#include "engine/app/viewer/window/study_window.h"
#include "engine/base/console.h"

namespace catena::app {

namespace {

struct StudyRunOptions {
  std::string study, folder, device, firmware, forces, size = "1280x960", quality = "time=50";
  int subject = 0;
  bool full_screen = false;
  StereoOptions stereo;
  RealtimeChoice realtime;
};

Result<Instructions> instructions_of(const study::Study& study) {
  if (study.instructions.empty()) return Instructions{};
  std::vector<std::string> tasks;
  for (const study::Task& task : study.tasks) tasks.push_back(task.name);
  return read_instructions(study.instructions, tasks);
}

/// Whether the device exerts forces must be set explicitly, never guessed: a session without forces is another experiment.
Outcome check_forces(const StudyRunOptions& options, const haptics::DeviceCapabilities& device) {
  if (device.max_force_n > 0 && options.forces.empty())
    return Error{"--device " + options.device + " can exert forces; --forces on or --forces off was expected"};
  if (!(device.max_force_n > 0) && options.forces == "on")
    return Error{"--forces on: " + options.device + " cannot exert forces; a haptic device was expected"};
  return Done{};
}

ViewOptions view_options(const StudyRunOptions& options, const ImageSize& size) {
  ViewOptions view;
  view.source = options.study;
  view.haptic_options = {options.device, options.firmware, {}, {}, options.realtime.options(), options.forces == "on", false};
  view.width = size.width;
  view.height = size.height;
  view.show_panels = false;
  return view;
}

Outcome run_study(const StudyRunOptions& options) {
  CATENA_TRY(const ImageSize size, parse_image_size(options.size));
  CATENA_TRY(const study::Study study, study::read_study(options.study));
  CATENA_TRY(const Instructions instructions, instructions_of(study));
  ViewOptions view = view_options(options, size);
  CATENA_TRY(view.quality, parse_quality(options.quality));
  const auto adjust = [&](scene::Scene& scene) { return options.stereo.apply(scene.stereo); };
  // the first trial's scene provides what a device needs
  const std::vector<study::Trial> trials = study::make_session(study, options.subject);
  CATENA_TRY(const SceneModel trial, LiveTrial(study).open(trials.front(), adjust));
  std::optional<InterruptHandler> interrupt;
  HapticSession hand(view.haptic_options);
  CATENA_CHECK(hand.open_device(trial.scene()));
  CATENA_CHECK(check_forces(options, hand.device().device->capabilities()));
  CATENA_TRY(SubjectFolder folder, SubjectFolder::open(options.folder, study, options.subject));
  Procedure procedure(study, instructions, folder.trials(), folder.finished_trials(), folder.answered_questions());
  LiveSession session(study, folder, procedure, adjust);
  CATENA_TRY(auto scene, session.next_scene());
  print_line(fmt::format("study run: subject {}: opening the window and preparing the first image", options.subject));
  auto window = Window::create(size.width, size.height, "catena study");
  if (!window) return Error{window.error().message, true};
  std::optional<Failure> failure;
  {
    StudyWindow shown(view, session, *scene, hand, **window, interrupt);
    (*window)->set_fullscreen(options.full_screen);
    failure = shown.open();
    if (!failure) failure = shown.run();
  }
  const Outcome written = folder.write_table();
  if (failure) return Error{failure->message, failure->exit_code == 1};
  CATENA_CHECK(written);
  print_nonblocking(STDOUT_FILENO, fmt::format("subject {}: {}\n", options.subject, procedure.progress_text()));
  return Done{};
}

}  // namespace

void add_study_run(CLI::App& study, CommandAction& chosen) {
  auto options = std::make_shared<StudyRunOptions>();
  CLI::App* command = study.add_subcommand("run", "runs a session with a subject in the window; the same command resumes it");
  command->add_option("STUDY", options->study, "study (.json)")->type_name("STUDY")->required();
  command->add_option("--subject", options->subject, "number of the subject")
      ->type_name("SUBJECT")
      ->required()
      ->check(CLI::Range(1, study::kMaxSubject));
  command->add_option("--device", options->device, "mouse, or a device that `catena devices` lists")->type_name("DEVICE")->required();
  command->add_option("-o,--output", options->folder, "data folder")->type_name("FOLDER")->required();
  command->add_option("--forces", options->forces, "whether the device may exert forces; required for a device that can")
      ->type_name("WORD")
      ->check(CLI::IsMember({"on", "off"}));
  command->add_option("--firmware", options->firmware, "firmware image of the vendor, sent to a Falcon without firmware")
      ->type_name("FIRMWARE");
  command->add_option("--size", options->size, "size of the window")
      ->type_name("WxH")
      ->check(image_size_up_to(kMaxImageSize))
      ->capture_default_str();
  command
      ->add_option("--quality", options->quality,
                   "target or settings of the images, as for view; error=2 gives the same image error on every machine")
      ->type_name("QUALITY")
      ->capture_default_str();
  command->add_flag("--fullscreen", options->full_screen, "starts in full screen (F11 changes it)");
  add_stereo_options(*command, options->stereo);
  add_realtime_options(*command, options->realtime);
  command->callback([&chosen, options] { chosen = [options] { return run_study(*options); }; });
}

}  // namespace catena::app
