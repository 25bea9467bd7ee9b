/// PictureView is the picture in the window: it says where the picture lies, draws it, shows it with the interface over it, looks up what
/// is under the pointer, and writes it to files. Frame thread.
#pragma once
#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "engine/app/viewer/shell/drawing.h"
#include "engine/app/viewer/shell/headset_host.h"
#include "engine/app/viewer/shell/shader_reload.h"
#include "engine/app/viewer/shell/shared.h"

namespace catena::app {

class PictureView {
 public:
  PictureView(Shared& shared, std::optional<ShaderReload> reload)
      : shared_(shared), drawing_(shared.scene, shared.controls, shared.pacing), reload_(std::move(reload)) {}
  ~PictureView();  ///< what the headset has on the device goes first

  /// What draws it, and the headset where one is asked for; before the first picture.
  std::optional<Failure> open();
  /// What the headset has to say. True: it wants a picture at every turn of the loop.
  Result<bool> follow_headset();
  /// The hand's newest state was taken while the headset's picture was drawn, and what comes of it is still to be looked at. Once.
  bool take_hand_moved() { return std::exchange(hand_moved_late_, false); }
  /// For the title; empty without one.
  std::string headset_words() const { return headset_ ? headset_->words() : std::string(); }
  /// The three places of the device on the desk are asked for, or not any more.
  Outcome ask_for_places();
  /// For the last words; empty without one.
  std::string headset_figures() const { return headset_ ? headset_->figures() : std::string(); }
  Screen& screen() { return *screen_; }

  bool is_minimised() const;
  /// The picture's place in the window; true where it has changed.
  bool lay_out();
  /// Width and height of the picture, pixels; at least 1.
  std::array<std::uint32_t, 2> size() const;
  /// It is not there, not in the window's size, or an eye's of a headset that shows nothing any more.
  bool is_stale() const { return screen_->is_resized() || !screen_->has_picture() || (is_eye_ && !headset_->running()); }
  /// True: the next picture is drawn with other shaders.
  bool take_shaders();

  /// Into the picture's part of the window; `for_file`: of the whole window's size, and no picture of the session's.
  std::optional<Failure> draw(const NextPicture& next, bool for_file = false);
  /// Which one comes next (drawing.h).
  Drawing& drawing() { return drawing_; }
  NextPicture followed() { return drawing_.followed(pixels_[2] - pixels_[0], pixels_[3] - pixels_[1]); }
  /// The error of the picture that is at rest, once.
  std::optional<Failure> estimate();
  /// The plan of the picture as it is now: measured, or out of the store. From then on it is drawn by it.
  std::optional<Failure> plan();
  /// The interface over the last picture.
  std::optional<Failure> show(const std::function<void()>& make_panels);

  /// The interface has to be shown again though nothing happened.
  bool is_damaged() const { return damaged_; }
  void damage() { damaged_ = true; }
  /// Another scene: nothing of the last picture counts.
  void forget();
  /// What lies under the pointer beside the hand; nothing where it is not on the picture, or where the picture shows
  /// several eyes beside each other.
  std::optional<PickedPlace> under_pointer() const;
  /// A place where the item ("isosurfaces[0]") is seen: under the pointer, or else the nearest to the middle of the picture on a lattice.
  std::optional<Vec3> seen_place(const std::string& item) const;
  /// "isosurfaces[0]"; empty: an id of no item.
  std::string item_of(std::uint32_t id) const { return drawing_.item_of(id); }
  /// The pointer may be over something else.
  void look_again() { picked_stale_ = true; }

  /// The picture, or the window, to the next free SCENE-001.png of the folder that the program was started in: as soon as there is one of
  /// every pixel, for which it waits a while.
  void ask_for_file(bool of_window) { asked_ = of_window; }
  void write_asked();
  /// --screenshot and --window-screenshot, at the end.
  std::optional<Failure> write_last(const std::function<void()>& make_panels);

 private:
  Result<bool> draw_in_headset();
  void follow_the_room();
  void keep_room(const haptics::DeviceSettings::Room& room);
  /// Of the picture's own size.
  Result<render::FramePacket> packet() const { return drawing_.packet(pixels_[2] - pixels_[0], pixels_[3] - pixels_[1]); }
  std::optional<PickedPlace> picked_at(double window_x, double window_y) const;
  void tell_notes() const;
  void update_values();

  Shared& shared_;
  Drawing drawing_;
  std::optional<ShaderReload> reload_;
  std::unique_ptr<HeadsetHost> headset_;  ///< outlives the device that it made
  std::unique_ptr<Screen> screen_;
  std::array<std::uint32_t, 4> pixels_{};  ///< where the picture lies in the window
  bool picked_stale_ = true;               ///< the place under the pointer is to be looked at again
  bool damaged_ = false;
  bool hand_moved_late_ = false;
  bool is_eye_ = false;        ///< the last picture is an eye of the headset
  std::optional<bool> asked_;  ///< a file; of the window: true
  int waits_ = 0;              ///< frames, for a picture of every pixel
};

}  // namespace catena::app
