// SPDX-License-Identifier: MIT
/// Server serves one page over HTTP and exchanges messages with it over WebSockets: text messages come from the pages (viewers); text
/// messages and frames go to them. It does not interpret them. A network thread of its own does all input and output; the functions here
/// are called by one other thread, and only wait_for_events() waits, up to its time limit.
///
/// The cost of a viewer is bounded, whatever it does:
///   to it      one message is being sent and at most one per Slot waits: a newer one replaces an older one that has not been sent. At most
///              kMaxFramesInFlight frames are in flight that the viewer has not acknowledged as shown
///   from it    a message has at most kMaxMessageBytes bytes; while kMaxPendingMessages of them wait to be processed, no more are read from
///              the network; a message that violates the protocol ends the connection
///   in all     kMaxConnections, kMaxViewers; a request has kRequestTimeoutS seconds and 8 KiB of headers; silence of kIdleTimeoutS
///              seconds, with a ping in between, ends a connection
/// Messages: text (UTF-8) in both directions; binary messages are frames to a viewer, and four bytes from a viewer: "one more frame was
/// shown".
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "engine/base/result.h"

namespace catena::http {

/// Limits; see above.
inline constexpr std::size_t kMaxMessageBytes = 16384, kMaxPendingMessages = 64;
inline constexpr int kMaxFramesInFlight = 2, kMaxViewers = 16, kMaxConnections = 64, kRequestTimeoutS = 10, kIdleTimeoutS = 60;

/// Number of a viewer, from 1; never reused.
using ViewerId = std::uint64_t;
/// Recipient of a message to all viewers.
inline constexpr ViewerId kAllViewers = 0;

/// An event of a viewer.
struct ViewerEvent {
  enum class Kind : std::uint8_t { connected, message, disconnected };
  Kind kind = Kind::connected;
  ViewerId viewer = 0;
  std::string text{};  ///< The text of Kind::message
};

/// Kinds of messages that can wait to be sent, in the order of sending; frames are binary.
enum class Slot : std::uint8_t { role, scene, note, state, frame };
inline constexpr std::size_t kSlotCount = 5;

/// Options of a server.
struct ServerOptions {
  std::string address = "127.0.0.1";  ///< Numeric IPv4 or IPv6 address
  std::uint16_t port = 0;             ///< 0: a free port
  /// Host names of this server, in addition to "localhost" and numeric addresses
  std::vector<std::string> host_names{};
  /// HTML; every NONCE in it is replaced by the nonce that allows its scripts and styles to run
  std::string page;
  /// Origin of a page that may show this page in a frame, "http://127.0.0.1:8888"; empty: none
  std::string frame_ancestor{};
};

/// The server. Used from one thread.
class Server {
 public:
  /// Starts the server. Error: an invalid address is bad input; a port that is in use is a system failure.
  static Result<std::unique_ptr<Server>> open(ServerOptions options);
  ~Server();  ///< Closes all connections
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// The port that is in use.
  std::uint16_t port() const;
  /// URL of the page, with the token.
  std::string url() const;

  /// Returns the events since the last call; if there are none, waits up to `wait_s` seconds for an event, or for a viewer that becomes
  /// ready for a frame.
  std::vector<ViewerEvent> wait_for_events(double wait_s);
  /// Sends a message to a viewer, or to all with kAllViewers.
  void send(ViewerId viewer, Slot slot, std::string bytes);
  /// Offers a file for download: GET /NAME, for browsers that have the cookie. An empty path: no file. One file at a time, with its size at
  /// the time of the request.
  void offer_file(std::string name, std::string path);
  /// Whether a frame could be sent to some viewer at once.
  bool has_ready_viewer() const;

 private:
  Server();
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace catena::http
