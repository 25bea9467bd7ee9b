#include "engine/app/viewer/shell/scene_host.h"

#include <utility>

#include "engine/app/hand/open_hand.h"
#include "engine/app/viewer/shell/hand_host.h"
#include "engine/base/threads.h"
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
  if (!scene.camera.given && packet.volumes.empty() && packet.isosurfaces.empty() && packet.tubes.empty() && packet.balls.empty())
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

namespace {

void make_cursor(scene::Scene& scene) {
  if (!scene.cursor) scene.cursor = scene.world.create();
  if (!scene.world.has<scene::Cursor>(scene.cursor)) scene.world.emplace<scene::Cursor>(scene.cursor);
}

}  // namespace

Result<SceneHost> SceneHost::open(scene::Document document, std::function<Outcome(scene::Scene&)> adjust) {
  SceneHost host(std::move(document), std::move(adjust));
  CATENA_TRY(host.scene_, host.read());
  return host;
}

Result<scene::Scene> SceneHost::read() const {
  CATENA_TRY(scene::Scene scene, document_.read());
  make_cursor(scene);
  if (adjust_) CATENA_CHECK(adjust_(scene));
  if (plan_) plan_->apply(scene);
  return scene;
}

Outcome SceneHost::plan_hand(std::optional<plan::HandPlan> plan) {
  std::swap(plan_, plan);
  const Outcome done = change([](scene::Document&) -> Outcome { return Done{}; });
  if (!done) std::swap(plan_, plan);
  return done;
}

std::string SceneHost::felt_text() const {
  auto text = plan_ ? plan_->apply(document_.text(), document_.path()) : Result<std::string>(document_.text());
  return text ? std::move(*text) : document_.text();
}

void SceneHost::keep_what_is_lived(scene::Scene& fresh) const {
  fresh.camera = scene_.camera;
  fresh.stereo.mode = scene_.stereo.mode;
  fresh.phase = scene_.phase;
  // fitted to the device once; a scene that states another one is followed when it is opened
  fresh.workspace = scene_.workspace;
  if (!fresh.coupling.ramp_s) fresh.coupling.ramp_s = scene_.coupling.ramp_s;
}

Outcome SceneHost::change(const std::function<Outcome(scene::Document&)>& edit) {
  scene::Document edited = document_;
  CATENA_CHECK(edit(edited));
  std::swap(document_, edited);
  // `edited` is what it was from here on
  auto fresh = read();
  if (!fresh) {
    std::swap(document_, edited);
    return fresh.error();
  }
  scene::carry_over(scene_, *fresh);
  keep_what_is_lived(*fresh);
  if (check_)
    if (const Outcome good = check_(*fresh); !good) {
      scene::carry_over(*fresh, scene_);
      std::swap(document_, edited);
      return good;
    }
  scene_ = std::move(*fresh);
  changed_ = true;
  return Done{};
}

Outcome SceneHost::set(std::string_view pointer, const std::string& value, const std::string& what, const std::string& drag) {
  return change([&](scene::Document& document) { return document.set(pointer, value, what, drag); });
}

Outcome SceneHost::remove(std::string_view pointer, const std::string& what) {
  return change([&](scene::Document& document) { return document.remove(pointer, what); });
}

Outcome SceneHost::apply(const std::vector<scene::Document::Edit>& edits, const std::string& what, const std::string& drag) {
  return change([&](scene::Document& document) { return document.apply(edits, what, drag); });
}

Outcome SceneHost::replace(const std::string& text, const std::string& what) {
  return change([&](scene::Document& document) { return document.replace(text, what); });
}

Outcome SceneHost::undo() {
  if (!document_.can_undo()) return Done{};
  return change([](scene::Document& document) -> Outcome {
    document.undo();
    return Done{};
  });
}

Outcome SceneHost::redo() {
  if (!document_.can_redo()) return Done{};
  return change([](scene::Document& document) -> Outcome {
    document.redo();
    return Done{};
  });
}

Outcome SceneHost::take_from_disk() {
  return change([](scene::Document& document) { return document.take_from_disk(); });
}

Outcome SceneHost::save(const std::string& path) { return document_.save(path); }

}  // namespace catena::app
