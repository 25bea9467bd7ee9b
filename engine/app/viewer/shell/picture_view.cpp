#include "engine/app/viewer/shell/picture_view.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "engine/app/hand/device_file.h"
#include "engine/app/viewer/shell/file_list.h"
#include "engine/base/clock.h"
#include "engine/base/tell.h"
#include "engine/scene/units.h"
#include "engine/scene/write_values.h"
#include "engine/schema/values.h"
#include "render/extract/extract.h"
#include "render/extract/extract_parts.h"
#include "render/image/picture.h"
#include "render/quality/quality.h"

namespace catena::app {

namespace {

constexpr int kMaxWaits = 30;

/// The largest part of an area, in its middle, with a picture's proportions.
std::array<std::uint32_t, 4> fitted_area(const std::array<std::uint32_t, 4>& area, const std::array<std::uint32_t, 2>& picture) {
  const double width = area[2] - area[0], height = area[3] - area[1];
  const double scale = std::min(width / picture[0], height / picture[1]);
  const auto half_x = std::uint32_t(0.5 * (width - scale * picture[0])), half_y = std::uint32_t(0.5 * (height - scale * picture[1]));
  return {area[0] + half_x, area[1] + half_y, area[2] - half_x, area[3] - half_y};
}

}  // namespace

PictureView::~PictureView() {
  if (headset_) headset_->leave();
}

std::optional<Failure> PictureView::open() {
  Screen::Options options{shared_.options.gpu_memory, shared_.options.fail};
  if (shared_.options.headset) {
    auto headset = HeadsetHost::open();
    if (!headset) return Failure{1, headset.error().message};
    headset_ = std::move(*headset);
    headset_->join(options);
  }
  auto screen = Screen::open(shared_.window, std::move(options));
  if (!screen) return Failure{1, screen.error().message};
  screen_ = std::move(*screen);
  const render::vk::DeviceInfo& device = screen_->renderer().device().info();
  if (device.is_cpu()) shared_.state.say("no GPU: drawn by the processor (" + device.name + ")");
  return std::nullopt;
}

// ---- its place ----

bool PictureView::is_minimised() const {
  std::uint32_t width = 0, height = 0;
  screen_->size(width, height);
  return width == 0 || height == 0;
}

bool PictureView::lay_out() {
  double width = 1, height = 1;
  std::uint32_t frame_width = 0, frame_height = 0;
  shared_.window.size(width, height);
  screen_->size(frame_width, frame_height);
  ViewState& state = shared_.state;
  state.area = picture_area(width, height, state.panels ? interface_edges() : Edges{});
  const auto before = pixels_;
  if (frame_width > 0 && frame_height > 0) pixels_ = pixels_of(state.area, width, height, frame_width, frame_height);
  return pixels_ != before;
}

std::array<std::uint32_t, 2> PictureView::size() const {
  return {std::max(1u, pixels_[2] - pixels_[0]), std::max(1u, pixels_[3] - pixels_[1])};
}

// ---- drawing ----

bool PictureView::take_shaders() { return reload_ && reload_->poll(screen_->renderer(), now_ns()); }

Result<bool> PictureView::follow_headset() {
  if (!headset_) return false;
  CATENA_CHECK(headset_->follow(*screen_, now_ns(), [this](const std::string& line) {
    shared_.state.say(line, true);
    tell_from_catena(line);
  }));
  if (!headset_->running()) shared_.hand.hold_off(false);  // nothing moves the world any more
  return headset_->running();
}

/// The hand's metres are the room's where the room knows them; not while the world is on its way.
void PictureView::follow_the_room() {
  HandHost& hand = shared_.hand;
  DeskDevice& desk = *headset_->desk();
  for (const DeskDevice::News& news : desk.take_news()) {
    shared_.state.say(news.words, news.is_error);
    tell_from_catena(news.words);
  }
  shared_.state.prompt = desk.prompt();
  if (const auto found = desk.take_found()) keep_room(*found);
  const auto now = headset_->hand_workspace(hand);
  if (!now) return (void)hand.hold_off(false);
  scene::Workspace& workspace = shared_.scene.scene().workspace;
  const bool stays =
      now->metres_per_unit == workspace.metres_per_unit && now->origin == workspace.origin && now->rotation == workspace.rotation;
  if (!hand.hold_off(!stays || headset_->holds_world()) || stays || headset_->holds_world()) return;
  workspace = *now;
  shared_.state.say_if_wrong(hand.publish(shared_.scene.scene(), shared_.scene.felt_text()));
}

Outcome PictureView::ask_for_places() {
  DeskDevice* const desk = headset_ ? headset_->desk() : nullptr;
  if (!desk) return Error{"there is no headset in whose room a device could be registered; view --xr was expected"};
  if (!desk->touching()) return desk->begin(shared_.hand);
  desk->cancel();
  return Done{};
}

/// With the settings of the device, in its own file or in the scene.
void PictureView::keep_room(const haptics::DeviceSettings::Room& room) {
  const std::string type = haptics::device_type_of(shared_.hand.device_name()), &file = shared_.options.device_file;
  const std::vector<scene::Document::Edit> edits{{"/type", scene::text_of(type)},
                                                 {"/room_origin", scene::text_of(room.origin_m)},
                                                 {"/room_rotation", schema::write_value(room.room_from_hand)}};
  const auto say = [&](const Outcome& kept, const std::string& where) {
    shared_.state.say(kept ? where : kept.error().message, !kept);
    tell_from_catena(kept ? where : kept.error().message);
  };
  if (!file.empty()) return say(write_device_file(file, edits), "where it stands was written to " + file);
  const auto& device = std::as_const(shared_.scene).scene().device;
  const json::Node* const other = device ? device->find("type") : nullptr;
  if (other && other->string != type)
    return say(
        Error{"the scene's \"device\" is a " + other->string + ": where the " + type + " stands is not kept; --device-file keeps it"}, "");
  std::vector<scene::Document::Edit> in_scene = edits;
  for (scene::Document::Edit& edit : in_scene) edit.pointer.insert(0, "/device");
  say(shared_.scene.apply(in_scene, "where the device stands"), "where it stands is part of the scene, which is saved with Ctrl+S");
}

/// True: the picture is an eye's. What lies at a place of the window's picture cannot be said by it: an eye has its own packet.
Result<bool> PictureView::draw_in_headset() {
  const std::int64_t start = now_ns();
  scene::Scene& scene = shared_.scene.scene();
  HeadsetHost::Content content;
  content.make = [&]() -> Result<render::FramePacket> {
    auto [width, height] = size();
    CATENA_TRY(render::FramePacket packet, drawing_.packet(width, height));
    // what belongs to a flat picture stays in the window
    packet.overlay.texts.clear();
    packet.overlay.scalar_bars.clear();
    packet.overlay.orientation_marker.reset();
    packet.overlay.status.reset();
    return packet;
  };
  content.latch = [&](render::FramePacket& of) {
    hand_moved_late_ = shared_.hand.take(scene) || hand_moved_late_;
    render::move_cursors(scene, of);
  };
  content.aim = [&](const render::View& view, render::FramePacket& of) { render::set_view(scene, view, of); };
  content.kind = [&](const render::FramePacket& of) {
    const SceneKind& kind = drawing_.look_at(of, screen_->renderer());
    return render::LadderKind{kind.fast, kind.shaded};
  };
  CATENA_TRY(const bool drawn, headset_->draw(*screen_, shared_.hand, content));
  follow_the_room();
  if (!drawn) return false;
  if (shared_.times.count() == 0) tell_notes();
  drawing_.forget();
  is_eye_ = picked_stale_ = true;
  shared_.times.add(ms_since(start), now_ns());
  return true;
}

std::optional<Failure> PictureView::draw(const NextPicture& next, bool for_file) {
  if (headset_ && headset_->running() && !for_file && !is_minimised()) {
    const auto drawn = draw_in_headset();
    if (!drawn) return Failure{1, drawn.error().message};
    // a number of pictures is counted in the window where nobody sees the headset's
    if (*drawn || (drawing_.shown() && shared_.options.frames == 0)) return std::nullopt;
  }
  is_eye_ = false;
  if (is_minimised()) {
    drawing_.drop_ahead();
    return std::nullopt;
  }
  std::uint32_t width = 0, height = 0;
  screen_->size(width, height);
  if (!for_file) {
    lay_out();
    width = pixels_[2] - pixels_[0];
    height = pixels_[3] - pixels_[1];
  } else {
    drawing_.drop_ahead();
  }
  std::int64_t start = now_ns();
  auto packet = drawing_.packet(next, width, height);
  if (!packet) {
    // at the start it is the scene's fault; later an edit's, and the last picture stands
    if (shared_.times.count() == 0) return failure_of(packet.error());
    shared_.state.say(packet.error().message, true);
    return std::nullopt;
  }
  Pacing& pacing = shared_.pacing;
  if (pacing.wants_estimate()) {
    if (auto known = drawing_.estimate_if_wanted(screen_->renderer(), *packet, next); !known) return Failure{1, known.error().message};
    start = now_ns();
  }
  const int recoveries = screen_->recoveries();
  const render::DrawingClock clock(screen_->renderer());
  auto drawn = screen_->draw(*packet, next.settings);
  // with the embedded shaders if those of --shaders cannot be drawn with
  if (!drawn && reload_ && reload_->give_up(screen_->renderer(), drawn.error().message)) drawn = screen_->draw(*packet, next.settings);
  if (!drawn) return Failure{1, drawn.error().message};
  const bool recovered = screen_->recoveries() != recoveries;
  if (recovered) shared_.state.say("the graphics device was lost and has been started again", true);
  // the clock's renderer is gone with a lost device
  const double ms = ms_since(start), drawing_ms = recovered ? ms : clock.ms();
  pacing.drawn(ms);
  LivePlan& live = shared_.plan;
  const bool as_planned = live.is_drawn_by(next) && !for_file && shared_.times.count() > 0;
  if (as_planned && live.drawn(drawing_ms))
    if (const auto quality = live.quality()) pacing = Pacing(*quality);
  if (shared_.times.count() == 0) tell_notes();
  drawing_.drawn(std::move(*packet), screen_->renderer());
  picked_stale_ = true;
  if (!for_file) shared_.times.add(ms, now_ns());
  return std::nullopt;
}

/// What the first picture had to leave out.
void PictureView::tell_notes() const {
  const render::RenderStats stats = screen_->renderer().stats();
  for (const std::string& note : stats.notes) tell_from_catena(note);
  for (const render::MirrorCoarsening& coarser : stats.mirror_coarsening) tell(coarser.words());
}

std::optional<Failure> PictureView::estimate() {
  Pacing& pacing = shared_.pacing;
  if (!pacing.may_estimate() || is_minimised()) return std::nullopt;
  auto packet = this->packet();
  if (!packet) return std::nullopt;  // said where it was drawn
  const auto estimate = [&]() -> Result<double> {
    if (!shared_.plan.eye) return render::estimate_rmse(screen_->renderer(), *packet, pacing.again().settings);
    // beside what a plan expects: the error itself, not the estimate above it
    return render::rmse_of(screen_->renderer(), *packet, pacing.again().settings);
  };
  const auto error = estimate();
  if (!error) return Failure{1, error.error().message};
  pacing.estimated(*error);
  // the estimate drew with the renderer's own images
  if (auto drawn = screen_->draw(*packet, pacing.again().settings); !drawn) return Failure{1, drawn.error().message};
  damaged_ = true;
  return std::nullopt;
}

std::optional<Failure> PictureView::plan() {
  if (is_minimised()) return std::nullopt;
  lay_out();
  auto packet = this->packet();
  if (!packet) return failure_of(packet.error());
  const Outcome made = measure_eye(shared_.plan, shared_.pacing, screen_->renderer(), *packet, shared_.scene, shared_.hand,
                                   [this](const std::string& line) { shared_.state.say(line); });
  if (!made) return Failure{1, made.error().message};
  picked_stale_ = damaged_ = true;
  return std::nullopt;
}

std::optional<Failure> PictureView::show(const std::function<void()>& make_panels) {
  const std::int64_t start = now_ns();
  update_values();
  Gui& gui = shared_.gui;
  if (const auto mouse = headset_ ? headset_->panel_mouse() : std::nullopt) {
    double width = 1, height = 1;
    std::uint32_t frame_width = 1, frame_height = 1;
    shared_.window.size(width, height);
    screen_->size(frame_width, frame_height);
    gui.point(mouse->x_px * width / frame_width, mouse->y_px * height / frame_height, mouse->pressed);
  }
  gui.begin();
  // the glyph is the pointer while the mouse is the hand
  if (shared_.controls.hand_mode && shared_.hand.is_mouse() && shared_.state.pointer_on_picture) gui.hide_pointer();
  make_panels();
  render::UiItems items = gui.end();
  items.area = is_eye_ && screen_->has_picture() ? fitted_area(pixels_, screen_->renderer().view_size()) : pixels_;
  if (auto shown = screen_->show(items); !shown) return Failure{1, shown.error().message};
  if (headset_) headset_->show_panel(*screen_);
  shared_.times.add_interface(ms_since(start));
  damaged_ = false;
  return std::nullopt;
}

void PictureView::forget() {
  drawing_.forget();
  picked_stale_ = true;
}

// ---- what is where ----

/// The rows of the table of values. The place under the pointer is looked up while nothing moves.
void PictureView::update_values() {
  const scene::Scene& scene = shared_.scene.scene();
  const HandHost& hand = shared_.hand;
  ViewState& state = shared_.state;
  state.unit_length = scene::unit_length(scene);
  const auto at = [&](const std::optional<Vec3>& world, std::string object) {
    PlaceValues place{world, std::move(object), {}};
    if (world) place.fields = values_at(scene, *world);
    return place;
  };
  const exchange::HapticState& felt = hand.felt();
  const bool feels = felt.tick > 0;
  state.probe = at(feels ? std::optional(felt.probe) : std::nullopt, {});
  std::optional<Vec3> proxy;
  if (feels && felt.link_count > 0) proxy = felt.links[static_cast<std::size_t>(felt.link_count - 1)].proxy;
  state.proxy = at(proxy, feels && felt.link_count > 0 && !hand.link_names().empty() ? hand.link_names().back() : "");
  const double most = scene.coupling.max_force_n;
  state.force_share = most > 0 ? std::clamp(norm(felt.force_n) / most, 0.0, 1.0) : 0;

  const auto& shown = drawing_.shown();
  const bool can = state.pointer_on_picture && !state.pointer_pressed && shown && shown->eyes.empty() && !state.untitled;
  if (can && !picked_stale_) return;
  picked_stale_ = !can;
  state.pointer = {};
  if (!can) return;
  const double x = (state.pointer_x - state.area.x) / state.area.width * shown->width;
  const double y = (state.pointer_y - state.area.y) / state.area.height * shown->height;
  const auto texel = screen_->pick(x, y);
  if (!texel) return;
  if (const auto place = pick(*shown, x, y, texel->depth, texel->id)) state.pointer = at(place->world, object_words(*shown, place->id));
}

std::optional<PickedPlace> PictureView::picked_at(double window_x, double window_y) const {
  const Area& area = shared_.state.area;
  if (shared_.state.untitled || !area.contains(window_x, window_y)) return std::nullopt;
  return drawing_.picked_at((window_x - area.x) / area.width, (window_y - area.y) / area.height);
}

std::optional<PickedPlace> PictureView::under_pointer() const {
  const ViewState& state = shared_.state;
  // eyes side by side have a place for the pointer each
  const auto& shown = drawing_.shown();
  const bool apart = shown && !shown->eyes.empty() && render::is_apart(shown->packing);
  return state.pointer_on_picture && !apart ? picked_at(state.pointer_x, state.pointer_y) : std::nullopt;
}

std::optional<Vec3> PictureView::seen_place(const std::string& item) const {
  // big meshes are looked at triangle by triangle
  std::size_t triangles = 0;
  if (const auto& shown = drawing_.shown())
    for (const render::MeshItem& mesh : shown->meshes) triangles += mesh.geometry->triangles.size() / 3;
  const int lattice = triangles > 200000 ? 8 : 24;
  if (const auto here = under_pointer(); here && item_of(here->id) == item) return here->world;
  const Area& area = shared_.state.area;
  std::optional<Vec3> place;
  double least = 2;
  for (int j = 0; j < lattice; ++j)
    for (int i = 0; i < lattice; ++i) {
      const double x = (i + 0.5) / lattice, y = (j + 0.5) / lattice, away = std::hypot(x - 0.5, y - 0.5);
      if (away >= least) continue;
      const auto there = picked_at(area.x + x * area.width, area.y + y * area.height);
      if (!there || item_of(there->id) != item) continue;
      least = away;
      place = there->world;
    }
  return place;
}

// ---- to a file ----

void PictureView::write_asked() {
  const bool of_window = asked_.value_or(false);
  const bool there = of_window ? screen_->is_shown() : screen_->has_picture();
  if (!asked_ || !there || (shared_.pacing.again().scale > 1 && waits_++ < kMaxWaits)) return;
  waits_ = 0;
  asked_.reset();
  std::error_code code;
  const scene::Document& document = shared_.scene.document();
  const std::string name = free_name(std::filesystem::current_path(code).string(), stem_of_path(document.path()), ".png");
  auto picture = of_window ? screen_->window_picture() : screen_->renderer().read_back();
  const bool transparent = !of_window && shared_.scene.scene().background.transparent;
  const Outcome written = picture ? render::write_png(name, *picture, transparent) : Outcome(picture.error());
  shared_.state.say(written ? "wrote " + name : written.error().message, !written);
}

std::optional<Failure> PictureView::write_last(const std::function<void()>& make_panels) {
  const ViewOptions& options = shared_.options;
  if (shared_.times.count() == 0) return std::nullopt;
  if (!options.window_screenshot.empty()) {
    if (auto failure = show(make_panels)) return failure;
    auto picture = screen_->window_picture();
    if (!picture) return Failure{1, picture.error().message};
    if (auto written = render::write_png(options.window_screenshot, *picture, false); !written) return failure_of(written.error());
  }
  if (options.screenshot.empty()) return std::nullopt;
  std::uint32_t width = 0, height = 0;
  screen_->size(width, height);
  const bool whole = pixels_ == std::array<std::uint32_t, 4>{0, 0, width, height};
  // of a headset: what was seen last by the first eye
  const bool seen = is_eye_ && screen_->has_picture();
  if (!seen && (!shared_.pacing.finished() || !whole || !screen_->has_picture()))
    if (auto failure = draw(drawing_.best(), !whole)) return failure;
  auto picture = screen_->renderer().read_back();
  if (!picture) return Failure{1, picture.error().message};
  const bool transparent = shared_.scene.scene().background.transparent;
  if (auto written = render::write_png(options.screenshot, *picture, transparent); !written) return failure_of(written.error());
  return std::nullopt;
}

}  // namespace catena::app
