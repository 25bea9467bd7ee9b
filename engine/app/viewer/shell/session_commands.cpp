// The one place where commands are carried out.
#include <utility>

#include "engine/app/viewer/shell/session.h"

namespace catena::app {

namespace {

template <class... F>
struct Overloaded : F... {
  using F::operator()...;
};

}  // namespace

void Session::carry_out() {
  while (!shared_.commands.empty())
    for (const Command& command : std::exchange(shared_.commands, {})) carry_out(command);
}

void Session::carry_out(const Command& command) {
  SceneHost& scene = shared_.scene;
  HandHost& hand = shared_.hand;
  ViewState& state = shared_.state;
  const auto choose_device = [&](const ChooseDevice& asked) {
    const Outcome done = hand.switch_device(scene.scene(), asked.name, scene.bounds);
    if (done && !hand.is_mouse() && !interrupt_) interrupt_.emplace();
    shared_.controls.hand = hand.felt().tick > 0 ? hand.felt().probe : hand.first_probe();
    state.say(done ? hand.hand().device->capabilities().name + " holds the probe" : done.error().message, !done);
  };
  const auto record = [&](const Record& asked) {
    const std::string before = hand.recording().path();
    const Outcome done = asked.path.empty() ? hand.stop_recording() : hand.record(asked.path, recorded(scene, hand));
    state.say(!done ? done.error().message : asked.path.empty() ? "recorded " + before : "recording to " + asked.path, !done);
  };
  const auto choose_stereo = [&](const ChooseStereo& asked) {
    scene.scene().stereo.mode = asked.mode;
    changed_ = true;
  };
  std::visit(Overloaded{[&](Action action) { act(action); },
                        [&](const Edit& edit) { state.say_if_wrong(scene.apply(edit.edits, edit.what, edit.drag)); },
                        [&](const OpenFile& file) { files_.open(file.path); }, [&](const DropFile& file) { files_.drop(file.path); },
                        [&](const SaveAs& file) { files_.save_as(file.path); }, [&](GiveUpSaving) { files_.give_up_saving(); },
                        [&](AnswerToUnsaved answer) { files_.answer(answer); }, [&](AnswerToDropped answer) { files_.answer(answer); },
                        [&](AnswerToLeft answer) { files_.answer(answer); },
                        [&](const ChooseQuality& asked) { shared_.pacing = Pacing(asked.quality); },
                        [&](EstimateError) { wants_error_ = true; }, choose_stereo, choose_device, record},
             command);
}

void Session::act(Action action) {
  SceneHost& scene = shared_.scene;
  ViewState& state = shared_.state;
  const auto toggle = [](bool& what) { what = !what; };
  switch (action) {
    case Action::open:
      state.ask.open = true;
      return;
    case Action::save:
      return files_.save();
    case Action::save_as:
      state.ask.save_as = true;
      return;
    case Action::picture:
    case Action::window_picture:
      return picture_.ask_for_file(action == Action::window_picture);
    case Action::quit:
      return files_.quit();
    case Action::undo:
      return state.say_if_wrong(scene.undo());
    case Action::redo:
      return state.say_if_wrong(scene.redo());
    case Action::panels:
      return toggle(state.panels);
    case Action::full_screen:
      return toggle(state.full_screen);
    case Action::help:
      return toggle(state.help);
    case Action::close:
      return close();
    case Action::next_stereo: {
      const int next = (static_cast<int>(scene.scene().stereo.mode) + 1) % scene::kStereoModes;
      return carry_out(ChooseStereo{static_cast<scene::StereoMode>(next)});
    }
    case Action::pulses:
      return toggle(pulses_run_);
    case Action::hand_mode:
      return toggle(shared_.controls.hand_mode);
    case Action::forces:
      return shared_.hand.set_forces(!shared_.hand.forces());
    case Action::first_view:
    case Action::fit:
    case Action::along_x:
    case Action::along_y:
    case Action::along_z:
    case Action::against_x:
    case Action::against_y:
    case Action::against_z:
    case Action::projection:
    case Action::turntable:
    case Action::fly:
      changed_ = eye_.act(action) || changed_;
      return;
  }
}

/// What is open above all goes first; the program stays.
void Session::close() {
  if (gui_.close_popup()) return;
  ViewState& state = shared_.state;
  Controls& controls = shared_.controls;
  bool* const open[] = {&state.help, &controls.fly, &controls.turntable, &controls.hand_mode, &state.full_screen};
  for (bool* what : open)
    if (std::exchange(*what, false)) return;
}

}  // namespace catena::app
