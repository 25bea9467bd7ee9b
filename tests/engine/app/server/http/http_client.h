// SPDX-License-Identifier: MIT
/// A client for tests: valid and invalid requests and WebSocket messages. All calls have a timeout.
#pragma once
#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace catena::test {

namespace asio = boost::asio;
namespace beast = boost::beast;
inline constexpr std::chrono::seconds kClientTimeout{20};

inline asio::ip::tcp::endpoint make_endpoint(int port) { return {asio::ip::make_address("127.0.0.1"), static_cast<unsigned short>(port)}; }

/// Sends the bytes unchanged, and returns the response until the server closes the connection.
inline std::string send_raw_request(int port, const std::string& bytes) {
  asio::io_context io;
  asio::ip::tcp::socket socket(io);
  std::string answer;
  std::size_t sent = 0;
  socket.async_connect(make_endpoint(port), [&](beast::error_code error) {
    if (error) return;
    asio::async_write(socket, asio::buffer(bytes), [&](beast::error_code, std::size_t count) {
      sent = count;
      asio::async_read(socket, asio::dynamic_buffer(answer), [](beast::error_code, std::size_t) {});
    });
  });
  io.run_for(kClientTimeout);
  return answer;
}

using Headers = std::vector<std::pair<std::string, std::string>>;

inline std::string make_request(const std::string& target, const Headers& headers, const std::string& method = "GET") {
  std::string text = method + " " + target + " HTTP/1.1\r\n";
  for (const auto& [name, value] : headers) text += name + ": " + value + "\r\n";
  return text + "\r\n";
}

/// The status code, as 403 of "HTTP/1.1 403 Forbidden ..."; 0 without a response.
inline int parse_status(const std::string& answer) { return answer.starts_with("HTTP/1.1 ") ? std::stoi(answer.substr(9)) : 0; }

/// The value of a header; empty if there is none.
inline std::string find_header(const std::string& answer, const std::string& name) {
  const auto at = answer.find("\r\n" + name + ": ");
  if (at == std::string::npos || at > answer.find("\r\n\r\n")) return {};
  const auto begin = at + name.size() + 4;
  return answer.substr(begin, answer.find("\r\n", begin) - begin);
}

/// The cookie that the server sets for the page's address: "catena_8642=...".
inline std::string fetch_cookie(int port, const std::string& url) {
  const std::string host = "127.0.0.1:" + std::to_string(port);
  const std::string cookie = find_header(send_raw_request(port, make_request(url.substr(url.find("/?")), {{"Host", host}})), "Set-Cookie");
  return cookie.substr(0, cookie.find(';'));
}

struct ReceivedMessage {
  bool is_text = false;
  std::string bytes;
};

/// A WebSocket connection.
class WebSocketClient {
 public:
  struct Identity {
    std::string cookie, origin, target = "/socket", host{};
  };
  /// Connects; is_open() tells whether the server accepted, and status() is the response's status code otherwise.
  WebSocketClient(int port, const Identity& as) : socket_(io_) {
    const std::string host = as.host.empty() ? "127.0.0.1:" + std::to_string(port) : as.host;
    socket_.set_option(beast::websocket::stream_base::decorator([as](beast::websocket::request_type& request) {
      if (!as.cookie.empty()) request.set(beast::http::field::cookie, as.cookie);
      if (!as.origin.empty()) request.set(beast::http::field::origin, as.origin);
    }));
    socket_.read_message_max(64 << 20);
    beast::get_lowest_layer(socket_).async_connect(make_endpoint(port), [this, host, as](beast::error_code error) {
      if (error) return;
      socket_.async_handshake(answer_, host, as.target, [this](beast::error_code wrong) { open_ = !wrong; });
    });
    run();
  }
  bool is_open() const { return open_; }
  int status() const { return static_cast<int>(answer_.result_int()); }

  void send(const std::string& words, bool text = true) {
    socket_.text(text);
    socket_.async_write(asio::buffer(words), [this](beast::error_code error, std::size_t) { open_ = open_ && !error; });
    run();
  }
  /// Acknowledges that one more image was shown.
  void acknowledge_frame() { send(std::string(4, '\0'), false); }
  /// The next message; none if the connection is closed.
  std::optional<ReceivedMessage> read() {
    beast::flat_buffer buffer;
    bool there = false;
    socket_.async_read(buffer, [&](beast::error_code error, std::size_t) { there = !error; });
    run();
    if (!there) open_ = false;
    return there ? std::optional(ReceivedMessage{socket_.got_text(), beast::buffers_to_string(buffer.data())}) : std::nullopt;
  }
  /// Sends the bytes unchanged, without the WebSocket protocol.
  void send_raw(const std::string& bytes) {
    beast::error_code ignored;
    asio::write(beast::get_lowest_layer(socket_).socket(), asio::buffer(bytes), ignored);
  }
  void close() {
    beast::error_code ignored;
    beast::get_lowest_layer(socket_).socket().close(ignored);
    open_ = false;
  }

 private:
  void run() {
    io_.restart();
    io_.run_for(kClientTimeout);
    if (io_.stopped()) return;
    close();
    io_.run();
  }

  asio::io_context io_;
  beast::websocket::stream<beast::tcp_stream> socket_;
  beast::websocket::response_type answer_;
  bool open_ = false;
};

}  // namespace catena::test
