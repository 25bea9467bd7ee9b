// SPDX-License-Identifier: MIT
#include "engine/app/viewer/window/viewport.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "engine/app/haptics/device_file.h"
#include "engine/app/viewer/scene/file_browser.h"
#include "engine/app/viewer/window/loading_screen.h"
#include "engine/base/clock.h"
#include "engine/base/console.h"
#include "engine/scene/to_json.h"
#include "engine/scene/units.h"
#include "engine/schema/values.h"
#include "render/extract/clipped_away.h"
#include "render/extract/extract.h"
#include "render/extract/extract_internal.h"
#include "render/image/image.h"
#include "render/quality/quality.h"

namespace catena::app {

namespace {

constexpr int kMaxWaits = 30;

/// The largest centered part of an area with the image's aspect ratio.
std::array<std::uint32_t, 4> fitted_area(const std::array<std::uint32_t, 4>& area, const std::array<std::uint32_t, 2>& picture) {
  const double width = area[2] - area[0], height = area[3] - area[1];
  const double scale = std::min(width / picture[0], height / picture[1]);
  const auto half_x = std::uint32_t(0.5 * (width - scale * picture[0])), half_y = std::uint32_t(0.5 * (height - scale * picture[1]));
  return {area[0] + half_x, area[1] + half_y, area[2] - half_x, area[3] - half_y};
}

}  // namespace

Viewport::~Viewport() {
  if (headset_session_) headset_session_->request_exit();
}

std::optional<Failure> Viewport::show_loading(const LoadWait& is_loaded) {
  if (is_loaded(kQuietLoadS) || context_.options.use_headset) return std::nullopt;
  if (auto failure = open()) return failure;
  const Outcome shown = app::show_loading(context_.window, context_.gui, *presenter_, context_.options.source, is_loaded);
  return shown ? std::nullopt : std::optional(Failure{1, shown.error().message});
}

std::optional<Failure> Viewport::open() {
  if (presenter_) return std::nullopt;
  Presenter::Options options{context_.options.gpu_memory, context_.options.inject_failure};
  if (context_.options.use_headset) {
    if (context_.scene.scene().stretch != Vec3(1.0))
      return Failure{2, "a headset shows the world at its own scale; a scene without \"stretch\" was expected"};
    auto headset = HeadsetSession::open();
    if (!headset) return Failure{1, headset.error().message};
    headset_session_ = std::move(*headset);
    headset_session_->configure(options);
  }
  auto screen = Presenter::open(context_.window, std::move(options));
  if (!screen) return Failure{1, screen.error().message};
  presenter_ = std::move(*screen);
  const render::vk::DeviceInfo& device = presenter_->renderer().device().info();
  if (device.is_cpu()) context_.state.show_message("no GPU was found: the processor renders (" + device.name + ")");
  return std::nullopt;
}

// ---- image area ----

bool Viewport::is_minimised() const {
  std::uint32_t width = 0, height = 0;
  presenter_->size(width, height);
  return width == 0 || height == 0;
}

bool Viewport::update_layout() {
  double width = 1, height = 1;
  std::uint32_t frame_width = 0, frame_height = 0;
  context_.window.size(width, height);
  presenter_->size(frame_width, frame_height);
  ViewState& state = context_.state;
  Navigation& navigation = context_.navigation;
  if (const Vec3 stretch = std::as_const(context_.scene).scene().stretch; navigation.view.stretch != stretch) {  // by an edit
    navigation.view.stretch = stretch;
    navigation.bounds = context_.scene.bounds.scaled(stretch);
  }
  state.image_area = compute_image_area(width, height, state.show_panels ? interface_insets() : Insets{});
  const auto before = pixel_rect_;
  if (frame_width > 0 && frame_height > 0) pixel_rect_ = to_pixel_rect(state.image_area, width, height, frame_width, frame_height);
  return pixel_rect_ != before;
}

std::array<std::uint32_t, 2> Viewport::size() const {
  return {std::max(1u, pixel_rect_[2] - pixel_rect_[0]), std::max(1u, pixel_rect_[3] - pixel_rect_[1])};
}

// ---- drawing ----

bool Viewport::reload_shaders() { return reload_ && reload_->poll(presenter_->renderer(), now_ns()); }

Result<bool> Viewport::poll_headset() {
  if (!headset_session_) return false;
  CATENA_CHECK(headset_session_->poll(*presenter_, now_ns(), [this](const std::string& line) {
    context_.state.show_message(line, true);
    print_message(line);
  }));
  if (!headset_session_->is_running()) context_.haptic_session.suspend_forces(false);  // world motion has ended
  return headset_session_->is_running();
}

/// Registers device and tracking space where the device is registered; not while the world is being moved.
void Viewport::update_room_registration() {
  HapticSession& hand = context_.haptic_session;
  DeviceRegistration& desk = *headset_session_->device_registration();
  for (const DeviceRegistration::Message& message : desk.take_messages()) {
    context_.state.show_message(message.text, message.is_error);
    print_message(message.text);
  }
  context_.state.prompt = desk.prompt();
  if (const auto found = desk.take_registration()) save_registration(*found);
  const auto now = headset_session_->probe_workspace(hand);
  if (!now) return (void)hand.suspend_forces(false);
  scene::Workspace& workspace = context_.scene.scene().workspace;
  const bool stays =
      now->meters_per_unit == workspace.meters_per_unit && now->origin == workspace.origin && now->rotation == workspace.rotation;
  if (!hand.suspend_forces(!stays || headset_session_->is_grabbing_world()) || stays || headset_session_->is_grabbing_world()) return;
  workspace = *now;
  context_.state.show_error(hand.publish(context_.scene.scene(), context_.scene.recording_text()));
}

Outcome Viewport::toggle_registration() {
  DeviceRegistration* const desk = headset_session_ ? headset_session_->device_registration() : nullptr;
  if (!desk) return Error{"a device can be registered only with a headset; catena view --xr was expected"};
  if (!desk->is_active()) return desk->begin(context_.haptic_session);
  desk->cancel();
  return Done{};
}

/// Saves the registration with the settings of the device, in its own file or in the scene.
void Viewport::save_registration(const haptics::DeviceSettings::RoomRegistration& room) {
  const std::string type = haptics::parse_device_type(context_.haptic_session.device_name()), &file = context_.options.device_file;
  const std::vector<scene::Document::Edit> edits{{"/type", scene::to_json(type)},
                                                 {"/room_origin", scene::to_json(room.origin_m)},
                                                 {"/room_rotation", schema::write_value(room.room_from_workspace)}};
  const auto report_result = [&](const Outcome& kept, const std::string& where) {
    context_.state.show_message(kept ? where : kept.error().message, !kept);
    print_message(kept ? where : kept.error().message);
  };
  if (!file.empty()) return report_result(write_device_file(file, edits), "the registration was written to " + file);
  const auto& device = std::as_const(context_.scene).scene().device;
  const json::Node* const other = device ? device->find("type") : nullptr;
  if (other && other->string != type)
    return report_result(Error{"the scene's \"device\" is a " + other->string + ": the registration of the " + type +
                               " is not saved; --device-file saves it"},
                         "");
  std::vector<scene::Document::Edit> in_scene = edits;
  for (scene::Document::Edit& edit : in_scene) edit.pointer.insert(0, "/device");
  report_result(context_.scene.apply(in_scene, "register the device"), "the registration is part of the scene; Ctrl+S saves the scene");
}

/// Draws into the headset. True: the window shows the image of one eye. Window positions cannot be picked there: each eye has its own
/// packet.
Result<bool> Viewport::draw_in_headset() {
  const std::int64_t start = now_ns();
  scene::Scene& scene = context_.scene.scene();
  HeadsetSession::FrameCallbacks content;
  content.make_packet = [&]() -> Result<render::FramePacket> {
    auto [width, height] = size();
    CATENA_TRY(render::FramePacket packet, frame_builder_.make_packet(width, height));
    // overlays of a flat image stay in the window
    packet.overlay.texts.clear();
    packet.overlay.scalar_bars.clear();
    packet.overlay.orientation_marker.reset();
    packet.overlay.status.reset();
    return packet;
  };
  content.late_latch = [&](render::FramePacket& of) {
    probe_moved_late_ = context_.haptic_session.pull_state(scene) || probe_moved_late_;
    render::update_cursors(scene, of);
  };
  content.apply_view = [&](const render::View& view, render::FramePacket& of) { render::set_view(scene, view, of); };
  content.classify_rays = [&](const render::FramePacket& of) {
    const RayWorkload& kind = frame_builder_.update_ray_workload(of, presenter_->renderer());
    return render::QualityLevelOptions{kind.supports_fast, kind.is_shaded};
  };
  CATENA_TRY(const bool drawn, headset_session_->draw(*presenter_, context_.haptic_session, content));
  update_room_registration();
  if (!drawn) return false;
  if (context_.frame_times.count() == 0) print_renderer_notes();
  frame_builder_.reset();
  shows_headset_eye_ = is_pick_stale_ = true;
  context_.frame_times.add(ms_since(start), now_ns());
  return true;
}

std::optional<Failure> Viewport::draw(const FrameRequest& next, bool for_file) {
  if (headset_session_ && headset_session_->is_running() && !for_file && !is_minimised()) {
    const auto drawn = draw_in_headset();
    if (!drawn) return Failure{1, drawn.error().message};
    // without headset frames, a limited number of frames is counted in the window
    if (*drawn || (frame_builder_.last_packet() && context_.options.max_frames == 0)) return std::nullopt;
  }
  shows_headset_eye_ = false;
  if (is_minimised()) {
    frame_builder_.discard_prebuilt();
    return std::nullopt;
  }
  std::uint32_t width = 0, height = 0;
  presenter_->size(width, height);
  if (!for_file) {
    update_layout();
    width = pixel_rect_[2] - pixel_rect_[0];
    height = pixel_rect_[3] - pixel_rect_[1];
  } else {
    frame_builder_.discard_prebuilt();
  }
  std::int64_t start = now_ns();
  auto packet = frame_builder_.make_packet(next, width, height);
  if (!packet) {
    // an error in the first frame is an error of the scene; later it comes from an edit, and the last frame stays
    if (context_.frame_times.count() == 0) return to_failure(packet.error());
    context_.state.show_message(packet.error().message, true);
    return std::nullopt;
  }
  const bool was_clipped_away = std::exchange(is_clipped_away_, render::is_clipped_away(*packet));
  if (is_clipped_away_ && !was_clipped_away)
    context_.state.show_message("the clip planes leave nothing of the data; undo, or \"other side\" of a plane, brings it back", true);
  ProgressiveScheduler& pacing = context_.scheduler;
  if (pacing.needs_estimate()) {
    if (auto known = frame_builder_.estimate_error_if_needed(presenter_->renderer(), *packet, next); !known)
      return Failure{1, known.error().message};
    start = now_ns();
  }
  const int recoveries = presenter_->recovery_count();
  const render::RenderTimer clock(presenter_->renderer());
  render::RenderSettings settings = next.settings;
  settings.waits_for_pages = for_file;
  auto drawn = presenter_->draw(*packet, settings);
  // falls back to the embedded shaders if those of --shaders fail
  if (!drawn && reload_ && reload_->fall_back(presenter_->renderer(), drawn.error().message)) drawn = presenter_->draw(*packet, settings);
  if (!drawn && context_.frame_times.count() > 0 && !drawn.error().system_failure && !presenter_->renderer().device().is_lost()) {
    // what cannot be drawn together comes from an edit: the last image stays
    context_.state.show_message(drawn.error().message, true);
    return std::nullopt;
  }
  if (!drawn) return Failure{1, drawn.error().message};
  const bool recovered = presenter_->recovery_count() != recoveries;
  if (recovered) context_.state.show_message("the graphics device was lost and restarted", true);
  // the clock's renderer was destroyed with the lost device
  const double ms = ms_since(start), drawing_ms = recovered ? ms : clock.elapsed_ms();
  pacing.on_rendered(ms);
  LiveTuning& live = context_.tuning;
  const bool as_planned = live.matches(next) && !for_file && context_.frame_times.count() > 0;
  if (as_planned && live.on_rendered(drawing_ms))
    if (const auto quality = live.quality()) pacing = ProgressiveScheduler(*quality);
  if (context_.frame_times.count() == 0) print_renderer_notes();
  frame_builder_.on_rendered(std::move(*packet), presenter_->renderer());
  is_pick_stale_ = true;
  if (!for_file) context_.frame_times.add(ms, now_ns());
  return std::nullopt;
}

/// Prints what the renderer had to omit in the first frame.
void Viewport::print_renderer_notes() const {
  const render::RenderStats stats = presenter_->renderer().stats();
  for (const std::string& note : stats.warnings) print_message(note);
  for (const render::GridDownsampling& coarser : stats.downsampled_grids) print_line(coarser.message());
}

std::optional<Failure> Viewport::estimate_error() {
  ProgressiveScheduler& pacing = context_.scheduler;
  if (!pacing.may_estimate() || is_minimised()) return std::nullopt;
  auto packet = this->make_packet();
  if (!packet) return std::nullopt;  // the error was reported when it was drawn
  const auto estimate = [&]() -> Result<double> {
    if (!context_.tuning.image_tuning) return render::estimate_rmse(presenter_->renderer(), *packet, pacing.current().settings);
    // for comparison with the tuning's prediction: the error itself, not the estimate above it
    return render::measure_single_rmse(presenter_->renderer(), *packet, pacing.current().settings);
  };
  const auto error = estimate();
  if (!error) return Failure{1, error.error().message};
  pacing.set_estimate(*error);
  // the estimate has overwritten the renderer's images
  if (auto drawn = presenter_->draw(*packet, pacing.current().settings); !drawn) return Failure{1, drawn.error().message};
  needs_redraw_ = true;
  return std::nullopt;
}

std::optional<Failure> Viewport::apply_tuning() {
  if (is_minimised()) return std::nullopt;
  update_layout();
  auto packet = this->make_packet();
  if (!packet) return to_failure(packet.error());
  const Outcome made = measure_image_costs(context_.tuning, context_.scheduler, presenter_->renderer(), *packet, context_.scene,
                                           context_.haptic_session, [this](const std::string& line) { context_.state.show_message(line); });
  if (!made) return Failure{1, made.error().message};
  is_pick_stale_ = needs_redraw_ = true;
  return std::nullopt;
}

std::optional<Failure> Viewport::show(const std::function<void()>& make_panels) {
  const std::int64_t start = now_ns();
  update_field_probes();
  Gui& gui = context_.gui;
  if (const auto mouse = headset_session_ ? headset_session_->take_panel_mouse() : std::nullopt) {
    double width = 1, height = 1;
    std::uint32_t frame_width = 1, frame_height = 1;
    context_.window.size(width, height);
    presenter_->size(frame_width, frame_height);
    gui.set_virtual_pointer(mouse->x_px * width / frame_width, mouse->y_px * height / frame_height, mouse->pressed);
  }
  gui.begin();
  // the probe glyph replaces the pointer while the mouse moves the probe
  if (context_.navigation.probe_mode && context_.haptic_session.is_mouse() && context_.state.pointer_on_image) gui.hide_pointer();
  const ViewState& state = context_.state;
  if (const Area area = view_area(); state.pointer_on_image && !state.pointer_pressed && area.contains(state.pointer_x, state.pointer_y) &&
                                     widget_at(state.pointer_x - area.x, state.pointer_y - area.y))
    gui.show_hand_pointer();
  make_panels();
  render::UiItems items = gui.end();
  items.image_area =
      shows_headset_eye_ && presenter_->has_image() ? fitted_area(pixel_rect_, presenter_->renderer().view_size()) : pixel_rect_;
  if (auto shown = presenter_->show(items); !shown) return Failure{1, shown.error().message};
  if (headset_session_) headset_session_->update_panel(*presenter_);
  const double interface_ms = ms_since(start);
  context_.frame_times.add_interface(interface_ms);
  context_.scheduler.on_interface_drawn(interface_ms);
  needs_redraw_ = false;
  return std::nullopt;
}

void Viewport::reset() {
  frame_builder_.reset();
  is_pick_stale_ = true;
}

// ---- picking ----

/// Updates the table of field values. The point under the pointer is looked up while nothing moves.
void Viewport::update_field_probes() {
  const scene::Scene& scene = context_.scene.scene();
  const HapticSession& hand = context_.haptic_session;
  ViewState& state = context_.state;
  state.unit_length = scene::length_unit(scene);
  const auto at = [&](const std::optional<Vec3>& world, std::string object) {
    PointSamples place{world, std::move(object), {}};
    if (world) place.samples = sample_fields(scene, *world);
    return place;
  };
  const HapticState& haptic_state = hand.latest_state();
  const bool feels = haptic_state.tick > 0;
  state.probe_samples = at(feels ? std::optional(haptic_state.probe) : std::nullopt, {});
  std::optional<Vec3> proxy;
  if (feels && haptic_state.link_count > 0) proxy = haptic_state.links[static_cast<std::size_t>(haptic_state.link_count - 1)].proxy;
  state.proxy_samples = at(proxy, feels && haptic_state.link_count > 0 && !hand.link_names().empty() ? hand.link_names().back() : "");
  const double maximum = scene.coupling.max_force_n;
  state.force_ratio = maximum > 0 ? std::clamp(norm(haptic_state.force_n) / maximum, 0.0, 1.0) : 0;

  const auto& shown = frame_builder_.last_packet();
  const bool can = state.pointer_on_image && !state.pointer_pressed && shown && shown->eyes.empty() && !state.is_untitled;
  if (can && !is_pick_stale_) return;
  is_pick_stale_ = !can;
  state.pointer_samples = {};
  if (!can) return;
  if (const auto in_plane = plane_at(state.pointer_x, state.pointer_y)) {
    state.pointer_samples = at(plane_point(*in_plane->plane, in_plane->area, state.pointer_x, state.pointer_y), {});
    return;
  }
  const Area area = view_area();
  const double x = (state.pointer_x - area.x) / area.width * shown->width;
  const double y = (state.pointer_y - area.y) / area.height * shown->height;
  const auto texel = presenter_->pick(x, y);
  if (!texel) return;
  if (const auto place = pick(*shown, x, y, texel->depth, texel->id))
    state.pointer_samples = at(place->world, object_label(*shown, place->id));
}

std::optional<PickHit> Viewport::pick_at(double window_x, double window_y) const {
  if (context_.state.is_untitled || !context_.state.image_area.contains(window_x, window_y)) return std::nullopt;
  if (const auto in_plane = plane_at(window_x, window_y))
    return PickHit{plane_point(*in_plane->plane, in_plane->area, window_x, window_y), 0, false};
  const Area area = view_area();
  return frame_builder_.pick_at((window_x - area.x) / area.width, (window_y - area.y) / area.height);
}

Area Viewport::view_area() const {
  const auto& shown = frame_builder_.last_packet();
  return shown && !shown->planes.empty() ? page_view_area(context_.state.image_area, 0) : context_.state.image_area;
}

std::optional<Viewport::PlaneAt> Viewport::plane_at(double window_x, double window_y) const {
  const auto& shown = frame_builder_.last_packet();
  const Area& page = context_.state.image_area;
  if (!shown || shown->planes.empty() || !page.contains(window_x, window_y)) return std::nullopt;
  const int view = page_view_at(page, window_x, window_y);
  if (view == 0) return std::nullopt;
  return PlaneAt{shown->planes[static_cast<std::size_t>(view - 1)], page_view_area(page, view)};
}

bool Viewport::shows_single_view() const {
  // each image of a side-by-side pair has its own pointer position
  const auto& shown = frame_builder_.last_packet();
  return shown && !context_.state.is_untitled && !shows_headset_eye_ &&
         (shown->eyes.empty() || !render::has_separate_views(shown->packing));
}

std::optional<WidgetPart> Viewport::widget_at(double x, double y) const {
  if (context_.navigation.probe_mode || context_.navigation.fly || !shows_single_view()) return std::nullopt;
  const Area area = view_area();
  const render::Camera camera = make_area_camera(context_.navigation.view, area.width, area.height);
  const auto part = find_widget_part(std::as_const(context_.scene).scene(), context_.scene.bounds, camera, x, y);
  if (!part) return std::nullopt;
  const auto seen = frame_builder_.pick_at(x / area.width, y / area.height);
  const auto depth = [&](const Vec3& p) { return dot(camera.position - camera.stretch * p, camera.back); };
  const bool hidden = seen && (!seen->is_volume || seen->opacity >= kHalfOpaque) &&
                      depth(seen->world) < depth(part->point) - part->pixel * kWidgetTolerancePx;
  return hidden ? std::nullopt : part;
}

std::optional<WidgetPart> Viewport::widget_in_plane(const PlaneAt& plane, const render::Camera& camera, double x, double y) const {
  if (context_.navigation.probe_mode || plane.plane->widgets.tubes.empty()) return std::nullopt;
  return find_widget_part(std::as_const(context_.scene).scene(), context_.scene.bounds, camera, x, y);
}

std::optional<PickHit> Viewport::pick_under_pointer() const {
  const ViewState& state = context_.state;
  return state.pointer_on_image && shows_single_view() ? pick_at(state.pointer_x, state.pointer_y) : std::nullopt;
}

std::optional<Vec3> Viewport::find_visible_point(const std::string& item) const {
  // large meshes are tested triangle by triangle
  std::size_t triangles = 0;
  if (const auto& shown = frame_builder_.last_packet())
    for (const render::MeshItem& mesh : shown->meshes) triangles += mesh.geometry->triangles.size() / 3;
  const int lattice = triangles > 200000 ? 8 : 24;
  if (const auto here = pick_under_pointer(); here && item_label(here->id) == item) return here->world;
  const Area area = view_area();
  std::optional<Vec3> place;
  double minimum = 2;
  for (int j = 0; j < lattice; ++j)
    for (int i = 0; i < lattice; ++i) {
      const double x = (i + 0.5) / lattice, y = (j + 0.5) / lattice, away = std::hypot(x - 0.5, y - 0.5);
      if (away >= minimum) continue;
      const auto there = pick_at(area.x + x * area.width, area.y + y * area.height);
      if (!there || item_label(there->id) != item) continue;
      minimum = away;
      place = there->world;
    }
  return place;
}

// ---- image files ----

void Viewport::write_requested_screenshot() {
  const bool of_window = requested_screenshot_.value_or(false);
  const bool there = of_window ? presenter_->has_presented() : presenter_->has_image();
  if (!requested_screenshot_ || !there || (context_.scheduler.current().pixel_stride > 1 && frames_waited_++ < kMaxWaits)) return;
  frames_waited_ = 0;
  requested_screenshot_.reset();
  std::error_code code;
  const scene::Document& document = context_.scene.document();
  const std::string name = unused_file_name(std::filesystem::current_path(code).string(), path_stem(document.path()), ".png");
  auto picture = of_window ? presenter_->capture_window() : presenter_->renderer().read_back();
  const bool transparent = !of_window && context_.scene.scene().background.transparent;
  const Outcome written = picture ? render::write_png(name, *picture, transparent) : Outcome(picture.error());
  context_.state.show_message(written ? "wrote " + name : written.error().message, !written);
}

std::optional<Failure> Viewport::write_final_screenshots(const std::function<void()>& make_panels) {
  const ViewOptions& options = context_.options;
  if (context_.frame_times.count() == 0) return std::nullopt;
  if (!options.ui_screenshot.empty()) {
    if (auto failure = show(make_panels)) return failure;
    auto picture = presenter_->capture_window();
    if (!picture) return Failure{1, picture.error().message};
    if (auto written = render::write_png(options.ui_screenshot, *picture, false); !written) return to_failure(written.error());
  }
  if (options.screenshot.empty()) return std::nullopt;
  std::uint32_t width = 0, height = 0;
  presenter_->size(width, height);
  const bool whole = pixel_rect_ == std::array<std::uint32_t, 4>{0, 0, width, height};
  // for a headset: the last image of the first eye
  const bool seen = shows_headset_eye_ && presenter_->has_image();
  if (!seen && (!context_.scheduler.is_finished() || !whole || !presenter_->has_image()))
    if (auto failure = draw(frame_builder_.final_frame(), !whole)) return failure;
  auto picture = presenter_->renderer().read_back();
  if (!picture) return Failure{1, picture.error().message};
  const bool transparent = context_.scene.scene().background.transparent;
  if (auto written = render::write_png(options.screenshot, *picture, transparent); !written) return to_failure(written.error());
  return std::nullopt;
}

}  // namespace catena::app
