// SPDX-License-Identifier: MIT
/// Panels of the GUI: their interface, the state they share, and the functions that draw the GUI outside the panels. Frame thread.
#pragma once
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/app/viewer/edit/edits.h"
#include "engine/app/viewer/edit/histogram_cache.h"
#include "engine/app/viewer/edit/label_statistics.h"
#include "engine/app/viewer/edit/transfer_editing.h"
#include "engine/app/viewer/input/haptic_session.h"
#include "engine/app/viewer/input/navigation.h"
#include "engine/app/viewer/scene/autosave.h"
#include "engine/app/viewer/scene/field_probe.h"
#include "engine/app/viewer/scene/scene_model.h"
#include "engine/app/viewer/scene/time_playback.h"
#include "engine/app/viewer/window/layout.h"
#include "engine/app/viewer/window/live_tuning.h"
#include "engine/app/viewer/window/presenter.h"
#include "engine/app/viewer/window/progressive_scheduler.h"

namespace catena::app {

/// State that the panels for the appearance of the scene keep from frame to frame.
struct AppearanceState {
  HistogramCache histograms;
  int press_count = 0;  ///< Number of pointer presses; identifies the undo group of a drag.

  /// During a drag in a plot: position of the handle according to the pointer alone, pixels.
  double handle_x = 0, handle_y = 0;

  /// The transfer function being edited.
  struct TransferEditor {
    std::string volume;                                           ///< JSON pointer of the volume.
    std::optional<std::size_t> selected_opacity, selected_color;  ///< Indices of the selected points.
    std::optional<TransferEdit> before_drag;                      ///< State at the start of the drag.
    std::optional<PlotTransform> drag_frame;                      ///< Plot of the drag, constant while it lasts.
    /// Plot the full range of the field.
    bool show_full_range = false;
  } transfer_editor;

  /// What the panel of measuring shows.
  struct Measure {
    std::string ruler, field;                                  ///< Names; empty: the first one.
    std::string second_ruler;                                  ///< Name of the ruler to which the angle is shown; empty: none.
    std::string map, values;                                   ///< Label map and field of the table; empty: the first one.
    LabelStatisticsCache labels;                               ///< Computes the table.
    std::shared_ptr<const LabelStatisticsCache::Table> table;  ///< Table from which `rows` were taken.
    LabelColumn sorted_by = LabelColumn::name;                 ///< Order of the rows.
    bool is_descending = false;
    std::vector<LabelStatistics> rows;  ///< Sorted rows of the table.
    std::optional<double> selected;     ///< Label of the selected row.
  } measure;

  std::map<std::string, std::string> disabled_text;  ///< Disabled text by the JSON pointer of its place.
};

/// A panel is one section of the side window, one file in panels/: it shows state, records edits of the scene (context.edits, see
/// edit/edits.h), and issues commands for everything else (context.commands, see input/commands.h). Panels never block. To add one: a file
/// with a function that returns its Panel, and the name of that function in the list in panels.cpp. Frame thread, between Gui::begin and
/// end.

/// A one-line message for the user, shown at the bottom of the window for a while.
struct Message {
  std::string text;
  bool is_error = false;
  /// Time when it was issued, nanoseconds of engine/base/clock.h.
  std::int64_t time_ns = 0;
};

/// The action to continue with when unsaved changes are resolved: opening another file, or (empty path) quitting.
struct PendingLeave {
  std::string open_path, grid{};  ///< File to open, and its grid; empty: quit, the default grid.
  bool quits() const { return open_path.empty(); }
};

/// Modal dialogs; each stays pending until it is answered.
struct PendingDialogs {
  bool show_open = false, show_add = false, show_save_as = false;  ///< Open these dialogs.
  std::optional<PendingLeave> unsaved_changes;                     ///< Action waiting for the unsaved changes dialog.
  std::optional<std::string> dropped_file;                         ///< A data file dropped on an open scene: open it, or add it.
  /// The scene's file was changed or removed by another program, and is to be saved.
  std::optional<scene::Document::DiskState> file_conflict;
  std::optional<OrphanedAutosave> recovery;  ///< Autosave of an earlier run.
};

/// State of the window apart from the scene: set by the session, read by the panels.
struct ViewState {
  bool show_panels = true;  ///< Show the side window and the status line.
  bool show_help = false, is_fullscreen = false;
  PendingDialogs dialogs;
  std::deque<Message> messages;  ///< Newest last, at most kMaxMessages.
  static constexpr std::size_t kMaxMessages = 100;

  // Files.
  bool is_untitled = false;  ///< Nothing is open: the window shows the welcome page.
  bool owns_file = true;     ///< The scene's path is its own; false: it was generated for a data file and is saved where the user chooses.
  std::string loading_path;  ///< Path being loaded; empty: none.
  std::vector<std::string> recent_files;  ///< Paths, newest first.

  TimePlayback playback;  ///< Playback of time steps.

  std::string prompt;  ///< Instruction for the user until it is done; empty: none.

  // Image and pointer.
  Area image_area;                                             ///< Area of the image in window coordinates.
  double pointer_x = 0, pointer_y = 0;                         ///< Window coordinates.
  bool pointer_on_image = false;                               ///< The pointer is on the image and not on a panel.
  bool pointer_has_moved = false;                              ///< The pointer has moved over the window at least one time.
  bool pointer_pressed = false;                                ///< A mouse button is down.
  PointSamples pointer_samples, probe_samples, proxy_samples;  ///< Rows of the value table.
  std::string unit_length;
  double force_ratio = 0;  ///< Force as a fraction of the maximum force, 0 to 1.

  // State kept by panels.
  EditState edit;
  AppearanceState appearance;

  /// Appends a message.
  void show_message(std::string text, bool is_error = false);
  /// Shows the error of a failed outcome as a message.
  void show_error(const Outcome& outcome) {
    if (!outcome) show_message(outcome.error().message, true);
  }
};

/// Everything that a panel can read and change.
struct PanelContext {
  SceneModel& scene;
  HapticSession& haptic_session;
  Presenter& presenter;
  Navigation& navigation;
  ProgressiveScheduler& scheduler;
  LiveTuning& tuning;
  FrameTimes& frame_times;
  ViewState& state;
  Commands& commands;
  Edits edits{commands, state.edit};

  /// Queues a command, executed after this frame, in order.
  void push_command(Command command) { commands.push_back(std::move(command)); }
};

/// Width of the side panel, of which the user drags the edge, and insets of the GUI while panels are shown, window coordinates (valid after
/// the first Gui::begin).
float side_panel_width();
Insets interface_insets();

/// One section of the side window.
struct Panel {
  const char* title;
  bool is_initially_open;
  void (*draw)(PanelContext& context);
  /// Returns whether the scene has anything for the panel; nullptr: always shown.
  bool (*is_relevant)(const PanelContext& context) = nullptr;
};
/// Returns whether the scene has a component of the type; for Panel::is_relevant.
template <class Component>
bool has_any(const PanelContext& context) {
  return context.scene.scene().entities.count<Component>() > 0;
}

/// Draws the whole GUI: menu bar, side window with all panels, dialogs, status line.
void draw_interface(PanelContext& context);

// Parts of the GUI apart from the panels.
void draw_menu(PanelContext& context);
void draw_dialogs(PanelContext& context);
void draw_status(PanelContext& context);
void draw_file_dialogs(PanelContext& context);
void draw_welcome(PanelContext& context);
/// Draws what is being done while the first scene is loaded, in the middle of the window.
void draw_loading(const std::string& source);
/// Draws the recent files as a list to choose from; returns false if there are none.
bool draw_recent_files(PanelContext& context);

}  // namespace catena::app
