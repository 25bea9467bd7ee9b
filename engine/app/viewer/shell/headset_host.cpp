#include "engine/app/viewer/shell/headset_host.h"

#include <utility>

#ifdef CATENA_XR
#include <fmt/format.h>

#include "render/xr/headset.h"
#endif

namespace catena::app {

#ifdef CATENA_XR

namespace {

constexpr int kFarewellTurns = 200;  // of events and frames, while the runtime ends the session

}  // namespace

struct HeadsetHost::Parts {
  std::mutex queue_lock;  // outlives the device
  std::unique_ptr<render::xr::Headset> headset;
  std::int64_t retry_ns = 0;  ///< not before
  std::string said;           ///< what was lost last, while nothing has been seen since
  std::string broken;         ///< what went wrong in a frame; follow() acts on it
  bool left = false;          ///< the person has ended it by the runtime's own ways

  void lose(const std::string& why, std::int64_t now_ns);
};

HeadsetHost::HeadsetHost(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
HeadsetHost::~HeadsetHost() = default;

Result<std::unique_ptr<HeadsetHost>> HeadsetHost::open() {
  auto parts = std::make_unique<Parts>();
  CATENA_TRY(parts->headset, render::xr::Headset::open());
  return std::unique_ptr<HeadsetHost>(new HeadsetHost(std::move(parts)));
}

void HeadsetHost::join(Screen::Options& options) {
  options.maker = [this] { return parts_->headset ? parts_->headset->maker(parts_->queue_lock) : render::vk::VulkanMaker{}; };
  options.before_making = [this] {
    if (parts_->headset) parts_->headset->stop();
  };
}

/// It is tried again later; the runtime's own instance goes with it where that was lost.
void HeadsetHost::Parts::lose(const std::string& why, std::int64_t now_ns) {
  said = why;
  retry_ns = now_ns + std::int64_t(1e9 * kRetryS);
  headset->stop();
  if (headset->loss() == render::xr::Loss::instance) headset.reset();
}

Outcome HeadsetHost::follow(Screen& screen, std::int64_t now_ns, const std::function<void(const std::string&)>& say) {
  Parts& p = *parts_;
  if (p.left) return Done{};
  const auto lose = [&](const std::string& why) {
    if (p.said != why) say(why);
    p.lose(why, now_ns);
  };
  if (!p.broken.empty()) lose(std::exchange(p.broken, {}));
  if (!p.headset) {
    if (now_ns < p.retry_ns) return Done{};
    p.retry_ns = now_ns + std::int64_t(1e9 * kRetryS);
    auto opened = render::xr::Headset::open();
    if (!opened) return Done{};
    p.headset = std::move(*opened);
    // the new runtime's own device
    CATENA_CHECK(screen.make_again());
  }
  if (!p.headset->started()) {
    if (now_ns < p.retry_ns) return Done{};
    if (const Outcome started = p.headset->start(screen.renderer().device()); !started) {
      lose(started.error().message);
      return Done{};
    }
  }
  if (const Outcome polled = p.headset->poll(); !polled) {
    lose(polled.error().message);
    return Done{};
  }
  if (p.headset->session().has_left()) {
    p.left = true;
    p.headset->stop();
    say("the headset's session was ended by its runtime");
  }
  return Done{};
}

bool HeadsetHost::running() const { return parts_->headset && parts_->headset->running(); }

Result<bool> HeadsetHost::draw(Screen& screen, render::FramePacket& packet, const render::RenderSettings& settings, double share,
                               const Aim& aim) {
  Parts& p = *parts_;
  if (!placement) placement = render::first_placement(packet.view);
  auto frame = p.headset->draw(screen.renderer(), packet, settings, *placement, share, aim);
  if (frame) {
    if (frame->wants_picture) {
      screen.has_drawn();
      p.said.clear();
    }
    return frame->wants_picture;
  }
  if (screen.renderer().device().lost()) {
    CATENA_CHECK(screen.make_again());
    return false;
  }
  if (p.headset->loss() == render::xr::Loss::none) return frame.error();
  p.broken = frame.error().message;
  return false;
}

void HeadsetHost::leave() {
  Parts& p = *parts_;
  if (!p.headset || !p.headset->running()) return;
  (void)p.headset->session().ask_to_leave();
  for (int i = 0; i < kFarewellTurns; ++i) {
    if (!p.headset->poll() || !p.headset->running()) break;
    if (!p.headset->skip_frame()) break;
  }
  p.headset->stop();
}

std::string HeadsetHost::words() const {
  const Parts& p = *parts_;
  const std::string state = p.headset && p.headset->started() ? render::xr::state_word(p.headset->session().state()) : "lost";
  return placement ? fmt::format("headset {}, 1 unit = {:.3g} m", state, placement->metres_per_unit) : "headset " + state;
}

#else

struct HeadsetHost::Parts {};
HeadsetHost::HeadsetHost(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
HeadsetHost::~HeadsetHost() = default;
Result<std::unique_ptr<HeadsetHost>> HeadsetHost::open() {
  return Error{"no headset: this program was built without OpenXR, expected the package libopenxr-dev when it is built"};
}
void HeadsetHost::join(Screen::Options&) {}
Outcome HeadsetHost::follow(Screen&, std::int64_t, const std::function<void(const std::string&)>&) { return Done{}; }
bool HeadsetHost::running() const { return false; }
Result<bool> HeadsetHost::draw(Screen&, render::FramePacket&, const render::RenderSettings&, double, const Aim&) { return false; }
void HeadsetHost::leave() {}
std::string HeadsetHost::words() const { return "no headset"; }

#endif

}  // namespace catena::app
