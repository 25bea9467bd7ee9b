// SPDX-License-Identifier: MIT
#include "engine/app/viewer/viewer.h"

#include <filesystem>

#include "engine/app/viewer/window/loading_screen.h"
#include "engine/app/viewer/window/session.h"
#include "engine/base/console.h"
#include "render/extract/extract.h"
#include "render/extract/extract_internal.h"
#include "render/image/image.h"

namespace catena::app {

namespace {

constexpr const char* kEmptyScene = "{\n  \"fields\": {},\n  \"chain\": []\n}\n";

Result<SceneModel> read_scene(const ViewOptions& options) {
  std::error_code code;
  CATENA_TRY(scene::Document document,
             options.source.empty() ? scene::Document::create(kEmptyScene, (std::filesystem::current_path(code) / "scene.json").string())
                                    : scene::Document::open(options.source, options.overrides, options.colors, options.grid_name));
  return SceneModel::open(std::move(document), options.apply_overrides);
}

/// Fallback without a window: draws what --screenshot requests in the way of `catena render`. Exit code 0.
Failure draw_without_window(const ViewOptions& options, SceneModel& host, HapticSession& hand, TrackedHead* head, const std::string& why) {
  const bool picture_only = options.ui_screenshot.empty() && options.servo_stats.empty() && options.frame_stats.empty() &&
                            options.haptic_options.recording_path.empty();
  if (options.screenshot.empty() || !picture_only) return {1, why};
  const auto loaded = load_initial_scene(host, hand, options.width, options.height);
  if (!loaded) return to_failure(loaded.error());
  const auto draw = [&]() -> Outcome {
    scene::Scene& scene = host.scene();
    scene.camera = to_scene_camera(loaded->packet.view);
    if (const auto first = head ? head->position_at(0) : std::nullopt) scene.camera.position = *first;
    const auto eye =
        render::view_size(render::stereo_packing(scene.stereo), render::stereo_view_count(scene.stereo), options.width, options.height);
    CATENA_TRY(const render::FramePacket packet,
               render::make_frame(scene, static_cast<std::uint32_t>(eye.width), static_cast<std::uint32_t>(eye.height)));
    render::vk::DeviceOptions device;
    device.memory_budget_bytes = options.gpu_memory;
    CATENA_TRY(const std::unique_ptr<render::Renderer> renderer, render::Renderer::create(device));
    CATENA_CHECK(renderer->draw(packet, ProgressiveScheduler(options.quality).final_frame(RayWorkload{}).settings));
    CATENA_TRY(const render::Image8 picture, renderer->read_back());
    return render::write_png(options.screenshot, picture, scene.background.transparent);
  }();
  if (!draw) return {1, draw.error().message};
  return {0, why.substr(0, why.find(';')) + "; " + options.screenshot + " was rendered without a window"};
}

std::optional<Failure> plan_hand(LiveTuning& live, SceneModel& scene, const HapticSession& hand) {
  if (!live.target.has_haptic_targets()) return std::nullopt;
  const Outcome planned = measure_tick_costs(live, scene, hand, [](const std::string& line) { print_message(line); });
  if (!planned) return to_failure(planned.error());
  if (!live.tick_tuning) return std::nullopt;
  print_message(live.tick_tuning->summary());
  scene.take_changed();
  return std::nullopt;
}

/// Opens the viewer. Errors in the scene, the device or the shaders are reported before a window opens, unless data take long to be read.
std::optional<Failure> show(const ViewOptions& options) {
  EarlyWindow early = options.early;
  auto scene = early.show_during([&] { return read_scene(options); });
  if (!scene) return to_failure(scene.error());
  std::optional<InterruptHandler> interrupt;
  HapticSession hand(options.haptic_options);
  if (auto opened = hand.open_device(scene->scene()); !opened) return to_failure(opened.error());
  // before the haptic program is built
  ViewOptions planned = options;
  if (auto failure = plan_hand(planned.tuning, *scene, hand)) return failure;
  std::optional<ShaderReload> reload;
  if (!options.shader_folder.empty()) {
    auto opened = ShaderReload::open(options.shader_folder);
    if (!opened) return Failure{2, "--shaders " + opened.error().message};
    reload = std::move(*opened);
  }
  std::unique_ptr<TrackedHead> head;
  if (!options.head_source.empty()) {
    auto opened = TrackedHead::open(options.head_source, scene->scene());
    if (!opened) return to_failure(opened.error());
    head = std::move(*opened);
  }
  if (!early.window) {
    auto window = Window::create(options.width, options.height, "catena");
    if (!window) return draw_without_window(options, *scene, hand, head.get(), window.error().message);
    early.window = std::move(*window);
  }
  Session session(planned, *scene, hand, *early.window, std::move(reload), std::move(head), interrupt);
  if (auto failure = session.open()) return failure;
  return session.run();
}

}  // namespace

int run_viewer(ViewOptions options) {
  const auto failure = show(options);
  if (failure) print_message(failure->message);
  return failure ? failure->exit_code : 0;
}

}  // namespace catena::app
