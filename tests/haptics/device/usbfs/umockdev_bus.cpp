// SPDX-License-Identifier: MIT
#include "tests/haptics/device/usbfs/umockdev_bus.h"

#include <pty.h>
#include <termios.h>
#include <umockdev.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <set>
#include <stdexcept>

#include "engine/base/result.h"

namespace catena::haptics::tests {
namespace {

using Data = std::shared_ptr<UMockdevIoctlData>;

/// Memory of the client at a pointer within `data`; empty if the client was killed.
Data resolve(UMockdevIoctlData* data, std::size_t offset, std::size_t size) {
  UMockdevIoctlData* memory = umockdev_ioctl_data_resolve(data, offset, size, nullptr);
  return memory != nullptr ? Data(memory, g_object_unref) : Data();
}

/// One plug-in: its device node and its emulated usbfs.
class Plug final : public EmulatedUsbfs::Node {
 public:
  Plug(EmulatedPort& port, const std::string& node_path) : node_path_(node_path) {
    char name[256];
    const int opened = openpty(&master_, &slave_, name, nullptr, nullptr);
    CATENA_ASSERT(opened == 0);
    termios raw;
    tcgetattr(slave_, &raw);
    cfmakeraw(&raw);
    tcsetattr(slave_, TCSANOW, &raw);
    std::filesystem::create_directories(std::filesystem::path(node_path).parent_path());
    std::filesystem::create_symlink(name, node_path);
    usbfs_ = std::make_unique<EmulatedUsbfs>(port, *this);
  }
  ~Plug() override {
    usbfs_.reset();
    if (master_ >= 0) close(master_);
    close(slave_);
    std::error_code ignored;
    std::filesystem::remove(node_path_, ignored);
  }
  void ready(bool something_to_reap) override {
    if (master_ >= 0) tcflow(slave_, something_to_reap ? TCOON : TCOOFF);
  }
  void gone() override {
    if (master_ >= 0) close(master_);
    master_ = -1;
  }
  EmulatedUsbfs& usbfs() { return *usbfs_; }

  // used by umockdev's thread only; holds the URBs' data until they are reaped
  std::set<Data> held_;

 private:
  std::string node_path_;
  int master_ = -1, slave_ = -1;
  std::unique_ptr<EmulatedUsbfs> usbfs_;
};

void finish(UMockdevIoctlClient* client, int error, int value = 0) {
  umockdev_ioctl_client_complete(client, error == 0 ? value : -1, error);
}

int submit(Plug& plug, UMockdevIoctlData* argument) {
  const Data data = resolve(argument, 0, sizeof(usbdevfs_urb));
  if (data == nullptr) return EFAULT;
  auto* urb = reinterpret_cast<usbdevfs_urb*>(data->data);
  const auto length = static_cast<std::size_t>(urb->buffer_length);
  const Data buffer = resolve(data.get(), offsetof(usbdevfs_urb, buffer), length);
  if (buffer == nullptr && length > 0) return EFAULT;
  static std::uint8_t nothing[1];
  // queued before it can complete
  plug.held_.insert(data);
  const int error = plug.usbfs().submit({urb, buffer != nullptr ? buffer->data : nothing, data->client_addr, data.get()});
  if (error != 0) plug.held_.erase(data);
  return error;
}

int reap(Plug& plug, UMockdevIoctlData* argument) {
  EmulatedUsbfs::Urb urb;
  if (const int error = plug.usbfs().reap(urb); error != 0) return error;
  auto* data = static_cast<UMockdevIoctlData*>(urb.owner);
  const Data pointer = resolve(argument, 0, sizeof(void*));
  if (pointer != nullptr) umockdev_ioctl_data_set_ptr(pointer.get(), 0, data);
  // the argument holds it until it is written back
  std::erase_if(plug.held_, [&](const Data& held) { return held.get() == data; });
  return 0;
}

int bulk(Plug& plug, UMockdevIoctlData* argument, int& moved) {
  const Data data = resolve(argument, 0, sizeof(usbdevfs_bulktransfer));
  if (data == nullptr) return EFAULT;
  const auto* transfer = reinterpret_cast<const usbdevfs_bulktransfer*>(data->data);
  const Data bytes = resolve(data.get(), offsetof(usbdevfs_bulktransfer, data), transfer->len);
  std::size_t n = 0;
  const int error = bytes == nullptr ? EFAULT : plug.usbfs().bulk(transfer->ep, bytes->data, transfer->len, n);
  moved = static_cast<int>(n);
  return error;
}

}  // namespace

struct UmockdevBus::State {
  /// Guard for umockdev's thread: rejects requests of programs that outlive the bus.
  struct Door {
    std::mutex mutex;
    State* state = nullptr;
  };
  explicit State(const EmulatedFalconOptions& options) : port(options) {}

