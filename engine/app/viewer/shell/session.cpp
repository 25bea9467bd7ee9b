#include "engine/app/viewer/shell/session.h"

#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <utility>

#include "engine/base/clock.h"
#include "engine/base/output_file.h"
#include "engine/base/text.h"
#include "engine/scene/hidden.h"
#include "engine/scene/steps.h"

namespace catena::app {

namespace {

constexpr double kEstimateS = 0.6;  // without a change for so long: the picture's error is looked at
constexpr double kTitleS = 0.25;
constexpr double kLiveS = 0.1;     // between interfaces that only follow the hand
constexpr double kMirrorS = 0.03;  // between the headset's pictures in the window, whose display may be the slower one

double s_since(std::int64_t ns) { return 1e-3 * ms_since(ns); }

}  // namespace

Session::Session(const ViewOptions& options, SceneHost& scene, HandHost& hand, Window& window, std::optional<ShaderReload> reload,
                 std::unique_ptr<TrackedHead> head, std::optional<Interrupt>& interrupt)
    : gui_(window),
      shared_{options, scene, hand, window, gui_},
      eye_(shared_.controls, scene, hand),
      head_(std::move(head)),
      picture_(shared_, std::move(reload)),
      files_(shared_, eye_, picture_),
      follower_(options.follow),
      interrupt_(interrupt) {}

Session::~Session() { shared_.hand.stop(); }

PanelContext Session::context() {
  return {shared_.scene, shared_.hand,  picture_.screen(), shared_.controls, shared_.pacing,
          shared_.plan,  shared_.times, shared_.state,     shared_.commands};
}

std::optional<Failure> Session::open() {
  const ViewOptions& options = shared_.options;
  HandHost& hand = shared_.hand;
  ViewState& state = shared_.state;
  state.panels = options.panels && options.width >= kNarrowWidth;
  // the picture's size: the panels' edges are known once the interface has begun
  gui_.begin();
  const Edges edges = state.panels ? interface_edges() : Edges{};
  gui_.end();
  state.area = picture_area(options.width, options.height, edges);

  const auto loaded =
      load_first(shared_.scene, hand, static_cast<std::uint32_t>(state.area.width), static_cast<std::uint32_t>(state.area.height));
  if (!loaded) return failure_of(loaded.error());
  files_.show(*loaded);
  look_for_pulses();
  before_screen_ = shared_.controls.view;
  follow_head();
  if (auto failure = picture_.open()) return failure;
  if (shared_.plan.wanted.of_eye())
    if (auto failure = picture_.plan()) return failure;
  observe_hand_anew();
  files_.begin();
  // a device that pushes is let go by its own way out, whatever signal comes; beside the mouse the outputs are finished
  if (hand.is_mouse())
    interrupt_.emplace(std::vector{SIGINT, SIGTERM, SIGHUP});
  else
    interrupt_.emplace();
  if (const Outcome started = hand.start(); !started) return Failure{1, started.error().message};
  if (!hand.note().empty()) state.say(hand.note());
  return std::nullopt;
}

/// The scene was edited, or is another: the hand's program is made again. True: so must the picture be.
bool Session::take_edits() {
  SceneHost& scene = shared_.scene;
  if (!scene.take_changed()) return false;
  shared_.state.say_if_wrong(follow_text(shared_.plan, scene, shared_.pacing));
  shared_.state.say_if_wrong(shared_.hand.publish(scene.scene(), scene.felt_text()));
  observe_hand_anew();
  look_for_pulses();
  return true;
}

/// Another scene has curves of its own.
void Session::forget_plan() {
  LivePlan& live = shared_.plan;
  live = {};
  const scene::Scene& scene = std::as_const(shared_.scene).scene();
  live.wanted = live.stated = scene.plan;
  live.quality_stated = shared_.options.quality_stated || !scene.quality.empty();
}

/// The curves of this scene, whatever is wanted of it: the slider goes by them.
std::optional<Failure> Session::measure_plan() {
  LivePlan& live = shared_.plan;
  want_the_usual(live);
  shared_.state.say_if_wrong(measure_hand(live, shared_.scene, shared_.hand, [&](const std::string& line) { shared_.state.say(line); }));
  if (live.quality_stated) return std::nullopt;
  return picture_.plan();
}

/// What was felt with other settings is no observation of these.
void Session::observe_hand_anew() {
  LivePlan& live = shared_.plan;
  live.hand_error.reset();
  live.observer.reset();
  if (live.hand && !live.hand->is_empty()) live.observer.emplace(&*live.hand, *shared_.hand.program());
}

void Session::look_for_pulses() {
  const scene::World& world = std::as_const(shared_.scene).scene().world;
  has_pulses_ = false;
  world.each<scene::StreamlineSet>(
      [&](scene::Entity e, const scene::StreamlineSet& set) { has_pulses_ = has_pulses_ || (set.pulse > 0 && !is_hidden(world, e)); });
}

/// What the hand has moved and let go of is written into the scene.
void Session::keep_widgets() {
  for (const WidgetEdits::Ended& ended : widget_edits_.take(shared_.scene.scene()))
    shared_.state.say_if_wrong(shared_.scene.apply(ended.edits, ended.what));
}

/// True where the pulses have moved. With a number of frames asked for they stand: the pictures repeat.
bool Session::run_pulses() {
  const bool running = has_pulses_ && pulses_run_ && shared_.options.frames == 0 && shared_.window.looked_at();
  scene::Scene& scene = shared_.scene.scene();
  const auto phase = pulses_.advance(now_ns(), running, scene.phase);
  if (phase) scene.phase = *phase;
  return phase.has_value();
}

/// The tracked head is where the eye is, whatever the mouse does. True where it has moved.
bool Session::follow_head() {
  if (!head_) return false;
  const auto at = head_->at(s_since(start_ns_));
  if (head_->was_lost()) shared_.state.say("the head is not tracked, or not before the screen: the picture stays", true);
  render::View view = before_screen_;
  view.position = at.value_or(shared_.controls.view.position);
  const bool moved = view.position != std::exchange(shared_.controls.view, view).position;
  eye_.pin();
  return moved;
}

void Session::follow_steps() {
  const auto more = follower_.run(shared_.scene, shared_.state.steps);
  if (!more)
    shared_.state.say(more.error().message, true);
  else if (*more)
    shared_.state.say(fmt::format("{} steps in time by now", scene::step_count(std::as_const(shared_.scene).scene())));
}

void Session::show_step(int step) { shared_.state.say_if_wrong(shared_.state.steps.show(shared_.scene, step)); }

void Session::update_title() {
  const double since_s = s_since(last_title_ns_);
  if (last_title_ns_ != 0 && since_s < kTitleS) return;
  const HandHost& hand = shared_.hand;
  const exchange::HapticState& felt = hand.felt();
  const scene::Document& document = shared_.scene.document();
  const int pictures = shared_.times.count();
  const std::string name = shared_.state.untitled ? "untitled" : std::filesystem::path(document.path()).filename().string();
  std::string title = fmt::format("catena  {}{}  {:.0f} fps  {:.2f} N", name, document.is_modified() ? " \u2022" : "",
                                  last_title_ns_ == 0 ? 0 : (pictures - pictures_in_title_) / since_s, norm(felt.force_n));
  const auto links = std::min(static_cast<std::size_t>(felt.link_count), hand.link_names().size());
  for (std::size_t k = 0; k < links; ++k)
    title += fmt::format("  {} {}", hand.link_names()[k], exchange::status_word(felt.links[k].status));
  if (const std::string text = hand.hand().device->status_text(); !text.empty()) title += "  " + text;
  if (hand.recording().running()) title += hand.recording().failed() ? "  the recording has stopped" : "  [recording]";
  if (!hand.is_mouse()) title += hand.forces() ? "  [forces on]" : "  [forces off]";
  const scene::StereoMode stereo = shared_.scene.scene().stereo.mode;
  if (stereo != scene::StereoMode::mono) title += fmt::format("  [{}]", scene::stereo_word(stereo));
  if (shared_.controls.hand_mode) title += "  [hand]";
  if (const std::string headset = picture_.headset_words(); !headset.empty()) title += "  [" + headset + "]";
  title += "  [" + shared_.pacing.words() + "]";
  shared_.window.set_title(title);
  last_title_ns_ = now_ns();
  pictures_in_title_ = pictures;
}

bool Session::goes_on() const {
  const ViewOptions& options = shared_.options;
  const bool asked = interrupt_ && interrupt_->asked();
  return !asked && !files_.has_ended() && (options.frames == 0 || shared_.times.count() < options.frames) &&
         (options.seconds <= 0 || s_since(start_ns_) < options.seconds);
}

std::optional<NextPicture> Session::next_picture(bool moved, bool hand_moved) {
  const ViewOptions& options = shared_.options;
  if (options.frames > 0 && shared_.times.count() + 1 == options.frames) return picture_.drawing().best();
  const auto [width, height] = picture_.size();
  return picture_.drawing().next(moved, hand_moved, width, height);
}

std::optional<Failure> Session::run() {
  const ViewOptions& options = shared_.options;
  SceneHost& scene = shared_.scene;
  start_ns_ = now_ns();
  if (head_)
    if (const Outcome started = head_->start(s_since(start_ns_)); !started) return Failure{1, started.error().message};
  picture_.drawing().changed();
  std::int64_t last_show_ns = 0;
  bool busy = true, minimised = false, live = false;
  const Gui::Frame frame = interface_frame();
  while (goes_on()) {
    const Changed by_input = take_input(minimised ? kMinimisedWaitS : busy ? 0 : kIdleWaitS);
    if (std::exchange(measure_, false)) {
      if (auto failure = measure_plan()) return failure;
      changed_ = true;
    }
    // what has changed since the last picture
    follow_steps();
    shared_.state.say_if_wrong(shared_.state.steps.run(scene));
    const bool opened = files_.take_loaded();
    if (opened) {
      forget_plan();
      head_.reset();  // its screen is of the scene that was left
    }
    const bool edited = take_edits(), late = picture_.take_hand_moved(), news = shared_.hand.take(scene.scene()) || late;
    if (news && shared_.plan.observer) shared_.plan.observer->add(shared_.hand.felt());
    live = live || news || files_.is_loading() || shared_.hand.recording().running();
    if (news) keep_widgets();
    const auto followed = picture_.follow_headset();
    if (!followed) return Failure{1, followed.error().message};
    const bool in_headset = *followed;
    minimised = picture_.is_minimised();
    if (minimised) {
      picture_.damage();
      frame.fulfil();  // it can be closed all the same
      continue;
    }
    const bool flies = shared_.controls.fly && !gui_.wants_keys();
    const bool pulsed = run_pulses(), reloaded = picture_.take_shaders();
    const bool head_moved = follow_head();
    const bool turned = eye_.move(flies ? shared_.window.held_keys() : FlyKeys{});
    const bool resized = picture_.is_stale() || picture_.lay_out();
    const bool moved = by_input.view || std::exchange(changed_, false) || opened || edited || resized || pulsed || reloaded || turned ||
                       head_moved || shared_.times.count() == 0;
    if (in_headset && moved) picture_.drawing().changed();
    auto next = in_headset ? picture_.drawing().moving() : next_picture(moved, news || by_input.hand);
    if (!next && picture_.drawing().rest_s() >= kEstimateS && std::exchange(wants_error_, false))
      if (auto failure = picture_.estimate()) return failure;
    if (!next && (options.frames > 0 || options.seconds > 0)) next = shared_.pacing.again();
    busy = next.has_value();
    if (next)
      if (auto failure = picture_.draw(*next)) return failure;

    // the interface follows the person at once, the hand at a calmer pace
    const bool due = live && s_since(last_show_ns) >= kLiveS;
    const bool mirrors = in_headset && s_since(last_show_ns) < kMirrorS && !picture_.is_damaged();
    if (mirrors) {
      unsettled_ = 0;
    } else if (next || picture_.is_damaged() || due || unsettled_ > 0 || shared_.window.happened() || gui_.is_busy()) {
      unsettled_ = std::max(0, unsettled_ - 1);
      if (auto failure = picture_.show(frame.make_panels)) return failure;
      last_show_ns = now_ns();
      live = false;
      frame.fulfil();
    }
    files_.keep_unsaved();
    update_title();
  }
  files_.keep_unsaved(true);
  return finish();
}

std::optional<Failure> Session::finish() {
  const ViewOptions& options = shared_.options;
  if (auto finished = shared_.hand.finish(options.servo_stats); !finished) return failure_of(finished.error());
  shared_.hand.take(shared_.scene.scene());
  if (!options.frame_stats.empty()) {
    auto file = OutputFile::open(options.frame_stats);
    if (!file) return failure_of(file.error());
    file->write(shared_.times.json());
    if (auto written = file->commit(); !written) return failure_of(written.error());
  }
  if (auto failure = picture_.write_last(interface_frame().make_panels)) return failure;
  tell_figures();
  if (interrupt_)
    if (const Outcome ended = interrupt_->outcome(); !ended) return Failure{1, ended.error().message};
  return std::nullopt;
}

/// The last words, on the terminal.
void Session::tell_figures() {
  Screen& screen = picture_.screen();
  const FrameTimes& times = shared_.times;
  const exchange::HapticState& felt = shared_.hand.felt();
  fmt::print("{} frames, {:.1f} ms median, on {}\n", times.count(), 1e-3 * times.draw().p50_us,
             printable(screen.renderer().stats().device));
  if (const std::string headset = picture_.headset_figures(); !headset.empty()) fmt::print("{}\n", headset);
  if (screen.recoveries() > 0)
    fmt::print("the graphics device was lost and started again {} time{}\n", screen.recoveries(), screen.recoveries() == 1 ? "" : "s");
  fmt::print("probe {:.6g} {:.6g} {:.6g}, force {:.3g} N, {} ticks, {} deadlines missed\n", felt.probe.x, felt.probe.y, felt.probe.z,
             norm(felt.force_n), felt.tick, felt.missed_deadlines);
}

}  // namespace catena::app
