// SPDX-License-Identifier: MIT
/// The Novint Falcon as a Device. A thread of its own owns the bus: newest force -> packet out, packets in -> newest pose, one
/// round trip after the other (1-2 ms); `read` and `write` exchange plain data with it through triple buffers and never wait.
///   force: converted with the Jacobian of the newest pose; zero when no force was written for `command_timeout_s` (an unresponsive servo;
///          the next read is `lost`, so that the force ramps in), after stop(), after three cycles without a frame, before homing, and
///          before the grip was pulled out past 0.170 m (forces_on is false)
///          A packet with a force that took longer than command_timeout_s to send (the program was stopped) is followed by a zero
///   watchdog: if one is given, a separate process watches the open device (watchdog_process.h) and cuts the force if this program is
///          stopped or killed, or this thread hangs. The force then stays cut until the haptic thread has acknowledged it: a read is
///          `lost`, so that the force ramps in. If its watchdog process does not run, the device gets no force
///   lost:  no frame for `lost_after_cycles` cycles, or unplugged; the thread then waits for the device, restarts its firmware, and
///          homing and arming start over
/// The destructor sends zero force with the LEDs off; it waits for at most some tenths of a second.
#pragma once
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "engine/base/clock.h"
#include "engine/base/triple_buffer.h"
#include "haptics/device/device.h"
#include "haptics/device/registry.h"
#include "haptics/device/usb/falcon_boot.h"
#include "haptics/device/usb/falcon_session.h"
#include "haptics/device/usb/watchdog_process.h"

namespace catena::haptics::usb {

/// Returns the time without a force command after which the force is cut: four periods of the servo, and no less than 20 ms.
inline double falcon_command_timeout_s(double rate_hz) { return rate_hz > 200 ? 0.02 : 4 / rate_hz; }

/// Options of Falcon::open.
struct FalconOptions {
  std::vector<std::uint8_t> firmware;  ///< validated image; empty: only a device whose firmware runs already
  FalconBootOptions boot{};            ///< its `progress` is called only during open()
  double force_gain = kFalconForceGain;
  double command_timeout_s = 0.02;
  int lost_after_cycles = 10;   ///< number of cycles in a row without a frame after which the device is `lost`
  double max_pose_age_s = 0.1;  ///< a pose this old is `lost`, whatever the I/O thread does
  /// Interval at which a lost device is looked for.
  int reconnect_poll_ms = 500;
  int realtime_priority = 0;    ///< SCHED_FIFO priority of the I/O thread, if permitted; 0: none
  WatchdogLauncher watchdog{};  ///< launched for each open device, when its firmware runs; empty: none
  FalconSession::Clock clock = now_ns;
};

/// Counters since the device was opened.
struct FalconStats {
  std::uint64_t cycles = 0, frames = 0, bad_cycles = 0;  ///< round trips; valid frames; round trips without a frame
  std::uint64_t packets_out = 0, packets_in = 0, idle_packets = 0;
  std::uint64_t resyncs = 0, dropped_bytes = 0;  ///< incomplete and dropped data of the open device
  std::uint64_t timeouts = 0, stalls = 0, retries = 0, errors = 0, line_errors = 0;
  /// rejected frames (jumps, out of reach); cycles whose force exceeded the motors; expired commands; firmware uploads; plug events
  std::uint64_t jumps = 0, out_of_reach = 0, saturated = 0, stale_commands = 0, uploads = 0, disconnects = 0, reconnects = 0;
  std::uint64_t takeovers = 0, watchdog_restarts = 0;  ///< the watchdog process cut the force; it was restarted after it had died
  bool realtime = false;
};

/// The device. read, write, resume: haptic thread; stop: any thread; status_text and stats: frame thread.
class Falcon final : public Device {
 public:
  /// Opens the device and starts its firmware (seconds, at most some tens of them; see options.boot.progress). An Error says what to do.
  static Result<std::unique_ptr<Falcon>> open(std::unique_ptr<TransportSource> source, FalconOptions options = {});
  ~Falcon() override;
  Falcon(const Falcon&) = delete;
  Falcon& operator=(const Falcon&) = delete;

