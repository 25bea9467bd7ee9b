/// SceneModel has the scene that the window shows, with the text that it is read from. Edits go to the text; the scene is then read again
/// and takes over what was loaded, what the hand did, and where the eye stands. Frame thread.
#pragma once
#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

#include "engine/app/tuning/plan/tick_tuning.h"
#include "engine/base/result.h"
#include "engine/scene/document.h"
#include "render/frame/camera.h"
#include "render/frame/frame_packet.h"

namespace catena::app {

class SceneModel {
 public:
  /// Reads it; nothing is loaded yet. `adjust`: what is wanted otherwise than the text says, whenever it is read.
  static Result<SceneModel> open(scene::Document document, std::function<Outcome(scene::Scene&)> adjust);

  scene::Scene& scene() { return scene_; }
  const scene::Scene& scene() const { return scene_; }
  const scene::Document& document() const { return document_; }

  /// What a scene must pass beside being read for an edit to count, such as that its program can be made. It may load what the scene names.
  using Validator = std::function<Outcome(scene::Scene&)>;
  void set_validator(Validator check) { validator_ = std::move(check); }

  /// An error leaves all as it was. `what`, `drag`: as Document::set.
  Outcome set(std::string_view pointer, const std::string& value, const std::string& what, const std::string& drag = {});
  Outcome remove(std::string_view pointer, const std::string& what);
  Outcome apply(const std::vector<scene::Document::Edit>& edits, const std::string& what, const std::string& drag = {});
  /// Another text, as one step of undo.
  Outcome replace(const std::string& text, const std::string& what);
  Outcome reload_from_disk();
  Outcome undo();
  Outcome redo();
  Outcome save(const std::string& path);

  /// The links are followed as this plan says, from now on and whenever the scene is read; read again at once.
  Outcome set_tick_tuning(std::optional<plan::TickTuning> plan);
  /// The text of what is felt: with the plan's settings, for a recording.
  std::string recording_text() const;

  /// The scene differs from what it was at the last call: picture and program have to be made again.
  bool take_changed() { return std::exchange(changed_, false); }
  void mark_changed() { changed_ = true; }

  /// All that is drawn and felt; set by who extracts.
  Bounds bounds;

 private:
  SceneModel(scene::Document document, std::function<Outcome(scene::Scene&)> adjust)
      : document_(std::move(document)), apply_overrides_(std::move(adjust)) {}
  Result<scene::Scene> parse_document() const;
  /// The document as `edit` leaves it and the scene of it, or both as they were.
  Outcome edit_document(const std::function<Outcome(scene::Document&)>& edit);
  /// What the person did to the scene without editing it.
  void transfer_session_state(scene::Scene& fresh) const;

  scene::Document document_;
  std::function<Outcome(scene::Scene&)> apply_overrides_;
  Validator validator_;
  std::optional<plan::TickTuning> tick_tuning_;
  scene::Scene scene_;
  bool changed_ = false;
};

/// SceneLoader opens a scene or a data file beside the window: it reads it, loads what it draws and feels, and makes its first packet. The
/// window goes on meanwhile. One at a time; what is under way when the loader goes is waited for.
struct LoadedScene {
  SceneModel model;
  render::FramePacket packet;  ///< of the size asked for
  Bounds bounds;               ///< of all that is drawn and felt
};

/// The work itself; any thread, the scene is its own. Errors: one line.
Result<LoadedScene> load_scene(SceneModel host, std::uint32_t width, std::uint32_t height);

class SceneLoader {
 public:
  /// Not while one is under way.
  void start(const std::string& path, std::uint32_t width, std::uint32_t height);
  /// The path that is being opened; empty: none.
  const std::string& path() const { return path_; }
  bool is_busy() const { return !path_.empty(); }
  /// What came of it, once.
  std::optional<Result<LoadedScene>> take_result();

 private:
  std::string path_;
  std::optional<Result<LoadedScene>> loaded_;
  std::atomic<bool> done_{false};
  std::jthread thread_;  ///< last: it is joined before what it writes goes
};

}  // namespace catena::app
