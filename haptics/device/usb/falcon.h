/// The Novint Falcon as a Device. A thread of its own owns the bus: newest force -> packet out, packets in -> newest pose, one
/// round trip after the other (1-2 ms); `read` and `write` exchange plain data with it through triple buffers and never wait.
///   force: sent with the Jacobian of the newest pose; zero when no force was written for `command_timeout_s` (a servo that
///          hangs; the next read is `lost`, so that the force ramps in), after stop(), after three cycles without a frame, before
///          homing and before the grip was once pulled out past 0.170 m (forces_on is false)
///          A packet with a force that took longer than command_timeout_s on its way (the program was stopped) is followed by a zero
///   watchdog: where one is given, a process of its own watches over the open device (watchdog_process.h) and takes the force away if
///          this program is stopped or killed, or this thread hangs. When it has, the force stays away until the haptic thread has
///          seen it: a read is `lost`, so that the force ramps in. Without its watchdog process the device gets no force
///   lost:  silent for `lost_after_cycles` cycles, or unplugged; the thread then waits for the device to come back, starts its firmware
///          again, and homing and arming begin anew
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

/// After how long without an order the force is taken away: four periods of the servo, and no less than 20 ms.
inline double falcon_command_timeout_s(double rate_hz) { return rate_hz > 200 ? 0.02 : 4 / rate_hz; }

struct FalconOptions {
  std::vector<std::uint8_t> firmware;  ///< checked; empty: only a device that has some already
  FalconBootOptions boot{};            ///< its `progress` is told only while open() works
  double force_gain = kFalconForceGain;
  double command_timeout_s = 0.02;
  int lost_after_cycles = 10;   ///< cycles in a row without a frame
  double max_pose_age_s = 0.1;  ///< a pose this old is `lost`, whatever the I/O thread does
  int reconnect_poll_ms = 500;
  int realtime_priority = 0;    ///< of the I/O thread, SCHED_FIFO, if permitted; 0: none
  WatchdogLauncher watchdog{};  ///< for each open device, once its firmware runs; empty: none
  FalconSession::Clock clock = now_ns;
};

/// Counted since the device was opened.
struct FalconStats {
  std::uint64_t cycles = 0, frames = 0, bad_cycles = 0;  ///< round trips; frames understood; round trips without one
  std::uint64_t packets_out = 0, packets_in = 0, idle_packets = 0;
  std::uint64_t resyncs = 0, dropped_bytes = 0;  ///< of the open device
  std::uint64_t timeouts = 0, stalls = 0, retries = 0, errors = 0, line_errors = 0;
  /// frames that were not believed or are no place; cycles whose force was more than the motors have
  std::uint64_t jumps = 0, out_of_reach = 0, saturated = 0, stale_commands = 0, uploads = 0, disconnects = 0, reconnects = 0;
  std::uint64_t takeovers = 0, watchdog_restarts = 0;  ///< the watchdog process took the force away; it had died
  bool realtime = false;
};

class Falcon final : public Device {
 public:
  /// Opens, and starts the firmware (seconds, at most some tens of them; see options.boot.progress).
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
    std::int64_t written_ns = 0;               ///< 0: never
    std::uint64_t acknowledged_takeovers = 0;  ///< by the haptic thread, when it was written
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
  std::atomic<bool> zero_force_confirmed_{true};  ///< cleared before stopped_ is read: who stops and then finds it set waits for nothing
  std::atomic<FalconState> state_{FalconState::booting};
  std::atomic<int> boot_attempt_{0}, boot_percent_{0};
  std::atomic<std::uint8_t> homed_{0};

  mutable std::mutex problem_mutex_;  ///< frame and I/O thread only
  std::string problem_;               ///< why the device is not there

  // I/O thread only
  std::unique_ptr<TransportSource> source_;
  std::unique_ptr<Transport> transport_;
  std::unique_ptr<ExternalWatchdog> watchdog_;  ///< after transport_: told to end before it closes
  int cycles_until_check_ = 0;                  ///< cycles until the next look whether it lives
  FalconPose pose_;
  bool had_fresh_command_ = false;
  std::thread thread_;

  // haptic thread only
  std::int64_t last_push_ns_ = 0;  ///< the last write, if it was a force; 0: it was none
  std::uint64_t acknowledged_takeovers_ = 0;
};

/// The Falcon for the registry: which are on the bus, and how one is opened by its number. Off the tick.

/// Those on the USB bus as "falcon", "falcon:1", ...; a "falcon" that is not present where there is none.
void list_falcons(std::vector<DeviceInfo>& to);

/// Tells the share of an upload, ten lines a try; for FalconBootOptions::progress.
std::function<bool(int attempt, double share)> make_boot_progress_reporter(std::function<void(const std::string&)> tell);

/// `detail`: empty or "0" for the first one, "1" for the second.
Result<std::unique_ptr<Device>> open_falcon(const std::string& detail, const DeviceSettings& settings);

}  // namespace catena::haptics::usb
