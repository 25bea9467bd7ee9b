/// The wait for a frame on a thread of its own: a runtime may keep it for seconds, and the window goes on meanwhile. One wait at a time.
#pragma once
#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "render/xr/xr_loader.h"

namespace catena::render::xr {

class FrameWaiter {
 public:
  struct WaitResult {
    XrResult result = XR_SUCCESS;
    XrFrameState state{};
  };

  FrameWaiter(PFN_xrWaitFrame wait, XrSession session);
  /// After the runtime's answer, unless end() was told that there is none: a session is not destroyed while it is used.
  ~FrameWaiter();
  FrameWaiter(const FrameWaiter&) = delete;
  FrameWaiter& operator=(const FrameWaiter&) = delete;

  /// Asks the runtime, unless it was asked and has not answered. Nothing where there is no answer within `patience`; none: however long.
  std::optional<WaitResult> wait_for(std::optional<std::chrono::nanoseconds> patience);

  /// The last call. False where the runtime does not answer within `patience` (none: however long): its call and the thread are left
  /// behind, and the session is in use for good.
  bool stop(std::optional<std::chrono::nanoseconds> patience);

 private:
  /// What the thread needs, even where it is left behind.
  struct SharedState {
    PFN_xrWaitFrame wait;
    XrSession session;
    std::mutex mutex;
    std::condition_variable changed;
    bool is_waiting = false, should_stop = false, has_stopped = false;  // under the lock, with the answer
    std::optional<WaitResult> wait_result;
  };
  static void run_thread(SharedState& shared);

  std::shared_ptr<SharedState> state_;
  std::thread thread_;
};

}  // namespace catena::render::xr
