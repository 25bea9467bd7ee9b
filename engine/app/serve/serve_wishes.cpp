// What the page that has the hand asks for, carried out.
#include <utility>

#include "engine/app/serve/serve_session.h"
#include "engine/scene/write_values.h"

namespace catena::app {

void ServeSession::carry_out(const MoveWish& wish) {
  motion_ = wish.number;
  Changed changed;
  for (Input piece : wish.pieces) {
    piece.width = width_;
    piece.height = height_;
    pointer_x_ = (piece.x + piece.dx) / width_;
    pointer_y_ = (piece.y + piece.dy) / height_;
    if (takes_hold(piece)) controls_.turntable = false;
    const auto under = controls_.hand_mode ? drawing_.picked_at(pointer_x_, pointer_y_) : std::nullopt;
    controls_.under = under ? std::optional(under->world) : std::nullopt;
    hand_.hold_back(scene_.scene(), controls_);
    const Changed by_piece = apply(controls_, piece);
    changed.view = changed.view || by_piece.view;
    changed.hand = changed.hand || by_piece.hand;
  }
  if (changed.hand) {
    hand_.move_mouse(scene_.scene(), controls_.hand, controls_.buttons);
    hand_moved_ = true;
  }
  if (!changed.view) return;
  eye_.pin();
  moved_ = true;
}

void ServeSession::carry_out(const SizeWish& wish) {
  moved_ = moved_ || width_ != wish.width || height_ != wish.height;
  width_ = wish.width;
  height_ = wish.height;
}

void ServeSession::carry_out(Action action) {
  switch (action) {
    case Action::hand_mode:
      return controls_.hand_mode ? end_hand() : begin_hand();
    case Action::undo:
      scene_told_ = false;
      return note_if_wrong(scene_.undo());
    case Action::redo:
      scene_told_ = false;
      return note_if_wrong(scene_.redo());
    case Action::play_steps:
      steps_.plays = !steps_.plays;
      return;
    case Action::next_step:
    case Action::step_before:
      return note_if_wrong(steps_.show(scene_, scene_.scene().time.step + (action == Action::next_step ? 1 : -1)));
    default:
      break;  // the eye's
  }
  moved_ = eye_.act(action, static_cast<double>(width_) / height_) || moved_;
}

/// The hand goes onto what is under the pointer.
void ServeSession::begin_hand() {
  controls_.hand_mode = true;
  const auto under = drawing_.picked_at(pointer_x_, pointer_y_);
  controls_.under = under ? std::optional(under->world) : std::nullopt;
  app::begin_hand(controls_);
  hand_.move_mouse(scene_.scene(), controls_.hand, controls_.buttons);
  hand_moved_ = true;
}

/// It stays where it is, with nothing pressed.
void ServeSession::end_hand() {
  controls_.hand_mode = false;
  controls_.buttons = 0;
  hand_.move_mouse(scene_.scene(), controls_.hand, 0);
  hand_moved_ = true;
}

void ServeSession::apply_edits(const TextEdits& edits, const std::string& what, const std::string& item) {
  if (const Outcome done = scene_.apply(edits, what, what + " of " + item); !done) note(done.error().message);
  scene_told_ = false;
}

void ServeSession::carry_out(const LevelWish& wish) {
  const auto surface = item_of<scene::Isosurface>(scene_.scene(), wish.item);
  if (!surface || pointer_of(surface->where).empty()) return note("there is no such isosurface");
  apply_edits(level_edits(scene_.scene(), *surface, wish.value), "isolevel", wish.item);
}

namespace {

/// The volume and its transfer function as it is drawn.
std::optional<std::pair<scene::Volume, TransferEdit>> volume_of(const scene::Scene& scene, const std::string& item) {
  const auto volume = item_of<scene::Volume>(scene, item);
  if (!volume || pointer_of(volume->where).empty()) return std::nullopt;
  const scene::FieldSource& source = scene.world.get<scene::FieldSource>(volume->field);
  if (!source.drawn.scalar) return std::nullopt;
  auto edit = transfer_edit(*volume, source.drawn.scalar->mapping().smallest_edge());
  if (!edit) return std::nullopt;
  return std::pair{*volume, std::move(*edit)};
}

}  // namespace

void ServeSession::carry_out(const OpacityWish& wish) {
  auto found = volume_of(scene_.scene(), wish.item);
  if (!found) return note("there is no such volume");
  found->second.opacities = wish.points;
  apply_edits(opacity_edits(found->first, found->second), "opacity", wish.item);
}

void ServeSession::carry_out(const MapWish& wish) {
  const auto found = volume_of(scene_.scene(), wish.item);
  if (!found) return note("there is no such volume");
  apply_edits(map_edits(found->first, found->second, wish.name), "colours", wish.item);
}

void ServeSession::carry_out(const StepWish& wish) { note_if_wrong(steps_.show(scene_, wish.step)); }

/// While one is under way nothing is offered: what is there is not whole.
void ServeSession::carry_out(const RecordWish& wish) {
  if (!wish.on) return end_recording();
  note_if_wrong(recording_.begin(scene_, hand_));
  server_.offer(recording_.name(), recording_.path());
}

void ServeSession::end_recording() {
  if (recording_.is_over(hand_))
    note("the recording has ended: " + std::string(hand_.recording().failed() ? "writing has failed" : "it is full"));
  note_if_wrong(recording_.end(hand_));
  server_.offer(recording_.name(), recording_.path());
}

void ServeSession::carry_out(const PlanWish& wish) {
  if (wish.place) {
    if (!plan_.eye && !plan_.hand) return note("the plan goes by what is not measured yet");
    return note_if_wrong(scene_.set("/plan", scene::text_of(plan_.at(*wish.place)), "plan"));
  }
  want_the_usual(plan_);
  note_if_wrong(measure_hand(plan_, scene_, hand_, [this](const std::string& line) { note(line); }));
  scene_.touch();
  if (!plan_.quality_stated) note_if_wrong(measure_eye_now());
}

}  // namespace catena::app
