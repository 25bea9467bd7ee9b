/// The wait for a frame on a thread of its own: a runtime may keep it for seconds, and the window goes on meanwhile. One wait at a time.
#pragma once
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <thread>

#include "render/xr/functions.h"

namespace catena::render::xr {

class FrameWait {
 public:
  struct Answer {
    XrResult result = XR_SUCCESS;
    XrFrameState state{};
  };

  FrameWait(PFN_xrWaitFrame wait, XrSession session);
  /// After the runtime's answer: a session is not destroyed while it is used.
  ~FrameWait();
  FrameWait(const FrameWait&) = delete;
  FrameWait& operator=(const FrameWait&) = delete;

  /// Asks the runtime, unless it was asked and has not answered. Nothing where there is no answer within `patience`; none: however long.
  std::optional<Answer> take(std::optional<std::chrono::nanoseconds> patience);

 private:
  void run();

  PFN_xrWaitFrame wait_;
  XrSession session_;
  std::mutex lock_;
  std::condition_variable changed_;
  bool asked_ = false, ends_ = false;  // under the lock, with the answer
  std::optional<Answer> answer_;
  std::thread thread_;
};

}  // namespace catena::render::xr
