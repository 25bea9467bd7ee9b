#include "render/xr/frame_wait.h"

#include <utility>

namespace catena::render::xr {

FrameWait::FrameWait(PFN_xrWaitFrame wait, XrSession session) : wait_(wait), session_(session), thread_([this] { run(); }) {}

FrameWait::~FrameWait() {
  {
    const std::lock_guard guard(lock_);
    ends_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

std::optional<FrameWait::Answer> FrameWait::take(std::optional<std::chrono::nanoseconds> patience) {
  std::unique_lock guard(lock_);
  if (!std::exchange(asked_, true)) changed_.notify_all();
  const auto answered = [this] { return answer_.has_value(); };
  if (!patience) {
    changed_.wait(guard, answered);
  } else if (!changed_.wait_for(guard, *patience, answered)) {
    return std::nullopt;
  }
  asked_ = false;
  return std::exchange(answer_, std::nullopt);
}

void FrameWait::run() {
  std::unique_lock guard(lock_);
  for (;;) {
    changed_.wait(guard, [this] { return ends_ || (asked_ && !answer_); });
    if (ends_) return;
    guard.unlock();
    Answer answer;
    answer.state.type = XR_TYPE_FRAME_STATE;
    XrFrameWaitInfo info{};
    info.type = XR_TYPE_FRAME_WAIT_INFO;
    answer.result = wait_(session_, &info, &answer.state);
    guard.lock();
    answer_ = answer;
    changed_.notify_all();
  }
}

}  // namespace catena::render::xr
