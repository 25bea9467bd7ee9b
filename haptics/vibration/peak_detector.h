// SPDX-License-Identifier: MIT
/// Peaks of the force for devices that vibrate instead of outputting force: how much the force changed and how much of it is friction,
/// collected until a sender takes them at its own rate. A controller is sent some dozens of vibrations per second while the tick runs at
/// 1 kHz, so a detent of 2 ms would fall between two calls if the sender used only the newest tick.
///   change    c = |F_k - m_(k-1)|,  m_k = m_(k-1) + (dt/tau) (F_k - m_(k-1)): a step of the force counts in full, a ramp as its rate times
///             tau
///   friction  f = min(|F|, lost / path), with two sums that decay with tau: `lost` sums the decrease of the links' energy account, `path`
///             sums |dx|
///   speed     path / tau, while f > 0
/// The energy account (DeviceOutput::accounted_j) includes the energy stored in a spring, so that pressing into a surface is no friction;
/// only energy that the user loses permanently is. take_peaks() returns the largest c, and the largest f with its speed, of all ticks since
/// the last call. Newtons, meters of probe travel, seconds. `add`: haptic thread, no allocation, lock or throw, at most two attempts to
/// store; take_peaks: one other thread.
#pragma once
#include <atomic>
#include <cstdint>

#include "engine/base/vec.h"

namespace catena::haptics {

/// Peaks since the last call of take_peaks.
struct ForcePeaks {
  double change_n = 0;       ///< largest change c of the force
  double friction_n = 0;     ///< largest friction f
  double speed_m_per_s = 0;  ///< speed of the probe at that friction
};

/// Force and position of one tick.
struct ForceSample {
  /// DeviceOutput::requested_force_n: without damping and the limiter's ramps, so that neither motion in free space nor a ramp in is a
  /// peak.
  Vec3 requested_force_n{0.0};
  Vec3 position_m{0.0};    ///< position of the probe, meters of probe travel
  double accounted_j = 0;  ///< sum of the energy accounts of all links: energy given to the user plus energy stored
  bool is_live = true;     ///< false: forces are off, or there is no probe
};

/// Collects the peaks of the force. `add` on the haptic thread, `take_peaks` on one other thread; lock-free.
class PeakDetector {
 public:
  static constexpr double kTau_s = 0.01;  ///< time constant tau, seconds

  /// Creates a detector for ticks at this rate, > 0.
  explicit PeakDetector(double rate_hz = 1000);

  /// Adds one tick. Haptic thread. A tick that is not live or not finite adds no peak and resets the sums, so that the force at the return
  /// of the probe is no step.
  void add(const ForceSample& tick) noexcept;
  /// Returns the peaks since the last call and resets them. One other thread.
  ForcePeaks take_peaks() noexcept;

 private:
  double gain_;  ///< dt / tau, at most 1

  // haptic thread
  bool has_previous_ = false;  ///< the last tick was live and finite
  Vec3 mean_n_{0.0}, last_m_{0.0};
  double last_accounted_j_ = 0, lost_j_ = 0, path_m_ = 0;

  // Shared: one thread only raises a word, the other only sets it to zero. Each word packs two 32-bit floats and is ordered by the first.
  static_assert(std::atomic<std::uint64_t>::is_always_lock_free);
  std::atomic<std::uint64_t> change_{0}, friction_{0};
};

}  // namespace catena::haptics
