// SPDX-License-Identifier: MIT
/// The server with a test client: access, messages, and hostile clients.
#include "engine/app/server/http/server.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "engine/app/server/http/access_control.h"
#include "tests/engine/app/server/http/http_client.h"
#include "tests/support/support.h"

namespace server_test {

namespace test = catena::test;
using namespace catena::http;

struct Rig {
  std::unique_ptr<Server> server;
  int port = 0;
  std::string host, cookie;
  test::Headers known;  ///< headers of a browser with the cookie

  Rig() {
    ServerOptions options;
    options.page = "<script nonce=\"NONCE\">NONCE</script>";
    auto opened = Server::open(std::move(options));
    EXPECT_TRUE(opened);
    server = std::move(*opened);
    port = server->port();
    host = "127.0.0.1:" + std::to_string(port);
    cookie = test::fetch_cookie(port, server->url());
    known = {{"Host", host}, {"Cookie", cookie}};
  }
  std::string ask(const std::string& target, const test::Headers& headers, const std::string& method = "GET") const {
    return test::send_raw_request(port, test::make_request(target, headers, method));
  }
  int status(const std::string& target, const test::Headers& headers, const std::string& method = "GET") const {
    return test::parse_status(ask(target, headers, method));
  }
  int status(const std::string& target) const { return status(target, known); }
  /// The status of an attempt to open a socket; 101 if it is open.
  int socket_status(const test::WebSocketClient::Identity& as) const {
    const test::WebSocketClient page(port, as);
    return page.is_open() ? 101 : page.status();
  }
  std::unique_ptr<test::WebSocketClient> page() const {
    return std::make_unique<test::WebSocketClient>(port, test::WebSocketClient::Identity{cookie, "http://" + host});
  }
  /// Waits for a number of events, and returns them; fewer if no more arrive.
  std::vector<ViewerEvent> news(std::size_t count) const {
    std::vector<ViewerEvent> all;
    for (int i = 0; i < 400 && all.size() < count; ++i)
      for (ViewerEvent& one : server->wait_for_events(0.05)) all.push_back(std::move(one));
    return all;
  }
  /// The text of the page's next message, which is an image; empty if it is not.
  static std::string picture(test::WebSocketClient& page) {
    const auto message = page.read();
    return message && !message->is_text ? message->bytes : "";
  }
};

TEST(Server, ServesThePageWithATokenOrCookie) {
  const Rig rig;
  const std::string url = rig.server->url(), invited = url.substr(url.find("/?"));
  EXPECT_EQ(rig.status("/", {{"Host", rig.host}}), 403);
  EXPECT_EQ(rig.status("/?token=" + std::string(32, '0'), {{"Host", rig.host}}), 403);
  const std::string page = rig.ask(invited, {{"Host", rig.host}});
  EXPECT_EQ(test::parse_status(page), 200);
  EXPECT_EQ(test::find_header(page, "Referrer-Policy"), "no-referrer");
  EXPECT_EQ(test::find_header(page, "Cache-Control"), "no-store");
  // Scripts need a nonce that differs in each response.
  const std::string rules = test::find_header(page, "Content-Security-Policy"), again = rig.ask("/", rig.known);
  ASSERT_NE(rules.find("script-src 'nonce-"), std::string::npos);
  const std::string nonce = rules.substr(rules.find("'nonce-") + 7, 32);
  EXPECT_NE(page.find("<script nonce=\"" + nonce + "\">" + nonce + "</script>"), std::string::npos);
  EXPECT_NE(rules.find("frame-ancestors 'none'"), std::string::npos);
  EXPECT_EQ(test::parse_status(again), 200);
  EXPECT_EQ(again.find(nonce), std::string::npos);
  EXPECT_EQ(test::find_header(again, "Set-Cookie"), "");
  EXPECT_EQ(page.find(rig.server->url().substr(url.size() - 32)), std::string::npos) << "the token goes nowhere";
}

TEST(Server, RefusesUnknownHostsOriginsAndCookies) {
  const Rig rig;
  const std::string own = "http://" + rig.host;
  EXPECT_EQ(rig.status("/", {{"Host", "evil.example"}, {"Cookie", rig.cookie}}), 403) << "a name that was rebound";
  EXPECT_EQ(rig.status("/", {{"Cookie", rig.cookie}}), 403);
  EXPECT_EQ(rig.status("/", rig.known, "POST"), 405);
  EXPECT_EQ(rig.status("/etc/passwd"), 404);
  EXPECT_EQ(rig.status("/socket", {{"Host", rig.host}, {"Cookie", rig.cookie}, {"Origin", own}}), 426);
  EXPECT_EQ(rig.socket_status({rig.cookie, "http://evil.example"}), 403);
  EXPECT_EQ(rig.socket_status({rig.cookie, ""}), 403);
  EXPECT_EQ(rig.socket_status({"", own}), 403);
  EXPECT_EQ(rig.socket_status({rig.cookie, "http://evil.example", "/socket", "evil.example"}), 403);
  EXPECT_EQ(rig.socket_status({rig.cookie, own}), 101);
}

TEST(Server, TextAndImagesAreDelivered) {
  const Rig rig;
  auto one = rig.page(), two = rig.page();
  ASSERT_TRUE(one->is_open() && two->is_open());
  one->send("hello");
  auto news = rig.news(3);
  ASSERT_EQ(news.size(), 3u);
  EXPECT_EQ(news[0].kind, ViewerEvent::Kind::connected);
  EXPECT_EQ(news[2].text, "hello");
  EXPECT_EQ(news[2].viewer, news[0].viewer);
  EXPECT_TRUE(rig.server->has_ready_viewer());
  rig.server->send(news[0].viewer, Slot::note, "only you");
  rig.server->send(kAllViewers, Slot::frame, "a picture");
  EXPECT_EQ(one->read()->bytes, "only you");
  EXPECT_EQ(Rig::picture(*one), "a picture");
  EXPECT_EQ(Rig::picture(*two), "a picture");
  one->close();
  news = rig.news(1);
  ASSERT_EQ(news.size(), 1u);
  EXPECT_EQ(news[0].kind, ViewerEvent::Kind::disconnected);
}

TEST(Server, ASlowReaderSkipsImages) {
  const Rig rig;
  auto slow = rig.page(), quick = rig.page();
  ASSERT_EQ(rig.news(2).size(), 2u);
  // Images in transit are delivered; of waiting images, only the newest is kept.
  for (int i = 0; i < 300; ++i) {
    rig.server->send(kAllViewers, Slot::frame, std::to_string(i) + std::string(200000, ' '));
    if (i >= 2) continue;
    ASSERT_EQ(std::stoi(Rig::picture(*quick)), i);
    quick->acknowledge_frame();
  }
  EXPECT_EQ(std::stoi(Rig::picture(*slow)), 0);
  EXPECT_EQ(std::stoi(Rig::picture(*slow)), 1);
  slow->acknowledge_frame();
  EXPECT_EQ(std::stoi(Rig::picture(*slow)), 299);
  // The other viewer gets its images independently.
  for (int last = -1; last != 299;) {
    last = std::stoi(Rig::picture(*quick));
    quick->acknowledge_frame();
  }
}

TEST(Server, AnInvalidMessageEndsTheConnection) {
  const Rig rig;
  auto good = rig.page();
  ASSERT_EQ(rig.news(1).size(), 1u);
  const std::vector<std::pair<const char*, std::function<void(test::WebSocketClient&)>>> bad{
      {"too long", [](test::WebSocketClient& page) { page.send(std::string(kMaxMessageBytes + 1, 'x')); }},
      {"an odd number of bytes", [](test::WebSocketClient& page) { page.send("abc", false); }},
      {"a picture shown that never came", [](test::WebSocketClient& page) { page.acknowledge_frame(); }},
      {"not masked", [](test::WebSocketClient& page) { page.send_raw(std::string("\x81\x05hello", 7)); }},
      {"not UTF-8", [](test::WebSocketClient& page) { page.send("\xff\xfe\xfd"); }},
      {"a length of 2^62", [](test::WebSocketClient& page) { page.send_raw(std::string("\x81\xff\x40\0\0\0\0\0\0\0abcd", 14)); }},
      {"a reserved kind", [](test::WebSocketClient& page) { page.send_raw(std::string("\x8f\x80\0\0\0\0", 6)); }},
      {"noise", [](test::WebSocketClient& page) { page.send_raw(std::string(5000, '\xa5')); }}};
  for (const auto& [what, does] : bad) {
    SCOPED_TRACE(what);
    auto page = rig.page();
    ASSERT_TRUE(page->is_open());
    does(*page);
    EXPECT_FALSE(page->read());
    const auto news = rig.news(2);
    ASSERT_EQ(news.size(), 2u);
    EXPECT_EQ(news[0].kind, ViewerEvent::Kind::connected);
    EXPECT_EQ(news[1].kind, ViewerEvent::Kind::disconnected);
  }
  good->send("still here");
  EXPECT_EQ(rig.news(1).at(0).text, "still here");
}

TEST(Server, AFloodOfMessagesIsNotBuffered) {
  const Rig rig;
  auto page = rig.page();
  ASSERT_EQ(rig.news(1).size(), 1u);
  constexpr std::size_t kCount = 500;
  for (std::size_t i = 0; i < kCount; ++i) page->send(std::to_string(i));
  // Until the events are taken, a bounded number of messages is read.
  std::vector<ViewerEvent> all;
  std::size_t max_events = 0;
  while (all.size() < kCount) {
    auto some = rig.server->wait_for_events(5);
    if (some.empty()) break;
    max_events = std::max(max_events, some.size());
    for (ViewerEvent& one : some) all.push_back(std::move(one));
  }
  EXPECT_LE(max_events, 2 * kMaxPendingMessages);
  ASSERT_EQ(all.size(), kCount);
  for (std::size_t i = 0; i < kCount; ++i) ASSERT_EQ(all[i].text, std::to_string(i));
}

TEST(Server, RequestsAreBounded) {
  const Rig rig;
  const std::string head = "GET / HTTP/1.1\r\nHost: " + rig.host + "\r\n";
  for (const std::string& request :
       {head + "X: " + std::string(20000, 'x') + "\r\n\r\n", head + "Content-Length: 1000000\r\n\r\n" + std::string(1000, 'x'),
        std::string(3000, '\0') + "\r\n\r\n", std::string("GET / HTTP/9.9\r\n\r\n")})
    EXPECT_NE(test::parse_status(test::send_raw_request(rig.port, request)), 200) << request.substr(0, 80);
  std::vector<std::unique_ptr<test::WebSocketClient>> pages;
  for (int i = 0; i < kMaxViewers; ++i) {
    pages.push_back(rig.page());
    ASSERT_TRUE(pages.back()->is_open()) << i;
    rig.news(1);
  }
  const auto one_more = rig.page();
  EXPECT_FALSE(one_more->is_open());
  EXPECT_EQ(one_more->status(), 503);
  EXPECT_EQ(rig.status("/"), 200);
}

TEST(Server, TheOfferedFileNeedsTheCookie) {
  const Rig rig;
  const test::TemporaryFolder folder;
  std::string bytes;
  for (int i = 0; i < 3'000'000; ++i) bytes += static_cast<char>(std::int64_t{i} * i >> 7);
  test::write_file(folder / "a", bytes);
  EXPECT_EQ(rig.status("/a.bin"), 404);
  rig.server->offer_file("a.bin", folder / "a");
  const std::string answer = rig.ask("/a.bin", rig.known);
  EXPECT_EQ(test::parse_status(answer), 200);
  EXPECT_EQ(test::find_header(answer, "Content-Disposition"), "attachment; filename=\"a.bin\"");
  EXPECT_TRUE(answer.substr(answer.find("\r\n\r\n") + 4) == bytes);
  EXPECT_EQ(rig.status("/a.bin", {{"Host", rig.host}}), 404);
  EXPECT_EQ(rig.status("/../a.bin"), 404);
  // The file is removed, then no longer offered.
  std::filesystem::remove(folder / "a");
  EXPECT_EQ(rig.status("/a.bin"), 404);
  rig.server->offer_file("", "");
  EXPECT_EQ(rig.status("/a.bin"), 404);
  EXPECT_EQ(rig.status("/"), 200);
}

TEST(Server, AnUnusableAddressIsAnError) {
  const Rig rig;
  ServerOptions taken;
  taken.port = rig.server->port();
  const auto second = Server::open(taken);
  ASSERT_FALSE(second);
  EXPECT_TRUE(second.error().system_failure);
  ServerOptions nowhere;
  nowhere.address = "localhost";
  const auto none = Server::open(nowhere);
  ASSERT_FALSE(none);
  EXPECT_FALSE(none.error().system_failure);
  ServerOptions framed;
  framed.frame_ancestor = "http://a; script-src *";
  EXPECT_FALSE(Server::open(framed));
}

}  // namespace server_test
