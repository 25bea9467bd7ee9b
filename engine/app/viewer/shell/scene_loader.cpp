#include "engine/app/viewer/shell/scene_loader.h"

#include "engine/app/hand/hand_setup.h"
#include "engine/app/viewer/shell/hand_host.h"
#include "engine/base/start_thread.h"
#include "engine/scene/prepare.h"
#include "render/extract/extract.h"

namespace catena::app {

namespace {

Result<LoadedScene> open_and_load(const std::string& path, std::uint32_t width, std::uint32_t height) {
  CATENA_TRY(scene::Document document, scene::Document::open(path));
  CATENA_TRY(SceneHost host, SceneHost::open(std::move(document), {}));
  return load_scene(std::move(host), width, height);
}

}  // namespace

Result<LoadedScene> load_scene(SceneHost host, std::uint32_t width, std::uint32_t height) {
  scene::Scene& scene = host.scene();
  // the program loads what is felt, the packet what is drawn
  CATENA_CHECK(HandHost::load(scene));
  CATENA_TRY(render::FramePacket packet, render::make_frame(scene, width, height));
  const Bounds bounds = scene::prepared_bounds(scene);
  if (!scene.camera.given && packet.volumes.empty() && packet.isosurfaces.empty() && packet.tubes.empty())
    packet.view = render::fit_view(bounds, static_cast<double>(width) / height);
  host.bounds = bounds;
  return LoadedScene{std::move(host), std::move(packet), bounds};
}

void SceneLoader::start(const std::string& path, std::uint32_t width, std::uint32_t height) {
  CATENA_ASSERT(!is_busy());
  path_ = path;
  done_ = false;
  const auto load = [this, path, width, height] {
    loaded_.emplace(open_and_load(path, width, height));
    done_ = true;
  };
  try {
    thread_ = std::jthread(load);
  } catch (const std::system_error& error) {
    loaded_.emplace(no_thread(path, error));
    done_ = true;
  }
}

std::optional<Result<LoadedScene>> SceneLoader::take() {
  if (!is_busy() || !done_) return std::nullopt;
  if (thread_.joinable()) thread_.join();
  path_.clear();
  return std::exchange(loaded_, std::nullopt);
}

}  // namespace catena::app
