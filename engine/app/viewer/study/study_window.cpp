#include "engine/app/viewer/study/study_window.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <utility>

#include "engine/base/clock.h"
#include "render/extract/extract_parts.h"
#include "render/frame/camera.h"

namespace catena::app {

namespace {

using Stage = Procedure::Stage;

std::optional<Stroke> stroke_of(const KeyEvent& event) {
  using What = KeyEvent::What;
  if (event.what == What::character) return Stroke{Stroke::What::character, event.character};
  const bool pressed = event.what == What::press;
  if (event.key == GLFW_KEY_BACKSPACE && (pressed || event.what == What::repeat)) return Stroke{Stroke::What::backspace};
  if (!pressed || event.control || event.alt) return std::nullopt;
  if (event.key == GLFW_KEY_SPACE) return Stroke{Stroke::What::space};
  if (event.key == GLFW_KEY_ENTER || event.key == GLFW_KEY_KP_ENTER) return Stroke{Stroke::What::enter};
  return std::nullopt;
}

/// A page for each eye that has a part of the window for itself.
std::vector<Area> areas_of(const scene::Stereo& stereo, const Area& whole) {
  const render::Packing packing = render::packing_of(stereo);
  const std::size_t views = render::is_apart(packing) ? render::views_of(stereo) : 1;
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

StudyWindow::StudyWindow(const ViewOptions& options, LiveSession& session, SceneHost& scene, HandHost& hand, Window& window,
                         std::optional<Interrupt>& interrupt)
    : session_(session),
      gui_(window, {kPageTextPixels, kHeadingPixels}),
      shared_{options, scene, hand, window, gui_},
      eye_(shared_.controls, scene, hand),
      picture_(shared_, std::nullopt),
      interrupt_(interrupt) {
  shared_.state.panels = false;
}

StudyWindow::~StudyWindow() { shared_.hand.stop(); }

std::optional<Failure> StudyWindow::open() {
  const ViewOptions& options = shared_.options;
  shared_.state.area = picture_area(options.width, options.height, Edges{});
  const auto loaded = load_first(shared_.scene, shared_.hand, options.width, options.height);
  if (!loaded) return failure_of(loaded.error());
  show_scene(*loaded);
  if (auto failure = picture_.open()) return failure;
  // a device that pushes is let go by its own way out, Ctrl-C or not
  if (!shared_.hand.is_mouse()) interrupt_.emplace();
  if (const Outcome started = shared_.hand.start(); !started) return Failure{1, started.error().message};
  return std::nullopt;
}

void StudyWindow::show_scene(const LoadedScene& loaded) {
  shared_.scene.bounds = loaded.bounds;
  eye_.look_at(loaded);
  picture_.forget();
  shared_.scene.set_check([&hand = shared_.hand](scene::Scene& scene) { return hand.check(scene); });
  put_hand_under_pointer();
  moved_ = true;
}

Outcome StudyWindow::open_next() {
  CATENA_TRY(auto host, session_.next_scene());
  if (!host) return Done{};
  const auto [width, height] = picture_.size();
  CATENA_TRY(LoadedScene loaded, load_scene(std::move(*host), width, height));
  CATENA_CHECK(shared_.hand.take_over(loaded.host.scene(), loaded.bounds));
  shared_.scene = std::move(loaded.host);
  show_scene(loaded);
  return Done{};
}

bool StudyWindow::goes_on() const {
  return !closed_ && session_.procedure().stage() != Stage::over && !(interrupt_ && interrupt_->asked());
}

bool StudyWindow::shows_picture() const {
  const Stage stage = session_.procedure().stage();
  return stage == Stage::ready || stage == Stage::running;
}

// ---- keyboard and hand ----

Outcome StudyWindow::take_key(const KeyEvent& key) {
  if (key.what == KeyEvent::What::press && key.key == GLFW_KEY_F11) shared_.window.set_full_screen(!shared_.window.is_full_screen());
  if (key.what == KeyEvent::What::press && key.control && key.key == GLFW_KEY_Q) closed_ = true;
  const auto stroke = stroke_of(key);
  if (!stroke) return Done{};
  picture_.damage();
  return session_.take(*stroke, shared_.scene, shared_.hand);
}

Outcome StudyWindow::take_input(double wait_s) {
  for (const Input& piece : shared_.window.poll(wait_s)) {
    if (piece.damaged) picture_.damage();
    // the stroke is made where the hand is now
    if (piece.key) {
      hand_moved_ = shared_.hand.take(shared_.scene.scene()) || hand_moved_;
      CATENA_CHECK(take_key(*piece.key));
    }
    move_hand(piece);
  }
  if (shared_.window.closing()) closed_ = true;
  return Done{};
}

/// The hand of a mouse is under the pointer, as deep as it was; the wheel moves it along the view. Nothing moves the eye.
void StudyWindow::move_hand(Input piece) {
  const bool motion = piece.dx != 0 || piece.dy != 0;
  if (motion || piece.x != 0 || piece.y != 0) pointer_ = {piece.x + piece.dx, piece.y + piece.dy};
  if (!shared_.hand.is_mouse() || !shows_picture() || (!motion && piece.wheel == 0)) return;
  piece.left = piece.middle = piece.right = piece.shift = piece.control = piece.space = false;
  Controls& controls = shared_.controls;
  controls.hand_mode = true;
  apply(controls, piece);
  controls.hand_mode = false;
  shared_.hand.move_mouse(shared_.scene.scene(), controls.hand, 0);
}

/// A mouse knows no depth: at the beginning it has that of the trial's start.
void StudyWindow::put_hand_under_pointer() {
  if (!shared_.hand.is_mouse()) return;
  Controls& controls = shared_.controls;
  const Area& area = shared_.state.area;
  const render::Camera camera = render::make_camera(controls.view, area.width, area.height, Bounds());
  const auto start = render::project(camera, session_.trial().start());
  if (!start) return;
  const std::array<double, 2> at = pointer_.value_or(std::array<double, 2>{0.5 * area.width, 0.5 * area.height});
  controls.push = 0;
  controls.hand = render::unproject(camera, at[0], at[1], start->z);
  shared_.hand.move_mouse(shared_.scene.scene(), controls.hand, 0);
}

// ---- what is shown ----

std::optional<NextPicture> StudyWindow::next_picture(bool moved, bool hand_moved) {
  if (moved) return picture_.drawing().moving();
  if (!shows_picture()) return std::nullopt;
  if (!hand_moved) return 1e-3 * ms_since(last_change_ns_) >= kRestS ? picture_.drawing().still() : std::nullopt;
  const NextPicture next = picture_.followed();
  if (!next.settings.keep) last_change_ns_ = now_ns();
  return next;
}

void StudyWindow::draw_pages() {
  if (shared_.hand.is_mouse() && shows_picture()) gui_.hide_pointer();
  const StudyView view{session_.procedure(), session_.is_at_start(shared_.hand), session_.wants_start(),
                       shared_.hand.hand().device->status_text()};
  draw_study(view, areas_of(shared_.scene.scene().stereo, shared_.state.area));
}

/// Nothing of it tells a trial's condition.
void StudyWindow::update_title() {
  const Procedure& procedure = session_.procedure();
  const std::size_t trials = procedure.trials().size();
  std::string title = "catena study  ";
  switch (procedure.stage()) {
    case Stage::page:
      title += procedure.page().heading;
      break;
    case Stage::ready:
      title += fmt::format("trial {} of {}{}", procedure.trial() + 1, trials, session_.is_at_start(shared_.hand) ? ", at the start" : "");
      break;
    case Stage::running:
      title += fmt::format("trial {} of {} runs", procedure.trial() + 1, trials);
      break;
    case Stage::question:
      title += fmt::format("question {} of {}", procedure.question_number() + 1, procedure.questions());
      break;
    case Stage::over:
      break;
  }
  if (const std::string text = shared_.hand.hand().device->status_text(); !text.empty()) title += "  " + text;
  if (title == title_) return;
  shared_.window.set_title(title);
  title_ = title;
  picture_.damage();
}

std::optional<Failure> StudyWindow::run() {
  SceneHost& scene = shared_.scene;
  last_change_ns_ = now_ns();
  bool busy = true, minimised = false;
  while (goes_on()) {
    if (const Outcome taken = take_input(minimised ? kMinimisedWaitS : busy ? 0 : kIdleWaitS); !taken) return failure_of(taken.error());
    if (const Outcome followed = session_.follow(scene, shared_.hand); !followed) return failure_of(followed.error());
    if (const Outcome opened = open_next(); !opened) return failure_of(opened.error());
    hand_moved_ = shared_.hand.take(scene.scene()) || hand_moved_;
    // another page, or the picture behind it
    if (std::exchange(stage_, session_.procedure().stage()) != session_.procedure().stage()) moved_ = true;
    update_title();
    minimised = picture_.is_minimised();
    if (minimised) {
      picture_.damage();
      continue;
    }
    const bool resized = picture_.is_stale() || picture_.lay_out();
    const bool moved = std::exchange(moved_, false) || resized || shared_.times.count() == 0;
    if (moved) last_change_ns_ = now_ns();
    const auto next = next_picture(moved, std::exchange(hand_moved_, false));
    busy = next.has_value();
    if (next)
      if (auto failure = picture_.draw(*next)) return failure;
    if (next || picture_.is_damaged() || shared_.window.happened())
      if (auto failure = picture_.show([this] { draw_pages(); })) return failure;
  }
  shared_.hand.stop();
  if (interrupt_)
    if (const Outcome ended = interrupt_->outcome(); !ended) return Failure{1, ended.error().message};
  return std::nullopt;
}

}  // namespace catena::app
