#include "engine/app/viewer/shell/drawing.h"

#include <algorithm>
#include <utility>

#include "engine/base/clock.h"
#include "render/extract/extract.h"
#include "render/extract/extract_parts.h"
#include "render/quality/quality.h"

namespace catena::app {

namespace {
constexpr std::uint32_t kLeastPixels = 16;  // of a picture each way: any packing of views has its pixels
}

Result<render::FramePacket> Drawing::packet(std::uint32_t width, std::uint32_t height) const {
  scene::Scene& scene = scene_.scene();
  const auto eye = render::view_size(render::packing_of(scene.stereo), render::views_of(scene.stereo), std::max(kLeastPixels, width),
                                     std::max(kLeastPixels, height));
  // a hand that the mouse holds says how deep it is
  const auto drop_line = [&]() -> bool& { return scene.world.get<scene::Cursor>(scene.cursor).drop_line; };
  const bool stated = std::exchange(drop_line(), drop_line() || controls_.hand_mode);
  auto packet = render::make_frame(scene, static_cast<std::uint32_t>(eye.width), static_cast<std::uint32_t>(eye.height));
  drop_line() = stated;
  return packet;
}

/// Interlaced eyes belong to the window's own pixels.
std::uint32_t Drawing::scale_of(const NextPicture& next) const {
  return render::is_interlaced(render::packing_of(scene_.scene().stereo)) ? 1 : next.scale;
}

Result<render::FramePacket> Drawing::packet(const NextPicture& next, std::uint32_t width, std::uint32_t height) {
  if (auto ahead = std::exchange(ahead_, std::nullopt)) return std::move(*ahead);
  const std::uint32_t scale = scale_of(next);
  return packet(width / scale, height / scale);
}

NextPicture Drawing::followed(std::uint32_t width, std::uint32_t height) {
  if (!shown_ || !kind_.rays || !pacing_.may_keep()) return moving();
  const std::uint32_t scale = scale_of(pacing_.again());
  auto packet = this->packet(width / scale, height / scale);
  if (!packet || !render::same_rays(*packet, *shown_)) return moving();
  ahead_ = std::move(*packet);
  return pacing_.kept();
}

double Drawing::rest_s() const { return 1e-3 * ms_since(last_change_ns_); }

void Drawing::changed() { last_change_ns_ = now_ns(); }

std::optional<NextPicture> Drawing::next(bool moved, bool hand_moved, std::uint32_t width, std::uint32_t height) {
  if (moved) changed();
  const double rested_s = rest_s();
  if (moved) return moving();
  if (!hand_moved) return rested_s >= kRestS ? still() : std::nullopt;
  const NextPicture next = followed(width, height);
  if (!next.settings.keep) changed();
  // better ones come while a hand is at work, too
  if (next.settings.keep && rested_s >= kRestS && pacing_.may_improve())
    if (auto better = still()) {
      drop_ahead();  // it may have fewer pixels
      return better;
    }
  return next;
}

Outcome Drawing::estimate_if_wanted(render::Renderer& renderer, const render::FramePacket& packet, const NextPicture& next) {
  if (!pacing_.wants_estimate()) return Done{};
  CATENA_TRY(const double error, render::estimate_rmse(renderer, packet, next.settings));
  pacing_.estimated(error);
  return Done{};
}

void Drawing::drawn(render::FramePacket packet, const render::Renderer& renderer) {
  look_at(packet, renderer);
  shown_ = std::move(packet);
}

const SceneKind& Drawing::look_at(const render::FramePacket& packet, const render::Renderer& renderer) {
  kind_ = {render::draws_rays(packet), renderer.draws_fast(packet), std::ranges::any_of(packet.volumes, &render::VolumeItem::shade)};
  return kind_;
}

std::optional<PickedPlace> Drawing::picked_at(double x, double y) const {
  if (!shown_) return std::nullopt;
  return pick_thing(*shown_, x * shown_->width, y * shown_->height);
}

std::string Drawing::item_of(std::uint32_t id) const {
  return shown_ && id > 0 && id <= shown_->objects.size() ? shown_->objects[id - 1].item : std::string();
}

}  // namespace catena::app
