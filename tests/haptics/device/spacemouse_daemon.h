// SPDX-License-Identifier: MIT
/// An emulated spacenavd: an AF_UNIX stream of eight 32-bit words per event, after a greeting to which newer daemons reply.
#pragma once
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

namespace catena::test {

class SpaceMouseDaemon {
 public:
  enum { motion = 0, press = 1, release = 2, device = 3 };

  explicit SpaceMouseDaemon(const std::string& path) : path_(path) {
    setenv("SPNAV_SOCKET", path.c_str(), 1);
    listener_ = socket(AF_UNIX, SOCK_STREAM, 0);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path.copy(address.sun_path, sizeof address.sun_path - 1);
    is_listening_ = bind(listener_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 && listen(listener_, 1) == 0;
  }
  ~SpaceMouseDaemon() {
    disconnect();
    close(listener_);
    unlink(path_.c_str());
    unsetenv("SPNAV_SOCKET");
  }
  bool is_listening() const { return is_listening_; }

  /// Accepts one connection; replies to the greeting if `answers` (newer protocol). False: no connection within 3 s.
  bool accept_client(bool answers) {
    pollfd waiting{listener_, POLLIN, 0};
    if (poll(&waiting, 1, 3000) <= 0) return false;
    client_ = accept(listener_, nullptr, nullptr);
    std::int32_t greeting = 0;
    if (recv(client_, &greeting, sizeof greeting, MSG_WAITALL) != sizeof greeting) return false;
    if (answers) return send(client_, &greeting, sizeof greeting, MSG_NOSIGNAL) == sizeof greeting;
    float sensitivity = 0;  // the old protocol accepts only sensitivities
    return recv(client_, &sensitivity, sizeof sensitivity, MSG_WAITALL) == sizeof sensitivity && sensitivity == 1.0f;
  }
  bool send_packet(const std::array<std::int32_t, 8>& packet, std::size_t first = 0, std::size_t bytes = 32) {
    const char* data = reinterpret_cast<const char*>(packet.data());
    return send(client_, data + first, bytes, MSG_NOSIGNAL) == static_cast<ssize_t>(bytes);
  }
  void disconnect() {
    if (client_ >= 0) close(client_);
    client_ = -1;
  }

 private:
  std::string path_;
  int listener_ = -1, client_ = -1;
  bool is_listening_ = false;
};

}  // namespace catena::test
