/// ServeSession is the loop of `catena serve`: what pages ask for -> newest haptic state -> picture -> pages. Frame thread.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/app/hand/signals.h"
#include "engine/app/serve/picture_maker.h"
#include "engine/app/serve/serve.h"
#include "engine/app/serve/served_recording.h"
#include "engine/app/serve/wishes.h"
#include "engine/app/viewer/edit/scene_items.h"
#include "engine/app/viewer/shell/eye.h"
#include "engine/app/viewer/shell/live_plan.h"
#include "engine/app/viewer/shell/step_follower.h"
#include "engine/app/viewer/shell/step_player.h"

namespace catena::app {

class ServeSession {
 public:
  /// `scene` is loaded, `hand` prepared and not started; all outlive the session.
  ServeSession(const ServeOptions& options, const LoadedScene& loaded, SceneHost& scene, HandHost& hand, web::Server& server,
               PictureMaker& maker, const Interrupt& interrupt);
  Outcome run();

 private:
  bool goes_on() const;
  // pages
  void hear(const web::News& news);
  void came(web::ViewerId viewer);
  void left(web::ViewerId viewer);
  void give_hand_to(web::ViewerId viewer);
  // what the page that has the hand asks for
  void carry_out(const MoveWish& wish);
  void carry_out(const SizeWish& wish);
  void carry_out(Action action);
  void carry_out(const LevelWish& wish);
  void carry_out(const OpacityWish& wish);
  void carry_out(const MapWish& wish);
  void carry_out(const StepWish& wish);
  void carry_out(const RecordWish& wish);
  void carry_out(const PlanWish& wish);
  void end_recording();
  void begin_hand();
  void end_hand();
  void apply_edits(const TextEdits& edits, const std::string& what, const std::string& item);
  // what pages are told
  void tell_roles();
  void tell_state();
  void note(const std::string& line);
  void note_if_wrong(const Outcome& outcome);
  Outcome plan_as_stated();
  Outcome measure_eye_now();
  Outcome show_next();
  Outcome send_picture(bool exact);

  const ServeOptions& options_;
  SceneHost& scene_;
  HandHost& hand_;
  web::Server& server_;
  PictureMaker& maker_;
  const Interrupt& interrupt_;
  Pacing pacing_;
  Controls controls_;
  Drawing drawing_;
  Eye eye_;
  FrameTimes times_;
  FieldValues values_;
  WidgetEdits widget_edits_;
  StepPlayer steps_;
  StepFollower follower_;
  LivePlan plan_;
  ServedRecording recording_;
  std::vector<web::ViewerId> viewers_;  ///< in the order in which they came
  web::ViewerId holder_ = 0;            ///< of the hand; 0: it is free
  std::size_t most_viewers_ = 0;
  std::uint32_t width_, height_;
  double pointer_x_ = 0.5, pointer_y_ = 0.5;  ///< shares of the picture
  std::uint32_t motion_ = 0;                  ///< number of the newest one
  bool moved_ = true, hand_moved_ = false;    ///< since the last picture
  bool exact_ = false;                        ///< the pages have the last picture as it is
  bool scene_told_ = false;
  std::string last_picture_, last_state_;
  std::int64_t start_ns_ = 0, last_state_ns_ = 0, last_scene_ns_ = 0, last_picture_ns_ = 0;
};

}  // namespace catena::app
