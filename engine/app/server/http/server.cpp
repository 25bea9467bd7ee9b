// SPDX-License-Identifier: MIT
#include "engine/app/server/http/server.h"

#include <fmt/format.h>

#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <utility>

#include "engine/app/server/http/server_state.h"
#include "engine/app/server/http/viewer_connection.h"
#include "engine/base/text.h"
#include "engine/base/threads.h"

namespace catena::http {

namespace asio = boost::asio;
using tcp = asio::ip::tcp;

void ServerState::post_event(ViewerEvent event) {
  {
    const std::lock_guard lock(mutex);
    events.push_back(std::move(event));
  }
  event_posted.notify_one();
}

void ServerState::update_ready_viewers() {
  int count = 0;
  for (const auto& [id, viewer] : viewers) count += viewer->is_ready_for_frame() ? 1 : 0;
  const int before = ready_viewers.exchange(count);
  if (before == 0 && count > 0) event_posted.notify_one();
}

struct Server::Impl {
  explicit Impl(const ServerOptions& options) : hub(options), acceptor(hub.io), again(hub.io) {}

  void accept() {
    acceptor.async_accept([this](boost::system::error_code error, tcp::socket socket) {
      if (!error) {
        serve_connection(hub, std::move(socket));
        return accept();
      }
      // for instance no free descriptors: retry, since other connections may end
      again.expires_after(std::chrono::milliseconds(100));
      again.async_wait([this](boost::system::error_code stopped) {
        if (!stopped) accept();
      });
    });
  }

  ServerState hub;
  tcp::acceptor acceptor;
  asio::steady_timer again;
  std::thread thread;
};

Server::Server() = default;

Server::~Server() {
  if (!impl_) return;
  impl_->hub.io.stop();
  if (impl_->thread.joinable()) impl_->thread.join();
}

Result<std::unique_ptr<Server>> Server::open(ServerOptions options) {
  boost::system::error_code error;
  const asio::ip::address address = asio::ip::make_address(options.address, error);
  if (error) return Error{in_quotes(options.address) + ": a numeric address was expected, such as 127.0.0.1 or ::1"};
  // the value is placed in a header
  const std::string& framed = options.frame_ancestor;
  const bool is_origin = framed.starts_with("http://") || framed.starts_with("https://");
  constexpr const char* kOfOrigins = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789.:/-[]";
  if (!framed.empty() && (!is_origin || framed.find_first_not_of(kOfOrigins) != std::string::npos))
    return Error{in_quotes(framed) + ": the origin of a page was expected, such as http://127.0.0.1:8888"};
  std::unique_ptr<Server> server(new Server());
  server->impl_ = std::make_unique<Impl>(options);
  Impl& parts = *server->impl_;
  const tcp::endpoint place(address, options.port);
  parts.acceptor.open(place.protocol(), error);
  if (!error) parts.acceptor.set_option(tcp::acceptor::reuse_address(true), error);
  if (!error) parts.acceptor.bind(place, error);
  if (!error) parts.acceptor.listen(asio::socket_base::max_listen_connections, error);
  if (error)
    return Error{fmt::format("{} port {}: cannot listen ({}); --port selects another port, 0 any free port", options.address, options.port,
                             error.message()),
                 true};
  parts.accept();
  CATENA_TRY(parts.thread, start_thread("the server", [&parts] { parts.hub.io.run(); }));
  return server;
}

std::uint16_t Server::port() const {
  boost::system::error_code error;
  return impl_->acceptor.local_endpoint(error).port();
}

std::string Server::url() const {
  const ServerOptions& options = impl_->hub.options;
  const bool any = options.address == "0.0.0.0" || options.address == "::";
  const std::string host = any && !options.host_names.empty()               ? options.host_names.front()
                           : any                                            ? "127.0.0.1"
                           : options.address.find(':') != std::string::npos ? "[" + options.address + "]"
                                                                            : options.address;
  return fmt::format("http://{}:{}/?token={}", host, port(), impl_->hub.access.token());
}

std::vector<ViewerEvent> Server::wait_for_events(double wait_s) {
  ServerState& hub = impl_->hub;
  std::vector<ViewerEvent> events;
  {
    std::unique_lock lock(hub.mutex);
    const int before = hub.ready_viewers;
    hub.event_posted.wait_for(lock, std::chrono::duration<double>(wait_s),
                              [&] { return !hub.events.empty() || (before == 0 && hub.ready_viewers > 0); });
    events.swap(hub.events);
  }
  if (!events.empty())
    asio::post(hub.io, [&hub] {
      const auto viewers = hub.viewers;  // a copy: a viewer that resumes reading may disconnect
      for (const auto& [id, viewer] : viewers) viewer->resume();
    });
  return events;
}

void Server::send(ViewerId viewer, Slot slot, std::string bytes) {
  ServerState& hub = impl_->hub;
  asio::post(hub.io, [&hub, viewer, slot, shared = std::make_shared<const std::string>(std::move(bytes))] {
    const auto viewers = hub.viewers;
    for (const auto& [id, link] : viewers)
      if (viewer == kAllViewers || viewer == id) link->enqueue(slot, shared);
    hub.update_ready_viewers();
  });
}

void Server::offer_file(std::string name, std::string path) {
  ServerState& hub = impl_->hub;
  asio::post(hub.io, [&hub, target = "/" + name, path = std::move(path)] { hub.offered_file = {target, path}; });
}

bool Server::has_ready_viewer() const { return impl_->hub.ready_viewers > 0; }

}  // namespace catena::http
