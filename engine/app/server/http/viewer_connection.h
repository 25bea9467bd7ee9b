// SPDX-License-Identifier: MIT
/// ViewerConnection is the WebSocket of one viewer. Network thread. Private to engine/app/server/http, because it includes Boost.
#pragma once
#include <array>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <memory>

#include "engine/app/server/http/server_state.h"

namespace catena::http {

/// The connection keeps itself alive while an operation is pending.
class ViewerConnection : public std::enable_shared_from_this<ViewerConnection> {
 public:
  using Request = boost::beast::http::request<boost::beast::http::empty_body>;

  ViewerConnection(ServerState& hub, boost::asio::ip::tcp::socket socket, std::unique_ptr<ConnectionGuard> counted);
  /// Accepts the WebSocket request; then the viewer is connected until the connection ends.
  void accept(Request request);
  /// Queues a message, in place of one that waits in the same slot.
  void enqueue(Slot slot, Bytes bytes);
  /// Call when the pending messages have been processed: continues reading if it was paused.
  void resume();
  /// Whether a frame would be sent at once.
  bool is_ready_for_frame() const { return !slots_[kSlotCount - 1] && frames_in_flight_ < kMaxFramesInFlight; }

 private:
  using Error = boost::system::error_code;
  void read();
  void on_read(Error error);
  bool handle_message();
  void write();
  void disconnect();

  ServerState& hub_;
  std::unique_ptr<ConnectionGuard> guard_;
  boost::beast::websocket::stream<boost::beast::tcp_stream> socket_;
  Request request_;
  boost::beast::flat_buffer buffer_{kMaxMessageBytes};
  std::array<Bytes, kSlotCount> slots_;
  Bytes writing_;
  ViewerId id_ = 0;
  int frames_in_flight_ = 0;          ///< Frames that were sent and not yet acknowledged as shown
  std::size_t pending_messages_ = 0;  ///< Messages that have not been processed yet
  bool paused_ = false;
};

}  // namespace catena::http
