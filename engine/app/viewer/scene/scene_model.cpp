// SPDX-License-Identifier: MIT
#include "engine/app/viewer/scene/scene_model.h"

#include <utility>

#include "engine/app/haptics/haptic_device_setup.h"
#include "engine/app/viewer/input/haptic_session.h"
#include "engine/base/threads.h"
#include "engine/scene/prepare.h"
#include "render/extract/extract.h"
#include "render/passes/renderer.h"

namespace catena::app {

namespace {

Result<LoadedScene> open_and_load(const std::string& path, const std::string& grid, std::uint32_t width, std::uint32_t height) {
  CATENA_TRY(scene::Document document, scene::Document::open(path, {}, {}, grid));
  CATENA_TRY(SceneModel host, SceneModel::open(std::move(document), {}));
  return load_scene(std::move(host), width, height);
}

}  // namespace

Result<LoadedScene> load_scene(SceneModel host, std::uint32_t width, std::uint32_t height) {
  scene::Scene& scene = host.scene();
  // the haptic program loads the fields of the chain, the frame packet those of visible items
  CATENA_CHECK(HapticSession::load(scene));
  CATENA_TRY(render::FramePacket packet, render::make_frame(scene, width, height));
  const Bounds bounds = scene::scene_bounds(scene);
  if (!scene.camera.is_explicit && packet.volumes.empty() && packet.isosurfaces.empty() && packet.tubes.empty() && packet.spheres.empty())
    packet.view = render::fit_view(bounds.scaled(scene.stretch), static_cast<double>(width) / height);
  packet.view.stretch = scene.stretch;
  host.bounds = bounds;
  return LoadedScene{std::move(host), std::move(packet), bounds};
}

void SceneLoader::start(const std::string& path, const std::string& grid, std::uint32_t width, std::uint32_t height) {
  CATENA_ASSERT(!is_busy());
  path_ = path;
  done_ = false;
  const auto load = [this, path, grid, width, height] {
    loaded_.emplace(open_and_load(path, grid, width, height));
    done_ = true;
  };
  try {
    thread_ = std::jthread(load);
  } catch (const std::system_error& error) {
    loaded_.emplace(thread_start_error(path, error));
    done_ = true;
  }
}

std::optional<Result<LoadedScene>> SceneLoader::take_result() {
  if (!is_busy() || !done_) return std::nullopt;
  if (thread_.joinable()) thread_.join();
  path_.clear();
  return std::exchange(loaded_, std::nullopt);
}

namespace {

void make_cursor(scene::Scene& scene) {
  if (!scene.cursor) scene.cursor = scene.entities.create();
  if (!scene.entities.has<scene::Cursor>(scene.cursor)) scene.entities.emplace<scene::Cursor>(scene.cursor);
}

}  // namespace

Result<SceneModel> SceneModel::open(scene::Document document, std::function<Outcome(scene::Scene&)> adjust) {
  SceneModel host(std::move(document), std::move(adjust));
  CATENA_TRY(host.scene_, host.parse_document());
  return host;
}

Result<scene::Scene> SceneModel::parse_document() const {
  CATENA_TRY(scene::Scene scene, document_.read());
  make_cursor(scene);
  if (apply_overrides_) CATENA_CHECK(apply_overrides_(scene));
  if (tick_tuning_) tick_tuning_->apply(scene);
  return scene;
}

Outcome SceneModel::set_tick_tuning(std::optional<tuning::TickTuning> plan) {
  std::swap(tick_tuning_, plan);
  const Outcome done = edit_document([](scene::Document&) -> Outcome { return Done{}; });
  if (!done) std::swap(tick_tuning_, plan);
  return done;
}

std::string SceneModel::recording_text() const {
  auto text = tick_tuning_ ? tick_tuning_->apply(document_.text(), document_.path()) : Result<std::string>(document_.text());
  return text ? std::move(*text) : document_.text();
}

void SceneModel::transfer_session_state(scene::Scene& reloaded) const {
  reloaded.camera = scene_.camera;
  reloaded.stereo.mode = scene_.stereo.mode;
  reloaded.animation_phase = scene_.animation_phase;
  // the workspace is fitted to the device only once; a scene that states another one takes effect when it is opened
  reloaded.workspace = scene_.workspace;
  if (!reloaded.coupling.ramp_s) reloaded.coupling.ramp_s = scene_.coupling.ramp_s;
}

Outcome SceneModel::edit_document(const std::function<Outcome(scene::Document&)>& edit) {
  scene::Document edited = document_;
  CATENA_CHECK(edit(edited));
  std::swap(document_, edited);
  // after the swap `edited` holds the previous document, restored on an error
  auto reloaded = parse_document();
  if (!reloaded) {
    std::swap(document_, edited);
    return reloaded.error();
  }
  scene::transfer_state(scene_, *reloaded);
  transfer_session_state(*reloaded);
  if (validator_)
    if (const Outcome valid_outcome = validator_(*reloaded); !valid_outcome) {
      scene::transfer_state(*reloaded, scene_);
      std::swap(document_, edited);
      return valid_outcome;
    }
  scene_ = std::move(*reloaded);
  changed_ = true;
  return Done{};
}

Outcome check_drawable(scene::Scene& scene) {
  CATENA_TRY(const render::FramePacket packet, render::make_frame(scene, 16, 16));
  return render::check_ray_items(packet);
}

SceneModel::Validator SceneModel::make_validator(const HapticSession& hand) {
  return [&hand](scene::Scene& edited) -> Outcome {
    CATENA_CHECK(hand.validate(edited));
    return check_drawable(edited);
  };
}

Outcome SceneModel::set(std::string_view pointer, const std::string& value, const std::string& what, const std::string& drag) {
  return edit_document([&](scene::Document& document) { return document.set(pointer, value, what, drag); });
}

Outcome SceneModel::remove(std::string_view pointer, const std::string& what) {
  return edit_document([&](scene::Document& document) { return document.remove(pointer, what); });
}

Outcome SceneModel::apply(const std::vector<scene::Document::Edit>& edits, const std::string& what, const std::string& drag) {
  return edit_document([&](scene::Document& document) { return document.apply(edits, what, drag); });
}

Outcome SceneModel::replace(const std::string& text, const std::string& what) {
  return edit_document([&](scene::Document& document) { return document.replace(text, what); });
}

Outcome SceneModel::undo() {
  if (!document_.can_undo()) return Done{};
  return edit_document([](scene::Document& document) -> Outcome {
    document.undo();
    return Done{};
  });
}

Outcome SceneModel::redo() {
  if (!document_.can_redo()) return Done{};
  return edit_document([](scene::Document& document) -> Outcome {
    document.redo();
    return Done{};
  });
}

Outcome SceneModel::reload_from_disk() {
  return edit_document([](scene::Document& document) { return document.reload_from_disk(); });
}

Outcome SceneModel::save(const std::string& path) { return document_.save(path); }

}  // namespace catena::app
