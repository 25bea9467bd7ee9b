// The one place where commands are carried out.
#include <utility>

#include "engine/app/viewer/edit/feel.h"
#include "engine/app/viewer/edit/removal.h"
#include "engine/app/viewer/shell/session.h"
#include "engine/base/clock.h"
#include "engine/scene/steps.h"

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
    // what pushes hears every signal, and a second one, too, only as a wish to end
    if (done && !hand.is_mouse() && !(interrupt_ && interrupt_->asked())) interrupt_.emplace();
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
                        [&](const OpenFile& file) { files_.open(file.path); },
                        [&](const DropFile& file) { files_.drop(file.path); },
                        [&](const SaveAs& file) { files_.save_as(file.path); },
                        [&](GiveUpSaving) { files_.give_up_saving(); },
                        [&](AnswerToUnsaved answer) { files_.answer(answer); },
                        [&](AnswerToDropped answer) { files_.answer(answer); },
                        [&](AnswerToChanged answer) { files_.answer(answer); },
                        [&](AnswerToLeft answer) { files_.answer(answer); },
                        [&](const ChooseQuality& asked) { shared_.pacing = Pacing(asked.quality); },
                        [&](EstimateError) { wants_error_ = true; },
                        [&](MeasurePlan) { measure_ = true; },
                        [&](ObserveHand) { observe_hand(); },
                        [&](const Feel& asked) { feel(asked.item, picture_.seen_place(asked.item)); },
                        [&](const RemoveItem& asked) { remove(asked.item, asked.what); },
                        choose_stereo,
                        choose_device,
                        [&](ShowStep asked) { show_step(asked.step); },
                        record},
             command);
}

/// Now and then: its lines are traced as far as the hand has gone.
void Session::observe_hand() {
  constexpr double kEveryMs = 2000;
  LivePlan& live = shared_.plan;
  if (!live.observer || ms_since(last_observed_ns_) < kEveryMs) return;
  live.hand_error = live.observer->error(shared_.scene.scene());
  last_observed_ns_ = now_ns();
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
    case Action::play_steps:
      return toggle(state.steps.plays);
    case Action::next_step:
      return show_step(scene.scene().time.step + 1);
    case Action::step_before:
      return show_step(scene.scene().time.step - 1);
    case Action::hand_mode:
      return shared_.controls.hand_mode ? end_hand() : begin_hand();
    case Action::register_device:
      return state.say_if_wrong(picture_.ask_for_places());
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
      changed_ = eye_.act(action, state.area.width / state.area.height) || changed_;
      return;
  }
}

void Session::end_hand() {
  shared_.controls.hand_mode = false;
  if (shared_.hand.is_mouse()) shared_.state.say("the hand stays where it is; H takes it again");
}

/// The hand goes onto what is under the pointer. A chain that holds nothing yet gets that very thing.
void Session::begin_hand() {
  Controls& controls = shared_.controls;
  controls.hand_mode = true;
  const auto under = picture_.under_pointer();
  const std::string item = under ? picture_.item_of(under->id) : std::string();
  const scene::World& world = std::as_const(shared_.scene).scene().world;
  if (world.count<scene::Link>() == 0) {
    if (!item.empty())
      feel(item, under->world);
    else
      shared_.state.say("nothing is felt yet: point at a thing in the picture and press H, or click Feel beside its name");
  }
  if (!shared_.hand.is_mouse()) return;
  controls.under = under ? std::optional(under->world) : std::nullopt;
  app::begin_hand(controls);
  shared_.hand.move_mouse(shared_.scene.scene(), controls.hand, controls.buttons);
}

/// `at`: a place where it is seen.
void Session::feel(const std::string& item, std::optional<Vec3> at) {
  SceneHost& scene = shared_.scene;
  ViewState& state = shared_.state;
  const double edge = scene.bounds.longest_edge();
  const auto thing = app::feel(scene.scene(), item, at, shared_.controls.view.position, edge > 0 ? edge : 4);
  if (!thing) return state.say(thing.error().message, true);
  if (const std::string by = felt_by(scene.scene(), *thing); !by.empty())
    return state.say(thing->words + " is felt already, by the link " + by);
  const Outcome done = scene.apply(edits_to_feel(scene.scene(), item, *thing), "feel " + thing->words, {});
  if (!done) return state.say(done.error().message, true);
  // a mouse's hand begins on the thing, not somewhere within it
  Controls& controls = shared_.controls;
  if (shared_.hand.is_mouse() && at) {
    controls.hand = *at;
    controls.push = 0;
    shared_.hand.move_mouse(scene.scene(), controls.hand, controls.buttons);
  }
  const char* how = !shared_.hand.is_mouse() ? ""
                    : controls.hand_mode     ? ". The wheel pushes; Esc ends it"
                                             : ". Point at it and press H: the pointer is the hand, the wheel pushes";
  state.say("felt: " + thing->words + how);
}

