// SPDX-License-Identifier: MIT
#include "engine/app/viewer/window/study_window.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <utility>

#include "engine/base/clock.h"
#include "render/extract/extract_internal.h"
#include "render/frame/camera.h"

namespace catena::app {

namespace {

using Stage = Procedure::Stage;

std::optional<KeyPress> stroke_of(const KeyEvent& event) {
  using What = KeyEvent::Type;
  if (event.type == What::character) return KeyPress{KeyPress::Kind::character, event.character};
  const bool pressed = event.type == What::press;
  if (event.key == GLFW_KEY_BACKSPACE && (pressed || event.type == What::repeat)) return KeyPress{KeyPress::Kind::backspace};
  if (!pressed || event.control || event.alt) return std::nullopt;
  if (event.key == GLFW_KEY_SPACE) return KeyPress{KeyPress::Kind::space};
  if (event.key == GLFW_KEY_ENTER || event.key == GLFW_KEY_KP_ENTER) return KeyPress{KeyPress::Kind::enter};
  return std::nullopt;
}

/// Areas for pages: one for each stereo eye that has its own part of the window.
std::vector<Area> areas_of(const scene::Stereo& stereo, const Area& whole) {
  const render::Packing packing = render::stereo_packing(stereo);
  const std::size_t views = render::has_separate_views(packing) ? render::stereo_view_count(stereo) : 1;
  const bool beside = packing == render::Packing::side_by_side || packing == render::Packing::side_by_side_half;
  std::vector<Area> areas;
  for (std::size_t i = 0; i < views; ++i) {
    Area area = whole;
    double& size = beside ? area.width : area.height;
    size /= static_cast<double>(views);
    (beside ? area.x : area.y) += static_cast<double>(i) * size;
    areas.push_back(area);
  }
  return areas;
}

}  // namespace

StudyWindow::StudyWindow(const ViewOptions& options, LiveSession& session, SceneModel& scene, HapticSession& hand, Window& window,
                         std::optional<InterruptHandler>& interrupt)
    : session_(session),
      gui_(window, {kPageTextPx, kHeadingTextPx}),
      context_{options, scene, hand, window, gui_},
      camera_(context_.navigation, scene, hand),
      viewport_(context_, std::nullopt),
      interrupt_(interrupt) {
  context_.state.show_panels = false;
}

StudyWindow::~StudyWindow() { context_.haptic_session.stop(); }

std::optional<Failure> StudyWindow::open() {
  const ViewOptions& options = context_.options;
  context_.state.image_area = compute_image_area(options.width, options.height, Insets{});
  const auto loaded = load_initial_scene(context_.scene, context_.haptic_session, options.width, options.height);
  if (!loaded) return to_failure(loaded.error());
  show_scene(*loaded);
  if (auto failure = viewport_.open()) return failure;
  // a device with forces is stopped by its own signal handling, with or without Ctrl-C
  if (!context_.haptic_session.is_mouse()) interrupt_.emplace();
  if (const Outcome started = context_.haptic_session.start(); !started) return Failure{1, started.error().message};
  return std::nullopt;
}

void StudyWindow::show_scene(const LoadedScene& loaded) {
  context_.scene.bounds = loaded.bounds;
  camera_.adopt_scene(loaded);
  viewport_.reset();
  context_.scene.set_validator(SceneModel::make_validator(context_.haptic_session));
  place_probe_under_pointer();
  needs_redraw_ = true;
}

Outcome StudyWindow::open_next_scene() {
  CATENA_TRY(auto host, session_.next_scene());
  if (!host) return Done{};
  const auto [width, height] = viewport_.size();
  CATENA_TRY(LoadedScene loaded, load_scene(std::move(*host), width, height));
  CATENA_CHECK(context_.haptic_session.switch_scene(loaded.model.scene(), loaded.bounds));
  context_.scene = std::move(loaded.model);
  show_scene(loaded);
  return Done{};
}

bool StudyWindow::should_continue() const {
  return !is_closed_ && session_.procedure().stage() != Stage::finished && !(interrupt_ && interrupt_->is_requested());
}

bool StudyWindow::shows_image() const {
  const Stage stage = session_.procedure().stage();
  return stage == Stage::ready || stage == Stage::running;
}

// ---- keyboard and probe ----

Outcome StudyWindow::process_key(const KeyEvent& key) {
  if (key.type == KeyEvent::Type::press && key.key == GLFW_KEY_F11) context_.window.set_fullscreen(!context_.window.is_fullscreen());
  if (key.type == KeyEvent::Type::press && key.control && key.key == GLFW_KEY_Q) is_closed_ = true;
  const auto stroke = stroke_of(key);
  if (!stroke) return Done{};
  viewport_.request_redraw();
  return session_.handle_key(*stroke, context_.scene, context_.haptic_session);
}

Outcome StudyWindow::process_input(double wait_s) {
  for (const Input& piece : context_.window.poll(wait_s)) {
    if (piece.needs_redraw) viewport_.request_redraw();
    // the key press applies to the present probe position
    if (piece.key_event) {
      probe_moved_ = context_.haptic_session.pull_state(context_.scene.scene()) || probe_moved_;
      CATENA_CHECK(process_key(*piece.key_event));
    }
    move_probe(piece);
  }
  if (context_.window.is_closing()) is_closed_ = true;
  return Done{};
}

/// Moves a mouse-driven probe under the pointer at its present depth; the wheel moves it along the view. The camera does not move.
void StudyWindow::move_probe(Input piece) {
  const bool motion = piece.dx != 0 || piece.dy != 0;
  if (motion || piece.x != 0 || piece.y != 0) last_pointer_ = {piece.x + piece.dx, piece.y + piece.dy};
  if (!context_.haptic_session.is_mouse() || !shows_image() || (!motion && piece.wheel == 0)) return;
  piece.left = piece.middle = piece.right = piece.shift = piece.control = piece.space = false;
  Navigation& controls = context_.navigation;
  controls.probe_mode = true;
  apply(controls, piece);
  controls.probe_mode = false;
  context_.haptic_session.move_mouse(context_.scene.scene(), controls.probe, 0);
}

/// A mouse gives no depth: the probe begins at the depth of the trial's start.
void StudyWindow::place_probe_under_pointer() {
  if (!context_.haptic_session.is_mouse()) return;
  Navigation& controls = context_.navigation;
  const Area& area = context_.state.image_area;
  const render::Camera camera = make_area_camera(controls.view, area.width, area.height);
  const auto start = render::project(camera, session_.trial().start_position());
  if (!start) return;
  const std::array<double, 2> at = last_pointer_.value_or(std::array<double, 2>{0.5 * area.width, 0.5 * area.height});
  controls.wheel_depth = 0;
  controls.probe = render::unproject(camera, at[0], at[1], start->z);
  context_.haptic_session.move_mouse(context_.scene.scene(), controls.probe, 0);
}

// ---- display ----

std::optional<FrameRequest> StudyWindow::next_frame(bool moved, bool probe_moved) {
  if (moved) return viewport_.frame_builder().interactive_frame();
  if (!shows_image()) return std::nullopt;
  if (!probe_moved) return 1e-3 * ms_since(last_change_ns_) >= kRefineDelayS ? viewport_.frame_builder().refined_frame() : std::nullopt;
  const FrameRequest next = viewport_.frame_after_probe_motion();
  if (!next.settings.reuse_rays) last_change_ns_ = now_ns();
  return next;
}

void StudyWindow::draw_pages() {
  if (context_.haptic_session.is_mouse() && shows_image()) gui_.hide_pointer();
  const StudyView view{session_.procedure(), session_.is_at_start(context_.haptic_session), session_.is_returning_to_start(),
                       context_.haptic_session.device().device->status_text()};
  draw_study(view, areas_of(context_.scene.scene().stereo, context_.state.image_area));
}

/// Updates the window title, which must not reveal a trial's condition.
void StudyWindow::update_title() {
  const Procedure& procedure = session_.procedure();
  const std::size_t trials = procedure.trials().size();
  std::string title = "catena study  ";
  switch (procedure.stage()) {
    case Stage::page:
      title += procedure.page().heading;
      break;
    case Stage::ready:
      title += fmt::format("trial {} of {}{}", procedure.trial() + 1, trials,
                           session_.is_at_start(context_.haptic_session) ? ", at the start" : "");
      break;
    case Stage::running:
      title += fmt::format("trial {} of {}, running", procedure.trial() + 1, trials);
      break;
    case Stage::question:
      title += fmt::format("question {} of {}", procedure.question_index() + 1, procedure.question_count());
      break;
    case Stage::finished:
      break;
  }
  if (const std::string text = context_.haptic_session.device().device->status_text(); !text.empty()) title += "  " + text;
  if (title == title_) return;
  context_.window.set_title(title);
  title_ = title;
  viewport_.request_redraw();
}

std::optional<Failure> StudyWindow::run() {
  SceneModel& scene = context_.scene;
  last_change_ns_ = now_ns();
  bool busy = true, minimised = false;
  while (should_continue()) {
    if (const Outcome taken = process_input(minimised ? kMinimizedWaitS : busy ? 0 : kIdleWaitS); !taken) return to_failure(taken.error());
    if (const Outcome followed = session_.update(scene, context_.haptic_session); !followed) return to_failure(followed.error());
    if (const Outcome opened = open_next_scene(); !opened) return to_failure(opened.error());
    probe_moved_ = context_.haptic_session.pull_state(scene.scene()) || probe_moved_;
    // another page, or the image behind it
    if (std::exchange(last_stage_, session_.procedure().stage()) != session_.procedure().stage()) needs_redraw_ = true;
    update_title();
    minimised = viewport_.is_minimised();
    if (minimised) {
      viewport_.request_redraw();
      continue;
    }
    const bool resized = viewport_.is_stale() || viewport_.update_layout();
    const bool moved = std::exchange(needs_redraw_, false) || resized || context_.frame_times.count() == 0;
    if (moved) last_change_ns_ = now_ns();
    const auto next = next_frame(moved, std::exchange(probe_moved_, false));
    busy = next.has_value();
    if (next)
      if (auto failure = viewport_.draw(*next)) return failure;
    if (next || viewport_.needs_redraw() || context_.window.had_events())
      if (auto failure = viewport_.show([this] { draw_pages(); })) return failure;
  }
  context_.haptic_session.stop();
  if (interrupt_)
    if (const Outcome ended = interrupt_->outcome(); !ended) return Failure{1, ended.error().message};
  return std::nullopt;
}

}  // namespace catena::app
