#include "engine/app/viewer/shell/scene_files.h"

#include <fmt/format.h>

#include <filesystem>
#include <utility>

#include "engine/app/command.h"
#include "engine/app/run_files.h"
#include "engine/app/viewer/edit/new_items.h"
#include "engine/app/viewer/shell/file_list.h"
#include "engine/base/clock.h"
#include "engine/base/output_file.h"
#include "engine/scene/write_values.h"

namespace catena::app {

namespace {

constexpr double kKeepS = 3;  // between looks at what is not saved

/// The first of a scene's notes, for the line of the window; all of them are on the terminal.
std::string noted(const scene::Scene& scene) {
  if (scene.notes.empty()) return {};
  const std::size_t rest = scene.notes.size() - 1;
  return "note: " + scene.notes.front() + (rest > 0 ? fmt::format(" (and {} more on the terminal)", rest) : "");
}

std::string name_of_file(const std::string& path) { return std::filesystem::path(path).filename().string(); }

}  // namespace

RecordedScene recorded(const SceneHost& scene, const HandHost& hand) {
  RunFiles files(scene.scene());
  files.reads_device(hand.device_name());
  files.reads(hand.firmware());
  return {scene.document().path(), scene.felt_text(), hand.fields(), files.inputs()};
}

Result<LoadedScene> load_first(SceneHost& scene, HandHost& hand, std::uint32_t width, std::uint32_t height) {
  CATENA_TRY(LoadedScene loaded, load_scene(std::move(scene), width, height));
  scene = std::move(loaded.host);
  tell_notes(scene.scene());
  CATENA_CHECK(hand.prepare(scene.scene(), loaded.bounds, recorded(scene, hand)));
  return loaded;
}

SceneFiles::SceneFiles(Shared& shared, Eye& eye, PictureView& picture) : shared_(shared), eye_(eye), picture_(picture) {
  shared_.state.untitled = shared.options.source.empty();
  shared_.state.owns_file = is_scene_name(shared.options.source);
}

void SceneFiles::begin() {
  shared_.state.recent = recent_.shown();
  if (const std::string& source = shared_.options.source; !source.empty()) remember(source);
  if (const std::string notes = noted(shared_.scene.scene()); !notes.empty()) shared_.state.say(notes);
  look_for_left();
}

void SceneFiles::show(const LoadedScene& loaded) {
  shared_.scene.bounds = loaded.bounds;
  eye_.look_at(loaded);
  picture_.forget();
  shared_.scene.set_check([&hand = shared_.hand](scene::Scene& scene) { return hand.check(scene); });
}

// ---- leaving ----

/// Unsaved changes are asked about first, and on the way out a recording. The view alone is no change.
void SceneFiles::leave_or_ask(const Leaving& leaving) {
  after_save_.reset();
  const bool ends_recording = leaving.ends() && shared_.hand.recording().running();
  if (!shared_.scene.document().is_modified() && !ends_recording) return leave(leaving);
  shared_.state.ask.unsaved = leaving;
}

void SceneFiles::leave(const Leaving& leaving) {
  if (!leaving.ends()) return start_loading(leaving.open, false);
  ended_ = true;
  draft_.remove();
}

void SceneFiles::answer(AnswerToUnsaved given) {
  const auto leaving = std::exchange(shared_.state.ask.unsaved, std::nullopt);
  if (!leaving) return;
  if (given == AnswerToUnsaved::discard) leave(*leaving);
  if (given != AnswerToUnsaved::save) return;
  after_save_ = leaving;
  save();
}

// ---- saving ----

/// Where the scene comes from; for one that was made for a data file, or comes from nowhere, the person says where: nothing is written
/// beside data unasked.
void SceneFiles::save() {
  if (shared_.state.untitled || !shared_.state.owns_file)
    shared_.state.ask.save_as = true;
  else
    save_as(shared_.scene.document().path());
}

/// What somebody else has written to the scene's own file since it was read is not replaced unasked.
void SceneFiles::save_as(const std::string& path) {
  const scene::Document& document = shared_.scene.document();
  const bool own = shared_.state.owns_file && !shared_.state.untitled && same_file(path, document.path());
  if (const auto there = own ? document.on_disk() : scene::Document::OnDisk::as_known; there != scene::Document::OnDisk::as_known)
    shared_.state.ask.changed = there;
  else
    write_and_go_on(path);
}

void SceneFiles::answer(AnswerToChanged given) {
  ViewState& state = shared_.state;
  if (!std::exchange(state.ask.changed, std::nullopt)) return;
  if (given == AnswerToChanged::keep_mine) return write_and_go_on(shared_.scene.document().path());
  if (given == AnswerToChanged::save_as) {
    state.ask.save_as = true;
    return;
  }
  const auto next = std::exchange(after_save_, std::nullopt);
  if (given != AnswerToChanged::take_theirs) return;
  if (const Outcome taken = shared_.scene.take_from_disk(); !taken) return state.say(taken.error().message, true);
  draft_.remove();
  state.say("the scene is as the file says; undo brings back yours");
  if (next) leave(*next);
}

void SceneFiles::write_and_go_on(const std::string& path) {
  const bool written = write(path);
  if (const auto next = std::exchange(after_save_, std::nullopt); next && written) leave(*next);
}

/// With the view, if the person has moved it.
bool SceneFiles::write(const std::string& path) {
  SceneHost& scene = shared_.scene;
  ViewState& state = shared_.state;
  if (eye_.is_moved()) state.say_if_wrong(scene.set("/camera", scene::text_of(scene.scene().camera), "view"));
  const Outcome saved = scene.save(path);
  state.say(saved ? "saved " + scene.document().path() : saved.error().message, !saved);
  if (!saved) return false;
  draft_.remove();
  eye_.saved();
  state.owns_file = true;
  state.untitled = false;
  remember(scene.document().path());
  return true;
}

// ---- opening ----

void SceneFiles::drop(const std::string& dropped) {
  std::error_code code;
  const bool folder = std::filesystem::is_directory(dropped, code);
  const std::string path = folder ? opened_for_folder(dropped) : dropped;
  if (is_scene_name(path) || shared_.state.untitled || (!folder && !is_openable(path))) return open(path);
  shared_.state.ask.dropped = path;
}

void SceneFiles::answer(AnswerToDropped given) {
  const auto path = std::exchange(shared_.state.ask.dropped, std::nullopt);
  if (!path) return;
  if (given == AnswerToDropped::add) start_loading(*path, true);
  if (given == AnswerToDropped::open) open(*path);
}

void SceneFiles::start_loading(const std::string& path, bool adds) {
  if (loader_.is_busy()) return shared_.state.say("still loading " + name_of_file(loader_.path()) + "; then again", true);
  loading_adds_ = adds;
  shared_.state.loading = path;
  const auto [width, height] = picture_.size();
  loader_.start(path, width, height);
}

bool SceneFiles::take_loaded() {
  auto loaded = loader_.take();
  if (!loaded) return false;
  const std::string path = std::exchange(shared_.state.loading, {});
  if (!*loaded) {
    shared_.state.say(loaded->error().message, true);
    return false;
  }
  if (loading_adds_)
    add_to_scene(std::move(**loaded), path);
  else
    replace_scene(std::move(**loaded), path);
  return true;
}

/// Another scene in the same window; one that the hand cannot feel leaves this one.
void SceneFiles::replace_scene(LoadedScene loaded, const std::string& path) {
  ViewState& state = shared_.state;
  if (auto taken = shared_.hand.take_over(loaded.host.scene(), loaded.bounds); !taken) return state.say(taken.error().message, true);
  draft_.remove();
  SceneHost& scene = shared_.scene;
  scene = std::move(loaded.host);
  show(loaded);
  state.owns_file = is_scene_name(path);
  if (!scene.scene().quality.empty() && !shared_.options.quality_stated)
    if (auto quality = parse_quality(scene.scene().quality)) shared_.pacing = Pacing(*quality);
  scene.touch();
  state.untitled = false;
  remember(path);
  tell_notes(scene.scene());
  const std::string notes = noted(scene.scene());
  state.say("opened " + path + (notes.empty() ? "" : "; " + notes));
  look_for_left();
}

/// One step of undo; what was loaded goes over.
void SceneFiles::add_to_scene(LoadedScene loaded, const std::string& path) {
  SceneHost& scene = shared_.scene;
  ViewState& state = shared_.state;
  const scene::Document& document = scene.document();
  const auto added = edits_to_add(document.text(), document.path(), loaded.host.document().text(), loaded.host.document().path());
  if (!added) return state.say(added.error().message, true);
  if (const Outcome done = scene.apply(added->edits, "added " + name_of_file(path)); !done) return state.say(done.error().message, true);
  for (const auto& [theirs, ours] : added->names) {
    const scene::Entity from = scene::find_field(loaded.host.scene(), theirs), to = scene::find_field(scene.scene(), ours);
    if (!from || !to) continue;
    const auto& source = loaded.host.scene().world.get<scene::FieldSource>(from);
    auto& target = scene.scene().world.get<scene::FieldSource>(to);
    target.loaded = source.loaded;
    target.drawn = source.drawn;
  }
  scene.bounds.add(loaded.bounds);
  shared_.controls.bounds = scene.bounds;
  tell_notes(loaded.host.scene());
  const std::string notes = noted(loaded.host.scene());
  state.say("added " + name_of_file(path) + " (A brings all into the picture)" + (notes.empty() ? "" : "; " + notes));
}

void SceneFiles::remember(const std::string& path) {
  recent_.add(path);
  shared_.state.recent = recent_.shown();
}

// ---- what is not saved ----

void SceneFiles::keep_unsaved(bool now) {
  if (ended_ || (!now && last_kept_ns_ != 0 && 1e-3 * ms_since(last_kept_ns_) < kKeepS)) return;
  last_kept_ns_ = now_ns();
  const scene::Document& document = shared_.scene.document();
  if (!document.is_modified()) return draft_.remove();
  const Outcome kept = [&]() -> Outcome {
    CATENA_TRY(const std::string text, document.whole_text());
    return draft_.keep(document.path(), text);
  }();
  const std::string why = kept ? "" : kept.error().message;
  if (!kept && why != not_kept_) shared_.state.say("unsaved changes are not kept: " + why, true);
  not_kept_ = why;
}

/// What a program that was killed left of this scene is offered; what is saved since is not.
void SceneFiles::look_for_left() {
  const scene::Document& document = shared_.scene.document();
  shared_.state.ask.left.reset();
  while (auto left = find_left_draft(document.path())) {
    if (left->text != document.text()) {
      shared_.state.ask.left = std::move(left);
      return;
    }
    remove_left_draft(*left);
    if (std::error_code code; std::filesystem::exists(left->path, code)) return;  // it cannot go
  }
}

void SceneFiles::answer(AnswerToLeft given) {
  ViewState& state = shared_.state;
  const auto left = std::exchange(state.ask.left, std::nullopt);
  if (!left || given == AnswerToLeft::later) return;
  if (given == AnswerToLeft::restore) {
    const Outcome done = shared_.scene.replace(left->text, "unsaved changes");
    if (!done) return state.say(done.error().message + " (" + left->path + " is still there)", true);
    state.say("the unsaved changes are here again; undo takes them back");
    // here before it goes there
    keep_unsaved(true);
    if (!not_kept_.empty()) return;
  }
  remove_left_draft(*left);
  if (given == AnswerToLeft::discard) look_for_left();
}

}  // namespace catena::app
