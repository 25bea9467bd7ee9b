/// ViewerLink is the WebSocket of one viewer. Network thread. Part of engine/web alone: it has Boost in it.
#pragma once
#include <array>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <memory>

#include "engine/web/hub.h"

namespace catena::web {

class ViewerLink : public std::enable_shared_from_this<ViewerLink> {
 public:
  using Request = boost::beast::http::request<boost::beast::http::empty_body>;

  ViewerLink(Hub& hub, boost::asio::ip::tcp::socket socket, std::unique_ptr<Counted> counted);
  /// Answers the request; then the viewer has come, until it leaves.
  void accept(Request request);
  /// In the place of what waits in that slot.
  void put(Slot slot, Bytes bytes);
  /// What the viewer said has been taken: more is read where nothing was for that reason.
  void resume();
  bool takes_picture() const { return !slots_[kSlots - 1] && on_the_way_ < kPicturesAhead; }

 private:
  using Error = boost::system::error_code;
  void read();
  void on_read(Error error);
  bool take_message();
  void write();
  void leave();

  Hub& hub_;
  std::unique_ptr<Counted> counted_;
  boost::beast::websocket::stream<boost::beast::tcp_stream> socket_;
  Request request_;
  boost::beast::flat_buffer buffer_{kLongestMessage};
  std::array<Bytes, kSlots> slots_;
  Bytes writing_;
  ViewerId id_ = 0;
  int on_the_way_ = 0;       ///< pictures
  std::size_t waiting_ = 0;  ///< messages that were not taken yet
  bool paused_ = false;
};

}  // namespace catena::web
