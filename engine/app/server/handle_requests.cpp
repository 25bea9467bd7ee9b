// SPDX-License-Identifier: MIT
// Carries out the requests of the viewer in control.
#include <utility>

#include "engine/app/server/serve_session.h"
#include "engine/scene/to_json.h"

namespace catena::app {

void ServeSession::handle(const MoveRequest& request) {
  input_number_ = request.number;
  NavigationChanges changed;
  for (Input piece : request.inputs) {
    piece.width = width_;
    piece.height = height_;
    pointer_x_ = (piece.x + piece.dx) / width_;
    pointer_y_ = (piece.y + piece.dy) / height_;
    if (stops_turntable(piece)) controls_.turntable = false;
    const auto under = controls_.probe_mode ? frame_builder_.pick_at(pointer_x_, pointer_y_) : std::nullopt;
    controls_.pointer_hit = under ? std::optional(under->world) : std::nullopt;
    haptics_.update_resistance(scene_.scene(), controls_);
    const NavigationChanges by_piece = apply(controls_, piece);
    changed.view = changed.view || by_piece.view;
    changed.probe = changed.probe || by_piece.probe;
  }
  if (changed.probe) {
    haptics_.move_mouse(scene_.scene(), controls_.probe, controls_.buttons);
    probe_moved_ = true;
  }
  if (!changed.view) return;
  camera_.pin_camera();
  has_changed_ = true;
}

void ServeSession::handle(const SizeRequest& request) {
  has_changed_ = has_changed_ || width_ != request.width || height_ != request.height;
  width_ = request.width;
  height_ = request.height;
}

void ServeSession::handle(Action action) {
  switch (action) {
    case Action::toggle_probe_mode:
      return controls_.probe_mode ? stop_haptics() : start_haptics();
    case Action::undo:
      scene_sent_ = false;
      return send_note_on_error(scene_.undo());
    case Action::redo:
      scene_sent_ = false;
      return send_note_on_error(scene_.redo());
    case Action::play_time_steps:
      playback_.is_playing = !playback_.is_playing;
      return;
    case Action::next_time_step:
    case Action::previous_time_step:
      return send_note_on_error(playback_.show(scene_, scene_.scene().time.step + (action == Action::next_time_step ? 1 : -1)));
    default:
      break;  // an action of the camera
  }
  has_changed_ = camera_.handle(action, static_cast<double>(width_) / height_) || has_changed_;
}

/// Moves the probe onto the item under the pointer.
void ServeSession::start_haptics() {
  controls_.probe_mode = true;
  const auto under = frame_builder_.pick_at(pointer_x_, pointer_y_);
  controls_.pointer_hit = under ? std::optional(under->world) : std::nullopt;
  app::begin_probe_mode(controls_);
  haptics_.move_mouse(scene_.scene(), controls_.probe, controls_.buttons);
  probe_moved_ = true;
}

/// The probe stays at its position with no button pressed.
void ServeSession::stop_haptics() {
  controls_.probe_mode = false;
  controls_.buttons = 0;
  haptics_.move_mouse(scene_.scene(), controls_.probe, 0);
  probe_moved_ = true;
}

void ServeSession::apply_edits(const TextEdits& edits, const std::string& what, const std::string& item) {
  if (const Outcome done = scene_.apply(edits, what, what + " of " + item); !done) send_note(done.error().message);
  scene_sent_ = false;
}

void ServeSession::handle(const LevelRequest& request) {
  const auto surface = find_item<scene::Isosurface>(scene_.scene(), request.item);
  if (!surface || item_pointer(surface->where).empty()) return send_note("there is no such isosurface");
  apply_edits(make_level_edits(scene_.scene(), *surface, request.value), "isolevel", request.item);
}

namespace {

/// The volume and its transfer function as rendered; std::nullopt if there is none.
std::optional<std::pair<scene::Volume, TransferEdit>> volume_of(const scene::Scene& scene, const std::string& item) {
  const auto volume = find_item<scene::Volume>(scene, item);
  if (!volume || item_pointer(volume->where).empty()) return std::nullopt;
  const scene::FieldSource& source = scene.entities.get<scene::FieldSource>(volume->field);
  if (!source.rendered.scalar) return std::nullopt;
  auto edit = make_transfer_edit(*volume, source.rendered.scalar->mapping().min_voxel_edge());
  if (!edit) return std::nullopt;
  return std::pair{*volume, std::move(*edit)};
}

}  // namespace

void ServeSession::handle(const OpacityRequest& request) {
  auto found = volume_of(scene_.scene(), request.item);
  if (!found) return send_note("there is no such volume");
  found->second.opacities = request.points;
  apply_edits(make_opacity_edits(found->first, found->second), "opacity", request.item);
}

void ServeSession::handle(const ColormapRequest& request) {
  const auto found = volume_of(scene_.scene(), request.item);
  if (!found) return send_note("there is no such volume");
  apply_edits(make_color_map_edits(found->first, found->second, request.name), "colours", request.item);
}

void ServeSession::handle(const StepRequest& request) { send_note_on_error(playback_.show(scene_, request.step)); }

/// During a recording its file is not offered for download, since it is incomplete.
void ServeSession::handle(const RecordRequest& request) {
  if (!request.on) return end_recording();
  send_note_on_error(recording_.begin(scene_, haptics_));
  server_.offer_file(recording_.name(), recording_.path());
}

void ServeSession::end_recording() {
  if (recording_.must_end(haptics_))
    send_note("the recording has ended: " +
              std::string(haptics_.recording().has_failed() ? "the file cannot be written" : "the maximum size is reached"));
  send_note_on_error(recording_.end(haptics_));
  server_.offer_file(recording_.name(), recording_.path());
}

void ServeSession::handle(const TuningRequest& request) {
  if (request.position) {
    if (!tuning_.image_tuning && !tuning_.tick_tuning)
      return send_note("the costs are not measured; \"tune\" without \"position\" was expected first");
    return send_note_on_error(scene_.apply(tuning_.edits_at(*request.position), "accuracy"));
  }
  set_default_target(tuning_);
  send_note_on_error(measure_tick_costs(tuning_, scene_, haptics_, [this](const std::string& line) { send_note(line); }));
  scene_.mark_changed();
  if (!tuning_.has_fixed_quality) send_note_on_error(measure_image());
}

}  // namespace catena::app
