/// The page of memory that a program which drives a device and its watchdog process share. The program's threads store into it, the
/// process looks: no system call in a tick.
///   The program tells:    how often it has ticked and exchanged packets; whether a packet with a force may be at the device.
///   The holder            is who may write to the device: the program, or the watchdog once the program has been silent. The watchdog
///                         takes hold by compare-and-exchange; the program takes it back, by a store, after a zero of its own.
/// All numbers are lock-free atomics, which hold across processes.
#pragma once
#include <atomic>
#include <cstdint>

namespace catena::haptics::watchdog {

enum class Holder : std::uint32_t { program, watchdog };

struct SharedPage {
  static constexpr std::uint32_t kMagic = 0x47444f47;
  static constexpr std::size_t kMaxZeroPacketBytes = 64;

  // before the process starts
  std::uint32_t magic = kMagic;
  std::uint32_t silence_timeout_ms = 50;            ///< so long without a tick or a packet while `pushing`
  std::uint32_t endpoint = 0;                       ///< bulk OUT
  std::uint32_t zero_packet_bytes = 0;              ///< of `off`
  std::uint8_t zero_packet[kMaxZeroPacketBytes]{};  ///< the packet that takes the force away

  // the program's threads
  std::atomic<std::uint32_t> ticks{0};         ///< haptic thread: orders written
  std::atomic<std::uint32_t> cycles{0};        ///< I/O thread: round trips begun
  std::atomic<std::uint32_t> force_active{0};  ///< 1 before a packet with a force leaves; 0 once a zero has been acknowledged

  std::atomic<Holder> holder{Holder::program};

  // the watchdog
  std::atomic<std::uint32_t> takeovers{0};           ///< how often it has taken hold
  std::atomic<std::uint32_t> acknowledged_zeros{0};  ///< off packets that were acknowledged
};
static_assert(std::atomic<std::uint32_t>::is_always_lock_free && std::atomic<Holder>::is_always_lock_free);
static_assert(sizeof(SharedPage) <= 4096);

/// The watchdog process's work: takes the force away where the program cannot.
///   The program is silent while it pushes (SIGSTOP, a hung I/O thread): takes hold, and writes the off packet until it is
///   acknowledged, then again every silence_timeout_ms until the program takes its device back.
///   The program is gone (SIGKILL, the out-of-memory killer): the lifeline ends; writes the off packet until it is acknowledged, twice.
/// It writes by USBDEVFS_BULK on the very file description that the program has open. The interface stays claimed, the packet is queued
/// behind what the program has under way, and that request alone completes in the call: transfers submitted the other way, as libusb
/// does, share one queue of completions with the program's, and two processes would take each other's.
/// No allocation, no exception.

/// What the watchdog reads from the lifeline, a stream socket: told to end, it writes nothing.
inline constexpr char kQuit = 'q';
/// What it writes there when it watches.
inline constexpr char kReady = 'r';

enum class EndReason { requested, program_gone, device_gone };

/// Returns when the program says so, or is gone, or the device is. `usb`: the device's usbfs node. `messages`: where one sentence goes
/// when it has acted; < 0: nowhere.
EndReason run_watchdog(SharedPage& page, int usb, int lifeline, int messages) noexcept;

}  // namespace catena::haptics::watchdog
