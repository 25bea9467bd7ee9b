/// A Command is anything that a person can ask of the window. A key, a menu entry, a button of a panel and a dropped file push a Command
/// into one queue; Session::carry_out applies it, in order, after every stroke and every frame of the interface. What needs no more than
/// its name is an Action, described once in the table of commands.cpp: its menu entry, its keys and its line in the list of keys come from
/// there. To add one: a name below, a row of the table, a case in session_input.cpp. Frame thread.
#pragma once
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "engine/app/render/options.h"
#include "engine/app/viewer/edit/scene_items.h"
#include "engine/app/viewer/shell/keys.h"

namespace catena::app {

enum class Action : std::uint8_t {
  // the program
  open,
  save,
  save_as,
  picture,
  window_picture,
  quit,
  undo,
  redo,
  // the window
  panels,
  full_screen,
  help,
  close,
  // the eye
  first_view,
  fit,
  along_x,
  along_y,
  along_z,
  against_x,
  against_y,
  against_z,
  projection,
  turntable,
  fly,
  next_stereo,
  pulses,
  play_steps,
  next_step,
  step_before,
  // the hand
  hand_mode,
  register_device,
  forces,
};

// what needs more than a name

/// Edits of the scene's text that are one, all of them or none (edit/edits.h). Those with the same `drag` that follow each other are one
/// step of undo.
struct Edit {
  TextEdits edits;
  std::string what, drag{};  ///< what: for the menu of undo
};
struct OpenFile {
  std::string path;
};
/// Opened, or asked about where it could join the scene.
struct DropFile {
  std::string path;
};
/// To "A file was dropped".
enum class AnswerToDropped : std::uint8_t { add, open, cancel };
struct SaveAs {
  std::string path;
};
/// The dialog was cancelled: what should follow the save does not.
struct GiveUpSaving {};
/// To "Before this scene is left".
enum class AnswerToUnsaved : std::uint8_t { save, discard, cancel };
/// To "The file is not as it was read".
enum class AnswerToChanged : std::uint8_t { keep_mine, take_theirs, save_as, cancel };
/// To "Unsaved changes of an earlier run".
enum class AnswerToLeft : std::uint8_t { restore, discard, later };
struct ChooseStereo {
  scene::StereoMode mode;
};
/// Of a picture at rest, from now on.
struct ChooseQuality {
  Quality quality;
};
/// The error of the picture at rest is looked at: asked with every frame that shows it.
struct EstimateError {};
/// What the plan's settings cost is measured now: the window stands still meanwhile.
struct MeasurePlan {};
/// How far the hand's proxies are off their lines: asked with every frame that shows it.
struct ObserveHand {};
/// A link of the chain that lies on that item, "isosurfaces[0]" (edit/feel.h).
struct Feel {
  std::string item;
};
/// That item goes, with what hangs on it (edit/removal.h); `what`: for the menu of undo.
struct RemoveItem {
  std::string item, what;
};
/// Another device that holds the probe.
struct ChooseDevice {
  std::string name;
};
/// In time.
struct ShowStep {
  int step;
};
struct Record {
  std::string path;  ///< .catlog of every tick from now on; empty: no more
};

using Command =
    std::variant<Action, Edit, OpenFile, DropFile, AnswerToDropped, SaveAs, GiveUpSaving, AnswerToUnsaved, AnswerToChanged, AnswerToLeft,
                 ChooseStereo, ChooseQuality, EstimateError, MeasurePlan, ObserveHand, Feel, RemoveItem, ChooseDevice, ShowStep, Record>;
using Commands = std::vector<Command>;

/// What a stroke asks of the program when it is no text for the interface. `fly`: letters and arrows fly, and ask for nothing.
std::optional<Action> action_of(const KeyEvent& event, bool fly);
/// The words of the action's menu entry; its first stroke ("Ctrl+Shift+S").
const char* menu_words(Action action);
std::string key_words(Action action);

/// One thing that a key or a button does.
struct KeyHelp {
  std::string section, keys, does;
};
const std::vector<KeyHelp>& key_list();
/// The same for the terminal.
std::string key_help();

}  // namespace catena::app
