/// What a hand that cannot be pushed is told of the force: how much it changed and how much of it rubbed, as peaks that a sender takes at
/// its own pace. A controller vibrates some dozens of times a second while the tick runs at 1 kHz, so a detent of 2 ms would fall between
/// two calls if the sender looked at the newest tick alone.
///   change    c = |F_k - m_(k-1)|,  m_k = m_(k-1) + (dt/tau) (F_k - m_(k-1))       a step of force counts whole, a ramp as its rate times
///   tau friction  f = min(|F|, lost / way),  both sums that fade with tau:  lost of what the links' ledger falls by, way of |dx| speed way
///   / tau, while f > 0
/// The ledger (DeviceOutput::accounted_j) keeps what a spring stores, so that pressing into a surface is no friction; only what the hand
/// loses for good is. `take` gives the largest c, and the largest f with its speed, of all ticks since the last `take`.
/// Newtons, metres of hand, seconds. `add`: haptic thread, no allocation, lock or throw, at most two tries to store; `take`: one other
/// thread.
#pragma once
#include <atomic>
#include <cstdint>

#include "engine/base/vec.h"

namespace catena::haptics {

/// Since the last time that somebody asked.
struct ForcePeaks {
  double change_n = 0;
  double friction_n = 0;
  double speed_m_per_s = 0;  ///< of the hand at that friction
};

/// A tick as the hand has it.
struct ForceSample {
  Vec3 requested_force_n{
      0.0};  ///< DeviceOutput::requested_force_n: a hand that waves in the air, or waits while forces rise, is told nothing
  Vec3 position_m{0.0};
  double accounted_j = 0;  ///< of all links: what they have given to the hand and have ready for it
  bool is_live = true;     ///< false: forces are off, or the hand is not there
};

class PeakDetector {
 public:
  static constexpr double kTau_s = 0.01;

  explicit PeakDetector(double rate_hz = 1000);

  /// Haptic thread. A tick that is not live, or not finite, tells nothing and begins anew: what is there when the hand comes back is no
  /// step.
  void add(const ForceSample& tick) noexcept;
  /// One other thread.
  ForcePeaks take_peaks() noexcept;

 private:
  double gain_;  ///< dt / tau, at most 1

  // haptic thread
  bool has_previous_ = false;  ///< the last tick was live
  Vec3 mean_n_{0.0}, last_m_{0.0};
  double last_accounted_j_ = 0, lost_j_ = 0, path_m_ = 0;

  // shared: each is only raised by one thread and only zeroed by the other. Two floats of 32 bits in one word, the first decides.
  static_assert(std::atomic<std::uint64_t>::is_always_lock_free);
  std::atomic<std::uint64_t> change_{0}, friction_{0};
};

}  // namespace catena::haptics
