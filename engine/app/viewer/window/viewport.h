/// Viewport is the picture in the window: it says where the picture lies, draws it, shows it with the interface over it, looks up what
/// is under the pointer, and writes it to files. Frame thread.
#pragma once
#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "engine/app/viewer/window/frame_builder.h"
#include "engine/app/viewer/window/shader_reload.h"
#include "engine/app/viewer/window/viewer_context.h"
#include "engine/app/viewer/xr/xr_session.h"

namespace catena::app {

class Viewport {
 public:
  Viewport(ViewerContext& shared, std::optional<ShaderReload> reload)
      : context_(shared), frame_builder_(shared.scene, shared.navigation, shared.scheduler), reload_(std::move(reload)) {}
  ~Viewport();  ///< what the headset has on the device goes first

  /// What draws it, and the headset where one is asked for; before the first picture.
  std::optional<Failure> open();
  /// What the headset has to say. True: it wants a picture at every turn of the loop.
  Result<bool> poll_headset();
  /// The hand's newest state was taken while the headset's picture was drawn, and what comes of it is still to be looked at. Once.
  bool take_late_probe_motion() { return std::exchange(probe_moved_late_, false); }
  /// For the title; empty without one.
  std::string headset_status() const { return headset_session_ ? headset_session_->status_text() : std::string(); }
  /// The three places of the device on the desk are asked for, or not any more.
  Outcome toggle_registration();
  /// For the last words; empty without one.
  std::string headset_summary() const { return headset_session_ ? headset_session_->summary_text() : std::string(); }
  Presenter& presenter() { return *presenter_; }

  bool is_minimised() const;
  /// The picture's place in the window; true where it has changed.
  bool update_layout();
  /// Width and height of the picture, pixels; at least 1.
  std::array<std::uint32_t, 2> size() const;
  /// It is not there, not in the window's size, or an eye's of a headset that shows nothing any more.
  bool is_stale() const {
    return presenter_->is_resized() || !presenter_->has_image() || (shows_headset_eye_ && !headset_session_->is_running());
  }
  /// True: the next picture is drawn with other shaders.
  bool reload_shaders();

  /// Into the picture's part of the window; `for_file`: of the whole window's size, and no picture of the session's.
  std::optional<Failure> draw(const FrameRequest& next, bool for_file = false);
  /// Which one comes next (drawing.h).
  FrameBuilder& frame_builder() { return frame_builder_; }
  FrameRequest frame_after_probe_motion() {
    return frame_builder_.frame_after_probe_motion(pixel_rect_[2] - pixel_rect_[0], pixel_rect_[3] - pixel_rect_[1]);
  }
  /// The error of the picture that is at rest, once.
  std::optional<Failure> estimate_error();
  /// The plan of the picture as it is now: measured, or out of the store. From then on it is drawn by it.
  std::optional<Failure> apply_tuning();
  /// The interface over the last picture.
  std::optional<Failure> show(const std::function<void()>& make_panels);

  /// The interface has to be shown again though nothing happened.
  bool needs_redraw() const { return needs_redraw_; }
  void request_redraw() { needs_redraw_ = true; }
  /// Another scene: nothing of the last picture counts.
  void reset();
  /// What lies under the pointer beside the hand; nothing where it is not on the picture, or where the picture shows
  /// several eyes beside each other.
  std::optional<PickHit> pick_under_pointer() const;
  /// A place where the item ("isosurfaces[0]") is seen: under the pointer, or else the nearest to the middle of the picture on a lattice.
  std::optional<Vec3> find_visible_point(const std::string& item) const;
  /// "isosurfaces[0]"; empty: an id of no item.
  std::string item_label(std::uint32_t id) const { return frame_builder_.item_label(id); }
  /// The pointer may be over something else.
  void invalidate_pick() { is_pick_stale_ = true; }

  /// The picture, or the window, to the next free SCENE-001.png of the folder that the program was started in: as soon as there is one of
  /// every pixel, for which it waits a while.
  void request_screenshot(bool of_window) { requested_screenshot_ = of_window; }
  void write_requested_screenshot();
  /// --screenshot and --window-screenshot, at the end.
  std::optional<Failure> write_final_screenshots(const std::function<void()>& make_panels);

 private:
  Result<bool> draw_in_headset();
  void update_room_registration();
  void save_registration(const haptics::DeviceSettings::RoomRegistration& room);
  /// Of the picture's own size.
  Result<render::FramePacket> make_packet() const {
    return frame_builder_.make_packet(pixel_rect_[2] - pixel_rect_[0], pixel_rect_[3] - pixel_rect_[1]);
  }
  std::optional<PickHit> pick_at(double window_x, double window_y) const;
  void print_renderer_notes() const;
  void update_field_probes();

  ViewerContext& context_;
  FrameBuilder frame_builder_;
  std::optional<ShaderReload> reload_;
  std::unique_ptr<HeadsetSession> headset_session_;  ///< outlives the device that it made
  std::unique_ptr<Presenter> presenter_;
  std::array<std::uint32_t, 4> pixel_rect_{};  ///< where the picture lies in the window
  bool is_pick_stale_ = true;                  ///< the place under the pointer is to be looked at again
  bool needs_redraw_ = false;
  bool probe_moved_late_ = false;
  bool shows_headset_eye_ = false;            ///< the last picture is an eye of the headset
  std::optional<bool> requested_screenshot_;  ///< a file; of the window: true
  int frames_waited_ = 0;                     ///< frames, for a picture of every pixel
};

}  // namespace catena::app
