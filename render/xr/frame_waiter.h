// SPDX-License-Identifier: MIT
/// Waits for frames on a separate thread: a runtime may block for seconds, during which the window must stay responsive. One wait at a
/// time.
#pragma once
#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "render/xr/xr_loader.h"

namespace catena::render::xr {

/// Thread that calls xrWaitFrame. To be used by the frame thread.
class FrameWaiter {
 public:
  struct WaitResult {
    XrResult result = XR_SUCCESS;
    XrFrameState state{};
  };

  FrameWaiter(PFN_xrWaitFrame wait, XrSession session);
  /// Waits for the runtime's answer, unless stop() returned false: a session must not be destroyed while it is in use.
  ~FrameWaiter();
  FrameWaiter(const FrameWaiter&) = delete;
  FrameWaiter& operator=(const FrameWaiter&) = delete;

  /// Requests a wait from the runtime, unless one is pending, and returns its result. nullopt if there is none within `patience` (nullopt:
  /// no time limit).
  std::optional<WaitResult> wait_for(std::optional<std::chrono::nanoseconds> patience);

  /// Stops the thread; no other calls may follow. Returns false if the runtime does not answer within `patience` (nullopt: no time limit):
  /// the call and the thread are then abandoned (deliberately leaked), and the session stays in use forever.
  bool stop(std::optional<std::chrono::nanoseconds> patience);

 private:
  /// State shared with the thread, which outlives the object if the thread is abandoned.
  struct SharedState {
    PFN_xrWaitFrame wait;
    XrSession session;
    std::mutex mutex;
    std::condition_variable changed;
    bool is_waiting = false, should_stop = false, has_stopped = false;  // guarded by the mutex, like the result
    std::optional<WaitResult> wait_result;
  };
  static void run_thread(SharedState& shared);

  std::shared_ptr<SharedState> state_;
  std::thread thread_;
};

}  // namespace catena::render::xr
