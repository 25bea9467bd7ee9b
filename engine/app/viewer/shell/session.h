/// One open window: input -> newest haptic state -> picture -> interface, again and again. Frame thread.
#pragma once
#include <memory>
#include <optional>
#include <string>

#include "engine/app/hand/interrupt.h"
#include "engine/app/viewer/edit/widget_edits.h"
#include "engine/app/viewer/panels/panel.h"
#include "engine/app/viewer/shell/draft.h"
#include "engine/app/viewer/shell/gui.h"
#include "engine/app/viewer/shell/pulse_clock.h"
#include "engine/app/viewer/shell/recent_files.h"
#include "engine/app/viewer/shell/scene_loader.h"
#include "engine/app/viewer/shell/shader_reload.h"
#include "engine/app/viewer/viewer.h"

namespace catena::app {

struct Failure {
  int exit_code;
  std::string message;
};

class Session {
 public:
  explicit Session(ViewOptions options) : options_(std::move(options)), pacing_(options_.quality), hand_(options_.hand) {}

  std::optional<Failure> open();
  std::optional<Failure> run();

 private:
  // session.cpp
  Outcome load_first(std::uint32_t width, std::uint32_t height);
  void look_at(const LoadedScene& loaded);
  std::optional<Failure> open_screen();
  std::optional<Failure> draw(const NextPicture& next, bool for_file = false);
  std::optional<Failure> estimate();
  std::optional<Failure> show();
  std::optional<Failure> finish();
  std::optional<Failure> draw_without_window(const std::string& why);
  bool run_pulses();
  bool take_edits();
  void keep_widgets();
  bool take_shaders();
  void measure();
  void pin_camera();
  void update_title();
  void say_goodbye() const;
  RecordedScene recorded() const;
  void check_edits();
  PanelContext context() { return {*scene_, hand_, *screen_, controls_, pacing_, times_, state_}; }

  // session_view.cpp
  bool lay_out();
  double aspect() const { return state_.area.width / state_.area.height; }
  bool move_camera();
  void obey_view();
  void stop_turning(const Input& input);
  bool is_gliding() const;
  void update_values();

  // session_input.cpp
  Changed take_input(double wait_s);
  Changed take_piece(Input piece);
  Gui::Frame interface_frame();
  void obey(Command command);
  bool obey_once(const Input& input);
  Input routed(Input input);
  void escape();
  void fulfil_wishes();
  void fulfil_wishes_for_the_hand();

  // session_files.cpp
  void fulfil_wishes_for_files();
  void leave(const Leaving& leaving);
  void leave_or_ask(const Leaving& leaving);
  void drop(const std::string& path);
  bool save(const std::string& path);
  void keep_unsaved(bool now = false);
  void look_for_left();
  void fulfil_wishes_for_left();
  void start_loading(const std::string& path, bool adds);
  bool take_loaded();
  void replace_scene(LoadedScene loaded, const std::string& path);
  void add_to_scene(LoadedScene loaded, const std::string& path);
  void remember(const std::string& path);
  void write_screenshot(const std::string& path);

  ViewOptions options_;
  std::optional<SceneHost> scene_;
  std::unique_ptr<Window> window_;
  std::unique_ptr<Screen> screen_;
  std::unique_ptr<Gui> gui_;
  Controls controls_;
  Pacing pacing_;
  int screenshot_waits_ = 0;  ///< frames, for a picture of every pixel
  FrameTimes times_;
  ViewState state_;
  SceneKind kind_;
  WidgetEdits widget_edits_;
  PulseClock pulses_;
  bool has_pulses_ = false, pulses_run_ = true;
  std::optional<ShaderReload> reload_;
  std::optional<Interrupt> interrupt_;
  HandHost hand_;

  RecentFiles recent_;
  SceneLoader loader_;
  bool loading_adds_ = false;                 ///< what is being loaded joins the scene
  std::optional<render::FramePacket> shown_;  ///< the last picture's
  std::array<std::uint32_t, 4> pixels_{};     ///< where the picture lies in the window
  render::View saved_view_;                   ///< that the scene's text has, or began with
  Flight flight_;
  std::int64_t last_move_ns_ = 0;  ///< of the camera by itself
  bool picked_stale_ = true;       ///< the place under the pointer is to be looked at again
  bool owns_file_ = true;          ///< the scene was read from, or saved to, the file of its path
  bool moved_by_menu_ = false;
  bool leaves_ = false;    ///< the loop ends
  Draft draft_;            ///< what is not saved
  bool given_up_ = false;  ///< by the person, on the way out
  std::int64_t last_kept_ns_ = 0;
  std::string not_kept_;  ///< why, as it was said
  int unsettled_ = 0;     ///< interfaces to come though nothing happens: they settle their sizes

  bool damaged_ = false;
  bool interface_holds_pointer_ = false;  ///< the buttons that are down went down on it
  std::int64_t last_title_ = 0;
  int frames_in_title_ = 0;
};

}  // namespace catena::app
