// SPDX-License-Identifier: MIT
/// The scene shown in the window together with the text it is read from. Edits change the text; the scene is then read again and takes over
/// loaded data, haptic state and the camera. Frame thread.
#pragma once
#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

#include "engine/app/tuning/choose/tick_tuning.h"
#include "engine/base/result.h"
#include "engine/scene/document.h"
#include "render/frame/camera.h"
#include "render/frame/frame_packet.h"

namespace catena::app {

class HapticSession;

/// Owns document and scene, and keeps them consistent.
class SceneModel {
 public:
  /// Reads the scene; nothing is loaded yet. `adjust`: applies overrides, called whenever the scene is read. An Error if the document is
  /// invalid.
  static Result<SceneModel> open(scene::Document document, std::function<Outcome(scene::Scene&)> adjust);

  scene::Scene& scene() { return scene_; }
  const scene::Scene& scene() const { return scene_; }
  const scene::Document& document() const { return document_; }

  /// Additional check that a scene must pass for an edit to be accepted, such as that its haptic program can be built. It may load what the
  /// scene refers to.
  using Validator = std::function<Outcome(scene::Scene&)>;
  void set_validator(Validator check) { validator_ = std::move(check); }
  /// Returns the check that the haptic program can be built and the scene be drawn. `hand` must outlive the validator.
  static Validator make_validator(const HapticSession& hand);

  /// Applies an edit; an Error leaves everything unchanged. `what`: undo label, `drag`: undo group, as in Document::set.
  Outcome set(std::string_view pointer, const std::string& value, const std::string& what, const std::string& drag = {});
  Outcome remove(std::string_view pointer, const std::string& what);
  Outcome apply(const std::vector<scene::Document::Edit>& edits, const std::string& what, const std::string& drag = {});
  /// Replaces the whole text, as one undo step.
  Outcome replace(const std::string& text, const std::string& what);
  /// Reads the file again, as one undo step.
  Outcome reload_from_disk();
  /// Undo and redo; without effect if there is nothing to undo or redo.
  Outcome undo();
  Outcome redo();
  /// Writes the text to a file. An Error if it cannot be written.
  Outcome save(const std::string& path);

  /// Applies the tick tuning to the links, immediately and whenever the scene is read. An Error leaves everything unchanged.
  Outcome set_tick_tuning(std::optional<tuning::TickTuning> plan);
  /// Returns the text of the scene as used for haptics, with the tick tuning applied; for recordings.
  std::string recording_text() const;

  /// Returns whether the scene has changed since the last call, so that image and haptic program must be updated.
  bool take_changed() { return std::exchange(changed_, false); }
  /// Marks the scene as changed.
  void mark_changed() { changed_ = true; }

  /// Bounds of everything visible and haptic, world units; set by the caller that extracts the scene.
  Bounds bounds;

 private:
  SceneModel(scene::Document document, std::function<Outcome(scene::Scene&)> adjust)
      : document_(std::move(document)), apply_overrides_(std::move(adjust)) {}
  Result<scene::Scene> parse_document() const;
  /// Applies `edit` to the document and reads the scene from it; on an Error both stay unchanged.
  Outcome edit_document(const std::function<Outcome(scene::Document&)>& edit);
  /// Copies what the user changed without editing the text: camera, stereo mode, animation phase, fitted workspace.
  void transfer_session_state(scene::Scene& reloaded) const;

  scene::Document document_;
  std::function<Outcome(scene::Scene&)> apply_overrides_;
  Validator validator_;
  std::optional<tuning::TickTuning> tick_tuning_;
  scene::Scene scene_;
  bool changed_ = false;
};

/// Loading of a scene or data file in the background: reads it, loads what is rendered and what the links use, and makes the first packet,
/// while the window continues.
struct LoadedScene {
  SceneModel model;
  render::FramePacket packet;  ///< First packet, of the requested size.
  Bounds bounds;               ///< Bounds of everything visible and haptic, world units.
};

/// Waits for at most a time, in seconds; returns whether the scene has been loaded.
using LoadWait = std::function<bool(double wait_s)>;

/// Loads a scene synchronously; any thread, since it owns its scene. Size in pixels. An Error, one line, if something cannot be loaded.
Result<LoadedScene> load_scene(SceneModel host, std::uint32_t width, std::uint32_t height);

/// Loads what the scene shows. An Error if it cannot be drawn.
Outcome check_drawable(scene::Scene& scene);

/// Loads one scene at a time on its own thread; the destructor waits for it.
class SceneLoader {
 public:
  /// Starts loading; only while not busy. Size of the first packet in pixels.
  void start(const std::string& path, const std::string& grid, std::uint32_t width, std::uint32_t height);
  /// Returns the path being loaded; empty: none.
  const std::string& path() const { return path_; }
  bool is_busy() const { return !path_.empty(); }
  /// Returns the result once it is available, and only once.
  std::optional<Result<LoadedScene>> take_result();

 private:
  std::string path_;
  std::optional<Result<LoadedScene>> loaded_;
  std::atomic<bool> done_{false};
  std::jthread thread_;  ///< Last member: joined before the members it writes are destroyed.
};

}  // namespace catena::app
