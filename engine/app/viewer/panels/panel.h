/// A panel: one part of the side window, one file in panels/. It shows what is there and turns what the person does into edits of the
/// document (SceneHost::set) or wishes (ViewState). Nothing here waits for anything. Frame thread, between Gui::begin and end.
/// To add one: a function in panels/NAME.cpp, declared below, and a line in the list of panels.cpp.
#pragma once
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/app/viewer/panels/look_state.h"
#include "engine/app/viewer/shell/controls.h"
#include "engine/app/viewer/shell/draft.h"
#include "engine/app/viewer/shell/frame_times.h"
#include "engine/app/viewer/shell/hand_host.h"
#include "engine/app/viewer/shell/layout.h"
#include "engine/app/viewer/shell/pacing.h"
#include "engine/app/viewer/shell/scene_host.h"
#include "engine/app/viewer/shell/screen.h"
#include "engine/app/viewer/shell/values.h"

namespace catena::app {

/// One line for the person, at the bottom of the window for a while.
struct Message {
  std::string text;
  bool is_error = false;
  std::int64_t at_ns = 0;
};

/// Numbers of the document that are being typed: taken when the person is done.
struct TypedNumbers {
  std::string pointer;
  Vec3 numbers{0.0};  ///< of a single one the first
  int frame = 0;      ///< when they were last typed at
};

/// What goes on once it is decided what becomes of unsaved changes.
struct Leaving {
  bool quit = false;
  std::string open;  ///< a path; empty: nothing is opened
};
enum class Answer { save, discard, cancel };
/// What becomes of work that an earlier run left unsaved.
enum class AnswerToLeft { restore, discard, later };

/// What the window does that is not the scene; panels write their wishes here, the session fulfils them after the frame.
struct ViewState {
  bool panels = true;  ///< the side window and the status line
  bool help = false;
  bool turntable = false;
  bool quit = false;
  std::optional<std::string> open, save;    ///< paths; save "": where the scene comes from
  bool ask_open = false, ask_save = false;  ///< show the dialogs
  std::optional<std::string> screenshot;    ///< .png to write
  bool screenshot_of_window = false;        ///< with the interface
  std::optional<Quality> quality;           ///< of a picture at rest, from now on
  bool estimate = false;                    ///< the error of the picture at rest is asked for
  std::optional<std::string> device;        ///< another one to hold the probe
  std::optional<std::string> record;        ///< .catlog to write from now on; empty: no more
  bool fly = false, full_screen = false;
  std::optional<Leaving> ask_unsaved;  ///< the question stands
  std::optional<Answer> answer;        ///< to it
  std::optional<Leaving> after_save;   ///< what a save that succeeds goes on with
  std::optional<LeftDraft> ask_left;   ///< the question stands
  std::optional<AnswerToLeft> answer_to_left;
  std::optional<std::string> ask_dropped;  ///< a data file on an open scene: open it, or add it
  std::optional<std::string> add;          ///< a data file that shall join the scene
  std::string loading;                     ///< the path that is being opened; empty: none
  bool untitled = false;                   ///< nothing is open: the window says how to begin
  std::vector<std::string> recent;         ///< paths, the newest first
  Area area;                               ///< of the picture, window coordinates
  Input moves{};                           ///< of the eye, asked for by the menu
  PlaceValues pointer, probe, proxy;       ///< for the table of values
  std::string unit_length;
  double force_share = 0;        ///< of the greatest force, 0..1
  std::deque<Message> messages;  ///< the newest last, at most kMessages
  static constexpr std::size_t kMessages = 100;
  double pointer_x = 0, pointer_y = 0;  ///< window coordinates
  bool pointer_on_picture = false;      ///< and not on a panel
  bool pointer_seen = false;            ///< it has moved over the window
  bool pointer_pressed = false;         ///< a button is down
  TypedNumbers typed;
  int next_drag = 0;  ///< numbers drags: edits of one drag are one step of undo
  LookState look;

  void say(std::string text, bool is_error = false);
};

struct PanelContext {
  SceneHost& scene;
  HandHost& hand;
  Screen& screen;
  Controls& controls;
  Pacing& pacing;
  FrameTimes& times;
  ViewState& state;

  /// An edit whose error becomes a message. True: done.
  bool edit(std::string_view pointer, const std::string& value, const std::string& what, const std::string& drag = {});
  bool remove(std::string_view pointer, const std::string& what);
  bool apply(const std::vector<scene::Document::Edit>& edits, const std::string& what, const std::string& drag = {});
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

/// All panels in order: the menu bar, the side window with every panel, the dialogs, the status line.
void draw_interface(PanelContext& context);

// panels/*.cpp
void draw_menu(PanelContext& context);
void draw_dialogs(PanelContext& context);
void draw_status(PanelContext& context);
void draw_times(PanelContext& context);
void draw_values(PanelContext& context);
void draw_file_dialogs(PanelContext& context);
void draw_start(PanelContext& context);
/// The recent files as a list to choose from; false: there are none.
bool draw_recent(ViewState& state);
void draw_chain(PanelContext& context);
void draw_device(PanelContext& context);
void draw_recording(PanelContext& context);
void draw_quality(PanelContext& context);
void draw_widgets(PanelContext& context);
void draw_fields(PanelContext& context);
void draw_transfer(PanelContext& context);
void draw_isosurfaces(PanelContext& context);
void draw_slices(PanelContext& context);
void draw_lines(PanelContext& context);
void draw_meshes(PanelContext& context);
void draw_scene_view(PanelContext& context);

}  // namespace catena::app
