/// A panel: one part of the side window, one file in panels/. It shows what is there and turns what the person does into edits of the
/// document (SceneHost::set) or wishes (ViewState). Nothing here waits for anything. Frame thread, between Gui::begin and end.
/// To add one: a function in panels/NAME.cpp, declared below, and a line in the list of panels.cpp.
#pragma once
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/app/viewer/controls.h"
#include "engine/app/viewer/frame_times.h"
#include "engine/app/viewer/hand_host.h"
#include "engine/app/viewer/look_state.h"
#include "engine/app/viewer/pacing.h"
#include "engine/app/viewer/scene_host.h"
#include "engine/app/viewer/screen.h"

namespace catena::app {

/// One line for the person, at the bottom of the window for a while.
struct Message {
  std::string text;
  bool is_error = false;
  std::int64_t at_ns = 0;
};

/// What the window does that is not the scene; panels write their wishes here, the session fulfils them after the frame.
struct ViewState {
  bool panels = true;  ///< the side window and the status line
  bool help = false;
  bool turntable = false;
  bool quit = false;
  std::optional<std::string> open, save;    ///< paths
  bool ask_open = false, ask_save = false;  ///< show the dialogs
  std::optional<std::string> screenshot;    ///< .png to write
  bool screenshot_of_window = false;        ///< with the interface
  std::optional<Quality> quality;           ///< of a picture at rest, from now on
  std::deque<Message> messages;             ///< the newest last, at most kMessages
  static constexpr std::size_t kMessages = 100;
  double pointer_x = 0, pointer_y = 0;  ///< window coordinates
  bool pointer_on_picture = false;      ///< and not on a panel
  bool pointer_pressed = false;         ///< a button is down
  int next_drag = 0;                    ///< numbers drags: edits of one drag are one step of undo
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
void draw_fields(PanelContext& context);
void draw_transfer(PanelContext& context);
void draw_isosurfaces(PanelContext& context);
void draw_slices(PanelContext& context);
void draw_lines(PanelContext& context);
void draw_meshes(PanelContext& context);
void draw_scene_view(PanelContext& context);

}  // namespace catena::app
