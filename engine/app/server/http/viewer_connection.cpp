// SPDX-License-Identifier: MIT
#include "engine/app/server/http/viewer_connection.h"

#include <algorithm>
#include <boost/asio/buffer.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <chrono>
#include <utility>

namespace catena::http {

namespace websocket = boost::beast::websocket;

ViewerConnection::ViewerConnection(ServerState& hub, boost::asio::ip::tcp::socket socket, std::unique_ptr<ConnectionGuard> counted)
    : hub_(hub), guard_(std::move(counted)), socket_(std::move(socket)) {}

void ViewerConnection::accept(Request request) {
  request_ = std::move(request);
  websocket::stream_base::timeout patience{};
  patience.handshake_timeout = std::chrono::seconds(kRequestTimeoutS);
  patience.idle_timeout = std::chrono::seconds(kIdleTimeoutS);
  patience.keep_alive_pings = true;
  socket_.set_option(patience);
  socket_.read_message_max(kMaxMessageBytes);
  socket_.auto_fragment(false);
  Error ignored;
  boost::beast::get_lowest_layer(socket_).socket().set_option(boost::asio::ip::tcp::no_delay(true), ignored);
  socket_.async_accept(request_, [self = shared_from_this()](Error error) {
    if (error) return;
    ServerState& hub = self->hub_;
    self->id_ = ++hub.last_viewer;
    hub.viewers[self->id_] = self;
    hub.post_event({ViewerEvent::Kind::connected, self->id_});
    hub.update_ready_viewers();
    self->read();
  });
}

void ViewerConnection::enqueue(Slot slot, Bytes bytes) {
  slots_[static_cast<std::size_t>(slot)] = std::move(bytes);
  if (!writing_) write();
}

void ViewerConnection::resume() {
  pending_messages_ = 0;
  if (std::exchange(paused_, false)) read();
}

// ---- messages from the viewer ----

void ViewerConnection::read() {
  socket_.async_read(buffer_, [self = shared_from_this()](Error error, std::size_t) { self->on_read(error); });
}

void ViewerConnection::on_read(Error error) {
  if (error) return disconnect();
  if (!handle_message()) {
    socket_.async_close(websocket::close_code::policy_error, [self = shared_from_this()](Error) { self->disconnect(); });
    return;
  }
  buffer_.consume(buffer_.size());
  paused_ = pending_messages_ >= kMaxPendingMessages;
  if (!paused_) read();
}

bool ViewerConnection::handle_message() {
  if (socket_.got_text()) {
    ++pending_messages_;
    hub_.post_event({ViewerEvent::Kind::message, id_, boost::beast::buffers_to_string(buffer_.data())});
    return true;
  }
  constexpr std::size_t kShownBytes = 4;
  if (buffer_.size() != kShownBytes || frames_in_flight_ == 0) return false;
  --frames_in_flight_;
  if (!writing_) write();
  hub_.update_ready_viewers();
  return true;
}

void ViewerConnection::disconnect() {
  if (std::exchange(id_, 0) == 0) return;
  const auto self = shared_from_this();
  for (auto it = hub_.viewers.begin(); it != hub_.viewers.end(); ++it)
    if (it->second == self) {
      const ViewerId gone = it->first;
      hub_.viewers.erase(it);
      hub_.post_event({ViewerEvent::Kind::disconnected, gone});
      break;
    }
  hub_.update_ready_viewers();
  Error ignored;
  boost::beast::get_lowest_layer(socket_).socket().close(ignored);
}

// ---- messages to the viewer ----

void ViewerConnection::write() {
  const std::size_t ready = frames_in_flight_ < kMaxFramesInFlight ? kSlotCount : kSlotCount - 1;
  const auto slot =
      std::find_if(slots_.begin(), slots_.begin() + static_cast<std::ptrdiff_t>(ready), [](const Bytes& b) { return bool(b); });
  if (slot == slots_.begin() + static_cast<std::ptrdiff_t>(ready)) return;
  const bool is_picture = slot == slots_.begin() + static_cast<std::ptrdiff_t>(kSlotCount - 1);
  writing_ = std::exchange(*slot, nullptr);
  if (is_picture) ++frames_in_flight_;
  hub_.update_ready_viewers();
  socket_.binary(is_picture);
  socket_.async_write(boost::asio::buffer(*writing_), [self = shared_from_this()](Error error, std::size_t) {
    self->writing_ = nullptr;
    if (error) return self->disconnect();
    self->write();
  });
}

}  // namespace catena::http
