/// The wait for a frame on a thread of its own: a runtime may keep it for seconds, and the window goes on meanwhile. One wait at a time.
#pragma once
#include <chrono>
#include <condition_variable>
#include <memory>
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
  /// After the runtime's answer, unless end() was told that there is none: a session is not destroyed while it is used.
  ~FrameWait();
  FrameWait(const FrameWait&) = delete;
  FrameWait& operator=(const FrameWait&) = delete;

  /// Asks the runtime, unless it was asked and has not answered. Nothing where there is no answer within `patience`; none: however long.
  std::optional<Answer> take(std::optional<std::chrono::nanoseconds> patience);

  /// The last call. False where the runtime does not answer within `patience` (none: however long): its call and the thread are left
  /// behind, and the session is in use for good.
  bool end(std::optional<std::chrono::nanoseconds> patience);

 private:
  /// What the thread needs, even where it is left behind.
  struct Shared {
    PFN_xrWaitFrame wait;
    XrSession session;
    std::mutex lock;
    std::condition_variable changed;
    bool asked = false, ends = false, ended = false;  // under the lock, with the answer
    std::optional<Answer> answer;
  };
  static void run(Shared& shared);

  std::shared_ptr<Shared> shared_;
  std::thread thread_;
};

}  // namespace catena::render::xr
