// SPDX-License-Identifier: MIT
#include "haptics/device/spacemouse.h"

#include <poll.h>
#include <spnav.h>
#include <sys/socket.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>

#include "engine/base/result.h"
#include "engine/base/threads.h"

namespace catena::haptics {
namespace {

constexpr double kFullCounts = 350;
constexpr int kPacketBytes = 8 * sizeof(std::int32_t);
constexpr int kWait_ms = 20;      // longest delay until the thread notices that it must end
constexpr int kLookAgain = 25;    // number of waits between two checks for a daemon
std::atomic<bool> in_use{false};  // libspnav's connection is global

double share(std::int32_t counts, double dead_zone) noexcept {
  const double c = static_cast<double>(counts), size = std::fabs(c);
  if (!(size > dead_zone)) return 0;
  const double r = std::min(1.0, (size - dead_zone) / (kFullCounts - dead_zone));
  return c < 0 ? -r : r;
}

// Blocks SIGPIPE: a daemon that closes the connection during libspnav's greeting must not end the program.
bool connect_daemon() {
  sigset_t pipe, before;
  sigemptyset(&pipe);
  sigaddset(&pipe, SIGPIPE);
  pthread_sigmask(SIG_BLOCK, &pipe, &before);
  const bool connected = spnav_open() != -1;
  const timespec at_once{};
  while (sigismember(&before, SIGPIPE) == 0 && sigtimedwait(&pipe, nullptr, &at_once) > 0) {
  }
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  return connected;
}

bool is_socket(const char* path) {
  struct stat about {};
  return path != nullptr && stat(path, &about) == 0 && S_ISSOCK(about.st_mode);
}

}  // namespace

SpaceMouseRates compute_spacemouse_rates(const SpaceMouseCounts& counts, const SpaceMouseParameters& parameters) noexcept {
  const auto axis = [&](std::size_t i) { return share(counts.axes[i], parameters.dead_zone_counts); };
  return {Vec3(axis(0), axis(1), -axis(2)) * parameters.speed_m_per_s, Vec3(axis(3), axis(4), -axis(5)) * parameters.turn_rad_per_s};
}

DeviceCapabilities SpaceMouse::nominal_capabilities() {
  DeviceCapabilities out;
  out.name = "SpaceMouse";
  out.has_orientation = true;
  out.button_count = 2;
  return out;
}

// Checks the places where libspnav looks: its environment variable, a path in /etc/spnavrc, the daemon's default path.
bool SpaceMouse::is_daemon_available() {
  struct stat about {};
  return is_socket(std::getenv("SPNAV_SOCKET")) || is_socket("/var/run/spnav.sock") || stat("/etc/spnavrc", &about) == 0;
}

const char* SpaceMouse::daemon_missing_hint() { return "spacenavd is not running: install and start it (apt install spacenavd)"; }

Result<std::unique_ptr<Device>> SpaceMouse::open(const SpaceMouseParameters& parameters) {
  if (!is_daemon_available()) return Error{daemon_missing_hint()};
  if (in_use.exchange(true)) return Error{"the SpaceMouse is already in use; a single use was expected"};
  if (!connect_daemon()) {
    in_use = false;
    return Error{daemon_missing_hint()};
  }
  auto device = std::unique_ptr<SpaceMouse>(new SpaceMouse(parameters));
  CATENA_TRY(device->thread_, start_thread("the SpaceMouse", [mouse = device.get()] { mouse->listen(); }));
  return std::unique_ptr<Device>(std::move(device));
}

SpaceMouse::SpaceMouse(const SpaceMouseParameters& parameters) : parameters_(parameters), capabilities_(nominal_capabilities()) {
  CATENA_ASSERT(parameters.rate_hz > 0 && parameters.dead_zone_counts >= 0 && parameters.dead_zone_counts < kFullCounts);
  publish(true);
}

SpaceMouse::~SpaceMouse() {
  stop_ = true;
  if (thread_.joinable()) thread_.join();
  spnav_close();
  in_use = false;
}

DeviceInput SpaceMouse::read() noexcept {
  counts_.acquire();
  const SpaceMouseCounts& counts = counts_.front();
  DeviceInput input;
  if (counts.connected) {
    const SpaceMouseRates rates = compute_spacemouse_rates(counts, parameters_);
    const double dt = 1 / parameters_.rate_hz, maximum = 0.5 * capabilities_.workspace_m;
    for (int a = 0; a < 3; ++a) position_m_[a] = std::clamp(position_m_[a] + rates.velocity_m_per_s[a] * dt, -maximum, maximum);
    if (max_abs(rates.turn_rad_per_s) > 0) orientation_ = normalized(rotation_from_vector(rates.turn_rad_per_s * dt) * orientation_);
  } else {
    input.status = DeviceStatus::lost;
  }
  input.position_m = position_m_;
  input.orientation = orientation_;
  input.buttons = counts.buttons;
  return input;
}

void SpaceMouse::publish(bool connected) {
  if (!connected) current_counts_ = {};
  current_counts_.connected = connected;
  counts_.publish(current_counts_);
}

// Reads complete packets only: libspnav treats a partial packet as a complete one, and does not report the end of the connection.
bool SpaceMouse::receive_events() {
  char packet[kPacketBytes];
  while (!stop_) {
    const auto bytes = recv(spnav_fd(), packet, sizeof packet, MSG_PEEK | MSG_DONTWAIT);
    if (bytes == 0) return false;
    if (bytes < 0) return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR;
    if (bytes < kPacketBytes) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      return true;
    }
    spnav_event event{};
    const int type = spnav_poll_event(&event);
    if (type == SPNAV_EVENT_MOTION) {
      current_counts_.axes = {event.motion.x, event.motion.y, event.motion.z, event.motion.rx, event.motion.ry, event.motion.rz};
    } else if (type == SPNAV_EVENT_BUTTON) {
      const auto bit = event.button.bnum >= 0 && event.button.bnum < 32 ? 1u << event.button.bnum : 0u;
      current_counts_.buttons = event.button.press != 0 ? current_counts_.buttons | bit : current_counts_.buttons & ~bit;
    } else if (type == SPNAV_EVENT_DEV) {
      current_counts_.axes = {};  // plugged or unplugged while the daemon runs: the daemon does not report the release of a deflected axis
      current_counts_.buttons = 0;
    } else {
      continue;
    }
    publish(true);
  }
  return true;
}

void SpaceMouse::listen() {
  bool connected = true;
  for (int waits = 0; !stop_; ++waits) {
    if (connected) {
      pollfd waiting{spnav_fd(), POLLIN, 0};
      if (poll(&waiting, 1, kWait_ms) > 0 && !receive_events()) {
        spnav_close();
        publish(connected = false);
        waits = 0;
      }
      continue;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(kWait_ms));
    if (waits % kLookAgain == 0 && is_daemon_available() && connect_daemon()) publish(connected = true);
  }
}

}  // namespace catena::haptics
