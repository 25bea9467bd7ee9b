#include "engine/app/viewer/session.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/app/hand/hand_setup.h"
#include "engine/base/clock.h"
#include "engine/base/output_file.h"
#include "engine/scene/hidden.h"
#include "render/extract/extract.h"
#include "render/extract/extract_stereo.h"
#include "render/passes/quality.h"
#include "render/vk/picture.h"

namespace catena::app {

namespace {

constexpr double kRestS = 0.25;       // without input for so long: the picture may take its time
constexpr double kIdleWaitS = 0.004;  // between looks at the servo's news when nothing else happens
constexpr double kMinimisedWaitS = 0.1;
constexpr double kTitleS = 0.25;
constexpr double kLiveS = 0.1;  // between interfaces that only follow the hand

}  // namespace

std::optional<Failure> Session::open_scene() {
  scene::Scene& scene = scene_->scene();
  // the program loads what is felt, the packet what is drawn; the workspace is fitted to both, then the program is final
  if (auto felt = HandHost::load(scene); !felt) return Failure{2, felt.error().message};
  auto packet = render::extract_frame(scene, options_.width, options_.height);
  if (!packet) return Failure{2, packet.error().message};
  render::Bounds bounds = render::packet_bounds(*packet);
  bounds.add(loaded_bounds(scene));
  if (auto prepared = hand_.prepare(scene, bounds); !prepared) return Failure{2, prepared.error().message};
  controls_.hand = hand_.first_probe();

  if (!scene.camera.given && packet->volumes.empty() && packet->isosurfaces.empty() && packet->tubes.empty())
    packet->view = render::fit_view(bounds, static_cast<double>(options_.width) / options_.height);
  controls_.view = controls_.home = packet->view;
  controls_.bounds = scene_->bounds = bounds;
  pin_camera();
  measure();
  return std::nullopt;
}

/// What the loop has to know of a scene that was read.
void Session::measure() {
  has_pulses_ = false;
  scene_->scene().world.each<scene::StreamlineSet>([&](scene::Entity e, const scene::StreamlineSet& set) {
    has_pulses_ = has_pulses_ || (set.pulse > 0 && !is_hidden(scene_->scene().world, e));
  });
}

std::optional<Failure> Session::open() {
  auto document = scene::Document::open(options_.source, options_.overrides);
  if (!document) return Failure{2, document.error().message};
  auto host = SceneHost::open(std::move(*document), options_.adjust);
  if (!host) return Failure{2, host.error().message};
  scene_ = std::move(*host);
  if (auto opened = hand_.open_device(scene_->scene()); !opened) return Failure{2, opened.error().message};
  if (!options_.shaders.empty()) {
    auto reload = ShaderReload::open(options_.shaders);
    if (!reload) return Failure{2, "--shaders " + reload.error().message};
    reload_ = std::move(*reload);
  }
  auto window = Window::create(options_.width, options_.height, "catena");
  if (!window) return Failure{1, window.error().message};
  window_ = std::move(*window);
  if (auto failure = open_scene()) return failure;

  auto screen = Screen::open(*window_, {options_.gpu_memory, {}});
  if (!screen) return Failure{1, screen.error().message};
  screen_ = std::move(*screen);
  gui_ = std::make_unique<Gui>(*window_);
  state_.panels = options_.panels;
  // a device that pushes is let go by its own way out, Ctrl-C or not
  if (!hand_.is_mouse()) interrupt_.emplace();
  hand_.start();
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
  if (auto published = hand_.publish(scene_->scene()); !published) state_.say(published.error().message, true);
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

std::optional<Failure> Session::draw(const NextPicture& next) {
  std::uint32_t width = 0, height = 0;
  screen_->size(width, height);
  if (width == 0 || height == 0) return std::nullopt;

  scene::Scene& scene = scene_->scene();
  const render::Packing packing = render::packing_of(scene.stereo);
  const std::uint32_t scale = render::is_interlaced(packing) ? 1 : next.scale;
  const auto eye = render::view_size(packing, render::views_of(scene.stereo), std::max(1u, width / scale), std::max(1u, height / scale));
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
  if (times_.count() == 0)
    for (const std::string& note : screen_->renderer().stats().notes) fmt::print(stderr, "catena: {}\n", note);
  times_.add(ms, now_ns());
  ++frames_in_title_;
  return std::nullopt;
}

/// The interface over the last picture.
std::optional<Failure> Session::show() {
  const std::int64_t start = now_ns();
  gui_->begin();
  PanelContext panels = context();
  draw_interface(panels);
  const render::UiItems items = gui_->end();
  window_->keys_are_text(gui_->wants_keys());
  if (auto shown = screen_->show(items); !shown) return Failure{1, shown.error().message};
  times_.add_interface(ms_since(start));
  damaged_ = false;
  return std::nullopt;
}

void Session::update_title() {
  const double since_s = 1e-3 * ms_since(last_title_);
  if (last_title_ != 0 && since_s < kTitleS) return;
  const exchange::HapticState& felt = hand_.felt();
  std::string title = fmt::format("catena  {:.0f} fps  {:.2f} N", last_title_ == 0 ? 0 : frames_in_title_ / since_s, norm(felt.force_n));
  const auto links = std::min(static_cast<std::size_t>(felt.link_count), hand_.link_names().size());
  for (std::size_t k = 0; k < links; ++k)
    title += fmt::format("  {} {}", hand_.link_names()[k], exchange::status_word(felt.links[k].status));
  if (const std::string text = hand_.hand().device->status_text(); !text.empty()) title += "  " + text;
  if (hand_.recording().failed()) title += "  the recording has stopped";
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
  fmt::print("{} frames, {:.1f} ms median, on {}\n", times_.count(), 1e-3 * times_.draw().p50_us, screen_->renderer().stats().device);
  fmt::print("probe {:.6g} {:.6g} {:.6g}, force {:.3g} N, {} ticks, {} deadlines missed\n", felt.probe.x, felt.probe.y, felt.probe.z,
             norm(felt.force_n), felt.tick, felt.missed_deadlines);
}

std::optional<Failure> Session::run() {
  std::int64_t last_move = now_ns(), last_show = 0;
  const std::int64_t start = now_ns();
  const bool always = options_.frames > 0 || options_.seconds > 0;
  bool busy = true, minimised = false, live = false;
  while (!state_.quit && (options_.frames == 0 || times_.count() < options_.frames) &&
         (options_.seconds <= 0 || 1e-3 * ms_since(start) < options_.seconds)) {
    const Changed changed = take_input(minimised ? kMinimisedWaitS : busy ? 0 : kIdleWaitS);
    const bool edited = take_edits(), news = hand_.take(scene_->scene());
    live = live || news;
    if (news) keep_widgets();
    std::uint32_t width = 0, height = 0;
    screen_->size(width, height);
    minimised = width == 0;
    if (minimised) {
      damaged_ = true;
      continue;
    }
    const bool pulsed = run_pulses(), reloaded = take_shaders(), resized = screen_->is_resized();
    const bool moved = changed.any() || edited || news || resized || pulsed || reloaded || times_.count() == 0;
    if (moved) last_move = now_ns();

    // a picture in time while something moves, better ones when it rests
    std::optional<NextPicture> next;
    if (options_.frames > 0 && times_.count() + 1 == options_.frames)
      next = pacing_.best(kind_);
    else if (moved)
      next = pacing_.moving(kind_);
    else if (1e-3 * ms_since(last_move) >= kRestS)
      next = pacing_.still(kind_);
    if (!next && always) next = pacing_.again();
    busy = next.has_value();
    if (next)
      if (auto failure = draw(*next)) return failure;

    // the interface follows the person at once, the hand at a calmer pace
    const bool due = live && 1e-3 * ms_since(last_show) >= kLiveS;
    if (next || damaged_ || due || window_->happened() || gui_->is_busy()) {
      if (auto failure = show()) return failure;
      last_show = now_ns();
      live = false;
      fulfil_wishes();
    }
    update_title();
  }
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
  if (!options_.screenshot.empty() && times_.count() > 0) {
    if (!pacing_.finished())
      if (auto failure = draw(pacing_.best(kind_))) return failure;
    auto picture = screen_->renderer().read_back();
    if (!picture) return Failure{1, picture.error().message};
    if (auto written = render::write_png(options_.screenshot, *picture, scene_->scene().background.transparent); !written)
      return Failure{2, written.error().message};
  }
  if (!options_.window_screenshot.empty() && times_.count() > 0) {
    if (auto failure = show()) return failure;
    auto picture = screen_->window_picture();
    if (!picture) return Failure{1, picture.error().message};
    if (auto written = render::write_png(options_.window_screenshot, *picture, false); !written) return Failure{2, written.error().message};
  }
  say_goodbye();
  return std::nullopt;
}

}  // namespace catena::app
