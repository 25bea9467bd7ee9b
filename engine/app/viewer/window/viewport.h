// SPDX-License-Identifier: MIT
/// The viewport: the image area of the window. Renders the image, shows it with the GUI on top, picks what is under the pointer, and writes
/// image files. Frame thread.
#pragma once
#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "engine/app/viewer/input/plane_views.h"
#include "engine/app/viewer/input/widget_drag.h"
#include "engine/app/viewer/scene/scene_model.h"
#include "engine/app/viewer/window/frame_builder.h"
#include "engine/app/viewer/window/shader_reload.h"
#include "engine/app/viewer/window/viewer_context.h"
#include "engine/app/viewer/xr/xr_session.h"

namespace catena::app {

/// Owns the presenter, the headset session and the frame builder.
class Viewport {
 public:
  Viewport(ViewerContext& shared, std::optional<ShaderReload> reload)
      : context_(shared), frame_builder_(shared.scene, shared.navigation, shared.scheduler), reload_(std::move(reload)) {}
  ~Viewport();  ///< Ends the headset session before its device is destroyed.

  /// Creates the presenter, and the headset session if requested. Call before the first frame. Returns the failure, if any.
  std::optional<Failure> open();
  /// Shows what is being read until the first scene is loaded; opens the presenter after a second. Does not use the scene.
  std::optional<Failure> show_loading(const LoadWait& is_loaded);
  /// Processes the events of the headset. Returns true if it needs a frame at every turn of the loop. An Error if the graphics device
  /// cannot be recreated.
  Result<bool> poll_headset();
  /// Returns, once, whether the latest haptic state was taken during a headset frame (late latching), so that its effects are still to be
  /// processed.
  bool take_late_probe_motion() { return std::exchange(probe_moved_late_, false); }
  /// Returns the status for the window title; empty without a headset.
  std::string headset_status() const { return headset_session_ ? headset_session_->status_text() : std::string(); }
  /// Starts the registration of the device on the desk, or cancels it. An Error without a headset or if the device cannot be registered.
  Outcome toggle_registration();
  /// Returns the final statistics; empty without a headset.
  std::string headset_summary() const { return headset_session_ ? headset_session_->summary_text() : std::string(); }
  Presenter& presenter() { return *presenter_; }

  bool is_minimised() const;
  /// Recomputes the image area; returns true if it has changed.
  bool update_layout();
  /// Returns width and height of the image, pixels; at least 1.
  std::array<std::uint32_t, 2> size() const;
  /// Returns whether the image must be rendered again: there is none, its size differs from the window's, or it is an eye of a headset that
  /// has stopped.
  bool is_stale() const {
    return presenter_->is_resized() || !presenter_->has_image() || (shows_headset_eye_ && !headset_session_->is_running());
  }
  /// Returns true if the next frame uses other shaders.
  bool reload_shaders();

  /// Renders a frame into the image area; `for_file`: at the size of the whole window, not counted as a frame of the session. Returns the
  /// failure, if any.
  std::optional<Failure> draw(const FrameRequest& next, bool for_file = false);
  /// Returns the frame builder, which determines the next frame (frame_builder.h).
  FrameBuilder& frame_builder() { return frame_builder_; }
  FrameRequest frame_after_probe_motion() {
    return frame_builder_.frame_after_probe_motion(pixel_rect_[2] - pixel_rect_[0], pixel_rect_[3] - pixel_rect_[1]);
  }
  /// Estimates the error of the refined image, if it is not known yet.
  std::optional<Failure> estimate_error();
  /// Tunes the image settings for the current image, from measured or cached costs; the following frames use them.
  std::optional<Failure> apply_tuning();
  /// Shows the last image with the GUI over it.
  std::optional<Failure> show(const std::function<void()>& make_panels);

  /// Returns whether the GUI must be shown again although there was no event.
  bool needs_redraw() const { return needs_redraw_; }
  void request_redraw() { needs_redraw_ = true; }
  /// Resets the state for another scene.
  void reset();
  /// Returns what lies under the pointer, ignoring the probe; nothing if the pointer is not on the image, or if the image shows several
  /// eyes side by side.
  std::optional<PickHit> pick_under_pointer() const;
  /// Returns the area of the 3D view, window coordinates: the image area, or its part in a page of orthogonal views.
  Area view_area() const;
  /// Returns the plane of a page of orthogonal views at a position of the window, and its area; nothing elsewhere.
  struct PlaneAt {
    std::shared_ptr<const render::FramePacket> plane;
    Area area;
  };
  std::optional<PlaneAt> plane_at(double window_x, double window_y) const;
  /// Returns the widget part that a press of the left button at a position of the 3D view would drag: a visible one, and none in probe
  /// mode.
  std::optional<WidgetPart> widget_at(double x, double y) const;
  /// Returns the widget part that a press at a position of a plane's area would drag. `camera`: of the plane.
  std::optional<WidgetPart> widget_in_plane(const PlaneAt& plane, const render::Camera& camera, double x, double y) const;
  /// Returns whether the window shows one image of one camera, so that its positions are those of the camera's image.
  bool shows_single_view() const;
  /// Returns a visible point of the item ("isosurfaces[0]"): under the pointer, or else the one nearest to the image center on a grid of
  /// sample points. Nothing if none is found.
  std::optional<Vec3> find_visible_point(const std::string& item) const;
  /// Returns "isosurfaces[0]"; empty for an id of no item.
  std::string item_label(std::uint32_t id) const { return frame_builder_.item_label(id); }
  /// Marks the pick under the pointer as out of date.
  void invalidate_pick() { is_pick_stale_ = true; }

  /// Requests a screenshot of the image or the window, written to the first unused SCENE-001.png in the working directory as soon as an
  /// image with every pixel is available, for which it waits at most 30 calls.
  void request_screenshot(bool of_window) { requested_screenshot_ = of_window; }
  void write_requested_screenshot();
  /// Writes the files of --screenshot and --screenshot-ui at the end. Returns the failure, if any.
  std::optional<Failure> write_final_screenshots(const std::function<void()>& make_panels);

 private:
  Result<bool> draw_in_headset();
  void update_room_registration();
  void save_registration(const haptics::DeviceSettings::RoomRegistration& room);
  /// Makes a packet of the size of the image.
  Result<render::FramePacket> make_packet() const {
    return frame_builder_.make_packet(pixel_rect_[2] - pixel_rect_[0], pixel_rect_[3] - pixel_rect_[1]);
  }
  std::optional<PickHit> pick_at(double window_x, double window_y) const;
  void print_renderer_notes() const;
  void update_field_probes();

  ViewerContext& context_;
  FrameBuilder frame_builder_;
  std::optional<ShaderReload> reload_;
  std::unique_ptr<HeadsetSession> headset_session_;  ///< Outlives the device created by its runtime.
  std::unique_ptr<Presenter> presenter_;
  std::array<std::uint32_t, 4> pixel_rect_{};  ///< Image area in framebuffer pixels: x0, y0, x1, y1.
  bool is_clipped_away_ = false;               ///< The clip planes leave nothing of the data.
  bool is_pick_stale_ = true;                  ///< The pick under the pointer must be repeated.
  bool needs_redraw_ = false;
  bool probe_moved_late_ = false;
  bool shows_headset_eye_ = false;            ///< The last image is an eye of the headset.
  std::optional<bool> requested_screenshot_;  ///< Requested screenshot: true for the window, false for the image.
  int frames_waited_ = 0;                     ///< Calls waited for an image with every pixel.
};

}  // namespace catena::app