  static DeviceCapabilities nominal_capabilities();

  const DeviceCapabilities& capabilities() const override { return capabilities_; }
  DeviceInput read() noexcept override;
  void write(const DeviceOutput& output) noexcept override;
  void stop() noexcept override { stopped_.store(true); }
  bool zero_force_confirmed() const noexcept override { return zero_force_confirmed_.load(); }
  void resume() noexcept override;

  std::string status_text() const override;
  FalconState state() const { return state_.load(std::memory_order_relaxed); }
  FalconStats stats() const;

 private:
  struct ForceCommand {
    Vec3 force_n{0.0};
    std::int64_t written_ns = 0;               ///< time of the command; 0: none yet
    std::uint64_t acknowledged_takeovers = 0;  ///< value of takeovers_ that the haptic thread had seen
  };

  Falcon(std::unique_ptr<TransportSource> source, FalconOptions options, std::unique_ptr<Transport> transport,
         std::unique_ptr<WatchdogSharedMemory> memory);
  void run() noexcept;
  void run_session() noexcept;
  void wait_for_reconnect() noexcept;
  void publish(const FalconPose& pose) noexcept;
  void set_problem(const std::string& text);
  bool has_fresh_command() noexcept;
  Outcome start_watchdog();
  bool ensure_watchdog(FalconSession& session) noexcept;
  bool handle_takeover(FalconSession& session, Ftdi& ftdi) noexcept;
  bool send(FalconSession& session, bool forces) noexcept;

  DeviceCapabilities capabilities_ = nominal_capabilities();
  FalconOptions options_;
  FalconCounters counters_;
  TripleBuffer<FalconPose> poses_;
  TripleBuffer<ForceCommand> force_commands_;
  const std::unique_ptr<WatchdogSharedMemory> watchdog_memory_;  ///< null: there is no watchdog
  std::atomic<std::uint64_t> takeovers_{0}, watchdog_restarts_{0};
  std::atomic<bool> unwatched_{false};
  std::atomic<bool> stopped_{false}, quit_{false}, realtime_{false};
  std::atomic<bool> zero_force_confirmed_{true};  ///< cleared before stopped_ is read: after stop(), true means that the zero is confirmed
  std::atomic<FalconState> state_{FalconState::booting};
  std::atomic<int> boot_attempt_{0}, boot_percent_{0};
  std::atomic<std::uint8_t> homed_{0};

  mutable std::mutex problem_mutex_;  ///< frame and I/O thread only
  std::string problem_;               ///< why the device is unavailable

  // I/O thread only
  std::unique_ptr<TransportSource> source_;
  std::unique_ptr<Transport> transport_;
  std::unique_ptr<ExternalWatchdog> watchdog_;  ///< declared after transport_: ended before that closes
  int cycles_until_check_ = 0;                  ///< cycles until the next check whether the watchdog process runs
  FalconPose pose_;
  bool had_fresh_command_ = false;
  std::thread thread_;

  // haptic thread only
  std::int64_t last_push_ns_ = 0;  ///< time of the last write, if its force was not zero; else 0
  std::uint64_t acknowledged_takeovers_ = 0;
};

/// Registry entries of the Falcon: which are on the bus, and how one is opened by its number. Off the tick.

/// Appends the devices on the USB bus as "falcon", "falcon:1", ...; a "falcon" that is not available if there is none.
void list_falcons(std::vector<DeviceInfo>& to);

/// Returns a FalconBootOptions::progress that reports the fraction of an upload to `on_message`, ten lines per attempt.
std::function<bool(int attempt, double share)> make_boot_progress_reporter(std::function<void(const std::string&)> on_message);

/// Opens a Falcon. `detail`: empty or "0" for the first one, "1" for the second.
Result<std::unique_ptr<Device>> open_falcon(const std::string& detail, const DeviceSettings& settings);

}  // namespace catena::haptics::usb
