/// The watchdog process's work: takes the force away where the program cannot.
///   The program is silent while it pushes (SIGSTOP, a hung I/O thread): takes hold, and writes the off packet until it is
///   acknowledged, then again every silence_ms until the program takes its device back.
///   The program is gone (SIGKILL, the out-of-memory killer): the lifeline ends; writes the off packet until it is acknowledged, twice.
/// It writes by USBDEVFS_BULK on the very file description that the program has open. The interface stays claimed, the packet is queued
/// behind what the program has under way, and that request alone completes in the call: transfers submitted the other way, as libusb
/// does, share one queue of completions with the program's, and two processes would take each other's.
/// No allocation, no exception.
#pragma once
#include "haptics/watchdog/page.h"

namespace catena::haptics::watchdog {

/// What the watchdog reads from the lifeline, a stream socket: told to end, it writes nothing.
inline constexpr char kQuit = 'q';
/// What it writes there when it watches.
inline constexpr char kReady = 'r';

enum class Ended { told, program_gone, device_gone };

/// Returns when the program says so, or is gone, or the device is. `usb`: the device's usbfs node. `messages`: where one sentence goes
/// when it has acted; < 0: nowhere.
Ended watch(Page& page, int usb, int lifeline, int messages) noexcept;

}  // namespace catena::haptics::watchdog
