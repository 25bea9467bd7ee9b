/// Session is the loop of one open window, again and again: input -> newest haptic state -> picture -> interface. It reads strokes and
/// carries out commands; files are in scene_files.h, the picture in picture_view.h, the eye in eye.h. Frame thread.
#pragma once
#include <optional>
#include <string>

#include "engine/app/hand/signals.h"
#include "engine/app/viewer/edit/scene_items.h"
#include "engine/app/viewer/shell/eye.h"
#include "engine/app/viewer/shell/pacing.h"
#include "engine/app/viewer/shell/picture_view.h"
#include "engine/app/viewer/shell/scene_files.h"
#include "engine/app/viewer/shell/shared.h"
#include "engine/app/viewer/shell/step_follower.h"
#include "engine/app/viewer/shell/tracked_head.h"

namespace catena::app {

class Session {
 public:
  /// `head`: where one is tracked. `hand` has its device; `scene` is read, and not loaded yet. `interrupt` is made where a device needs it,
  /// and outlives the hand.
  Session(const ViewOptions& options, SceneHost& scene, HandHost& hand, Window& window, std::optional<ShaderReload> reload,
          std::unique_ptr<TrackedHead> head, std::optional<Interrupt>& interrupt);
  ~Session();  ///< the hand is let go first
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  std::optional<Failure> open();
  std::optional<Failure> run();

 private:
  // the loop
  bool goes_on() const;
  std::optional<NextPicture> next_picture(bool moved, bool hand_moved);
  bool take_edits();
  void keep_widgets();
  void look_for_pulses();
  void observe_hand_anew();
  void observe_hand();
  void forget_plan();
  std::optional<Failure> measure_plan();
  bool run_pulses();
  bool follow_head();
  void follow_steps();
  void show_step(int step);
  void update_title();
  PanelContext context();
  std::optional<Failure> finish();
  void tell_figures();

  // session_input.cpp
  Changed take_input(double wait_s);
  Changed take_piece(Input piece);
  Input routed(Input input);
  Gui::Frame interface_frame();

  // session_input.cpp
  void carry_out();
  void carry_out(const Command& command);
  void act(Action action);
  void begin_hand();
  void end_hand();
  void feel(const std::string& item, std::optional<Vec3> at);
  void remove(const std::string& item, const std::string& what);
  void close();

  Gui gui_;
  Shared shared_;
  Eye eye_;
  std::unique_ptr<TrackedHead> head_;  ///< none: the mouse moves the eye
  render::View before_screen_;         ///< but for where the head is
  PictureView picture_;
  SceneFiles files_;
  StepFollower follower_;
  std::optional<Interrupt>& interrupt_;
  WidgetEdits widget_edits_;
  PulseClock pulses_;
  bool has_pulses_ = false, pulses_run_ = true;
  std::int64_t start_ns_ = 0;             ///< of the loop
  bool changed_ = false;                  ///< a command has changed what the picture shows
  bool wants_error_ = false;              ///< of the picture at rest
  bool measure_ = false;                  ///< what a plan goes by
  std::int64_t last_observed_ns_ = 0;     ///< the hand
  bool interface_holds_pointer_ = false;  ///< the buttons that are down went down on it
  int unsettled_ = 0;                     ///< interfaces to come though nothing happens: they settle their sizes
  std::int64_t last_title_ns_ = 0;
  int pictures_in_title_ = 0;  ///< drawn when it was last made
};

}  // namespace catena::app
