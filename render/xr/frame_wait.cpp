#include "render/xr/frame_wait.h"

#include <utility>

namespace catena::render::xr {

FrameWait::FrameWait(PFN_xrWaitFrame wait, XrSession session) : shared_(std::make_shared<Shared>()) {
  shared_->wait = wait;
  shared_->session = session;
  thread_ = std::thread([shared = shared_] { run(*shared); });
}

FrameWait::~FrameWait() {
  if (thread_.joinable()) (void)end(std::nullopt);
}

bool FrameWait::end(std::optional<std::chrono::nanoseconds> patience) {
  std::unique_lock guard(shared_->lock);
  shared_->ends = true;
  shared_->changed.notify_all();
  const bool ended = !patience || shared_->changed.wait_for(guard, *patience, [this] { return shared_->ended; });
  guard.unlock();
  if (ended) {
    thread_.join();
  } else {
    thread_.detach();
  }
  return ended;
}

std::optional<FrameWait::Answer> FrameWait::take(std::optional<std::chrono::nanoseconds> patience) {
  Shared& s = *shared_;
  std::unique_lock guard(s.lock);
  if (!std::exchange(s.asked, true)) s.changed.notify_all();
  const auto answered = [&s] { return s.answer.has_value(); };
  if (!patience) {
    s.changed.wait(guard, answered);
  } else if (!s.changed.wait_for(guard, *patience, answered)) {
    return std::nullopt;
  }
  s.asked = false;
  return std::exchange(s.answer, std::nullopt);
}

void FrameWait::run(Shared& s) {
  std::unique_lock guard(s.lock);
  for (;;) {
    s.changed.wait(guard, [&s] { return s.ends || (s.asked && !s.answer); });
    if (s.ends) break;
    guard.unlock();
    Answer answer;
    answer.state.type = XR_TYPE_FRAME_STATE;
    XrFrameWaitInfo info{};
    info.type = XR_TYPE_FRAME_WAIT_INFO;
    answer.result = s.wait(s.session, &info, &answer.state);
    guard.lock();
    s.answer = answer;
    s.changed.notify_all();
  }
  s.ended = true;
  s.changed.notify_all();
}

}  // namespace catena::render::xr
