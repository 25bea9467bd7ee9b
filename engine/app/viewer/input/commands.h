/// A Command is anything that a person can ask of the window. A key, a menu entry, a button of a panel and a dropped file push a Command
/// into one queue; Session::carry_out applies it, in order, after every stroke and every frame of the interface. What needs no more than
/// its name is an Action, described once in the table of commands.cpp: its menu entry, its keys and its line in the list of keys come from
/// there. To add one: a name below, a row of the table, a case in session_input.cpp. Frame thread.
#pragma once
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "engine/app/render/render_options.h"
#include "engine/app/viewer/edit/scene_items.h"
#include "engine/app/viewer/input/keys.h"

namespace catena::app {

enum class Action : std::uint8_t {
  // the program
  open,
  save,
  save_as,
  save_image,
  save_window_image,
  quit,
  undo,
  redo,
  // the window
  toggle_panels,
  toggle_fullscreen,
  toggle_help,
  dismiss,
  // the eye
  reset_view,
  fit_view,
  view_along_plus_x,
  view_along_plus_y,
  view_along_plus_z,
  view_along_minus_x,
  view_along_minus_y,
  view_along_minus_z,
  toggle_projection,
  toggle_turntable,
  toggle_fly,
  next_stereo_mode,
  toggle_band_animation,
  play_time_steps,
  next_time_step,
  previous_time_step,
  // the hand
  toggle_probe_mode,
  register_device,
  toggle_forces,
};

// what needs more than a name

/// Edits of the scene's text that are one, all of them or none (edit/edits.h). Those with the same `drag` that follow each other are one
/// step of undo.
struct Edit {
  TextEdits edits;
  std::string undo_label, undo_group{};  ///< what: for the menu of undo
};
struct OpenFile {
  std::string path;
};
/// ImportedData, or asked about where it could join the scene.
struct DropFile {
  std::string path;
};
/// To "A file was dropped".
enum class DroppedFileChoice : std::uint8_t { add, open, cancel };
struct SaveAs {
  std::string path;
};
/// The dialog was cancelled: what should follow the save does not.
struct CancelSave {};
/// To "Before this scene is left".
enum class UnsavedChangesChoice : std::uint8_t { save, discard, cancel };
/// To "The file is not as it was read".
enum class FileConflictChoice : std::uint8_t { overwrite, take_disk_version, save_as, cancel };
/// To "Unsaved changes of an earlier run".
enum class RecoveryChoice : std::uint8_t { restore, discard, later };
struct SetStereoMode {
  scene::StereoMode mode;
};
/// Of a picture at rest, from now on.
struct SetQuality {
  Quality quality;
};
/// The error of the picture at rest is looked at: asked with every frame that shows it.
struct EstimateImageError {};
/// What the plan's settings cost is measured now: the window stands still meanwhile.
struct MeasureCosts {};
/// How far the hand's proxies are off their lines: asked with every frame that shows it.
struct ObserveTrackingError {};
/// A link of the chain that lies on that item, "isosurfaces[0]" (edit/feel.h).
struct BindHaptics {
  std::string item;
};
/// That item goes, with what hangs on it (edit/removal.h); `what`: for the menu of undo.
struct RemoveItem {
  std::string item, undo_label;
};
/// Another device that holds the probe.
struct SelectDevice {
  std::string name;
};
/// In time.
struct ShowTimeStep {
  int step;
};
struct SetRecording {
  std::string path;  ///< .catlog of every tick from now on; empty: no more
};

using Command = std::variant<Action, Edit, OpenFile, DropFile, DroppedFileChoice, SaveAs, CancelSave, UnsavedChangesChoice,
                             FileConflictChoice, RecoveryChoice, SetStereoMode, SetQuality, EstimateImageError, MeasureCosts,
                             ObserveTrackingError, BindHaptics, RemoveItem, SelectDevice, ShowTimeStep, SetRecording>;
using Commands = std::vector<Command>;

/// What a stroke asks of the program when it is no text for the interface. `fly`: letters and arrows fly, and ask for nothing.
std::optional<Action> find_action(const KeyEvent& event, bool fly);
/// The words of the action's menu entry; its first stroke ("Ctrl+Shift+S").
const char* menu_label(Action action);
std::string shortcut_label(Action action);

/// One thing that a key or a button does.
struct KeyHelp {
  std::string section, keys, description;
};
const std::vector<KeyHelp>& key_list();
/// The same for the terminal.
std::string key_help();

}  // namespace catena::app
