// SPDX-License-Identifier: MIT
#include <boost/beast/core/bind_handler.hpp>
#include <boost/beast/http/file_body.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/http/write.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <chrono>
#include <optional>
#include <utility>

#include "engine/app/server/http/server_state.h"
#include "engine/app/server/http/viewer_connection.h"

namespace catena::http {

namespace beast = boost::beast;
namespace http = boost::beast::http;

namespace {

constexpr std::uint32_t kLongestHeader = 8192;
constexpr const char* kNoEntry = "A token is missing or wrong: open the complete address that `catena serve` printed.\n";

std::string with_nonce(const std::string& page, const std::string& nonce) {
  constexpr std::string_view kPlace = "NONCE";
  std::string text;
  std::size_t at = 0;
  for (std::size_t next = page.find(kPlace); next != std::string::npos; next = page.find(kPlace, at)) {
    text.append(page, at, next - at).append(nonce);
    at = next + kPlace.size();
  }
  return text.append(page, at);
}

std::string_view view_of(beast::string_view text) { return {text.data(), text.size()}; }

class Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(ServerState& hub, boost::asio::ip::tcp::socket socket)
      : hub_(hub), counted_(std::make_unique<ConnectionGuard>(hub)), stream_(std::move(socket)) {}

  void read() {
    parser_.header_limit(kLongestHeader);
    stream_.expires_after(std::chrono::seconds(kRequestTimeoutS));
    http::async_read(stream_, buffer_, parser_, [self = shared_from_this()](boost::system::error_code error, std::size_t) {
      if (error)
        self->end();
      else
        self->answer();
    });
  }

 private:
  void answer() {
    const auto& request = parser_.get();
    const std::string_view host = view_of(request[http::field::host]), target = view_of(request.target());
    if (!hub_.access.allows_host(host))
      return say(http::status::forbidden, "The host name is not known; see `catena serve --help`, --name.\n");
    const bool known = hub_.access.has_cookie(view_of(request[http::field::cookie]), host);
    if (target == "/socket") return open_socket(known);
    if (request.method() != http::verb::get) return say(http::status::method_not_allowed, "Only GET is supported.\n");
    const bool invited = hub_.access.has_token(target);
    const ServerState::OfferedFile& offered = hub_.offered_file;
    if (known && !offered.path.empty() && target == offered.target) return send_file(offered);
    if (!invited && target != "/" && !target.starts_with("/?")) return say(http::status::not_found, "There is no such page.\n");
    if (!invited && !known) return say(http::status::forbidden, kNoEntry);
    show_page(invited ? std::optional(hub_.access.set_cookie_header(host)) : std::nullopt);
  }

  void open_socket(bool known) {
    const auto& request = parser_.get();
    const std::string_view host = view_of(request[http::field::host]), origin = view_of(request[http::field::origin]);
    if (!known || !AccessControl::allows_origin(origin, host)) return say(http::status::forbidden, kNoEntry);
    if (!beast::websocket::is_upgrade(request)) return say(http::status::upgrade_required, "A WebSocket was expected.\n");
    if (hub_.viewers.size() >= kMaxViewers) return say(http::status::service_unavailable, "Too many pages are connected.\n");
    stream_.expires_never();
    std::make_shared<ViewerConnection>(hub_, stream_.release_socket(), std::move(counted_))->accept(parser_.release());
  }

  void show_page(const std::optional<std::string>& cookie) {
    const std::string nonce = generate_secret(), framed = hub_.options.frame_ancestor.empty() ? "'none'" : hub_.options.frame_ancestor;
    begin(response_, http::status::ok, "text/html; charset=utf-8");
    response_.set("Content-Security-Policy",
                  "default-src 'none'; script-src 'nonce-" + nonce + "'; style-src 'nonce-" + nonce +
                      "'; img-src blob: data:; connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors " + framed);
    if (cookie) response_.set(http::field::set_cookie, *cookie);
    response_.body() = with_nonce(hub_.options.page, nonce);
    finish();
  }

  /// Sends a file as a download, which the browser stores and does not display, whatever its content.
  void send_file(const ServerState::OfferedFile& offered) {
    boost::system::error_code error;
    begin(file_, http::status::ok, "application/octet-stream");
    file_.set(http::field::content_disposition, "attachment; filename=\"" + offered.target.substr(1) + "\"");
    file_.body().open(offered.path.c_str(), beast::file_mode::scan, error);
    if (error) return say(http::status::not_found, "The file cannot be read.\n");
    file_.prepare_payload();
    sender_.emplace(file_);
    send_more();
  }

  /// Sends the next part. The total time is unlimited, but the connection ends if one part takes longer than kRequestTimeoutS.
  void send_more() {
    stream_.expires_after(std::chrono::seconds(kRequestTimeoutS));
    http::async_write_some(stream_, *sender_, [self = shared_from_this()](boost::system::error_code error, std::size_t) {
      if (error || self->sender_->is_done()) return self->end();
      self->send_more();
    });
  }

  void say(http::status status, const std::string& words) {
    begin(response_, status, "text/plain; charset=utf-8");
    response_.body() = words;
    finish();
  }

  template <class Response>
  static void begin(Response& response, http::status status, const char* type) {
    response.result(status);
    response.version(11);
    response.set(http::field::content_type, type);
    response.set(http::field::cache_control, "no-store");
    response.set("X-Content-Type-Options", "nosniff");
    response.set("Referrer-Policy", "no-referrer");
    response.set("Cross-Origin-Opener-Policy", "same-origin");
    response.set("Cross-Origin-Resource-Policy", "same-origin");
    response.keep_alive(false);
  }

  void finish() {
    response_.prepare_payload();
    http::async_write(stream_, response_, [self = shared_from_this()](boost::system::error_code, std::size_t) { self->end(); });
  }

  void end() {
    boost::system::error_code ignored;
    stream_.socket().shutdown(boost::asio::ip::tcp::socket::shutdown_send, ignored);
  }

  ServerState& hub_;
  std::unique_ptr<ConnectionGuard> counted_;
  beast::tcp_stream stream_;
  beast::flat_buffer buffer_{kLongestHeader + 1024};
  http::request_parser<http::empty_body> parser_;
  http::response<http::string_body> response_;
  http::response<http::file_body> file_;
  std::optional<http::response_serializer<http::file_body>> sender_;  ///< of file_
};

}  // namespace

void serve_connection(ServerState& hub, boost::asio::ip::tcp::socket socket) {
  if (hub.connections >= kMaxConnections) return;  // the socket closes
  std::make_shared<Connection>(hub, std::move(socket))->read();
}

}  // namespace catena::http
