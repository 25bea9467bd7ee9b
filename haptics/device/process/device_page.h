// SPDX-License-Identifier: MIT
/// Protocol between the program and a process that holds a haptic device for it: one page of shared memory, and a socket whose closing
/// reports that the other side has exited. Neither waits for the other: poses go one way and forces the other through triple buffers, so
/// that each side takes the newest value whenever it reads. Times are of CLOCK_MONOTONIC, which both processes share.
///   program: fills the request, starts the process, waits for kReady or kFailed on the socket; each tick takes a pose, writes a command
///   process: opens the device, describes it; each period takes the newest command, passes it to the device, and publishes a pose
/// The process cuts the force, until the program has acknowledged it, when the program outputs force and is unresponsive for
/// silence_timeout_ms (SIGSTOP, a hung thread), and at once when the program has exited (SIGKILL) or sets `stopped`.
#pragma once
#include <atomic>
#include <cstdint>

#include "engine/base/triple_buffer.h"
#include "haptics/device/device.h"

namespace catena::haptics::process {

/// Bytes sent by the process over the socket: the device is open, or could not be opened.
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

/// Pose from the device to the program.
struct DevicePose {
  DeviceInput input{};
  std::int64_t written_ns = 0;  ///< time of the pose; 0: none yet
};

/// Force command from the program to the device.
struct ForceCommand {
  DeviceOutput output{};
  std::uint32_t acknowledged_takeovers = 0;  ///< value of DevicePage::takeovers that the program had seen
};

/// Device::status_text(), truncated.
struct StatusText {
  char text[160]{};
};

/// The shared page.
struct DevicePage {
  static constexpr std::uint32_t kMagic = 0x56454443, kVersion = 2;

  // request, filled before the process starts
  std::uint32_t magic = kMagic, version = kVersion;
  std::uint32_t silence_timeout_ms = 50;
  double rate_hz = 1000, force_gain = 0;
  char device[256]{};     ///< a device name of the registry: "emulated-falcon:still"
  char firmware[1024]{};  ///< path of the firmware; empty: none

  // answer, filled before kReady or kFailed
  DeviceDescription description{};
  char error_text[512]{};         ///< with kFailed: one line
  bool is_machine_error = false;  ///< with kFailed: Error::machine, the machine failed

  // while both run
  TripleBuffer<DevicePose> poses;
  TripleBuffer<ForceCommand> commands;
  TripleBuffer<StatusText> status;
  std::atomic<std::uint32_t> stopped{0};  ///< written by the program, any thread: 1: no force until it is 0
  /// Written by the process: the device has confirmed a zero; cleared before `stopped` is read.
  std::atomic<std::uint32_t> zero_force_confirmed{1};
  std::atomic<std::uint32_t> takeovers{0};  ///< written by the process: how often it has cut the force of an unresponsive program
  std::atomic<int> table_error{0};          ///< written by the process: errno code, the force table has lost rows since; 0: none
};
static_assert(std::atomic<std::uint32_t>::is_always_lock_free);

}  // namespace catena::haptics::process
