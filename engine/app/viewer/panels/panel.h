/// AppearanceState is what the panels of the scene's look remember from frame to frame. Frame thread.
#pragma once
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/app/viewer/edit/edits.h"
#include "engine/app/viewer/edit/histogram_cache.h"
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

struct AppearanceState {
  HistogramCache histograms;
  int press_count = 0;  ///< counts presses of the pointer: names drags

  /// A drag in a plot: where the handle would be, by the pointer alone.
  double handle_x = 0, handle_y = 0;

  /// The transfer function being edited.
  struct TransferEditor {
    std::string volume;                                           ///< its pointer
    std::optional<std::size_t> selected_opacity, selected_color;  ///< selected points
    std::optional<TransferEdit> before_drag;                      ///< as it was when the drag began
    std::optional<PlotTransform> drag_frame;                      ///< stands still while something is dragged
    bool show_full_range = false;
  } transfer_editor;

  std::map<std::string, std::string> disabled_text;  ///< pointer to the text that stood there
};

/// A panel is one part of the side window, one file in panels/: it shows what is there, notes edits of the scene (context.edits, see
/// edit/edits.h), and asks for what else the window can do (context.commands, see shell/commands.h). Nothing here waits for anything.
/// To add one: a file with a function that returns its Panel, and that function's name in the list of panels.cpp. Frame thread, between
/// Gui::begin and end.

/// One line for the person, at the bottom of the window for a while.
struct Message {
  std::string text;
  bool is_error = false;
  std::int64_t time_ns = 0;
};

/// What goes on once it is decided what becomes of unsaved changes: another file, or (empty) the end of the program.
struct PendingLeave {
  std::string open_path;
  bool quits() const { return open_path.empty(); }
};

/// What is asked above everything else; each stands until it is answered.
struct PendingDialogs {
  bool show_open = false, show_save_as = false;  ///< the dialogs shall come up
  std::optional<PendingLeave> unsaved_changes;   ///< what becomes of unsaved changes before that
  std::optional<std::string> dropped_file;       ///< a data file on an open scene: open it, or add it
  /// The scene's file was changed or removed by somebody else, and is to be saved.
  std::optional<scene::Document::DiskState> file_conflict;
  std::optional<OrphanedAutosave> recovery;  ///< unsaved work of an earlier run
};

/// What the window shows beside the scene: set by the session, read by the panels.
struct ViewState {
  bool show_panels = true;  ///< the side window and the status line
  bool show_help = false, is_fullscreen = false;
  PendingDialogs dialogs;
  std::deque<Message> messages;  ///< the newest last, at most kMaxMessages
  static constexpr std::size_t kMaxMessages = 100;

  // files
  bool is_untitled = false;  ///< nothing is open: the window says how to begin
  bool owns_file = true;     ///< the scene's path is its own; else it was made for a data file and is saved where the person says
  std::string loading_path;  ///< the path that is being opened; empty: none
  std::vector<std::string> recent_files;  ///< paths, the newest first

  TimePlayback playback;  ///< in time

  std::string prompt;  ///< what the person does next, until it is done; empty: nothing is asked

  // the picture and the pointer
  Area image_area;                                             ///< of the picture, window coordinates
  double pointer_x = 0, pointer_y = 0;                         ///< window coordinates
  bool pointer_on_image = false;                               ///< and not on a panel
  bool pointer_has_moved = false;                              ///< it has moved over the window
  bool pointer_pressed = false;                                ///< a button is down
  PointSamples pointer_samples, probe_samples, proxy_samples;  ///< for the table of values
  std::string unit_length;
  double force_ratio = 0;  ///< of the greatest force, 0..1

  // what panels remember
  EditState edit;
  AppearanceState appearance;

  void show_message(std::string text, bool is_error = false);
  /// An error is said.
  void show_error(const Outcome& outcome) {
    if (!outcome) show_message(outcome.error().message, true);
  }
};

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

  /// Done after this frame, in order.
  void push_command(Command command) { commands.push_back(std::move(command)); }
};

/// What the interface takes of the window where panels are shown (after the first frame's begin).
inline constexpr float kSidePanelWidth = 320;
Insets interface_insets();

struct Panel {
  const char* title;
  bool is_initially_open;
  void (*draw)(PanelContext& context);
  /// Whether the scene has anything for it; nullptr: always shown.
  bool (*is_relevant)(const PanelContext& context) = nullptr;
};
/// For Panel::wanted.
template <class Component>
bool has_any(const PanelContext& context) {
  return context.scene.scene().entities.count<Component>() > 0;
}

/// Everything in order: the menu bar, the side window with every panel, the dialogs, the status line.
void draw_interface(PanelContext& context);

// what is drawn beside the panels
void draw_menu(PanelContext& context);
void draw_dialogs(PanelContext& context);
void draw_status(PanelContext& context);
void draw_file_dialogs(PanelContext& context);
void draw_welcome(PanelContext& context);
/// The recent files as a list to choose from; false: there are none.
bool draw_recent_files(PanelContext& context);

}  // namespace catena::app
