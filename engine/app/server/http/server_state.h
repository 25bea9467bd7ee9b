/// What the connections of a server share. The network thread owns all of it but `news`, which is locked. Part of engine/app/server/http
/// alone: it has Boost in it.
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

struct ServerState {
  explicit ServerState(const ServerOptions& wanted) : options(wanted), access(wanted.host_names) {}

  const ServerOptions options;
  const AccessControl access;
  int connections = 0;
  boost::asio::io_context io{1};
  std::map<ViewerId, std::shared_ptr<ViewerConnection>> viewers;
  ViewerId last_viewer = 0;
  struct OfferedFile {
    std::string target, path{};  ///< of a request, "/NAME"; of the file, empty: none
  } offered_file;

  std::mutex mutex;
  std::condition_variable event_posted;
  std::vector<ViewerEvent> events;    ///< under `mutex`
  std::atomic<int> ready_viewers{0};  ///< viewers that take a picture

  void post_event(ViewerEvent one);
  void update_ready_viewers();
};

/// One connection, counted as long as it lives.
class ConnectionGuard {
 public:
  explicit ConnectionGuard(ServerState& hub) : hub_(hub) { ++hub_.connections; }
  ~ConnectionGuard() { --hub_.connections; }
  ConnectionGuard(const ConnectionGuard&) = delete;
  ConnectionGuard& operator=(const ConnectionGuard&) = delete;

 private:
  ServerState& hub_;
};

/// Reads one request, answers it, and ends; a request for the WebSocket becomes a viewer.
void serve_connection(ServerState& hub, boost::asio::ip::tcp::socket socket);

}  // namespace catena::http
