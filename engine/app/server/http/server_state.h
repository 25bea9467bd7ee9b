// SPDX-License-Identifier: MIT
/// State shared by the connections of a server. Only the network thread uses it, except `events` (under `mutex`) and `ready_viewers`
/// (atomic). Private to engine/app/server/http, because it includes Boost.
#pragma once
#include <array>
#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "engine/app/server/http/access_control.h"
#include "engine/app/server/http/server.h"

namespace catena::http {

class ViewerConnection;
using Bytes = std::shared_ptr<const std::string>;

/// The shared state.
struct ServerState {
  explicit ServerState(const ServerOptions& initial_options) : options(initial_options), access(initial_options.host_names) {}

  const ServerOptions options;
  const AccessControl access;
  int connections = 0;
  boost::asio::io_context io{1};
  std::map<ViewerId, std::shared_ptr<ViewerConnection>> viewers;
  ViewerId last_viewer = 0;
  struct OfferedFile {
    /// The file that pages can download. `target`: of the request, "/NAME"; `path`: of the file, empty: none.
    std::string target, path{};
  } offered_file;

  std::mutex mutex;
  std::condition_variable event_posted;
  std::vector<ViewerEvent> events;    ///< Guarded by `mutex`
  std::atomic<int> ready_viewers{0};  ///< Number of viewers that can be sent a frame at once

  /// Adds an event and wakes the caller of Server::wait_for_events().
  void post_event(ViewerEvent event);
  /// Recounts ready_viewers.
  void update_ready_viewers();
};

/// Counts one connection during its lifetime.
class ConnectionGuard {
 public:
  explicit ConnectionGuard(ServerState& hub) : hub_(hub) { ++hub_.connections; }
  ~ConnectionGuard() { --hub_.connections; }
  ConnectionGuard(const ConnectionGuard&) = delete;
  ConnectionGuard& operator=(const ConnectionGuard&) = delete;

 private:
  ServerState& hub_;
};

/// Serves one connection: reads one request, answers it, and closes; a request for the WebSocket becomes a ViewerConnection.
void serve_connection(ServerState& hub, boost::asio::ip::tcp::socket socket);

}  // namespace catena::http
