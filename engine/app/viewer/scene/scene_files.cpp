// SPDX-License-Identifier: MIT
#include "engine/app/viewer/scene/scene_files.h"

#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <future>
#include <utility>

#include "engine/app/cli/command.h"
#include "engine/app/cli/io_conflicts.h"
#include "engine/app/viewer/scene/file_browser.h"
#include "engine/base/clock.h"
#include "engine/base/output_file.h"
#include "engine/scene/merge.h"
#include "engine/scene/to_json.h"

namespace catena::app {

namespace {

constexpr double kKeepS = 3;  // seconds between checks for unsaved changes to autosave

/// The first of a scene's notes, for the status line; all of them are printed to the terminal.
std::string noted(const scene::Scene& scene) {
  if (scene.notes.empty()) return {};
  const std::size_t rest = scene.notes.size() - 1;
  return "note: " + scene.notes.front() + (rest > 0 ? fmt::format(" (and {} more on the terminal)", rest) : "");
}

std::string name_of_file(const std::string& path) { return std::filesystem::path(path).filename().string(); }

}  // namespace

RecordedScene make_recorded_scene(const SceneModel& scene, const HapticSession& hand) {
  IoConflictChecker files(scene.scene());
  files.add_device_files(hand.device_name());
  files.add_input(hand.firmware());
  return {scene.document().path(), scene.recording_text(), hand.field_options(), files.inputs()};
}

Result<LoadedScene> load_initial_scene(SceneModel& scene, HapticSession& hand, std::uint32_t width, std::uint32_t height,
                                       const std::function<void(const LoadWait&)>& meanwhile) {
  auto loading =
      std::async(meanwhile ? std::launch::async : std::launch::deferred, [&] { return load_scene(std::move(scene), width, height); });
  if (meanwhile)
    meanwhile([&](double wait_s) { return loading.wait_for(std::chrono::duration<double>(wait_s)) == std::future_status::ready; });
  CATENA_TRY(LoadedScene loaded, loading.get());
  scene = std::move(loaded.model);
  print_scene_notes(scene.scene());
  CATENA_CHECK(hand.prepare(scene.scene(), loaded.bounds, make_recorded_scene(scene, hand)));
  return loaded;
}

SceneFiles::SceneFiles(ViewerContext& shared, CameraController& camera, Viewport& viewport)
    : context_(shared), camera_(camera), viewport_(viewport) {
  context_.state.is_untitled = shared.options.source.empty();
  context_.state.owns_file = is_scene_path(shared.options.source);
}

void SceneFiles::begin() {
  context_.state.recent_files = recent_files_.existing_files();
  if (const std::string& source = context_.options.source; !source.empty()) add_to_recent(source);
  if (const std::string notes = noted(context_.scene.scene()); !notes.empty()) context_.state.show_message(notes);
  offer_recovery();
}

void SceneFiles::adopt_scene(const LoadedScene& loaded) {
  context_.scene.bounds = loaded.bounds;
  camera_.adopt_scene(loaded);
  viewport_.reset();
  context_.scene.set_validator(SceneModel::make_validator(context_.haptic_session));
}

// ---- closing ----

/// Asks about unsaved changes first and, on exit, about a running recording. A changed view alone does not count as a change.
void SceneFiles::confirm_leave(const PendingLeave& leaving) {
  after_save_.reset();
  const bool ends_recording = leaving.quits() && context_.haptic_session.recording().is_recording();
  if (!context_.scene.document().is_modified() && !ends_recording) return leave(leaving);
  context_.state.dialogs.unsaved_changes = leaving;
}

void SceneFiles::leave(const PendingLeave& leaving) {
  if (!leaving.quits()) return start_loading(leaving, false);
  has_quit_ = true;
  autosave_.remove();
}

void SceneFiles::on_choice(UnsavedChangesChoice choice) {
  const auto leaving = std::exchange(context_.state.dialogs.unsaved_changes, std::nullopt);
  if (!leaving) return;
  if (choice == UnsavedChangesChoice::discard) leave(*leaving);
  if (choice != UnsavedChangesChoice::save) return;
  after_save_ = leaving;
  save();
}

// ---- saving ----

/// Saves to the scene's own file; a scene that was made for a data file, or has no file, gets a dialog for its path: nothing is written
/// next to data without confirmation.
void SceneFiles::save() {
  if (context_.state.is_untitled || !context_.state.owns_file)
    context_.state.dialogs.show_save_as = true;
  else
    save_as(context_.scene.document().path());
}

/// Saves to `path`. If another program has changed the scene's own file since it was read, the user is asked before it is replaced.
void SceneFiles::save_as(const std::string& path) {
  const scene::Document& document = context_.scene.document();
  const bool own = context_.state.owns_file && !context_.state.is_untitled && is_same_file(path, document.path());
  if (const auto there = own ? document.disk_state() : scene::Document::DiskState::unchanged;
      there != scene::Document::DiskState::unchanged)
    context_.state.dialogs.file_conflict = there;
  else
    save_and_continue(path);
}

void SceneFiles::on_choice(FileConflictChoice choice) {
  ViewState& state = context_.state;
  if (!std::exchange(state.dialogs.file_conflict, std::nullopt)) return;
  if (choice == FileConflictChoice::overwrite) return save_and_continue(context_.scene.document().path());
  if (choice == FileConflictChoice::save_as) {
    state.dialogs.show_save_as = true;
    return;
  }
  const auto next = std::exchange(after_save_, std::nullopt);
  if (choice != FileConflictChoice::take_disk_version) return;
  if (const Outcome taken = context_.scene.reload_from_disk(); !taken) return state.show_message(taken.error().message, true);
  autosave_.remove();
  state.show_message("the scene was read from the file; undo restores your version");
  if (next) leave(*next);
}

void SceneFiles::save_and_continue(const std::string& path) {
  const bool written = write(path);
  if (const auto next = std::exchange(after_save_, std::nullopt); next && written) leave(*next);
}

/// Writes the scene, including the view if the user has changed it.
bool SceneFiles::write(const std::string& path) {
  SceneModel& scene = context_.scene;
  ViewState& state = context_.state;
  if (camera_.has_unsaved_view()) state.show_error(scene.set("/camera", scene::to_json(scene.scene().camera), "view"));
  if (camera_.has_unsaved_planes()) {
    const auto planes = camera_.shown_planes();
    state.show_error(planes ? scene.set("/orthogonal_views", scene::to_json(*planes), "planes")
                            : scene.remove("/orthogonal_views", "planes"));
  }
  const Outcome saved = scene.save(path);
  state.show_message(saved ? "saved " + scene.document().path() : saved.error().message, !saved);
  if (!saved) return false;
  autosave_.remove();
  camera_.mark_saved();
  state.owns_file = true;
  state.is_untitled = false;
  add_to_recent(scene.document().path());
  return true;
}

// ---- opening ----

void SceneFiles::open_dropped(const std::string& dropped) {
  std::error_code code;
  const bool folder = std::filesystem::is_directory(dropped, code);
  const std::string path = folder ? resolve_dropped_folder(dropped) : dropped;
  if (is_scene_path(path) || context_.state.is_untitled || (!folder && !is_openable(path))) return open(path);
  context_.state.dialogs.dropped_file = path;
}

void SceneFiles::on_choice(DroppedFileChoice choice) {
  const auto path = std::exchange(context_.state.dialogs.dropped_file, std::nullopt);
  if (!path) return;
  if (choice == DroppedFileChoice::add) add(*path);
  if (choice == DroppedFileChoice::open) open(*path);
}

void SceneFiles::start_loading(const PendingLeave& file, bool to_current_scene) {
  if (loader_.is_busy())
    return context_.state.show_message("still loading " + name_of_file(loader_.path()) + "; try again when it is open", true);
  loading_joins_scene_ = to_current_scene;
  context_.state.loading_path = file.open_path;
  const auto [width, height] = viewport_.size();
  loader_.start(file.open_path, file.grid, width, height);
}

bool SceneFiles::poll_loaded() {
  auto loaded = loader_.take_result();
  if (!loaded) return false;
  const std::string path = std::exchange(context_.state.loading_path, {});
  if (!*loaded) {
    context_.state.show_message(loaded->error().message, true);
    return false;
  }
  if (loading_joins_scene_)
    add_to_scene(std::move(**loaded), path);
  else
    replace_scene(std::move(**loaded), path);
  return true;
}

/// Opens another scene in the same window; if its haptic program cannot be built, the present scene stays.
void SceneFiles::replace_scene(LoadedScene loaded, const std::string& path) {
  ViewState& state = context_.state;
  if (auto taken = context_.haptic_session.switch_scene(loaded.model.scene(), loaded.bounds); !taken)
    return state.show_message(taken.error().message, true);
  autosave_.remove();
  SceneModel& scene = context_.scene;
  scene = std::move(loaded.model);
  adopt_scene(loaded);
  state.owns_file = is_scene_path(path);
  if (!scene.scene().quality.empty() && !context_.options.has_explicit_quality)
    if (auto quality = parse_quality(scene.scene().quality)) context_.scheduler = ProgressiveScheduler(*quality);
  scene.mark_changed();
  state.is_untitled = false;
  add_to_recent(path);
  print_scene_notes(scene.scene());
  const std::string notes = noted(scene.scene());
  state.show_message("opened " + path + (notes.empty() ? "" : "; " + notes));
  offer_recovery();
}

/// Adds the loaded items as one undo step; the loaded data are reused.
void SceneFiles::add_to_scene(LoadedScene loaded, const std::string& path) {
  SceneModel& scene = context_.scene;
  ViewState& state = context_.state;
  const scene::Document& document = scene.document();
  const auto added = scene::merge_scene(document.text(), document.path(), loaded.model.document().text(), loaded.model.document().path());
  if (!added) return state.show_message(added.error().message, true);
  if (const Outcome done = scene.apply(added->edits, "added " + name_of_file(path)); !done)
    return state.show_message(done.error().message, true);
  for (const auto& [theirs, ours] : added->fields) {
    const scene::Entity from = scene::find_field(loaded.model.scene(), theirs), to = scene::find_field(scene.scene(), ours);
    if (!from || !to) continue;
    const auto& source = loaded.model.scene().entities.get<scene::FieldSource>(from);
    auto& target = scene.scene().entities.get<scene::FieldSource>(to);
    target.loaded = source.loaded;
    target.rendered = source.rendered;
  }
  scene.bounds.extend(loaded.bounds);
  context_.navigation.bounds = scene.bounds.scaled(scene.scene().stretch);
  print_scene_notes(loaded.model.scene());
  const std::string notes = noted(loaded.model.scene());
  state.show_message("added " + name_of_file(path) + " (A shows the whole scene)" + (notes.empty() ? "" : "; " + notes));
}

void SceneFiles::add_to_recent(const std::string& path) {
  recent_files_.add(path);
  context_.state.recent_files = recent_files_.existing_files();
}

// ---- autosave ----

void SceneFiles::autosave(bool now) {
  if (has_quit_ || (!now && last_autosave_ns_ != 0 && 1e-3 * ms_since(last_autosave_ns_) < kKeepS)) return;
  last_autosave_ns_ = now_ns();
  const scene::Document& document = context_.scene.document();
  if (!document.is_modified()) return autosave_.remove();
  const Outcome kept = [&]() -> Outcome {
    CATENA_TRY(const std::string text, document.text_with_overrides());
    return autosave_.save_text(document.path(), text);
  }();
  const std::string why = kept ? "" : kept.error().message;
  if (!kept && why != autosave_error_) context_.state.show_message("unsaved changes cannot be stored: " + why, true);
  autosave_error_ = why;
}

/// Offers the autosave that a killed program left of this scene, unless the scene has been saved since.
void SceneFiles::offer_recovery() {
  const scene::Document& document = context_.scene.document();
  context_.state.dialogs.recovery.reset();
  while (auto left = find_orphaned_autosave(document.path())) {
    if (left->text != document.text()) {
      context_.state.dialogs.recovery = std::move(left);
      return;
    }
    remove_orphaned_autosave(*left);
    if (std::error_code code; std::filesystem::exists(left->path, code)) return;  // the file cannot be removed
  }
}

void SceneFiles::on_choice(RecoveryChoice choice) {
  ViewState& state = context_.state;
  const auto left = std::exchange(state.dialogs.recovery, std::nullopt);
  if (!left || choice == RecoveryChoice::later) return;
  if (choice == RecoveryChoice::restore) {
    const Outcome done = context_.scene.replace(left->text, "unsaved changes");
    if (!done) return state.show_message(done.error().message + " (" + left->path + " is kept)", true);
    state.show_message("the unsaved changes were restored; undo reverts them");
    // write the new autosave before the old one is removed
    autosave(true);
    if (!autosave_error_.empty()) return;
  }
  remove_orphaned_autosave(*left);
  if (choice == RecoveryChoice::discard) offer_recovery();
}

}  // namespace catena::app
