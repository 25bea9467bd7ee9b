// SPDX-License-Identifier: MIT
/// Commands of the window: everything that a user can trigger. Keys, menu entries, panel buttons and dropped files push a Command into one
/// queue; Session::execute applies it, in order, after every key press and every GUI frame. A command without parameters is an Action,
/// described in one row of the table in commands.cpp, which defines its menu entry, its keys and its line in the key list. To add one: a
/// name below, a row of the table, a case in session_input.cpp. Frame thread.
#pragma once
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "engine/app/render/render_options.h"
#include "engine/app/viewer/edit/scene_items.h"
#include "engine/app/viewer/input/keys.h"

namespace catena::app {

/// Commands without parameters.
enum class Action : std::uint8_t {
  // Program.
  open,
  add,
  save,
  save_as,
  save_image,
  save_window_image,
  quit,
  undo,
  redo,
  // Window.
  toggle_panels,
  toggle_fullscreen,
  toggle_help,
  dismiss,
  // Camera.
  reset_view,
  fit_view,
  view_along_plus_x,
  view_along_plus_y,
  view_along_plus_z,
  view_along_minus_x,
  view_along_minus_y,
  view_along_minus_z,
  toggle_projection,
  toggle_ortho_views,
  toggle_turntable,
  toggle_fly,
  next_stereo_mode,
  toggle_band_animation,
  play_time_steps,
  next_time_step,
  previous_time_step,
  // Probe and device.
  toggle_probe_mode,
  register_device,
  toggle_forces,
};

// Commands with parameters.

/// A group of edits of the scene's text, all or none (edit/edits.h). Consecutive edits with the same undo_group form one undo step.
struct Edit {
  TextEdits edits;
  std::string undo_label, undo_group{};  ///< undo_label: shown in the menu.
};
/// Opens a file in place of the scene.
struct OpenFile {
  std::string path;
  std::string grid{};  ///< Grid of a data file; empty: the default one.
};
/// Adds what a file shows to the scene.
struct AddFile {
  std::string path;
};
/// Opens a dropped file, or asks the user if it could be added to the scene.
struct DropFile {
  std::string path;
};
/// Choices of the dialog "A file was dropped".
enum class DroppedFileChoice : std::uint8_t { add, open, cancel };
/// Saves the scene to a path.
struct SaveAs {
  std::string path;
};
/// The Save As dialog was canceled; so is what should follow the save.
struct CancelSave {};
/// Choices of the dialog "Before this scene is left".
enum class UnsavedChangesChoice : std::uint8_t { save, discard, cancel };
/// Choices of the dialog "The file has changed on disk".
enum class FileConflictChoice : std::uint8_t { overwrite, take_disk_version, save_as, cancel };
/// Choices of the dialog "Unsaved changes of an earlier run".
enum class RecoveryChoice : std::uint8_t { restore, discard, later };
/// Sets the stereo mode.
struct SetStereoMode {
  scene::StereoMode mode;
};
/// Sets the quality of refined frames.
struct SetQuality {
  Quality quality;
};
/// Requests the error of the refined frame; issued with every GUI frame that shows it.
struct EstimateImageError {};
/// Measures the cost curves of the tuning; the window does not respond meanwhile.
struct MeasureCosts {};
/// Requests the tracking error of the proxies; issued with every GUI frame that shows it.
struct ObserveTrackingError {};
/// Adds a link that lies on the item, "isosurfaces[0]" (edit/haptic_binding.h).
struct BindHaptics {
  std::string item;
};
/// Removes the item with everything that refers to it (edit/remove_item.h).
struct RemoveItem {
  std::string item, undo_label;
};
/// Replaces the device that moves the probe.
struct SelectDevice {
  std::string name;
};
/// Shows a time step.
struct ShowTimeStep {
  int step;
};
/// Starts or stops a recording.
struct SetRecording {
  std::string path;  ///< Path of a .catlog with every tick from the next one on; empty: stop recording.
};

using Command = std::variant<Action, Edit, OpenFile, AddFile, DropFile, DroppedFileChoice, SaveAs, CancelSave, UnsavedChangesChoice,
                             FileConflictChoice, RecoveryChoice, SetStereoMode, SetQuality, EstimateImageError, MeasureCosts,
                             ObserveTrackingError, BindHaptics, RemoveItem, SelectDevice, ShowTimeStep, SetRecording>;
using Commands = std::vector<Command>;

/// Returns the action of a key event that is not text input of the GUI. `fly`: in fly mode, letters and arrows have no action.
std::optional<Action> find_action(const KeyEvent& event, bool fly);
/// Return the text of an action's menu entry, and its first shortcut ("Ctrl+Shift+S").
const char* menu_label(Action action);
std::string shortcut_label(Action action);

/// A line of the key list: section, keys, and what they do.
struct KeyHelp {
  std::string section, keys, description;
};
const std::vector<KeyHelp>& key_list();
/// Returns the key list as text for the terminal.
std::string key_help();

}  // namespace catena::app
