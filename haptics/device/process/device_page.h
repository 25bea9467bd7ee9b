/// The protocol between the program and a process that holds a haptic device for it: one page of memory that both see, and a socket
/// whose end says that the other has gone. Neither waits for the other: poses go one way and forces the other through triple buffers, so
/// that each side takes the newest whenever it looks. The times in it are of CLOCK_MONOTONIC, which both processes share.
///   program: fills the request, starts the process, waits for kReady or kFailed on the socket; each tick takes a pose and puts an order
///   process: opens the device, describes it; each period takes the newest order, gives it to the device, and puts a pose
/// The force is taken away by the process, and stays away until the program has seen it, when the program pushes and is silent for
/// silence_timeout_ms (SIGSTOP, a hung thread), and at once when it has ended (SIGKILL) or says stop.
#pragma once
#include <atomic>
#include <cstdint>

#include "engine/base/triple_buffer.h"
#include "haptics/device/device.h"

namespace catena::haptics::process {

/// On the socket, from the process: one byte.
inline constexpr char kReady = 'r', kFailed = 'f';

/// DeviceCapabilities as plain data.
struct DeviceDescription {
  char name[64]{};
  double workspace_m = 0;
  Vec3 workspace_center_m{0.0};
  int button_count = 0;
  bool has_orientation = false, has_vibration = false;
  double max_force_n = 0, max_torque_nm = 0;
  Mechanics mechanics{};
};

/// From the device to the program.
struct DevicePose {
  DeviceInput input{};
  std::int64_t written_ns = 0;  ///< 0: never
};

/// From the program to the device.
struct ForceCommand {
  DeviceOutput output{};
  std::uint32_t acknowledged_takeovers = 0;  ///< of DevicePage::takeovers when it was written
};

/// Device::status_text(), cut.
struct StatusText {
  char text[160]{};
};

struct DevicePage {
  static constexpr std::uint32_t kMagic = 0x56454443, kVersion = 2;

  // the request: before the process starts
  std::uint32_t magic = kMagic, version = kVersion;
  std::uint32_t silence_timeout_ms = 50;
  double rate_hz = 1000, force_gain = 0;
  char device[256]{};     ///< a name of the registry: "emulated-falcon:still"
  char firmware[1024]{};  ///< a path; empty: none

  // the answer: before kReady or kFailed
  DeviceDescription description{};
  char error_text[512]{};         ///< with kFailed: one line
  bool is_machine_error = false;  ///< and whether the machine failed (Error::machine)

  // while both run
  TripleBuffer<DevicePose> poses;
  TripleBuffer<ForceCommand> commands;
  TripleBuffer<StatusText> status;
  std::atomic<std::uint32_t> stopped{0};               ///< program, any thread: 1: no force until it is 0
  std::atomic<std::uint32_t> zero_force_confirmed{1};  ///< process: the device has confirmed a zero; cleared before `stopped` is read
  std::atomic<std::uint32_t> takeovers{0};             ///< process: how often it has taken the force from a silent program
  std::atomic<int> table_error{0};                     ///< process: a code of errno: the table has lost rows since
};
static_assert(std::atomic<std::uint32_t>::is_always_lock_free);

}  // namespace catena::haptics::process
