/// One open window: input -> newest haptic state -> picture -> interface, again and again. Frame thread.
#pragma once
#include <memory>
#include <optional>
#include <string>

#include "engine/app/hand/interrupt.h"
#include "engine/app/viewer/gui.h"
#include "engine/app/viewer/panel.h"
#include "engine/app/viewer/pulse_clock.h"
#include "engine/app/viewer/shader_reload.h"
#include "engine/app/viewer/viewer.h"
#include "engine/app/viewer/widget_edits.h"

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
  std::optional<Failure> open_scene();
  std::optional<Failure> draw(const NextPicture& next);
  std::optional<Failure> show();
  std::optional<Failure> finish();
  bool run_pulses();
  bool take_edits();
  void keep_widgets();
  bool take_shaders();
  void measure();
  void pin_camera();
  void update_title();
  void say_goodbye() const;
  PanelContext context() { return {*scene_, hand_, *screen_, controls_, pacing_, times_, state_}; }

  // session_input.cpp
  Changed take_input(double wait_s);
  void obey(Command command);
  void obey_once(const Input& input, Changed& changed);
  Input routed(Input input);
  void fulfil_wishes();
  void replace_scene(const std::string& path);

  ViewOptions options_;
  std::optional<SceneHost> scene_;
  std::unique_ptr<Window> window_;
  std::unique_ptr<Screen> screen_;
  std::unique_ptr<Gui> gui_;
  Controls controls_;
  Pacing pacing_;
  FrameTimes times_;
  ViewState state_;
  SceneKind kind_;
  WidgetEdits widget_edits_;
  PulseClock pulses_;
  bool has_pulses_ = false, pulses_run_ = true;
  std::optional<ShaderReload> reload_;
  std::optional<Interrupt> interrupt_;
  HandHost hand_;

  bool damaged_ = false;
  bool interface_holds_pointer_ = false;  ///< the buttons that are down went down on it
  std::int64_t last_title_ = 0;
  int frames_in_title_ = 0;
};

}  // namespace catena::app
