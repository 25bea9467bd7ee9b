// SPDX-License-Identifier: MIT
#include "tests/haptics/device/usbfs/emulated_usbfs.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <string>

namespace catena::haptics::tests {
namespace {

// configuration; interface 0 with two endpoints; bulk IN; bulk OUT
constexpr std::uint8_t kConfiguration[] = {9,    2,    32,   0, 1, 1, 0,
                                           0xA0, 45,   9,    4, 0, 0, 2,
                                           0xFF, 0xFF, 0xFF, 2, 7, 5, EmulatedFalcon::kEndpointIn,
                                           2,    64,   0,    0, 7, 5, EmulatedFalcon::kEndpointOut,
                                           2,    64,   0,    0};

constexpr std::uint8_t kDevice[] = {18, 1, 0x00, 0x02, 0, 0, 0, 8, 0x03, 0x04, 0x48, 0xcb, 0x00, 0x06, 1, 2, 0, 1};

EmulatedUsbfs::Urb take_first(std::deque<EmulatedUsbfs::Urb>& queue) {
  const EmulatedUsbfs::Urb urb = queue.front();
  queue.pop_front();
  return urb;
}

std::vector<std::uint8_t> string_descriptor(int index) {
  if (index == 0) return {4, 3, 0x09, 0x04};
  const std::string text = index == 1 ? "Novint" : index == 2 ? "FALCON HAPTIC" : "";
  if (text.empty()) return {};
  std::vector<std::uint8_t> out{static_cast<std::uint8_t>(2 + 2 * text.size()), 3};
  for (const char c : text) out.insert(out.end(), {static_cast<std::uint8_t>(c), 0});
  return out;
}

}  // namespace

std::vector<std::uint8_t> EmulatedUsbfs::descriptors() {
  std::vector<std::uint8_t> all(std::begin(kDevice), std::end(kDevice));
  all.insert(all.end(), std::begin(kConfiguration), std::end(kConfiguration));
  return all;
}

EmulatedUsbfs::EmulatedUsbfs(EmulatedPort& port, Node& node) : port_(port), node_(node), latency_([this] { tick_latency(); }) {
  const std::scoped_lock lock(port_.mutex);
  node_.ready(false);
}

EmulatedUsbfs::~EmulatedUsbfs() {
  {
    const std::scoped_lock lock(port_.mutex);
    stop_ = true;
  }
  wake_.notify_all();
  latency_.join();
}

// the chip's latency timer: at each tick, a waiting IN URB without data gets the two status bytes
void EmulatedUsbfs::tick_latency() {
  std::unique_lock lock(port_.mutex);
  while (!stop_) {
    // a change of the latency takes effect at the next tick
    wake_.wait_until(lock, std::chrono::system_clock::now() + std::chrono::milliseconds(port_.device.latency_ms()));
    if (stop_ || !plugged_) continue;
    pump_locked();
    if (in_.empty() || !port_.faults.idle_packets) continue;
    const Urb urb = take_first(in_);
    std::uint8_t packet[EmulatedFalcon::kPacket];
    const std::size_t n = port_.device.bulk_in(packet);
    std::memcpy(urb.buffer, packet, std::min(n, static_cast<std::size_t>(urb.urb->buffer_length)));
    complete(urb, 0, n);
  }
}

void EmulatedUsbfs::complete(const Urb& urb, int status, std::size_t length) {
  urb.urb->status = status;
  urb.urb->actual_length = static_cast<int>(length);
  port_.counts.shut_down += status == -ESHUTDOWN;
  done_.push_back(urb);
  if (done_.size() == 1) node_.ready(true);
}

void EmulatedUsbfs::pump() {
  const std::scoped_lock lock(port_.mutex);
  pump_locked();
}

void EmulatedUsbfs::pump_locked() {
  if (!plugged_) return;
  EmulatedFalcon& device = port_.device;
  while (!out_.empty() && !port_.faults.out_naks && device.plugged()) {
    const Urb urb = take_first(out_);
    const auto n = static_cast<std::size_t>(urb.urb->buffer_length);
    if (device.halted(EmulatedFalcon::kEndpointOut)) {
      complete(urb, -EPIPE, 0);
      continue;
    }
    device.bulk_out({urb.buffer, n});
    complete(urb, device.plugged() ? 0 : -ESHUTDOWN, device.plugged() ? n : 0);
  }
  if (!device.plugged()) {
    unplug_locked();
    return;
  }
  while (!in_.empty()) {
    const bool halted = device.halted(EmulatedFalcon::kEndpointIn);
    if (!halted && !device.has_payload()) break;
    const Urb urb = take_first(in_);
    if (halted) {
      complete(urb, -EPIPE, 0);
      continue;
    }
    // a full packet continues the transfer, a short one ends it; one that does not fit is babble
    const auto room = static_cast<std::size_t>(urb.urb->buffer_length);
    std::size_t filled = 0, n = EmulatedFalcon::kPacket;
    while (n == EmulatedFalcon::kPacket && filled < room && device.has_payload()) {
      std::uint8_t packet[EmulatedFalcon::kPacket];
      n = device.bulk_in(packet);
      std::memcpy(urb.buffer + filled, packet, std::min(n, room - filled));
      filled += n;
    }
    complete(urb, filled > room ? -EOVERFLOW : 0, std::min(filled, room));
  }
}

void EmulatedUsbfs::unplug() {
  const std::scoped_lock lock(port_.mutex);
  port_.device.unplug();
  unplug_locked();
}

void EmulatedUsbfs::unplug_locked() {
  if (!plugged_) return;
  plugged_ = false;
  for (std::deque<Urb>* queue : {&out_, &in_}) {
    for (const Urb& urb : *queue) complete(urb, -ESHUTDOWN, 0);
    queue->clear();
  }
  node_.gone();
}

int EmulatedUsbfs::submit(const Urb& urb) {
  const std::scoped_lock lock(port_.mutex);
  ++port_.counts.submitted;
  if (!plugged_) {
    ++port_.counts.after_unplug;
    return ENODEV;
  }
  if (port_.faults.submit_errors > 0) {
    --port_.faults.submit_errors;
    return ENOMEM;
  }
  if (urb.urb->type == USBDEVFS_URB_TYPE_CONTROL) {
    control(urb);
    pump_locked();
    return 0;
  }
  if (urb.urb->type != USBDEVFS_URB_TYPE_BULK) return EINVAL;
  if (urb.urb->endpoint == EmulatedFalcon::kEndpointOut)
    out_.push_back(urb);
  else if (urb.urb->endpoint == EmulatedFalcon::kEndpointIn)
    in_.push_back(urb);
  else
    return ENOENT;
  pump_locked();
  return 0;
}

int EmulatedUsbfs::reap(Urb& urb) {
  const std::scoped_lock lock(port_.mutex);
  if (done_.empty()) return plugged_ ? EAGAIN : ENODEV;
  urb = take_first(done_);
  ++port_.counts.reaped;
  if (done_.empty() && plugged_) node_.ready(false);
  return 0;
}

int EmulatedUsbfs::bulk(unsigned endpoint, std::uint8_t* data, std::size_t size, std::size_t& moved) {
  const std::scoped_lock lock(port_.mutex);
  ++port_.counts.bulks;
  EmulatedFalcon& device = port_.device;
  if (!plugged_) return ENODEV;
  if (endpoint != EmulatedFalcon::kEndpointOut) return ENOENT;
  pump_locked();
  if (!out_.empty() || port_.faults.out_naks) return ETIMEDOUT;
  if (device.halted(EmulatedFalcon::kEndpointOut)) return EPIPE;
  device.bulk_out({data, size});
  pump_locked();
  if (!plugged_) return ESHUTDOWN;
  moved = size;
  return 0;
}

int EmulatedUsbfs::discard(std::uintptr_t client) {
  const std::scoped_lock lock(port_.mutex);
  for (std::deque<Urb>* queue : {&in_, &out_})
    for (auto at = queue->begin(); at != queue->end(); ++at)
      if (at->client == client) {
        const Urb urb = *at;
        queue->erase(at);
        ++port_.counts.discarded;
        complete(urb, -ENOENT, 0);
        return 0;
      }
  return plugged_ ? EINVAL : ENODEV;
}

void EmulatedUsbfs::control(const Urb& urb) {
  const std::uint8_t* setup = urb.buffer;
  const auto word = [&](int at) { return static_cast<std::uint16_t>(setup[at] | setup[at + 1] << 8); };
  if ((setup[0] & 0x60) == 0x40) {
    const bool known = word(6) == 0 && port_.device.control({setup[0], setup[1], word(2), word(4)});
    complete(urb, known ? 0 : -EPIPE, 0);
    return;
  }
  std::size_t length = 0;
  const int error = standard_control(setup, urb.buffer + 8, std::min<std::size_t>(word(6), urb.urb->buffer_length - 8), length);
  complete(urb, -error, length);
}

int EmulatedUsbfs::standard_control(const std::uint8_t* setup, std::uint8_t* data, std::size_t room, std::size_t& length) {
  std::vector<std::uint8_t> answer;
  if (setup[0] == 0x80 && setup[1] == 6) {
    const std::vector<std::uint8_t> all = descriptors();
    if (setup[3] == 1) answer.assign(all.begin(), all.begin() + 18);
    if (setup[3] == 2) answer.assign(all.begin() + 18, all.end());
    if (setup[3] == 3) answer = string_descriptor(setup[2]);
  } else if (setup[0] == 0x80 && setup[1] == 8) {
    answer = {1};
  }
  if (answer.empty()) return EPIPE;
  length = std::min(answer.size(), room);
  std::copy_n(answer.begin(), length, data);
  return 0;
}

int EmulatedUsbfs::simple(unsigned long request, void* data) {
  const std::scoped_lock lock(port_.mutex);
  if (!plugged_) return ENODEV;
  switch (request) {
    case USBDEVFS_GET_CAPABILITIES:
      *static_cast<std::uint32_t*>(data) =
          USBDEVFS_CAP_ZERO_PACKET | USBDEVFS_CAP_BULK_CONTINUATION | USBDEVFS_CAP_NO_PACKET_SIZE_LIM | USBDEVFS_CAP_REAP_AFTER_DISCONNECT;
      return 0;
    case USBDEVFS_CLAIMINTERFACE:
    case USBDEVFS_DISCONNECT_CLAIM:
      if (port_.faults.claimed_by_another) return EBUSY;
      ++port_.counts.claims;
      return *static_cast<unsigned*>(data) == 0 ? 0 : EINVAL;
    case USBDEVFS_RELEASEINTERFACE:
      ++port_.counts.releases;
      return 0;
    case USBDEVFS_CLEAR_HALT:
    case USBDEVFS_RESETEP:
      port_.device.clear_halt(static_cast<std::uint8_t>(*static_cast<unsigned*>(data)));
      ++port_.counts.clear_halts;
      return 0;
    case USBDEVFS_SETCONFIGURATION:
    case USBDEVFS_RESET:
      return 0;
    case USBDEVFS_GETDRIVER:
    case USBDEVFS_IOCTL:
      return ENODATA;  // no kernel driver is bound
    case USBDEVFS_CONNECTINFO:
      *static_cast<usbdevfs_connectinfo*>(data) = {.devnum = 2, .slow = 0};
      return 0;
    case USBDEVFS_CONTROL: {
      auto* transfer = static_cast<usbdevfs_ctrltransfer*>(data);
      const std::uint8_t setup[8] = {transfer->bRequestType, transfer->bRequest, static_cast<std::uint8_t>(transfer->wValue),
                                     static_cast<std::uint8_t>(transfer->wValue >> 8)};
      std::size_t length = 0;
      return standard_control(setup, static_cast<std::uint8_t*>(transfer->data), transfer->wLength, length);
    }
    default:
      return ENOTTY;
  }
}

}  // namespace catena::haptics::tests
