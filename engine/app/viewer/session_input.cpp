// What the person does: to the interface, to the eye, to the hand, to the program.
#include <fmt/format.h>

#include <cstdio>

#include "engine/app/hand/hand_setup.h"
#include "engine/app/viewer/session.h"
#include "engine/base/output_file.h"
#include "render/extract/extract.h"
#include "render/vk/picture.h"

namespace catena::app {

/// What the interface holds is not the scene's: a drag belongs to where it began.
Input Session::routed(Input input) {
  const bool pressed = input.left || input.middle || input.right;
  const bool here = gui_->holds(input.x, input.y);
  if (!pressed) interface_holds_pointer_ = false;
  if (pressed && !state_.pointer_pressed) interface_holds_pointer_ = here;
  state_.pointer_pressed = pressed;
  state_.pointer_x = input.x + input.dx;
  state_.pointer_y = input.y + input.dy;
  state_.pointer_on_picture = !interface_holds_pointer_ && !gui_->holds(state_.pointer_x, state_.pointer_y);
  if (interface_holds_pointer_ || (!pressed && here)) {
    input.dx = input.dy = input.wheel = 0;
    input.left = input.middle = input.right = false;
  }
  return input;
}

void Session::obey(Command command) {
  const auto said = [&](const Outcome& done) {
    if (!done) state_.say(done.error().message, true);
  };
  switch (command) {
    case Command::undo:
      return said(scene_->undo());
    case Command::redo:
      return said(scene_->redo());
    case Command::open:
      state_.ask_open = true;
      return;
    case Command::save:
      state_.save = scene_->document().path();
      return;
    case Command::save_as:
      state_.ask_save = true;
      return;
    case Command::quit:
      state_.quit = true;
      return;
    case Command::screenshot:
    case Command::window_screenshot:
      state_.screenshot.emplace();
      state_.screenshot_of_window = command == Command::window_screenshot;
      return;
    case Command::full_screen:
      return;
    case Command::toggle_panels:
      state_.panels = !state_.panels;
      return;
    case Command::turntable:
      state_.turntable = !state_.turntable;
      return;
    case Command::fly:
      return;
  }
}

void Session::obey_once(const Input& input, Changed& changed) {
  state_.quit = state_.quit || input.quit;
  damaged_ = damaged_ || input.damaged;
  if (input.toggle_pulses) pulses_run_ = !pulses_run_;
  if (input.next_stereo) {
    auto& mode = scene_->scene().stereo.mode;
    mode = static_cast<scene::StereoMode>((static_cast<int>(mode) + 1) % scene::kStereoModes);
    changed.view = true;
  }
  if (input.toggle_forces) hand_.set_forces(!hand_.forces());
  if (input.help) {
    state_.help = !state_.help;
    std::fputs(std::string(key_help()).c_str(), stdout);
    std::fflush(stdout);
  }
  for (const Command command : input.commands) obey(command);
  if (!input.dropped.empty()) state_.open = input.dropped.back();
}

Changed Session::take_input(double wait_s) {
  Changed changed;
  for (const Input& piece : window_->poll(wait_s)) {
    const Changed by_piece = apply(controls_, routed(piece));
    changed.view = changed.view || by_piece.view;
    changed.hand = changed.hand || by_piece.hand;
    obey_once(piece, changed);
  }
  state_.quit = state_.quit || window_->closing() || (interrupt_ && interrupt_->asked());
  if (changed.hand) hand_.move_mouse(scene_->scene(), controls_.hand, controls_.buttons);
  if (changed.view) pin_camera();
  return changed;
}

/// What panels and keys asked for, after the frame in which they did.
void Session::fulfil_wishes() {
  if (const auto path = std::exchange(state_.save, std::nullopt)) {
    const Outcome saved = scene_->save(*path);
    state_.say(saved ? "saved " + scene_->document().path() : saved.error().message, !saved);
  }
  if (const auto path = std::exchange(state_.open, std::nullopt)) replace_scene(*path);
  if (const auto path = std::exchange(state_.screenshot, std::nullopt)) {
    auto picture = state_.screenshot_of_window ? screen_->window_picture() : screen_->renderer().read_back();
    const std::string name = path->empty() ? "catena.png" : *path;
    Outcome written = picture ? render::write_png(name, *picture, false) : Outcome(picture.error());
    state_.say(written ? "wrote " + name : written.error().message, !written);
  }
  if (const auto quality = std::exchange(state_.quality, std::nullopt)) pacing_ = Pacing(*quality);
  fulfil_wishes_for_the_hand();
}

void Session::fulfil_wishes_for_the_hand() {
  if (const auto device = std::exchange(state_.device, std::nullopt)) {
    const Outcome done = hand_.switch_device(scene_->scene(), *device, scene_->bounds);
    if (done && !hand_.is_mouse() && !interrupt_) interrupt_.emplace();
    controls_.hand = hand_.felt().tick > 0 ? hand_.felt().probe : hand_.first_probe();
    state_.say(done ? hand_.hand().device->capabilities().name + " holds the probe" : done.error().message, !done);
  }
  if (const auto path = std::exchange(state_.record, std::nullopt)) {
    const std::string before = hand_.recording().path();
    const Outcome done = path->empty() ? hand_.stop_recording() : hand_.record(*path, recorded());
    state_.say(!done ? done.error().message : path->empty() ? "recorded " + before : "recording to " + *path, !done);
  }
}

/// Another scene in the same window; one that cannot be opened leaves this one.
void Session::replace_scene(const std::string& path) {
  const auto failed = [&](const Error& error) { state_.say(error.message, true); };
  auto document = scene::Document::open(path);
  if (!document) return failed(document.error());
  auto host = SceneHost::open(std::move(*document), {});
  if (!host) return failed(host.error());
  scene::Scene& scene = host->scene();
  if (auto felt = HandHost::load(scene); !felt) return failed(felt.error());
  auto packet = render::extract_frame(scene, options_.width, options_.height);
  if (!packet) return failed(packet.error());
  render::Bounds bounds = render::packet_bounds(*packet);
  bounds.add(loaded_bounds(scene));
  if (auto taken = hand_.take_over(scene, bounds); !taken) return failed(taken.error());
  scene_ = std::move(*host);
  controls_.hand = hand_.first_probe();
  if (!scene_->scene().camera.given && packet->volumes.empty() && packet->isosurfaces.empty() && packet->tubes.empty())
    packet->view = render::fit_view(bounds, static_cast<double>(options_.width) / options_.height);
  controls_.view = controls_.home = packet->view;
  controls_.bounds = scene_->bounds = bounds;
  pin_camera();
  measure();
  check_edits();
  if (!scene_->scene().quality.empty() && !options_.quality_stated)
    if (auto quality = parse_quality(scene_->scene().quality)) state_.quality = *quality;
  scene_->touch();
  state_.say("opened " + path);
}

}  // namespace catena::app
