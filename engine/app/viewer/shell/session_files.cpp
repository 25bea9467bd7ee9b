// Opening, adding, saving, leaving. What takes long runs beside the window; what fails leaves all as it was.
#include <fmt/format.h>

#include <filesystem>

#include "engine/app/viewer/edit/add_file.h"
#include "engine/app/viewer/shell/file_list.h"
#include "engine/app/viewer/shell/session.h"
#include "engine/base/clock.h"
#include "engine/scene/write_values.h"
#include "render/image/picture.h"

namespace catena::app {

namespace {

constexpr double kKeepS = 3;  // between looks at what is not saved

std::string name_of_file(const std::string& path) { return std::filesystem::path(path).filename().string(); }

bool same_view(const render::View& a, const render::View& b) {
  return a.position == b.position && a.target == b.target && a.up == b.up && a.fovy_deg == b.fovy_deg && a.orthographic == b.orthographic &&
         (!a.orthographic || a.height == b.height);
}

}  // namespace

void Session::fulfil_wishes_for_files() {
  if (const auto path = std::exchange(state_.save, std::nullopt)) {
    std::error_code code;
    const bool nameless = path->empty() && (state_.untitled || (!owns_file_ && std::filesystem::exists(scene_->document().path(), code)));
    if (nameless) {
      state_.ask_save = true;  // with the question about what is there
      return;
    }
    const bool saved = save(*path);
    if (const auto next = std::exchange(state_.after_save, std::nullopt); next && saved) leave(*next);
  }
  if (const auto answer = std::exchange(state_.answer, std::nullopt); answer && state_.ask_unsaved) {
    const Leaving leaving = *std::exchange(state_.ask_unsaved, std::nullopt);
    if (*answer == Answer::discard) leave(leaving);
    if (*answer == Answer::save) {
      state_.after_save = leaving;
      state_.save.emplace();
    }
  }
  if (const auto path = std::exchange(state_.open, std::nullopt)) leave_or_ask({false, *path});
  if (const auto path = std::exchange(state_.add, std::nullopt)) start_loading(*path, true);
  if (std::exchange(state_.quit, false)) leave_or_ask({true, {}});
  fulfil_wishes_for_left();
  // a wish of before the first picture waits for it; for a picture of every pixel, where nothing moves, too
  constexpr int kMostWaits = 30;
  const bool there = state_.screenshot_of_window ? screen_->is_shown() : screen_->has_picture();
  if (!state_.screenshot || !there || (pacing_.again().scale > 1 && screenshot_waits_++ < kMostWaits)) return;
  screenshot_waits_ = 0;
  write_screenshot(*std::exchange(state_.screenshot, std::nullopt));
}

void Session::leave(const Leaving& leaving) {
  if (leaving.quit) {
    leaves_ = given_up_ = true;
    draft_.remove();
  }
  if (!leaving.open.empty()) start_loading(leaving.open, false);
}

/// Unsaved changes are asked about first, and on the way out a recording. The view alone is no change.
void Session::leave_or_ask(const Leaving& leaving) {
  state_.after_save.reset();
  const bool ends_recording = leaving.quit && hand_.recording().running();
  if (!scene_->document().is_modified() && !ends_recording) return leave(leaving);
  state_.ask_unsaved = leaving;
}

/// Every few seconds, beside the scene, and at the end where nobody was asked. What cannot be kept is said once.
void Session::keep_unsaved(bool now) {
  if (given_up_ || (!now && last_kept_ns_ != 0 && 1e-3 * ms_since(last_kept_ns_) < kKeepS)) return;
  last_kept_ns_ = now_ns();
  const scene::Document& document = scene_->document();
  if (!document.is_modified()) return draft_.remove();
  const Outcome kept = [&]() -> Outcome {
    CATENA_TRY(const std::string text, document.whole_text());
    return draft_.keep(document.path(), text);
  }();
  const std::string why = kept ? "" : kept.error().message;
  if (!kept && why != not_kept_) state_.say("unsaved changes are not kept: " + why, true);
  not_kept_ = why;
}

/// What a program that was killed left of this scene is offered; what is saved since is not.
void Session::look_for_left() {
  state_.ask_left.reset();
  while (auto left = find_left_draft(scene_->document().path())) {
    if (left->text != scene_->document().text()) {
      state_.ask_left = std::move(left);
      return;
    }
    remove_left_draft(*left);
    if (std::error_code code; std::filesystem::exists(left->path, code)) return;  // it cannot go
  }
}

void Session::fulfil_wishes_for_left() {
  const auto answer = std::exchange(state_.answer_to_left, std::nullopt);
  if (!answer || !state_.ask_left) return;
  const LeftDraft left = *std::exchange(state_.ask_left, std::nullopt);
  if (*answer == AnswerToLeft::later) return;
  if (*answer == AnswerToLeft::restore) {
    const Outcome done = scene_->replace(left.text, "unsaved changes");
    if (!done) return state_.say(done.error().message + " (" + left.path + " is still there)", true);
    state_.say("the unsaved changes are here again; undo takes them back");
    // here before it goes there
    keep_unsaved(true);
    if (!not_kept_.empty()) return;
  }
  remove_left_draft(left);
  if (*answer == AnswerToLeft::discard) look_for_left();
}

void Session::drop(const std::string& path) {
  if (is_scene_name(path) || state_.untitled || !is_openable(path))
    state_.open = path;
  else
    state_.ask_dropped = path;
}

/// With the view, if the person has moved it.
bool Session::save(const std::string& path) {
  if (!same_view(controls_.view, saved_view_)) {
    const Outcome viewed = scene_->set("/camera", scene::text_of(scene_->scene().camera), "view");
    if (!viewed) state_.say(viewed.error().message, true);
  }
  const Outcome saved = scene_->save(path.empty() ? scene_->document().path() : path);
  state_.say(saved ? "saved " + scene_->document().path() : saved.error().message, !saved);
  if (!saved) return false;
  draft_.remove();
  saved_view_ = controls_.view;
  owns_file_ = true;
  state_.untitled = false;
  remember(scene_->document().path());
  return true;
}

void Session::start_loading(const std::string& path, bool adds) {
  if (loader_.is_busy()) return state_.say("still loading " + name_of_file(loader_.path()) + "; then again", true);
  loading_adds_ = adds;
  state_.loading = path;
  loader_.start(path, std::max(1u, pixels_[2] - pixels_[0]), std::max(1u, pixels_[3] - pixels_[1]));
}

/// True: the picture has to be made again.
bool Session::take_loaded() {
  auto loaded = loader_.take();
  if (!loaded) return false;
  const std::string path = std::exchange(state_.loading, {});
  if (!*loaded) {
    state_.say(loaded->error().message, true);
    return false;
  }
  if (loading_adds_)
    add_to_scene(std::move(**loaded), path);
  else
    replace_scene(std::move(**loaded), path);
  return true;
}

/// Another scene in the same window; one that the hand cannot feel leaves this one.
void Session::replace_scene(LoadedScene loaded, const std::string& path) {
  if (auto taken = hand_.take_over(loaded.host.scene(), loaded.bounds); !taken) return state_.say(taken.error().message, true);
  draft_.remove();
  scene_ = std::move(loaded.host);
  look_at(loaded);
  owns_file_ = is_scene_name(path);
  if (!scene_->scene().quality.empty() && !options_.quality_stated)
    if (auto quality = parse_quality(scene_->scene().quality)) state_.quality = *quality;
  scene_->touch();
  state_.untitled = false;
  remember(path);
  state_.say("opened " + path);
  look_for_left();
}

/// One step of undo; what was loaded goes over.
void Session::add_to_scene(LoadedScene loaded, const std::string& path) {
  const scene::Document& document = scene_->document();
  const auto added = edits_to_add(document.text(), document.path(), loaded.host.document().text(), loaded.host.document().path());
  if (!added) return state_.say(added.error().message, true);
  if (const Outcome done = scene_->apply(added->edits, "added " + name_of_file(path)); !done) return state_.say(done.error().message, true);
  for (const auto& [theirs, ours] : added->names) {
    const scene::Entity from = scene::find_field(loaded.host.scene(), theirs), to = scene::find_field(scene_->scene(), ours);
    if (!from || !to) continue;
    const auto& source = loaded.host.scene().world.get<scene::FieldSource>(from);
    auto& target = scene_->scene().world.get<scene::FieldSource>(to);
    target.loaded = source.loaded;
    target.drawn = source.drawn;
  }
  scene_->bounds.add(loaded.bounds);
  controls_.bounds = scene_->bounds;
  state_.say("added " + name_of_file(path) + " (A brings all into the picture)");
}

void Session::remember(const std::string& path) {
  recent_.add(path);
  state_.recent = recent_.shown();
}

/// Empty: the next free SCENE-001.png of the folder that the program was started in.
void Session::write_screenshot(const std::string& path) {
  std::string name = path;
  std::error_code code;
  if (name.empty()) name = free_name(std::filesystem::current_path(code).string(), stem_of_path(scene_->document().path()), ".png");
  auto picture = state_.screenshot_of_window ? screen_->window_picture() : screen_->renderer().read_back();
  const bool transparent = !state_.screenshot_of_window && scene_->scene().background.transparent;
  const Outcome written = picture ? render::write_png(name, *picture, transparent) : Outcome(picture.error());
  state_.say(written ? "wrote " + name : written.error().message, !written);
}

}  // namespace catena::app