  static gboolean on_ioctl(UMockdevIoctlBase*, UMockdevIoctlClient* client, Door* door) {
    const std::scoped_lock lock(door->mutex);
    State* self = door->state;
    if (self == nullptr) return FALSE;
    Plug* plug = self->find(umockdev_ioctl_client_get_devnode(client));
    if (plug == nullptr) return FALSE;
    const gulong request = umockdev_ioctl_client_get_request(client);
    UMockdevIoctlData* argument = umockdev_ioctl_client_get_arg(client);
    if (request == USBDEVFS_SUBMITURB) {
      finish(client, submit(*plug, argument));
    } else if (request == USBDEVFS_REAPURBNDELAY || request == USBDEVFS_REAPURB) {
      finish(client, reap(*plug, argument));
    } else if (request == USBDEVFS_DISCARDURB) {
      finish(client, plug->usbfs().discard(*reinterpret_cast<std::uintptr_t*>(argument->data)));
    } else if (request == USBDEVFS_BULK) {
      int moved = 0;
      const int error = bulk(*plug, argument, moved);
      finish(client, error, moved);
    } else {
      const Data data = _IOC_SIZE(request) > 0 ? resolve(argument, 0, _IOC_SIZE(request)) : nullptr;
      finish(client, plug->usbfs().simple(request, data != nullptr ? data->data : nullptr));
    }
    return TRUE;
  }

  Plug* find(const std::string& node) {
    const std::scoped_lock lock(plugs_mutex);
    const auto at = plugs.find(node);
    return at == plugs.end() ? nullptr : at->second.get();
  }

  EmulatedPort port;
  UMockdevTestbed* testbed = nullptr;
  UMockdevIoctlBase* handler = nullptr;
  Door* door = nullptr;
  std::string root;
  std::mutex plugs_mutex;
  std::map<std::string, std::unique_ptr<Plug>> plugs;  ///< keyed by device node
  Plug* current = nullptr;
  std::string current_path;
  int last_number = 1;
};

// umockdev's own check needs a test bed and caches its first result
UmockdevBus::UmockdevBus(const EmulatedFalconOptions& options) : state_(std::make_unique<State>(options)) {
  const char* preloaded = std::getenv("LD_PRELOAD");
  if (preloaded == nullptr || std::string(preloaded).find("umockdev") == std::string::npos)
    throw std::runtime_error("run this program through umockdev-wrapper");
  state_->testbed = umockdev_testbed_new();
  gchar* root = umockdev_testbed_get_root_dir(state_->testbed);
  state_->root = root;
  g_free(root);
  state_->handler = umockdev_ioctl_base_new();
  state_->door = new State::Door{{}, state_.get()};  // deleted with the last reference to the handler
  const auto free_door = [](gpointer door, GClosure*) { delete static_cast<State::Door*>(door); };
  g_signal_connect_data(state_->handler, "handle-ioctl", G_CALLBACK(&State::on_ioctl), state_->door, free_door, GConnectFlags{});
}

UmockdevBus::~UmockdevBus() {
  if (state_->current != nullptr) unplug();
  for (const auto& [node, plug] : state_->plugs) umockdev_testbed_detach_ioctl(state_->testbed, node.c_str(), nullptr);
  {
    const std::scoped_lock lock(state_->door->mutex);
    state_->door->state = nullptr;
  }
  g_object_unref(state_->testbed);
  g_object_unref(state_->handler);
}

EmulatedPort& UmockdevBus::port() { return state_->port; }

void UmockdevBus::pump() {
  if (state_->current != nullptr) state_->current->usbfs().pump();
}

void UmockdevBus::plug(bool stays_powered) {
  CATENA_ASSERT(state_->current == nullptr);
  const bool first = state_->plugs.empty();
  if (!first) {
    const std::scoped_lock lock(state_->port.mutex);
    state_->port.device.plug(stays_powered);
  }
  const int number = ++state_->last_number;
  char digits[16];
  std::snprintf(digits, sizeof digits, "%03d", number);
  const std::string node = "/dev/bus/usb/001/" + std::string(digits);
  auto plug = std::make_unique<Plug>(state_->port, state_->root + node);
  state_->current = plug.get();
  {
    const std::scoped_lock lock(state_->plugs_mutex);
    state_->plugs.emplace(node, std::move(plug));
  }
  umockdev_testbed_attach_ioctl(state_->testbed, node.c_str(), state_->handler, nullptr);

  state_->current_path = "/devices/usb1/1-" + std::to_string(number);
  std::string hex;
  for (const std::uint8_t byte : EmulatedUsbfs::descriptors()) {
    char two[3];
    std::snprintf(two, sizeof two, "%02X", byte);
    hex += two;
  }
  const std::string text = "P: " + state_->current_path +
                           "\nE: SUBSYSTEM=usb\nE: DRIVER=usb\nE: DEVTYPE=usb_device\nE: BUSNUM=001\nE: DEVNUM=" + digits +
                           "\nE: DEVNAME=" + node + "\nA: busnum=1\\n\nA: devnum=" + std::to_string(number) +
                           "\\n\nA: bConfigurationValue=1\\n\nA: speed=12\\n\nA: idVendor=0403\\n\nA: idProduct=cb48\\n"
                           "\nA: product=FALCON HAPTIC\\n\nH: descriptors=" +
                           hex + "\n\n";
  GError* error = nullptr;
  umockdev_testbed_add_from_string(state_->testbed, text.c_str(), &error);
  CATENA_ASSERT(error == nullptr);
}

void UmockdevBus::unplug() {
  if (state_->current != nullptr) state_->current->usbfs().unplug();
  announce_removal();
}

void UmockdevBus::announce_removal() {
  CATENA_ASSERT(state_->current != nullptr);
  const std::string path = "/sys" + state_->current_path;
  umockdev_testbed_uevent(state_->testbed, path.c_str(), "remove");
  umockdev_testbed_remove_device(state_->testbed, path.c_str());
  state_->current = nullptr;
}

}  // namespace catena::haptics::tests