/// With the links that feel it, unless something else needs them.
void Session::remove(const std::string& item, const std::string& what) {
  SceneHost& scene = shared_.scene;
  const TextEdits felt = edits_to_remove_felt(scene.scene(), scene.document().text(), item);
  if (scene.apply(felt, what)) return;
  shared_.state.say_if_wrong(scene.apply(edits_to_remove(scene.document().text(), item), what));
}

/// What is open above all goes first; the program stays.
void Session::close() {
  if (gui_.close_popup()) return;
  ViewState& state = shared_.state;
  Controls& controls = shared_.controls;
  bool* const first[] = {&state.help, &controls.fly, &controls.turntable};
  for (bool* what : first)
    if (std::exchange(*what, false)) return;
  if (controls.hand_mode) return end_hand();
  state.full_screen = false;
}

// What the person does with keys and pointer: for the interface, for a command, for the eye or the hand.

namespace {

constexpr int kSettling = 3;

}  // namespace

Gui::Frame Session::interface_frame() {
  return {[this] {
            PanelContext panels = context();
            draw_interface(panels);
          },
          [this] {
            carry_out();
            picture_.write_asked();
          }};
}

Changed Session::take_input(double wait_s) {
  Changed changed;
  Window& window = shared_.window;
  for (const Input& piece : window.poll(wait_s)) {
    const Changed by_piece = take_piece(piece);
    changed.view = changed.view || by_piece.view;
    changed.hand = changed.hand || by_piece.hand;
  }
  if (window.closing()) {
    window.keep_open();
    shared_.commands.push_back(Action::quit);
    carry_out();
    unsettled_ = kSettling;
  }
  if (window.happened()) {
    picture_.look_again();
    unsettled_ = kSettling;
  }
  if (bool& full = shared_.state.full_screen; window.is_full_screen() != full) {
    window.set_full_screen(full);
    full = window.is_full_screen();
  }
  const scene::Scene& scene = shared_.scene.scene();
  shared_.hand.hold_back(scene, shared_.controls);
  if (changed.hand) shared_.hand.move_mouse(scene, shared_.controls.hand, shared_.controls.buttons);
  if (changed.view) eye_.pin();
  return changed;
}

/// The interface first: it says whether a stroke is text for it or a command. Then the stroke, then the motion after it.
Changed Session::take_piece(Input piece) {
  gui_.tell(piece, interface_frame());
  Commands& commands = shared_.commands;
  if (piece.damaged) picture_.damage();
  if (piece.key && !gui_.wants_keys())
    if (const auto action = action_of(*piece.key, shared_.controls.fly)) {
      commands.push_back(*action);
      gui_.expect_change();
    }
  if (!piece.dropped.empty()) {
    const auto series = scene::pattern_of(piece.dropped);
    if (!series) shared_.state.say("several files that are no series were dropped: the last one counts");
    commands.push_back(DropFile{series ? *series : piece.dropped.back()});
  }
  carry_out();
  Controls& controls = shared_.controls;
  if (takes_hold(piece)) controls.turntable = false;
  Input input = routed(piece);
  if (controls.hand_mode && shared_.hand.is_mouse()) {
    // over a panel the hand stays where it is: a way that leads there does not move it
    if (!shared_.state.pointer_on_picture && !shared_.state.pointer_pressed) input.dx = input.dy = input.wheel = 0;
    const auto under = picture_.under_pointer();
    controls.under = under ? std::optional(under->world) : std::nullopt;
  }
  return apply(controls, input);
}

/// What the interface holds is not the scene's: a drag belongs to where it began.
Input Session::routed(Input input) {
  ViewState& state = shared_.state;
  const bool pressed = input.left || input.middle || input.right;
  const bool here = gui_.holds(input.x, input.y);
  if (!pressed) interface_holds_pointer_ = false;
  if (pressed && !state.pointer_pressed) interface_holds_pointer_ = here;
  state.pointer_pressed = pressed;
  state.pointer_x = input.x + input.dx;
  state.pointer_y = input.y + input.dy;
  if (input.dx != 0 || input.dy != 0) state.pointer_seen = true;
  state.pointer_on_picture =
      !interface_holds_pointer_ && state.area.contains(state.pointer_x, state.pointer_y) && !gui_.holds(state.pointer_x, state.pointer_y);
  if (interface_holds_pointer_ || (!pressed && here)) {
    input.dx = input.dy = input.wheel = 0;
    input.left = input.middle = input.right = false;
  }
  // from now on the picture is all there is
  input.x -= state.area.x;
  input.y -= state.area.y;
  input.width = state.area.width;
  input.height = state.area.height;
  return input;
}

}  // namespace catena::app
