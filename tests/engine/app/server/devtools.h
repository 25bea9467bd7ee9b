// SPDX-License-Identifier: MIT
/// A headless Chromium, driven over its DevTools (https://chromedevtools.github.io/devtools-protocol).
#pragma once
#include "tests/engine/app/server/serve_process.h"

namespace catena::test {

/// The path of the browser; empty if none is installed.
inline std::string browser_path() {
  for (const char* path : {"/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"})
    if (exists(path)) return path;
  return {};
}

class Browser {
 public:
  /// Starts the browser with a size like "800,600"; is_running() tells whether it responds.
  explicit Browser(const std::string& size) {
    std::vector<std::string> words{browser_path(), "--window-size=" + size, "--user-data-dir=" + folder_ / "home"};
    for (const char* word :
         {"--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--no-first-run", "--disable-extensions",
          "--disable-background-networking", "--mute-audio", "--remote-debugging-port=0", "about:blank"})
      words.push_back(word);
    const std::string port_file = folder_ / "home/DevToolsActivePort";
    child_ = start_process(words, [&] {
      setpgid(0, 0);
      for (const int descriptor : {0, 1, 2}) dup2(::open("/dev/null", O_RDWR), descriptor);
      setenv("HOME", folder_.path().c_str(), 1);
    });
    for (int i = 0; i < 3000 && (!exists(port_file) || read_file(port_file).find('\n') == std::string::npos); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    if (!exists(port_file)) return;
    const int port = std::stoi(read_file(port_file));
    const std::string answer =
        send_raw_request(port, make_request("/json/list", {{"Host", "127.0.0.1:" + std::to_string(port)}, {"Connection", "close"}}));
    const std::string scheme = "ws://127.0.0.1:" + std::to_string(port);
    const auto at = answer.find(scheme + "/devtools/page/");
    if (at == std::string::npos) return;
    const auto begin = at + scheme.size(), end = answer.find('"', at);
    tab_ = std::make_unique<WebSocketClient>(port, WebSocketClient::Identity{"", "", answer.substr(begin, end - begin)});
  }
  ~Browser() {
    tab_.reset();
    if (child_ <= 0) return;
    kill(-child_, SIGKILL);
    waitpid(child_, nullptr, 0);
  }
  Browser(const Browser&) = delete;
  Browser& operator=(const Browser&) = delete;

  bool is_running() const { return tab_ && tab_->is_open(); }

  /// The result of a call with parameters as JSON; null if the browser has ended.
  json::Node call(const std::string& method, const std::string& parameters) {
    const int id = ++calls_;
    tab_->send("{\"id\": " + std::to_string(id) + ", \"method\": \"" + method + "\", \"params\": " + parameters + "}");
    while (const auto message = tab_->read()) {
      const auto node = json::parse(message->bytes, method);
      if (!node || node->find("id") == nullptr || node->find("id")->number != id) continue;
      const json::Node* result = node->find("result");
      return result != nullptr ? *result : json::Node();
    }
    return {};
  }
  void open(const std::string& url) { call("Page.navigate", "{\"url\": \"" + url + "\"}"); }
  /// The value of an expression in the page; the expression may have single quotes only.
  json::Node evaluate(const std::string& expression) {
    const json::Node answer =
        call("Runtime.evaluate", "{\"returnByValue\": true, \"awaitPromise\": true, \"expression\": \"" + expression + "\"}");
    const json::Node* result = answer.find("result");
    const json::Node* value = result != nullptr ? result->find("value") : nullptr;
    return value != nullptr ? *value : json::Node();
  }
  double evaluate_number(const std::string& expression) {
    const json::Node node = evaluate("Number(" + expression + ")");
    return node.kind == json::Kind::number ? node.number : -1;
  }
  /// Waits until the expression is true; false if it never is.
  bool wait_until(const std::string& expression) {
    for (int i = 0; i < 600; ++i) {
      if (evaluate("Boolean(" + expression + ")").boolean) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    return false;
  }
  /// Sends a mouse event: "mousePressed", "mouseMoved", "mouseReleased" or "mouseWheel".
  void mouse(const std::string& what, int x, int y, const std::string& more = "") {
    call("Input.dispatchMouseEvent", "{\"type\": \"" + what + "\", \"x\": " + std::to_string(x) + ", \"y\": " + std::to_string(y) +
                                         (more.empty() ? "" : ", " + more) + "}");
  }
  void key(const std::string& key) {
    for (const char* what : {"keyDown", "keyUp"})
      call("Input.dispatchKeyEvent", std::string("{\"type\": \"") + what + "\", \"key\": \"" + key + "\"}");
  }
  /// A PNG of the page.
  std::string screenshot() {
    const json::Node answer = call("Page.captureScreenshot", "{\"format\": \"png\"}");
    return answer.find("data") != nullptr ? from_base64(answer.find("data")->string) : "";
  }

 private:
  static std::string from_base64(const std::string& text) {
    constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string bytes;
    unsigned held = 0;
    int bits = 0;
    for (const char c : text) {
      const auto digit = kDigits.find(c);
      if (digit == std::string_view::npos) continue;
      held = held << 6 | static_cast<unsigned>(digit);
      bits += 6;
      if (bits < 8) continue;
      bits -= 8;
      bytes += static_cast<char>(held >> bits & 255);
    }
    return bytes;
  }

  TemporaryFolder folder_;
  pid_t child_ = 0;
  int calls_ = 0;
  std::unique_ptr<WebSocketClient> tab_;
};

}  // namespace catena::test
