#include "engine/app/viewer/viewer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <vector>

#include "engine/app/hand/crash_guard.h"
#include "engine/app/hand/hand_setup.h"
#include "engine/app/hand/interrupt.h"
#include "engine/app/hand/open_hand.h"
#include "engine/app/hand/recording.h"
#include "engine/app/viewer/controls.h"
#include "engine/app/viewer/pacing.h"
#include "engine/app/viewer/pulse_clock.h"
#include "engine/app/viewer/shader_reload.h"
#include "engine/app/viewer/window.h"
#include "engine/base/clock.h"
#include "engine/scene/systems.h"
#include "haptics/device/mouse.h"
#include "haptics/extract/extract.h"
#include "haptics/servo/servo.h"
#include "render/extract/extract.h"
#include "render/extract/extract_stereo.h"
#include "render/passes/quality.h"
#include "render/passes/renderer.h"
#include "render/vk/picture.h"
#include "render/vk/swapchain.h"

namespace catena::app {

namespace {

constexpr double kRestS = 0.25;       // without input for so long: the picture may take its time
constexpr double kIdleWaitS = 0.004;  // between looks at the servo's news when nothing else happens
constexpr double kMinimisedWaitS = 0.1;
constexpr double kTitleS = 0.25;

struct Failure {
  int exit_code;
  std::string message;
};

/// One open window on one scene. Members in the order of their making: the servo goes before the device it reads.
class Session {
 public:
  explicit Session(ViewOptions options) : options_(std::move(options)), pacing_(options_.quality) {}

  std::optional<Failure> open();
  std::optional<Failure> run();

 private:
  std::optional<Failure> open_scene();
  void pin_camera();
  void say_forces() const;
  Changed take_input(double wait_s);
  bool take_haptics();
  bool run_pulses();
  bool take_shaders();
  std::optional<Failure> draw(const NextPicture& next);
  Outcome draw_packet(const render::FramePacket& packet, const render::RenderSettings& settings);
  void update_title();
  void say_goodbye();

  ViewOptions options_;
  std::unique_ptr<Window> window_;
  std::unique_ptr<render::Renderer> renderer_;
  std::unique_ptr<render::vk::Swapchain> swapchain_;
  Controls controls_;
  Pacing pacing_;
  SceneKind kind_;
  PulseClock pulses_;
  bool has_pulses_ = false, pulses_run_ = true;
  std::optional<ShaderReload> reload_;
  OpenHand hand_;
  haptics::MouseDevice* mouse_ = nullptr;  ///< hand_.device, if that is the mouse: the frame moves it
  Recording recording_;
  std::optional<Interrupt> interrupt_;
  std::optional<CrashGuard> crash_guard_;
  std::unique_ptr<haptics::Servo> servo_;
  std::vector<std::string> link_names_;
  exchange::HapticState felt_;

