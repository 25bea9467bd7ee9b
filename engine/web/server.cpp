#include "engine/web/server.h"

#include <fmt/format.h>

#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <utility>

#include "engine/base/text.h"
#include "engine/base/threads.h"
#include "engine/web/hub.h"
#include "engine/web/viewer_link.h"

namespace catena::web {

namespace asio = boost::asio;
using tcp = asio::ip::tcp;

void Hub::tell(News one) {
  {
    const std::lock_guard lock(mutex);
    news.push_back(std::move(one));
  }
  happened.notify_one();
}

void Hub::count_takers() {
  int count = 0;
  for (const auto& [id, viewer] : viewers) count += viewer->takes_picture() ? 1 : 0;
  const int before = takers.exchange(count);
  if (before == 0 && count > 0) happened.notify_one();
}

struct Server::Parts {
  explicit Parts(const ServerOptions& options) : hub(options), acceptor(hub.io), again(hub.io) {}

  void accept() {
    acceptor.async_accept([this](boost::system::error_code error, tcp::socket socket) {
      if (!error) {
        serve_connection(hub, std::move(socket));
        return accept();
      }
      // no descriptors left, or the like: others may end soon
      again.expires_after(std::chrono::milliseconds(100));
      again.async_wait([this](boost::system::error_code stopped) {
        if (!stopped) accept();
      });
    });
  }

  Hub hub;
  tcp::acceptor acceptor;
  asio::steady_timer again;
  std::thread thread;
};

Server::Server() = default;

Server::~Server() {
  if (!parts_) return;
  parts_->hub.io.stop();
  if (parts_->thread.joinable()) parts_->thread.join();
}

Result<std::unique_ptr<Server>> Server::open(ServerOptions options) {
  boost::system::error_code error;
  const asio::ip::address address = asio::ip::make_address(options.address, error);
  if (error) return Error{in_quotes(options.address) + ": expected an address in numbers, such as 127.0.0.1 or ::1"};
  // it stands in a header
  const std::string& framed = options.framed_by;
  const bool is_origin = framed.starts_with("http://") || framed.starts_with("https://");
  constexpr const char* kOfOrigins = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789.:/-[]";
  if (!framed.empty() && (!is_origin || framed.find_first_not_of(kOfOrigins) != std::string::npos))
    return Error{in_quotes(framed) + ": expected the origin of a page, such as http://127.0.0.1:8888"};
  std::unique_ptr<Server> server(new Server());
  server->parts_ = std::make_unique<Parts>(options);
  Parts& parts = *server->parts_;
  const tcp::endpoint place(address, options.port);
  parts.acceptor.open(place.protocol(), error);
  if (!error) parts.acceptor.set_option(tcp::acceptor::reuse_address(true), error);
  if (!error) parts.acceptor.bind(place, error);
  if (!error) parts.acceptor.listen(asio::socket_base::max_listen_connections, error);
  if (error)
    return Error{fmt::format("{} port {}: cannot be listened at ({}); --port takes another one, 0 any that is free", options.address,
                             options.port, error.message()),
                 true};
  parts.accept();
  CATENA_TRY(parts.thread, start_thread("the server", [&parts] { parts.hub.io.run(); }));
  return server;
}

std::uint16_t Server::port() const {
  boost::system::error_code error;
  return parts_->acceptor.local_endpoint(error).port();
}

std::string Server::url() const {
  const ServerOptions& options = parts_->hub.options;
  const bool any = options.address == "0.0.0.0" || options.address == "::";
  const std::string host = any && !options.names.empty()                    ? options.names.front()
                           : any                                            ? "127.0.0.1"
                           : options.address.find(':') != std::string::npos ? "[" + options.address + "]"
                                                                            : options.address;
  return fmt::format("http://{}:{}/?token={}", host, port(), parts_->hub.access.token());
}

std::vector<News> Server::take(double wait_s) {
  Hub& hub = parts_->hub;
  std::vector<News> news;
  {
    std::unique_lock lock(hub.mutex);
    const int before = hub.takers;
    hub.happened.wait_for(lock, std::chrono::duration<double>(wait_s),
                          [&] { return !hub.news.empty() || (before == 0 && hub.takers > 0); });
    news.swap(hub.news);
  }
  if (!news.empty())
    asio::post(hub.io, [&hub] {
      const auto viewers = hub.viewers;  // one that reads on may leave
      for (const auto& [id, viewer] : viewers) viewer->resume();
    });
  return news;
}

void Server::send(ViewerId viewer, Slot slot, std::string bytes) {
  Hub& hub = parts_->hub;
  asio::post(hub.io, [&hub, viewer, slot, shared = std::make_shared<const std::string>(std::move(bytes))] {
    const auto viewers = hub.viewers;
    for (const auto& [id, link] : viewers)
      if (viewer == kAllViewers || viewer == id) link->put(slot, shared);
    hub.count_takers();
  });
}

void Server::offer(std::string name, std::string path) {
  Hub& hub = parts_->hub;
  asio::post(hub.io, [&hub, target = "/" + name, path = std::move(path)] { hub.offered = {target, path}; });
}

bool Server::wants_picture() const { return parts_->hub.takers > 0; }

}  // namespace catena::web
