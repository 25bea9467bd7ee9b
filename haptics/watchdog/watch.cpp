// SPDX-License-Identifier: MIT
#include "haptics/watchdog/watch.h"

#include <linux/usbdevice_fs.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <ctime>

namespace catena::haptics::watchdog {

namespace {

constexpr int kLookMs = 5, kWriteMs = 20;
constexpr int kOffsForTheGone = 2;  // zero-force packets after the program has exited: a packet in transit may corrupt the first one

std::int64_t now_ms() noexcept {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return std::int64_t{1000} * now.tv_sec + now.tv_nsec / 1000000;
}

void say(int messages, const char* sentence) noexcept {
  pollfd room{messages, POLLOUT, 0};
  if (messages < 0 || poll(&room, 1, 0) != 1 || (room.revents & POLLOUT) == 0) return;  // never waits for a reader
  [[maybe_unused]] const auto written = write(messages, sentence, std::strlen(sentence));
}

enum class Sent { yes, not_yet, gone };

Sent send_off(SharedPage& page, int usb) noexcept {
  usbdevfs_bulktransfer transfer{};
  transfer.ep = page.endpoint;
  transfer.len = std::min<std::uint32_t>(page.zero_packet_bytes, SharedPage::kMaxZeroPacketBytes);
  transfer.timeout = kWriteMs;
  transfer.data = page.zero_packet;
  const int sent = ioctl(usb, USBDEVFS_BULK, &transfer);
  if (sent == static_cast<int>(transfer.len)) {
    page.acknowledged_zeros.fetch_add(1, std::memory_order_acq_rel);
    return Sent::yes;
  }
  const int error = errno;
  if (sent >= 0) return Sent::not_yet;
  if (error == ENODEV || error == ESHUTDOWN || error == EBADF || error == ENOTTY || error == ENOENT) return Sent::gone;
  if (error == EPIPE) {
    unsigned endpoint = page.endpoint;
    ioctl(usb, USBDEVFS_CLEAR_HALT, &endpoint);
  }
  return Sent::not_yet;
}

/// Counter that must keep changing, and the time of its last change.
struct Beat {
  std::uint32_t last = 0;
  std::int64_t since_ms = 0;
  std::int64_t silent_ms(std::uint32_t count, std::int64_t now) noexcept {
    if (count != last) {
      last = count;
      since_ms = now;
    }
    return now - since_ms;
  }
};

enum class Line { quiet, quit, ended };

Line look(int lifeline, int wait_ms) noexcept {
  pollfd line{lifeline, POLLIN, 0};
  if (poll(&line, 1, wait_ms) <= 0 || line.revents == 0) return Line::quiet;
  char byte = 0;
  const auto n = read(lifeline, &byte, 1);
  if (n == 1) return byte == kQuit ? Line::quit : Line::quiet;
  return n < 0 && (errno == EINTR || errno == EAGAIN) ? Line::quiet : Line::ended;
}

EndReason program_gone(SharedPage& page, int usb, int messages) noexcept {
  const bool pushed = page.force_active.load(std::memory_order_acquire) != 0;
  for (int done = 0; done < kOffsForTheGone;) {
    const Sent sent = send_off(page, usb);
    if (sent == Sent::gone) return EndReason::device_gone;
    if (sent == Sent::yes) ++done;
    const timespec nap{0, 1000000};
    if (sent == Sent::not_yet) nanosleep(&nap, nullptr);
  }
  if (pushed) say(messages, "catena: the program ended while a force was on: the force was set to zero\n");
  return EndReason::program_gone;
}

}  // namespace

EndReason run_watchdog(SharedPage& page, int usb, int lifeline, int messages) noexcept {
  const std::int64_t silence_ms = page.silence_timeout_ms;
  Beat ticks{page.ticks.load(), now_ms()}, cycles{page.cycles.load(), now_ms()};
  bool holds = false, said = false;
  std::int64_t next_off_ms = 0;
  while (true) {
    const Line line = look(lifeline, kLookMs);
    if (line == Line::quit) return EndReason::requested;
    if (line == Line::ended) return program_gone(page, usb, messages);

    const std::int64_t now = now_ms();
    const std::int64_t silent = std::max(ticks.silent_ms(page.ticks.load(std::memory_order_acquire), now),
                                         cycles.silent_ms(page.cycles.load(std::memory_order_acquire), now));
    if (!holds) {
      // no force at the device: silence is allowed
      if (page.force_active.load(std::memory_order_acquire) == 0) ticks.since_ms = cycles.since_ms = now;
      Holder expected = Holder::program;
      if (silent < silence_ms || page.force_active.load(std::memory_order_acquire) == 0 ||
          !page.holder.compare_exchange_strong(expected, Holder::watchdog, std::memory_order_acq_rel))
        continue;
      holds = true;
      said = false;
      next_off_ms = now;
      page.takeovers.fetch_add(1, std::memory_order_acq_rel);
    }
    if (page.holder.load(std::memory_order_acquire) == Holder::program) {
      holds = false;
      ticks.since_ms = cycles.since_ms = now;
      continue;
    }
    if (now < next_off_ms) continue;
    const Sent sent = send_off(page, usb);
    if (sent == Sent::gone) return EndReason::device_gone;
    if (sent != Sent::yes) continue;
    next_off_ms = now + silence_ms;
    if (!said) say(messages, "catena: the program stopped responding while a force was on: the force is zero until the program responds\n");
    said = true;
  }
}

}  // namespace catena::haptics::watchdog
