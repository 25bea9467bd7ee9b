// SPDX-License-Identifier: MIT
/// `catena serve` as a child process of a test.
#pragma once
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fcntl.h>

#include <string>
#include <thread>
#include <vector>

#include "engine/base/json.h"
#include "tests/engine/app/server/http/http_client.h"
#include "tests/support/run_program.h"
#include "tests/support/support.h"

namespace catena::test {

/// Starts a program without a shell; `prepare` runs in the child before it.
inline pid_t start_process(std::vector<std::string> words, const std::function<void()>& prepare) {
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const pid_t child = fork();
  if (child != 0) return child;
  prepare();
  execv(argv[0], argv.data());
  _exit(127);
}

class ServeProcess {
 public:
  /// Starts the server with port 0, small images and more options, and waits for the address.
  explicit ServeProcess(const std::string& source, const std::vector<std::string>& options = {}) {
    std::vector<std::string> words{program_path(), "serve", source, "--port", "0", "--size", "160x120", "--seconds", "120"};
    words.insert(words.end(), options.begin(), options.end());
    const std::string out = folder_ / "out", err = folder_ / "err";
    child_ = start_process(words, [&] {
      dup2(::open(out.c_str(), O_WRONLY | O_CREAT, 0600), 1);
      dup2(::open(err.c_str(), O_WRONLY | O_CREAT, 0600), 2);
      setenv("XDG_CACHE_HOME", (folder_ / "cache").c_str(), 1);
    });
    for (int i = 0; i < 3000 && this->out().find('\n') == std::string::npos && waitpid(child_, &status_, WNOHANG) == 0; ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    url_ = this->out().substr(0, this->out().find('\n'));
    if (!url_.starts_with("http://127.0.0.1:")) return;
    port_ = std::stoi(url_.substr(17));
    cookie_ = fetch_cookie(port_, url_);
  }
  ~ServeProcess() {
    if (child_ > 0 && !ended_) {
      kill(child_, SIGKILL);
      waitpid(child_, nullptr, 0);
    }
  }
  ServeProcess(const ServeProcess&) = delete;
  ServeProcess& operator=(const ServeProcess&) = delete;

  const std::string& url() const { return url_; }
  int port() const { return port_; }
  const std::string& cookie() const { return cookie_; }
  std::string out() const { return exists(folder_ / "out") ? read_file(folder_ / "out") : ""; }
  std::string err() const { return exists(folder_ / "err") ? read_file(folder_ / "err") : ""; }
  std::unique_ptr<WebSocketClient> page() const {
    return std::make_unique<WebSocketClient>(port_, WebSocketClient::Identity{cookie_, "http://127.0.0.1:" + std::to_string(port_)});
  }
  /// Sends SIGINT, and returns the exit code.
  int interrupt_and_wait() {
    kill(child_, SIGINT);
    return wait();
  }
  /// Waits for the end, and returns the exit code.
  int wait() {
    waitpid(child_, &status_, 0);
    ended_ = true;
    return WIFEXITED(status_) ? WEXITSTATUS(status_) : 128 + WTERMSIG(status_);
  }

 private:
  TemporaryFolder folder_;
  pid_t child_ = 0;
  int status_ = 0, port_ = 0;
  bool ended_ = false;
  std::string url_, cookie_;
};

/// The member `key` of the next message that has it and is wanted; null if the connection ends first. Acknowledges images. `passed` gets
/// every earlier message, because one-time messages have no fixed order.
inline json::Node wait_for_message(WebSocketClient& page, const std::string& key, const std::function<bool(const json::Node&)>& wanted = {},
                                   const std::function<void(const json::Node&)>& passed = {}) {
  for (int i = 0; i < 2000; ++i) {
    const auto message = page.read();
    if (!message) return {};
    if (!message->is_text) {
      page.acknowledge_frame();
      continue;
    }
    const auto node = json::parse(message->bytes, "message");
    if (node && passed) passed(*node);
    const json::Node* member = node ? node->find(key) : nullptr;
    if (member != nullptr && (!wanted || wanted(*member))) return *member;
  }
  return {};
}

struct SentFrame {
  std::uint32_t number = 0, motion = 0, width = 0, height = 0;
  bool exact = false;
  std::string file;
};

/// The next wanted image, acknowledged; number 0 if the connection ends first.
inline SentFrame wait_for_frame(WebSocketClient& page, const std::function<bool(const SentFrame&)>& wanted = {}) {
  for (int i = 0; i < 2000; ++i) {
    const auto message = page.read();
    if (!message) return {};
    if (message->is_text || message->bytes.size() < 16) continue;
    page.acknowledge_frame();
    const auto number = [&](std::size_t at, int count) {
      std::uint32_t value = 0;
      for (int k = count; k-- > 0;) value = 256 * value + static_cast<unsigned char>(message->bytes[at + static_cast<std::size_t>(k)]);
      return value;
    };
    SentFrame picture{number(0, 4), number(4, 4), number(8, 2), number(10, 2), number(12, 1) == 2, message->bytes.substr(16)};
    if (!wanted || wanted(picture)) return picture;
  }
  return {};
}

}  // namespace catena::test
