// SPDX-License-Identifier: MIT
#include "render/xr/frame_waiter.h"

#include <utility>

namespace catena::render::xr {

FrameWaiter::FrameWaiter(PFN_xrWaitFrame wait, XrSession session) : state_(std::make_shared<SharedState>()) {
  state_->wait = wait;
  state_->session = session;
  thread_ = std::thread([shared = state_] { run_thread(*shared); });
}

FrameWaiter::~FrameWaiter() {
  if (thread_.joinable()) (void)stop(std::nullopt);
}

bool FrameWaiter::stop(std::optional<std::chrono::nanoseconds> patience) {
  std::unique_lock guard(state_->mutex);
  state_->should_stop = true;
  state_->changed.notify_all();
  const bool ended = !patience || state_->changed.wait_for(guard, *patience, [this] { return state_->has_stopped; });
  guard.unlock();
  if (ended) {
    thread_.join();
  } else {
    thread_.detach();
  }
  return ended;
}

std::optional<FrameWaiter::WaitResult> FrameWaiter::wait_for(std::optional<std::chrono::nanoseconds> patience) {
  SharedState& s = *state_;
  std::unique_lock guard(s.mutex);
  if (!std::exchange(s.is_waiting, true)) s.changed.notify_all();
  const auto answered = [&s] { return s.wait_result.has_value(); };
  if (!patience) {
    s.changed.wait(guard, answered);
  } else if (!s.changed.wait_for(guard, *patience, answered)) {
    return std::nullopt;
  }
  s.is_waiting = false;
  return std::exchange(s.wait_result, std::nullopt);
}

void FrameWaiter::run_thread(SharedState& s) {
  std::unique_lock guard(s.mutex);
  for (;;) {
    s.changed.wait(guard, [&s] { return s.should_stop || (s.is_waiting && !s.wait_result); });
    if (s.should_stop) break;
    guard.unlock();
    WaitResult answer;
    answer.state.type = XR_TYPE_FRAME_STATE;
    XrFrameWaitInfo info{};
    info.type = XR_TYPE_FRAME_WAIT_INFO;
    answer.result = s.wait(s.session, &info, &answer.state);
    guard.lock();
    s.wait_result = answer;
    s.changed.notify_all();
  }
  s.has_stopped = true;
  s.changed.notify_all();
}

}  // namespace catena::render::xr
