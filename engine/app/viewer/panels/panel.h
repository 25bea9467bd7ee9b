/// LookState is what the panels of the scene's look remember from frame to frame. Frame thread.
#pragma once
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/app/viewer/edit/edits.h"
#include "engine/app/viewer/edit/field_values.h"
#include "engine/app/viewer/edit/transfer_edit.h"
#include "engine/app/viewer/shell/controls.h"
#include "engine/app/viewer/shell/draft.h"
#include "engine/app/viewer/shell/hand_host.h"
#include "engine/app/viewer/shell/layout.h"
#include "engine/app/viewer/shell/live_plan.h"
#include "engine/app/viewer/shell/pacing.h"
#include "engine/app/viewer/shell/scene_host.h"
#include "engine/app/viewer/shell/screen.h"
#include "engine/app/viewer/shell/step_player.h"
#include "engine/app/viewer/shell/values.h"

namespace catena::app {

struct LookState {
  FieldValues values;
  int press = 0;  ///< counts presses of the pointer: names drags

  /// A drag in a plot: where the handle would be, by the pointer alone.
  double at_x = 0, at_y = 0;

  /// The transfer function being edited.
  struct Transfer {
    std::string volume;                         ///< its pointer
    std::optional<std::size_t> opacity, color;  ///< selected points
    std::optional<TransferEdit> before;         ///< as it was when the drag began
    std::optional<PlotFrame> frame;             ///< stands still while something is dragged
    bool whole_range = false;
  } transfer;

  std::map<std::string, std::string> switched_off;  ///< pointer to the text that stood there
};

/// A panel is one part of the side window, one file in panels/: it shows what is there, notes edits of the scene (context.edits, see
/// edit/edits.h), and asks for what else the window can do (context.commands, see shell/commands.h). Nothing here waits for anything.
/// To add one: a file with a function that returns its Panel, and that function's name in the list of panels.cpp. Frame thread, between
/// Gui::begin and end.

/// One line for the person, at the bottom of the window for a while.
struct Message {
  std::string text;
  bool is_error = false;
  std::int64_t at_ns = 0;
};

/// What goes on once it is decided what becomes of unsaved changes: another file, or (empty) the end of the program.
struct Leaving {
  std::string open;
  bool ends() const { return open.empty(); }
};

/// What is asked above everything else; each stands until it is answered.
struct Questions {
  bool open = false, save_as = false;  ///< the dialogs shall come up
  std::optional<Leaving> unsaved;      ///< what becomes of unsaved changes before that
  std::optional<std::string> dropped;  ///< a data file on an open scene: open it, or add it
  /// The scene's file was changed or removed by somebody else, and is to be saved.
  std::optional<scene::Document::OnDisk> changed;
  std::optional<LeftDraft> left;  ///< unsaved work of an earlier run
};

/// What the window shows beside the scene: set by the session, read by the panels.
struct ViewState {
  bool panels = true;  ///< the side window and the status line
  bool help = false, full_screen = false;
  Questions ask;
  std::deque<Message> messages;  ///< the newest last, at most kMessages
  static constexpr std::size_t kMessages = 100;

  // files
  bool untitled = false;            ///< nothing is open: the window says how to begin
  bool owns_file = true;            ///< the scene's path is its own; else it was made for a data file and is saved where the person says
  std::string loading;              ///< the path that is being opened; empty: none
  std::vector<std::string> recent;  ///< paths, the newest first

  StepPlayer steps;  ///< in time

  std::string prompt;  ///< what the person does next, until it is done; empty: nothing is asked

  // the picture and the pointer
  Area area;                            ///< of the picture, window coordinates
  double pointer_x = 0, pointer_y = 0;  ///< window coordinates
  bool pointer_on_picture = false;      ///< and not on a panel
  bool pointer_seen = false;            ///< it has moved over the window
  bool pointer_pressed = false;         ///< a button is down
  PlaceValues pointer, probe, proxy;    ///< for the table of values
  std::string unit_length;
  double force_share = 0;  ///< of the greatest force, 0..1

  // what panels remember
  EditState edit;
  LookState look;

  void say(std::string text, bool is_error = false);
  /// An error is said.
  void say_if_wrong(const Outcome& outcome) {
    if (!outcome) say(outcome.error().message, true);
  }
};

struct PanelContext {
  SceneHost& scene;
  HandHost& hand;
  Screen& screen;
  Controls& controls;
  Pacing& pacing;
  LivePlan& plan;
  FrameTimes& times;
  ViewState& state;
  Commands& commands;
  Edits edits{commands, state.edit};

  /// Done after this frame, in order.
  void ask(Command command) { commands.push_back(std::move(command)); }
};

/// What the interface takes of the window where panels are shown (after the first frame's begin).
inline constexpr float kSideWidth = 320;
Edges interface_edges();

struct Panel {
  const char* title;
  bool open_at_first;
  void (*draw)(PanelContext& context);
  /// Whether the scene has anything for it; nullptr: always shown.
  bool (*wanted)(const PanelContext& context) = nullptr;
};
/// For Panel::wanted.
template <class Component>
bool has_any(const PanelContext& context) {
  return context.scene.scene().world.count<Component>() > 0;
}

/// Everything in order: the menu bar, the side window with every panel, the dialogs, the status line.
void draw_interface(PanelContext& context);

// what is drawn beside the panels
void draw_menu(PanelContext& context);
void draw_dialogs(PanelContext& context);
void draw_status(PanelContext& context);
void draw_file_dialogs(PanelContext& context);
void draw_start(PanelContext& context);
/// The recent files as a list to choose from; false: there are none.
bool draw_recent(PanelContext& context);

}  // namespace catena::app