  bool quit_ = false;
  bool fits_ = true;  ///< the swapchain still has the window's size
  bool damaged_ = false;
  int frames_ = 0;
  std::vector<double> frame_ms_;  ///< of this run, for the goodbye
  std::int64_t last_title_ = 0;
  int frames_in_title_ = 0;
};

std::optional<Failure> Session::open_scene() {
  scene::Scene& scene = options_.scene;
  if (!scene.cursor) scene.cursor = scene.world.create();
  if (!scene.world.has<scene::Cursor>(scene.cursor)) scene.world.emplace<scene::Cursor>(scene.cursor);

  // the program loads what is felt, the packet what is drawn; the workspace is fitted to both, then the program is final
  if (auto felt = haptics::extract_program(scene); !felt) return Failure{2, felt.error().message};
  auto packet = render::extract_frame(scene, options_.width, options_.height);
  if (!packet) return Failure{2, packet.error().message};
  render::Bounds bounds = render::packet_bounds(*packet);
  bounds.add(loaded_bounds(scene));
  const bool is_mouse = !hand_.device;
  if (is_mouse) hand_.device = std::make_unique<haptics::MouseDevice>(Vec3(0.0));
  auto program = program_for(scene, hand_, bounds);
  if (!program) return Failure{2, program.error().message};
  controls_.hand = first_probe(scene, bounds);
  if (is_mouse) {
    auto mouse = std::make_unique<haptics::MouseDevice>(device_from_world(scene.workspace, controls_.hand));
    mouse_ = mouse.get();
    hand_.device = std::move(mouse);
  }
  for (const haptics::Link& link : (*program)->links) link_names_.push_back(link.name);
  scene.world.get<scene::Cursor>(scene.cursor).names = link_names_;
  haptics::ServoOptions servo;
  servo.rate_hz = hand_.settings.rate_hz;
  servo.forces = is_mouse || hand_.device->capabilities().max_force_n <= 0;
  servo.realtime = options_.realtime;
  if (is_mouse) servo.realtime.lock_memory = false;  // nothing pushes: a page fault does no harm
  auto recording = Recording::open(options_.record, scene, options_.fields, hand_, **program);
  if (!recording) return Failure{2, recording.error().message};
  recording_ = std::move(*recording);
  servo.sink = recording_.sink();
  servo_ = std::make_unique<haptics::Servo>(*hand_.device, *program, servo);

  if (!scene.camera.given && packet->volumes.empty() && packet->isosurfaces.empty() && packet->tubes.empty())
    packet->view = render::fit_view(bounds, static_cast<double>(options_.width) / options_.height);
  controls_.view = controls_.home = packet->view;
  controls_.bounds = bounds;
  scene.world.each<scene::StreamlineSet>(
      [&](scene::Entity, const scene::StreamlineSet& set) { has_pulses_ = has_pulses_ || set.pulse > 0; });
  pin_camera();
  return std::nullopt;
}

std::optional<Failure> Session::open() {
  if (options_.device != "mouse") {
    auto hand = open_hand(options_.scene, options_.device, {}, options_.firmware);
    if (!hand) return Failure{2, hand.error().message};
    hand_ = std::move(*hand);
  }
  if (!options_.shaders.empty()) {
    auto reload = ShaderReload::open(options_.shaders);
    if (!reload) return Failure{2, "--shaders " + reload.error().message};
    reload_ = std::move(*reload);
  }
  auto window = Window::create(options_.width, options_.height, "catena");
  if (!window) return Failure{1, window.error().message};
  window_ = std::move(*window);
  if (auto failure = open_scene()) return failure;

  render::vk::DeviceOptions device;
  device.surface = window_->surface_factory();
  auto renderer = render::Renderer::create(device);
  if (!renderer) return Failure{1, renderer.error().message};
  renderer_ = std::move(*renderer);
  std::uint32_t width = 0, height = 0;
  window_->framebuffer_size(width, height);
  auto swapchain = render::vk::Swapchain::create(renderer_->device(), std::max(1u, width), std::max(1u, height));
  if (!swapchain) return Failure{1, swapchain.error().message};
  swapchain_ = std::move(*swapchain);
  // a device that pushes is let go by its own way out, Ctrl-C or not
  if (mouse_ == nullptr) {
    interrupt_.emplace();
    crash_guard_.emplace(*hand_.device);
  }
  servo_->start();
  if (mouse_ == nullptr) {
    if (!hand_.note.empty()) fmt::print(stderr, "catena: {}\n", hand_.note);
    for (const std::string& note : servo_->report().realtime.notes) fmt::print(stderr, "catena: {}\n", note);
    say_forces();
  }
  return std::nullopt;
}

/// From now on the camera is where the controls have it (a fitted one would follow the cursor).
void Session::pin_camera() {
  const render::View& v = controls_.view;
  options_.scene.camera = {v.position, v.target, v.up, v.fovy_deg, v.orthographic, v.height, true};
}

void Session::say_forces() const {
  fmt::print("{}: forces {} (F turns them {})\n", hand_.device->capabilities().name, servo_->forces() ? "on" : "off",
             servo_->forces() ? "off" : "on");
  std::fflush(stdout);
}

Changed Session::take_input(double wait_s) {
  Changed changed;
  for (const Input& input : window_->poll(wait_s)) {
    const Changed by_piece = apply(controls_, input);
    changed.view = changed.view || by_piece.view;
    changed.hand = changed.hand || by_piece.hand;
    quit_ = quit_ || input.quit;
    damaged_ = damaged_ || input.damaged;
    if (input.toggle_pulses) pulses_run_ = !pulses_run_;
    if (input.next_stereo) {
      auto& mode = options_.scene.stereo.mode;
      mode = static_cast<scene::StereoMode>((static_cast<int>(mode) + 1) % scene::kStereoModes);
      changed.view = true;
    }
    if (input.toggle_forces && mouse_ == nullptr) {
      servo_->set_forces(!servo_->forces());
      say_forces();
    }
    if (input.help) {
      std::fputs(std::string(key_help()).c_str(), stdout);
      std::fflush(stdout);
    }
  }
  quit_ = quit_ || window_->closing() || (interrupt_ && interrupt_->asked());
  if (changed.hand && mouse_ != nullptr) mouse_->move_to(device_from_world(options_.scene.workspace, controls_.hand), controls_.buttons);
  if (changed.view) pin_camera();
  return changed;
}

/// The newest state, if there is one; true where it would change the picture.
bool Session::take_haptics() {
  const exchange::HapticState before = felt_;
  if (!servo_->take(felt_)) return false;
  scene::update_cursor(options_.scene, felt_);
  bool changed = before.tick == 0 || before.probe != felt_.probe || before.force_n != felt_.force_n;
  for (int i = 0; i < felt_.link_count && !changed; ++i) {
    const auto k = static_cast<std::size_t>(i);
    changed = before.links[k].proxy != felt_.links[k].proxy || before.links[k].active != felt_.links[k].active ||
              before.links[k].status != felt_.links[k].status;
  }
  return changed;
}

/// True where the pulses have moved. With a number of frames asked for they stand: the pictures repeat.
bool Session::run_pulses() {
  const bool running = has_pulses_ && pulses_run_ && options_.frames == 0 && window_->looked_at();
  const auto phase = pulses_.advance(now_ns(), running, options_.scene.phase);
  if (phase) options_.scene.phase = *phase;
  return phase.has_value();
}

bool Session::take_shaders() { return reload_ && reload_->poll(*renderer_, now_ns()); }

/// With the embedded shaders if those of --shaders cannot be drawn with.
Outcome Session::draw_packet(const render::FramePacket& packet, const render::RenderSettings& settings) {
  auto drawn = renderer_->draw(packet, settings);
  if (!drawn && reload_ && reload_->give_up(*renderer_, drawn.error().message)) return renderer_->draw(packet, settings);
  return drawn;
}

std::optional<Failure> Session::draw(const NextPicture& next) {
  std::uint32_t width = 0, height = 0;
  window_->framebuffer_size(width, height);
  if (width == 0 || height == 0) return std::nullopt;
  if (!fits_ || swapchain_->extent().width != width || swapchain_->extent().height != height)
    if (auto resized = swapchain_->resize(width, height); !resized) return Failure{1, resized.error().message};

  const scene::Stereo& stereo = options_.scene.stereo;
  const render::Packing packing = render::packing_of(stereo);
  const std::uint32_t scale = render::is_interlaced(packing) ? 1 : next.scale;
  const auto eye = render::view_size(packing, render::views_of(stereo), std::max(1u, width / scale), std::max(1u, height / scale));
  std::int64_t start = now_ns();
  auto packet = render::extract_frame(options_.scene, static_cast<std::uint32_t>(eye.width), static_cast<std::uint32_t>(eye.height));
  if (!packet) return Failure{2, packet.error().message};
  if (pacing_.wants_estimate()) {
    const auto error = render::estimate_rmse(*renderer_, *packet, next.settings);
    if (!error) return Failure{1, error.error().message};
    pacing_.estimated(*error);
    start = now_ns();
  }
  if (auto drawn = draw_packet(*packet, next.settings); !drawn) return Failure{1, drawn.error().message};
  const double ms = ms_since(start);
  pacing_.drawn(ms);
  const auto shaded = [](const render::VolumeItem& item) { return item.shade; };
  kind_ = {!packet->volumes.empty() || !packet->isosurfaces.empty(), renderer_->draws_fast(*packet),
           std::any_of(packet->volumes.begin(), packet->volumes.end(), shaded)};
  if (frames_ == 0)
    for (const std::string& note : renderer_->stats().notes) fmt::print(stderr, "catena: {}\n", note);
  frame_ms_.push_back(ms);

  auto shown = renderer_->present(*swapchain_);
  if (!shown) return Failure{1, shown.error().message};
  fits_ = *shown;
  damaged_ = false;
  ++frames_;
  ++frames_in_title_;
  return std::nullopt;
}

void Session::update_title() {
  const double since_s = 1e-3 * ms_since(last_title_);
  if (last_title_ != 0 && since_s < kTitleS) return;
  std::string title = fmt::format("catena  {:.0f} fps  {:.2f} N", last_title_ == 0 ? 0 : frames_in_title_ / since_s, norm(felt_.force_n));
  for (int i = 0; i < felt_.link_count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    title += fmt::format("  {} {}", link_names_[k], exchange::status_word(felt_.links[k].status));
  }
  if (const std::string text = hand_.device->status_text(); !text.empty()) title += "  " + text;
  if (recording_.failed()) title += "  the recording has stopped";
  if (mouse_ == nullptr) title += servo_->forces() ? "  [forces on]" : "  [forces off]";
  if (options_.scene.stereo.mode != scene::StereoMode::mono) title += fmt::format("  [{}]", scene::stereo_word(options_.scene.stereo.mode));
  if (controls_.hand_mode) title += "  [hand]";
  title += "  [" + pacing_.words() + "]";
  window_->set_title(title);
  last_title_ = now_ns();
  frames_in_title_ = 0;
}

void Session::say_goodbye() {
  std::sort(frame_ms_.begin(), frame_ms_.end());
  fmt::print("{} frames, {:.1f} ms median, on {}\n", frames_, frame_ms_.empty() ? 0 : frame_ms_[frame_ms_.size() / 2],
             renderer_->stats().device);
  fmt::print("probe {:.6g} {:.6g} {:.6g}, force {:.3g} N, {} ticks, {} deadlines missed\n", felt_.probe.x, felt_.probe.y, felt_.probe.z,
             norm(felt_.force_n), felt_.tick, felt_.missed_deadlines);
}

std::optional<Failure> Session::run() {
  std::int64_t last_move = now_ns();
  const std::int64_t start = now_ns();
  const bool always = options_.frames > 0 || options_.seconds > 0;
  bool busy = true, minimised = false;
  while (!quit_ && (options_.frames == 0 || frames_ < options_.frames) &&
         (options_.seconds <= 0 || 1e-3 * ms_since(start) < options_.seconds)) {
    const Changed changed = take_input(minimised ? kMinimisedWaitS : busy ? 0 : kIdleWaitS);
    const bool news = take_haptics();
    std::uint32_t width = 0, height = 0;
    window_->framebuffer_size(width, height);
    minimised = width == 0;
    if (minimised) {
      damaged_ = true;
      continue;
    }
    const bool resized = !fits_ || width != swapchain_->extent().width || height != swapchain_->extent().height;
    const bool pulsed = run_pulses(), reloaded = take_shaders();
    const bool moved = changed.any() || news || resized || pulsed || reloaded || frames_ == 0;
    if (moved) last_move = now_ns();

    // a picture in time while something moves, better ones when it rests
    std::optional<NextPicture> next;
    if (options_.frames > 0 && frames_ + 1 == options_.frames)
      next = pacing_.best(kind_);
    else if (moved)
      next = pacing_.moving(kind_);
    else if (1e-3 * ms_since(last_move) >= kRestS)
      next = pacing_.still(kind_);
    if (!next && (damaged_ || always)) next = pacing_.again();
    busy = next.has_value();
    if (next)
      if (auto failure = draw(*next)) return failure;
    update_title();
  }
  servo_->stop();
  take_haptics();
  if (auto recorded = recording_.finish(); !recorded) return Failure{2, recorded.error().message};
  if (auto written = write_servo_stats(options_.servo_stats, *servo_, *hand_.device); !written) return Failure{2, written.error().message};

  if (!options_.screenshot.empty() && frames_ > 0) {
    if (!pacing_.finished())
      if (auto failure = draw(pacing_.best(kind_))) return failure;
    auto picture = renderer_->read_back();
    if (!picture) return Failure{1, picture.error().message};
    if (auto written = render::write_png(options_.screenshot, *picture, options_.scene.background.transparent); !written)
      return Failure{2, written.error().message};
  }
  say_goodbye();
  return std::nullopt;
}

}  // namespace

int view(ViewOptions options) {
  Session session(std::move(options));
  auto failure = session.open();
  if (!failure) failure = session.run();
  if (failure) fmt::print(stderr, "catena: {}\n", failure->message);
  return failure ? failure->exit_code : 0;
}

}  // namespace catena::app
