// SPDX-License-Identifier: MIT
#include "haptics/device/usb/libusb_transport.h"

#include <fmt/format.h>
#include <libusb.h>
#include <poll.h>

#include <algorithm>
#include <chrono>
#include <thread>

namespace catena::haptics::usb {
namespace {

constexpr unsigned char kOut = 0x02, kIn = 0x81;
constexpr std::uint8_t kVendorOut = 0x40;
constexpr int kInterface = 0, kControlMs = 500;

UsbError to_error(int code) noexcept {
  switch (code) {
    case LIBUSB_SUCCESS:
      return UsbError::none;
    case LIBUSB_ERROR_TIMEOUT:
      return UsbError::timeout;
    case LIBUSB_ERROR_PIPE:
      return UsbError::stall;
    case LIBUSB_ERROR_NO_DEVICE:
      return UsbError::disconnected;
    default:
      return UsbError::other;
  }
}

Result<std::shared_ptr<libusb_context>> make_context() {
  libusb_context* context = nullptr;
  if (const int code = libusb_init(&context); code != 0)
    return Error{
        fmt::format("USB cannot be used: {}; a machine with a USB bus that this user may access was expected", libusb_strerror(code))};
  return std::shared_ptr<libusb_context>(context, libusb_exit);
}

struct DeviceUnref {
  void operator()(libusb_device* device) const { libusb_unref_device(device); }
};
using DevicePtr = std::unique_ptr<libusb_device, DeviceUnref>;
struct HandleClose {
  void operator()(libusb_device_handle* handle) const { libusb_close(handle); }
};
using HandlePtr = std::unique_ptr<libusb_device_handle, HandleClose>;

// Device with a given id: its handle and file descriptor, or libusb's error code if it cannot be opened.
struct Candidate {
  DevicePtr device;
  HandlePtr handle;
  int code = 0;
  int fd = -1;
};

void on_pollfd(int fd, short events, void* at) {
  if ((events & POLLOUT) != 0) *static_cast<int*>(at) = fd;
}

// Opens a device. libusb announces the file that it opens and polls (POLLOUT: a transfer is complete) only by this callback.
int open_with_file(libusb_context* context, libusb_device* device, libusb_device_handle*& handle, int& fd) {
  libusb_set_pollfd_notifiers(context, on_pollfd, nullptr, &fd);
  const int code = libusb_open(device, &handle);
  libusb_set_pollfd_notifiers(context, nullptr, nullptr, nullptr);
  return code;
}

std::string place(libusb_device* device) {
  return fmt::format("USB bus {}, address {}", libusb_get_bus_number(device), libusb_get_device_address(device));
}

std::string why_not(const UsbId& id, int code) {
  if (code == LIBUSB_ERROR_ACCESS)
    return fmt::format(
        "no permission; as root add the line SUBSYSTEM==\"usb\", ATTR{{idVendor}}==\"{:04x}\", ATTR{{idProduct}}==\"{:04x}\", "
        "MODE=\"0660\", TAG+=\"uaccess\" to /etc/udev/rules.d/60-catena.rules, run udevadm control --reload, and plug the device in again",
        id.vendor, id.product);
  if (code == LIBUSB_ERROR_BUSY) return "another program uses the device; close this program first";
  return libusb_strerror(code);
}

bool says_another_name(libusb_device_handle* handle, libusb_device* device, const std::string& expected) {
  libusb_device_descriptor descriptor{};
  if (expected.empty() || libusb_get_device_descriptor(device, &descriptor) != 0 || descriptor.iProduct == 0) return false;
  unsigned char text[128];
  const int length = libusb_get_string_descriptor_ascii(handle, descriptor.iProduct, text, sizeof text);
  return length > 0 && std::string(text, text + length) != expected;
}

std::vector<Candidate> candidates(libusb_context* context, const UsbId& id) {
  std::vector<Candidate> found;
  libusb_device** all = nullptr;
  const auto n = libusb_get_device_list(context, &all);
  if (n < 0) return found;
  for (std::ptrdiff_t i = 0; i < n; ++i) {
    DevicePtr device(all[i]);
    libusb_device_descriptor descriptor{};
    if (libusb_get_device_descriptor(device.get(), &descriptor) != 0 || descriptor.idVendor != id.vendor ||
        descriptor.idProduct != id.product)
      continue;
    libusb_device_handle* handle = nullptr;
    int fd = -1;
    const int code = open_with_file(context, device.get(), handle, fd);
    HandlePtr opened(code == 0 ? handle : nullptr);
    if (code == 0 && says_another_name(handle, device.get(), id.product_string)) continue;
    found.push_back({std::move(device), std::move(opened), code, fd});
  }
  libusb_free_device_list(all, 0);
  std::sort(found.begin(), found.end(), [](const Candidate& a, const Candidate& b) {
    const auto key = [](libusb_device* d) { return libusb_get_bus_number(d) * 256 + libusb_get_device_address(d); };
    return key(a.device.get()) < key(b.device.get());
  });
  return found;
}

int claim(libusb_device_handle* handle) {
  libusb_set_auto_detach_kernel_driver(handle, 1);  // on systems without it there is nothing to detach
  return libusb_claim_interface(handle, kInterface);
}

int on_arrival(libusb_context*, libusb_device*, libusb_hotplug_event, void* flag) {
  static_cast<std::atomic<bool>*>(flag)->store(true);
  return 0;
}

}  // namespace

Result<std::vector<UsbDeviceInfo>> list_usb(const UsbId& id) {
  CATENA_TRY(const auto context, make_context());
  std::vector<UsbDeviceInfo> listed;
  for (Candidate& candidate : candidates(context.get(), id)) {
    int code = candidate.code;
    if (code == 0) code = claim(candidate.handle.get());
    if (code == 0) libusb_release_interface(candidate.handle.get(), kInterface);
    listed.push_back({code == 0, place(candidate.device.get()) + (code == 0 ? "" : ": " + why_not(id, code))});
  }
  return listed;
}

// ---- the open device ----

LibusbTransport::LibusbTransport(std::shared_ptr<libusb_context> context, libusb_device_handle* handle, int fd)
    : context_(std::move(context)), handle_(handle), fd_(fd) {}

LibusbTransport::~LibusbTransport() {
  libusb_release_interface(handle_, kInterface);
  libusb_close(handle_);
}

Result<std::unique_ptr<LibusbTransport>> LibusbTransport::wrap(int fd) {
  libusb_set_option(nullptr, LIBUSB_OPTION_NO_DEVICE_DISCOVERY);
  CATENA_TRY(auto context, make_context());
  libusb_device_handle* handle = nullptr;
  if (const int code = libusb_wrap_sys_device(context.get(), fd, &handle); code != 0)
    return Error{fmt::format("the file of the USB device cannot be used: {}; an open usbfs node was expected", libusb_strerror(code))};
  if (const int code = claim(handle); code != 0) {
    libusb_close(handle);
    return Error{fmt::format("the USB device cannot be claimed: {}", libusb_strerror(code))};
  }
  return std::unique_ptr<LibusbTransport>(new LibusbTransport(std::move(context), handle, fd));
}

UsbError LibusbTransport::control(std::uint8_t request, std::uint16_t value) noexcept {
  const int code = libusb_control_transfer(handle_, kVendorOut, request, value, 0, nullptr, 0, kControlMs);
  return to_error(std::min(code, 0));
}

UsbTransferResult LibusbTransport::write(std::span<const std::uint8_t> bytes, int timeout_ms) noexcept {
  int moved = 0;
  // libusb takes a non-const pointer, but does not write for OUT
  const int code = libusb_bulk_transfer(handle_, kOut, const_cast<unsigned char*>(bytes.data()), static_cast<int>(bytes.size()), &moved,
                                        static_cast<unsigned>(timeout_ms));
  return {to_error(code), static_cast<std::size_t>(std::max(moved, 0))};
}

UsbTransferResult LibusbTransport::read(UsbPacket& packet, int timeout_ms) noexcept {
  int moved = 0;
  const int code =
      libusb_bulk_transfer(handle_, kIn, packet.data(), static_cast<int>(packet.size()), &moved, static_cast<unsigned>(timeout_ms));
  return {to_error(code), static_cast<std::size_t>(std::max(moved, 0))};
}

UsbError LibusbTransport::clear_halt(UsbEndpoint endpoint) noexcept {
  return to_error(libusb_clear_halt(handle_, endpoint == UsbEndpoint::out ? kOut : kIn));
}

// ---- transport source ----

LibusbTransportSource::LibusbTransportSource(UsbId id, int index) : id_(std::move(id)), index_(index) {
  auto context = make_context();
  if (!context) {
    context_error_ = context.error().message;
    return;
  }
  context_ = std::move(*context);
  if (libusb_has_capability(LIBUSB_CAP_HAS_HOTPLUG) == 0) return;
  libusb_hotplug_callback_handle handle = 0;
  if (libusb_hotplug_register_callback(context_.get(), LIBUSB_HOTPLUG_EVENT_DEVICE_ARRIVED, 0, id_.vendor, id_.product,
                                       LIBUSB_HOTPLUG_MATCH_ANY, on_arrival, &arrived_, &handle) == 0)
    hotplug_ = handle;
}

LibusbTransportSource::~LibusbTransportSource() {
  if (hotplug_ != 0) libusb_hotplug_deregister_callback(context_.get(), hotplug_);
}

Result<std::unique_ptr<Transport>> LibusbTransportSource::open() {
  if (!context_) return Error{context_error_};
  arrived_ = false;
  std::vector<Candidate> found = candidates(context_.get(), id_);
  if (found.size() <= static_cast<std::size_t>(index_))
    return Error{
        fmt::format("{} is not on the USB bus ({} of {:04x}:{:04x} found, number {} was expected); connect the USB cable and the power",
                    id_.product_string, found.size(), id_.vendor, id_.product, index_ + 1)};
  Candidate& chosen = found[static_cast<std::size_t>(index_)];
  int code = chosen.code;
  if (code == 0) code = claim(chosen.handle.get());
  if (code != 0)
    return Error{fmt::format("{} at {} cannot be opened: {}", id_.product_string, place(chosen.device.get()), why_not(id_, code))};
  return std::unique_ptr<Transport>(new LibusbTransport(context_, chosen.handle.release(), chosen.fd));
}

bool LibusbTransportSource::wait_for_arrival(int timeout_ms) noexcept {
  timeval time{.tv_sec = timeout_ms / 1000, .tv_usec = 1000 * (timeout_ms % 1000)};
  const bool waited = hotplug_ != 0 && !arrived_ && libusb_handle_events_timeout_completed(context_.get(), &time, nullptr) == 0;
  if (!waited && !arrived_) std::this_thread::sleep_for(std::chrono::milliseconds(timeout_ms));
  return arrived_.exchange(false);
}

}  // namespace catena::haptics::usb
