// SPDX-License-Identifier: MIT
/// Watchdog process of a USB device, and the shared memory page between it and the program that drives the device. The program's threads
/// write to the page and the watchdog process polls it, so that a tick makes no system call.
///   written by the program   numbers of ticks and of packet exchanges; whether a packet with a force may be at the device
///   holder                   process that may write to the device: the program, or the watchdog after the program was unresponsive. The
///                            watchdog takes over by compare-and-exchange; the program takes it back by a store, after a zero-force packet
///                            of its own
/// All shared numbers are lock-free atomics, which work across processes.
#pragma once
#include <atomic>
#include <cstdint>

namespace catena::haptics::watchdog {

/// Process that may write to the device.
enum class Holder : std::uint32_t { program, watchdog };

/// Shared memory page.
struct SharedPage {
  static constexpr std::uint32_t kMagic = 0x47444f47;     ///< magic number of a valid page
  static constexpr std::size_t kMaxZeroPacketBytes = 64;  ///< maximum size of the zero-force packet

  // Set before the watchdog process starts.
  std::uint32_t magic = kMagic;                     ///< magic number
  std::uint32_t silence_timeout_ms = 50;            ///< time without a tick or a packet, while force_active, after which the watchdog acts
  std::uint32_t endpoint = 0;                       ///< address of the bulk OUT endpoint
  std::uint32_t zero_packet_bytes = 0;              ///< used bytes of zero_packet
  std::uint8_t zero_packet[kMaxZeroPacketBytes]{};  ///< packet that cuts the force

  // Written by the program's threads.
  std::atomic<std::uint32_t> ticks{0};   ///< haptic thread: number of force commands written
  std::atomic<std::uint32_t> cycles{0};  ///< I/O thread: number of round trips started
  /// 1: set before a packet with a force is sent; 0: a zero-force packet has been acknowledged
  std::atomic<std::uint32_t> force_active{0};

  std::atomic<Holder> holder{Holder::program};  ///< process that may write to the device

  // Written by the watchdog process.
  std::atomic<std::uint32_t> takeovers{0};           ///< number of times that the watchdog took over
  std::atomic<std::uint32_t> acknowledged_zeros{0};  ///< number of acknowledged zero-force packets
};
static_assert(std::atomic<std::uint32_t>::is_always_lock_free && std::atomic<Holder>::is_always_lock_free);
static_assert(sizeof(SharedPage) <= 4096);

/// Byte that the program sends on the lifeline, a stream socket, to end the watchdog, which then writes nothing to the device.
inline constexpr char kQuit = 'q';
/// Byte that the watchdog process sends on the lifeline when it has started to watch.
inline constexpr char kReady = 'r';

/// Reason why the watchdog ended: requested by the program; the program has exited; the device is disconnected.
enum class EndReason { requested, program_gone, device_gone };

/// Runs the watchdog: cuts the force where the program cannot.
///   The program is unresponsive while it outputs force (SIGSTOP, a hung I/O thread): takes over the device, sends the zero-force packet
///   until it is acknowledged, then repeats it every silence_timeout_ms until the program takes its device back.
///   The program has exited (SIGKILL, the out-of-memory killer): the lifeline closes; sends the zero-force packet until it has been
///   acknowledged twice.
/// Packets are sent by USBDEVFS_BULK on the same file description that the program has open. The interface stays claimed, the packet is
/// queued behind the program's transfers in progress, and only that request completes in the call. Asynchronous transfers, as libusb
/// submits them, share one completion queue with the program's, so that two processes would take each other's completions.
/// Returns when the program requests it or has exited, or when the device is disconnected. `usb`: descriptor of the device's usbfs node.
/// `messages`: descriptor to which one sentence is written after an intervention; < 0: none. No allocation, no exception.
EndReason run_watchdog(SharedPage& page, int usb, int lifeline, int messages) noexcept;

}  // namespace catena::haptics::watchdog
