/// What the connections of a server share. The network thread owns all of it but `news`, which is locked. Part of engine/web alone: it has
/// Boost in it.
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

#include "engine/web/access.h"
#include "engine/web/server.h"

namespace catena::web {

class ViewerLink;
using Bytes = std::shared_ptr<const std::string>;

struct Hub {
  explicit Hub(const ServerOptions& wanted) : options(wanted), access(wanted.names) {}

  const ServerOptions options;
  const Access access;
  int connections = 0;
  boost::asio::io_context io{1};
  std::map<ViewerId, std::shared_ptr<ViewerLink>> viewers;
  ViewerId last_viewer = 0;
  struct Offered {
    std::string target, path{};  ///< of a request, "/NAME"; of the file, empty: none
  } offered;

  std::mutex mutex;
  std::condition_variable happened;
  std::vector<News> news;      ///< under `mutex`
  std::atomic<int> takers{0};  ///< viewers that take a picture

  void tell(News one);
  void count_takers();
};

/// One connection, counted as long as it lives.
class Counted {
 public:
  explicit Counted(Hub& hub) : hub_(hub) { ++hub_.connections; }
  ~Counted() { --hub_.connections; }
  Counted(const Counted&) = delete;
  Counted& operator=(const Counted&) = delete;

 private:
  Hub& hub_;
};

/// Reads one request, answers it, and ends; a request for the WebSocket becomes a viewer.
void serve_connection(Hub& hub, boost::asio::ip::tcp::socket socket);

}  // namespace catena::web
