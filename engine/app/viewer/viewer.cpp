#include "engine/app/viewer/viewer.h"

#include <filesystem>

#include "engine/app/viewer/shell/session.h"
#include "engine/base/tell.h"
#include "render/extract/extract.h"
#include "render/extract/extract_parts.h"
#include "render/image/picture.h"

namespace catena::app {

namespace {

constexpr const char* kEmptyScene = "{\n  \"fields\": {},\n  \"chain\": []\n}\n";

Result<SceneHost> read_scene(const ViewOptions& options) {
  std::error_code code;
  CATENA_TRY(scene::Document document,
             options.source.empty() ? scene::Document::make(kEmptyScene, (std::filesystem::current_path(code) / "scene.json").string())
                                    : scene::Document::open(options.source, options.overrides, {}, options.grid));
  return SceneHost::open(std::move(document), options.adjust);
}

/// The next best thing to a window: what --screenshot asks for, drawn as `catena render` does. Exit code 0.
Failure draw_without_window(const ViewOptions& options, SceneHost& host, HandHost& hand, TrackedHead* head, const std::string& why) {
  const bool picture_only =
      options.window_screenshot.empty() && options.servo_stats.empty() && options.frame_stats.empty() && options.hand.record.empty();
  if (options.screenshot.empty() || !picture_only) return {1, why};
  const auto loaded = load_first(host, hand, options.width, options.height);
  if (!loaded) return failure_of(loaded.error());
  const auto draw = [&]() -> Outcome {
    scene::Scene& scene = host.scene();
    scene.camera = camera_of(loaded->packet.view);
    if (const auto first = head ? head->at(0) : std::nullopt) scene.camera.position = *first;
    const auto eye = render::view_size(render::packing_of(scene.stereo), render::views_of(scene.stereo), options.width, options.height);
    CATENA_TRY(const render::FramePacket packet,
               render::make_frame(scene, static_cast<std::uint32_t>(eye.width), static_cast<std::uint32_t>(eye.height)));
    render::vk::DeviceOptions device;
    device.memory_budget_bytes = options.gpu_memory;
    CATENA_TRY(const std::unique_ptr<render::Renderer> renderer, render::Renderer::create(device));
    CATENA_CHECK(renderer->draw(packet, Pacing(options.quality).best(SceneKind{}).settings));
    CATENA_TRY(const render::Picture picture, renderer->read_back());
    return render::write_png(options.screenshot, picture, scene.background.transparent);
  }();
  if (!draw) return {1, draw.error().message};
  return {0, why.substr(0, why.find(';')) + "; " + options.screenshot + " was drawn without a window"};
}

std::optional<Failure> plan_hand(LivePlan& live, SceneHost& scene, const HandHost& hand) {
  if (!live.wanted.of_hand()) return std::nullopt;
  const Outcome planned = measure_hand(live, scene, hand, [](const std::string& line) { tell_from_catena(line); });
  if (!planned) return failure_of(planned.error());
  if (!live.hand) return std::nullopt;
  tell_from_catena(live.hand->sentence());
  scene.take_changed();
  return std::nullopt;
}

/// What is wrong with the scene, the device or the shaders is said before any window opens.
std::optional<Failure> show(const ViewOptions& options) {
  auto scene = read_scene(options);
  if (!scene) return failure_of(scene.error());
  std::optional<Interrupt> interrupt;
  HandHost hand(options.hand);
  if (auto opened = hand.open_device(scene->scene()); !opened) return failure_of(opened.error());
  // before anything is felt
  ViewOptions planned = options;
  if (auto failure = plan_hand(planned.plan, *scene, hand)) return failure;
  std::optional<ShaderReload> reload;
  if (!options.shaders.empty()) {
    auto opened = ShaderReload::open(options.shaders);
    if (!opened) return Failure{2, "--shaders " + opened.error().message};
    reload = std::move(*opened);
  }
  std::unique_ptr<TrackedHead> head;
  if (!options.head.empty()) {
    auto opened = TrackedHead::open(options.head, scene->scene());
    if (!opened) return failure_of(opened.error());
    head = std::move(*opened);
  }
  auto window = Window::create(options.width, options.height, "catena");
  if (!window) return draw_without_window(options, *scene, hand, head.get(), window.error().message);
  Session session(planned, *scene, hand, **window, std::move(reload), std::move(head), interrupt);
  if (auto failure = session.open()) return failure;
  return session.run();
}

}  // namespace

int view(ViewOptions options) {
  const auto failure = show(options);
  if (failure) tell_from_catena(failure->message);
  return failure ? failure->exit_code : 0;
}

}  // namespace catena::app
