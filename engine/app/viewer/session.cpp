#include "engine/app/viewer/session.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "engine/app/run_files.h"
#include "engine/app/viewer/file_list.h"
#include "engine/base/clock.h"
#include "engine/base/output_file.h"
#include "engine/base/tell.h"
#include "engine/base/text.h"
#include "engine/scene/hidden.h"
#include "render/extract/extract.h"
#include "render/extract/extract_stereo.h"
#include "render/image/picture.h"
#include "render/quality/quality.h"

namespace catena::app {

namespace {

constexpr std::uint32_t kLeastPixels = 16;  // of a picture each way: any packing of views has its pixels
constexpr double kRestS = 0.25;             // without input for so long: the picture may take its time
constexpr double kEstimateS = 0.6;          // the same, before its error is looked at
constexpr double kIdleWaitS = 0.004;        // between looks at the servo's news when nothing else happens
constexpr double kMinimisedWaitS = 0.1;
constexpr double kTitleS = 0.25;
constexpr double kLiveS = 0.1;  // between interfaces that only follow the hand

constexpr const char* kEmptyScene = "{\n  \"fields\": {},\n  \"chain\": []\n}\n";

}  // namespace

/// The eye's place in a scene that has just become the one that is shown.
void Session::look_at(const LoadedScene& loaded) {
  scene_->bounds = loaded.bounds;
  controls_.hand = hand_.first_probe();
  controls_.view = controls_.home = saved_view_ = loaded.packet.view;
  controls_.bounds = loaded.bounds;
  flight_ = {};
  shown_.reset();
  picked_stale_ = true;
  pin_camera();
  measure();
  check_edits();
}

/// Loads what the scene draws and feels; the hand takes hold.
Outcome Session::load_first(std::uint32_t width, std::uint32_t height) {
  CATENA_TRY(LoadedScene loaded, load_scene(std::move(*scene_), width, height));
  scene_ = std::move(loaded.host);
  CATENA_CHECK(hand_.prepare(scene_->scene(), loaded.bounds, recorded()));
  look_at(loaded);
  return Done{};
}

/// The next best thing to a window: what --screenshot asks for, drawn as `catena render` does. Exit code 0.
std::optional<Failure> Session::draw_without_window(const std::string& why) {
  const bool picture_only =
      options_.window_screenshot.empty() && options_.servo_stats.empty() && options_.frame_stats.empty() && options_.hand.record.empty();
  if (options_.screenshot.empty() || !picture_only) return Failure{1, why};
  if (auto loaded = load_first(options_.width, options_.height); !loaded) return Failure{2, loaded.error().message};
  const auto draw = [&]() -> Outcome {
    scene::Scene& scene = scene_->scene();
    const auto eye = render::view_size(render::packing_of(scene.stereo), render::views_of(scene.stereo), options_.width, options_.height);
    CATENA_TRY(const render::FramePacket packet,
               render::extract_frame(scene, static_cast<std::uint32_t>(eye.width), static_cast<std::uint32_t>(eye.height)));
    render::vk::DeviceOptions device;
    device.memory_budget_bytes = options_.gpu_memory;
    CATENA_TRY(const std::unique_ptr<render::Renderer> renderer, render::Renderer::create(device));
    CATENA_CHECK(renderer->draw(packet, pacing_.best(kind_).settings));
    CATENA_TRY(const render::Picture picture, renderer->read_back());
    return render::write_png(options_.screenshot, picture, scene.background.transparent);
  }();
  if (!draw) return Failure{1, draw.error().message};
  return Failure{0, why.substr(0, why.find(';')) + "; " + options_.screenshot + " was drawn without a window"};
}

/// An edit counts if the hand can feel what it makes.
void Session::check_edits() {
  scene_->set_check([this](scene::Scene& scene) { return hand_.check(scene); });
}

RecordedScene Session::recorded() const {
  RunFiles files(scene_->scene());
  files.reads_device(hand_.device_name());
  files.reads(options_.hand.firmware);
  return {scene_->document().path(), scene_->document().text(), hand_.fields(), files.inputs()};
}

/// What the loop has to know of a scene that was read.
void Session::measure() {
  has_pulses_ = false;
  scene_->scene().world.each<scene::StreamlineSet>([&](scene::Entity e, const scene::StreamlineSet& set) {
    has_pulses_ = has_pulses_ || (set.pulse > 0 && !is_hidden(scene_->scene().world, e));
  });
}

std::optional<Failure> Session::open() {
  // what is wrong with the scene or the device is said before any window opens
  std::error_code code;
  auto document = options_.source.empty()
                      ? scene::Document::make(kEmptyScene, (std::filesystem::current_path(code) / "scene.json").string())
                      : scene::Document::open(options_.source, options_.overrides);
  if (!document) return Failure{2, document.error().message};
  auto host = SceneHost::open(std::move(*document), options_.adjust);
  if (!host) return Failure{2, host.error().message};
  scene_ = std::move(*host);
  state_.untitled = options_.source.empty();
  owns_file_ = is_scene_name(options_.source);
  if (auto opened = hand_.open_device(scene_->scene()); !opened) return Failure{2, opened.error().message};
  if (!options_.shaders.empty()) {
    auto reload = ShaderReload::open(options_.shaders);
    if (!reload) return Failure{2, "--shaders " + reload.error().message};
    reload_ = std::move(*reload);
  }
  auto window = Window::create(options_.width, options_.height, "catena");
  if (!window) return draw_without_window(window.error().message);
  window_ = std::move(*window);
  gui_ = std::make_unique<Gui>(*window_);
  state_.panels = options_.panels && options_.width >= kNarrowWidth;
  // the picture's size: the panels' edges are known once the interface has begun
  gui_->begin();
  const Edges edges = state_.panels ? interface_edges() : Edges{};
  gui_->end();
  state_.area = picture_area(options_.width, options_.height, edges);

  const auto loaded = load_first(static_cast<std::uint32_t>(state_.area.width), static_cast<std::uint32_t>(state_.area.height));
  if (!loaded) return Failure{2, loaded.error().message};
  if (auto failure = open_screen()) return failure;
  state_.recent = recent_.shown();
  if (!options_.source.empty()) remember(options_.source);
  // a device that pushes is let go by its own way out, Ctrl-C or not
  if (!hand_.is_mouse()) interrupt_.emplace();
  if (const Outcome started = hand_.start(); !started) return Failure{1, started.error().message};
  if (!hand_.note().empty()) state_.say(hand_.note());
  look_for_left();
  return std::nullopt;
}

std::optional<Failure> Session::open_screen() {
  auto screen = Screen::open(*window_, {options_.gpu_memory, options_.fail});
  if (!screen) return Failure{1, screen.error().message};
  screen_ = std::move(*screen);
  const render::vk::DeviceInfo& device = screen_->renderer().device().info();
  if (device.is_cpu()) state_.say("no GPU: drawn by the processor (" + device.name + ")");
  return std::nullopt;
}

/// From now on the camera is where the controls have it (a fitted one would follow the cursor).
void Session::pin_camera() {
  const render::View& v = controls_.view;
  scene_->scene().camera = {v.position, v.target, v.up, v.fovy_deg, v.orthographic, v.height, true};
}

/// The scene was edited: the hand's program is made again. True: so must the picture be.
bool Session::take_edits() {
  if (!scene_->take_changed()) return false;
  if (auto published = hand_.publish(scene_->scene(), scene_->document().text()); !published) state_.say(published.error().message, true);
  measure();
  return true;
}

/// What the hand has moved and let go of is written into the scene.
void Session::keep_widgets() {
  for (const WidgetEdits::Ended& ended : widget_edits_.take(scene_->scene()))
    if (auto kept = scene_->apply(ended.edits, ended.what); !kept) state_.say(kept.error().message, true);
}

/// True where the pulses have moved. With a number of frames asked for they stand: the pictures repeat.
bool Session::run_pulses() {
  const bool running = has_pulses_ && pulses_run_ && options_.frames == 0 && window_->looked_at();
  const auto phase = pulses_.advance(now_ns(), running, scene_->scene().phase);
  if (phase) scene_->scene().phase = *phase;
  return phase.has_value();
}

bool Session::take_shaders() { return reload_ && reload_->poll(screen_->renderer(), now_ns()); }

/// Into the picture's part of the window; `for_file`: of the whole window's size, and no picture of the session's.
std::optional<Failure> Session::draw(const NextPicture& next, bool for_file) {
  std::uint32_t width = 0, height = 0;
  screen_->size(width, height);
  if (width == 0 || height == 0) return std::nullopt;
  if (!for_file) {
    lay_out();
    width = pixels_[2] - pixels_[0];
    height = pixels_[3] - pixels_[1];
  }

  scene::Scene& scene = scene_->scene();
  const render::Packing packing = render::packing_of(scene.stereo);
  const std::uint32_t scale = render::is_interlaced(packing) ? 1 : next.scale;
  const auto eye = render::view_size(packing, render::views_of(scene.stereo), std::max(kLeastPixels, width / scale),
                                     std::max(kLeastPixels, height / scale));
  std::int64_t start = now_ns();
  auto packet = render::extract_frame(scene, static_cast<std::uint32_t>(eye.width), static_cast<std::uint32_t>(eye.height));
  if (!packet) {
    // at the start it is the scene's fault; later an edit's, and the last picture stands
    if (times_.count() == 0) return Failure{2, packet.error().message};
    state_.say(packet.error().message, true);
    return std::nullopt;
  }
  render::Renderer& renderer = screen_->renderer();
  if (pacing_.wants_estimate()) {
    const auto error = render::estimate_rmse(renderer, *packet, next.settings);
    if (!error) return Failure{1, error.error().message};
    pacing_.estimated(*error);
    start = now_ns();
  }
  const int recoveries = screen_->recoveries();
  auto drawn = screen_->draw(*packet, next.settings);
  // with the embedded shaders if those of --shaders cannot be drawn with
  if (!drawn && reload_ && reload_->give_up(screen_->renderer(), drawn.error().message)) drawn = screen_->draw(*packet, next.settings);
  if (!drawn) return Failure{1, drawn.error().message};
  if (screen_->recoveries() != recoveries) state_.say("the graphics device was lost and has been started again", true);
  const double ms = ms_since(start);
  pacing_.drawn(ms);
  const auto shaded = [](const render::VolumeItem& item) { return item.shade; };
  kind_ = {!packet->volumes.empty() || !packet->isosurfaces.empty(), screen_->renderer().draws_fast(*packet),
           std::any_of(packet->volumes.begin(), packet->volumes.end(), shaded)};
  if (times_.count() == 0) {
    const render::RenderStats stats = screen_->renderer().stats();
    for (const std::string& note : stats.notes) tell_from_catena(note);
    for (const render::MirrorCoarsening& coarser : stats.mirror_coarsening) tell(coarser.words());
  }
  shown_ = std::move(*packet);
  picked_stale_ = true;
  if (for_file) return std::nullopt;
  times_.add(ms, now_ns());
  ++frames_in_title_;
  return std::nullopt;
}

/// The error of the picture that is at rest, once.
std::optional<Failure> Session::estimate() {
  if (!pacing_.may_estimate()) return std::nullopt;
  std::uint32_t width = 0, height = 0;
  screen_->size(width, height);
  if (width == 0 || height == 0) return std::nullopt;
  width = pixels_[2] - pixels_[0];
  height = pixels_[3] - pixels_[1];
  scene::Scene& scene = scene_->scene();
  const render::Packing packing = render::packing_of(scene.stereo);
  const auto eye =
      render::view_size(packing, render::views_of(scene.stereo), std::max(kLeastPixels, width), std::max(kLeastPixels, height));
  auto packet = render::extract_frame(scene, static_cast<std::uint32_t>(eye.width), static_cast<std::uint32_t>(eye.height));
  if (!packet) return std::nullopt;  // said where it was drawn
  const auto error = render::estimate_rmse(screen_->renderer(), *packet, pacing_.again().settings);
  if (!error) return Failure{1, error.error().message};
  pacing_.estimated(*error);
  // the estimate drew with the renderer's own images
  if (auto drawn = screen_->draw(*packet, pacing_.again().settings); !drawn) return Failure{1, drawn.error().message};
  damaged_ = true;
  return std::nullopt;
}

/// The interface over the last picture.
std::optional<Failure> Session::show() {
  const std::int64_t start = now_ns();
  update_values();
  gui_->begin();
  // the glyph is the pointer while the mouse is the hand
  if (controls_.hand_mode && hand_.is_mouse() && state_.pointer_on_picture) gui_->hide_pointer();
  PanelContext panels = context();
  draw_interface(panels);
  render::UiItems items = gui_->end();
  items.area = pixels_;
  if (auto shown = screen_->show(items); !shown) return Failure{1, shown.error().message};
  times_.add_interface(ms_since(start));
  damaged_ = false;
  return std::nullopt;
}

void Session::update_title() {
  const double since_s = 1e-3 * ms_since(last_title_);
  if (last_title_ != 0 && since_s < kTitleS) return;
  const exchange::HapticState& felt = hand_.felt();
  const scene::Document& document = scene_->document();
  const std::string name = state_.untitled ? "untitled" : std::filesystem::path(document.path()).filename().string();
  std::string title = fmt::format("catena  {}{}  {:.0f} fps  {:.2f} N", name, document.is_modified() ? " \u2022" : "",
                                  last_title_ == 0 ? 0 : frames_in_title_ / since_s, norm(felt.force_n));
  const auto links = std::min(static_cast<std::size_t>(felt.link_count), hand_.link_names().size());
  for (std::size_t k = 0; k < links; ++k)
    title += fmt::format("  {} {}", hand_.link_names()[k], exchange::status_word(felt.links[k].status));
  if (const std::string text = hand_.hand().device->status_text(); !text.empty()) title += "  " + text;
  if (hand_.recording().running()) title += hand_.recording().failed() ? "  the recording has stopped" : "  [recording]";
  if (!hand_.is_mouse()) title += hand_.forces() ? "  [forces on]" : "  [forces off]";
  const scene::StereoMode stereo = scene_->scene().stereo.mode;
  if (stereo != scene::StereoMode::mono) title += fmt::format("  [{}]", scene::stereo_word(stereo));
  if (controls_.hand_mode) title += "  [hand]";
  title += "  [" + pacing_.words() + "]";
  window_->set_title(title);
  last_title_ = now_ns();
  frames_in_title_ = 0;
}

void Session::say_goodbye() const {
  const exchange::HapticState& felt = hand_.felt();
  fmt::print("{} frames, {:.1f} ms median, on {}\n", times_.count(), 1e-3 * times_.draw().p50_us,
             printable(screen_->renderer().stats().device));
  if (screen_->recoveries() > 0)
    fmt::print("the graphics device was lost and started again {} time{}\n", screen_->recoveries(), screen_->recoveries() == 1 ? "" : "s");
  fmt::print("probe {:.6g} {:.6g} {:.6g}, force {:.3g} N, {} ticks, {} deadlines missed\n", felt.probe.x, felt.probe.y, felt.probe.z,
             norm(felt.force_n), felt.tick, felt.missed_deadlines);
}

std::optional<Failure> Session::run() {
  std::int64_t last_move = now_ns(), last_show = 0;
  const std::int64_t start = now_ns();
  const bool always = options_.frames > 0 || options_.seconds > 0;
  bool busy = true, minimised = false, live = false;
  last_move_ns_ = start;
  while (!leaves_ && (options_.frames == 0 || times_.count() < options_.frames) &&
         (options_.seconds <= 0 || 1e-3 * ms_since(start) < options_.seconds)) {
    const Changed changed = take_input(minimised ? kMinimisedWaitS : busy ? 0 : kIdleWaitS);
    obey_view();
    const bool opened = take_loaded(), edited = take_edits(), news = hand_.take(scene_->scene());
    live = live || news || loader_.is_busy();
    if (news) keep_widgets();
    std::uint32_t width = 0, height = 0;
    screen_->size(width, height);
    minimised = width == 0;
    if (minimised) {
      damaged_ = true;
      fulfil_wishes();  // it can be closed all the same
      continue;
    }
    const bool pulsed = run_pulses(), reloaded = take_shaders(), turned = move_camera();
    const bool resized = screen_->is_resized() || lay_out() || !screen_->has_picture();
    const bool moved = changed.any() || opened || std::exchange(moved_by_menu_, false) || edited || news || resized || pulsed || reloaded ||
                       turned || times_.count() == 0;
    if (moved) last_move = now_ns();

    // a picture in time while something moves, better ones when it rests
    std::optional<NextPicture> next;
    if (options_.frames > 0 && times_.count() + 1 == options_.frames)
      next = pacing_.best(kind_);
    else if (moved)
      next = pacing_.moving(kind_);
    else if (1e-3 * ms_since(last_move) >= kRestS)
      next = pacing_.still(kind_);
    if (!next && 1e-3 * ms_since(last_move) >= kEstimateS && std::exchange(state_.estimate, false))
      if (auto failure = estimate()) return failure;
    if (!next && always) next = pacing_.again();
    busy = next.has_value();
    if (next)
      if (auto failure = draw(*next)) return failure;

    // the interface follows the person at once, the hand at a calmer pace
    const bool due = live && 1e-3 * ms_since(last_show) >= kLiveS;
    if (next || damaged_ || due || unsettled_ > 0 || window_->happened() || gui_->is_busy()) {
      unsettled_ = std::max(0, unsettled_ - 1);
      if (auto failure = show()) return failure;
      last_show = now_ns();
      live = false;
      fulfil_wishes();
    }
    keep_unsaved();
    update_title();
  }
  keep_unsaved(true);
  return finish();
}

std::optional<Failure> Session::finish() {
  if (auto finished = hand_.finish(options_.servo_stats); !finished) return Failure{2, finished.error().message};
  hand_.take(scene_->scene());
  if (!options_.frame_stats.empty()) {
    auto file = OutputFile::open(options_.frame_stats);
    if (!file) return Failure{2, file.error().message};
    file->write(times_.json());
    if (auto written = file->commit(); !written) return Failure{2, written.error().message};
  }
  if (!options_.window_screenshot.empty() && times_.count() > 0) {
    if (auto failure = show()) return failure;
    auto picture = screen_->window_picture();
    if (!picture) return Failure{1, picture.error().message};
    if (auto written = render::write_png(options_.window_screenshot, *picture, false); !written) return Failure{2, written.error().message};
  }
  if (!options_.screenshot.empty() && times_.count() > 0) {
    std::uint32_t width = 0, height = 0;
    screen_->size(width, height);
    const bool whole = pixels_ == std::array<std::uint32_t, 4>{0, 0, width, height};
    if (!pacing_.finished() || !whole || !screen_->has_picture())
      if (auto failure = draw(pacing_.best(kind_), !whole)) return failure;
    auto picture = screen_->renderer().read_back();
    if (!picture) return Failure{1, picture.error().message};
    if (auto written = render::write_png(options_.screenshot, *picture, scene_->scene().background.transparent); !written)
      return Failure{2, written.error().message};
  }
  say_goodbye();
  if (interrupt_)
    if (const Outcome ended = interrupt_->outcome(); !ended) return Failure{1, ended.error().message};
  return std::nullopt;
}

}  // namespace catena::app
