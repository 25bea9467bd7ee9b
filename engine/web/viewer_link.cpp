#include "engine/web/viewer_link.h"

#include <algorithm>
#include <boost/asio/buffer.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <chrono>
#include <utility>

namespace catena::web {

namespace websocket = boost::beast::websocket;

ViewerLink::ViewerLink(Hub& hub, boost::asio::ip::tcp::socket socket, std::unique_ptr<Counted> counted)
    : hub_(hub), counted_(std::move(counted)), socket_(std::move(socket)) {}

void ViewerLink::accept(Request request) {
  request_ = std::move(request);
  websocket::stream_base::timeout patience{};
  patience.handshake_timeout = std::chrono::seconds(kPatienceS);
  patience.idle_timeout = std::chrono::seconds(kSilenceS);
  patience.keep_alive_pings = true;
  socket_.set_option(patience);
  socket_.read_message_max(kLongestMessage);
  socket_.auto_fragment(false);
  Error ignored;
  boost::beast::get_lowest_layer(socket_).socket().set_option(boost::asio::ip::tcp::no_delay(true), ignored);
  socket_.async_accept(request_, [self = shared_from_this()](Error error) {
    if (error) return;
    Hub& hub = self->hub_;
    self->id_ = ++hub.last_viewer;
    hub.viewers[self->id_] = self;
    hub.tell({News::What::came, self->id_});
    hub.count_takers();
    self->read();
  });
}

void ViewerLink::put(Slot slot, Bytes bytes) {
  slots_[static_cast<std::size_t>(slot)] = std::move(bytes);
  if (!writing_) write();
}

void ViewerLink::resume() {
  waiting_ = 0;
  if (std::exchange(paused_, false)) read();
}

// ---- from the viewer ----

void ViewerLink::read() {
  socket_.async_read(buffer_, [self = shared_from_this()](Error error, std::size_t) { self->on_read(error); });
}

void ViewerLink::on_read(Error error) {
  if (error) return leave();
  if (!take_message()) {
    socket_.async_close(websocket::close_code::policy_error, [self = shared_from_this()](Error) { self->leave(); });
    return;
  }
  buffer_.consume(buffer_.size());
  paused_ = waiting_ >= kMostWaiting;
  if (!paused_) read();
}

bool ViewerLink::take_message() {
  if (socket_.got_text()) {
    ++waiting_;
    hub_.tell({News::What::said, id_, boost::beast::buffers_to_string(buffer_.data())});
    return true;
  }
  constexpr std::size_t kShownBytes = 4;
  if (buffer_.size() != kShownBytes || on_the_way_ == 0) return false;
  --on_the_way_;
  if (!writing_) write();
  hub_.count_takers();
  return true;
}

void ViewerLink::leave() {
  if (std::exchange(id_, 0) == 0) return;
  const auto self = shared_from_this();
  for (auto it = hub_.viewers.begin(); it != hub_.viewers.end(); ++it)
    if (it->second == self) {
      const ViewerId gone = it->first;
      hub_.viewers.erase(it);
      hub_.tell({News::What::left, gone});
      break;
    }
  hub_.count_takers();
  Error ignored;
  boost::beast::get_lowest_layer(socket_).socket().close(ignored);
}

// ---- to the viewer ----

void ViewerLink::write() {
  const std::size_t ready = on_the_way_ < kPicturesAhead ? kSlots : kSlots - 1;
  const auto slot =
      std::find_if(slots_.begin(), slots_.begin() + static_cast<std::ptrdiff_t>(ready), [](const Bytes& b) { return bool(b); });
  if (slot == slots_.begin() + static_cast<std::ptrdiff_t>(ready)) return;
  const bool is_picture = slot == slots_.begin() + static_cast<std::ptrdiff_t>(kSlots - 1);
  writing_ = std::exchange(*slot, nullptr);
  if (is_picture) ++on_the_way_;
  hub_.count_takers();
  socket_.binary(is_picture);
  socket_.async_write(boost::asio::buffer(*writing_), [self = shared_from_this()](Error error, std::size_t) {
    self->writing_ = nullptr;
    if (error) return self->leave();
    self->write();
  });
}

}  // namespace catena::web
