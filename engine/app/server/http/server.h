/// Server shows one page over HTTP and talks with it over WebSockets: words come from the pages (viewers), words and pictures go to them.
/// It knows nothing of what they mean. One thread of its own does all of the network; the functions here are called by one other thread,
/// and none of them waits for a viewer.
///
/// What a viewer may cost is bounded, whatever it does:
///   to it      one message is under way and one of each Slot waits: a newer one takes the place of an older one that has not left. Of
///              pictures no more than kMaxFramesInFlight are on the way that the viewer has not said to have shown
///   from it    a message has at most kMaxMessageBytes bytes; when kMaxPendingMessages of them wait to be read here, no more are taken from
///   the
///              network; what is no message of the protocol ends the connection
///   at all     kMaxConnections, kMaxViewers; a request has kRequestTimeoutS seconds and 8 KiB of headers; silence of kIdleTimeoutS
///   seconds, with
///              a ping between, ends a connection
/// Messages: text is words (UTF-8) both ways; binary is a picture from here, and from a viewer four bytes, "one more picture has been
/// shown".
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "engine/base/result.h"

namespace catena::http {

inline constexpr std::size_t kMaxMessageBytes = 16384, kMaxPendingMessages = 64;
inline constexpr int kMaxFramesInFlight = 2, kMaxViewers = 16, kMaxConnections = 64, kRequestTimeoutS = 10, kIdleTimeoutS = 60;

using ViewerId = std::uint64_t;
inline constexpr ViewerId kAllViewers = 0;

/// What a viewer did since it was last asked for.
struct ViewerEvent {
  enum class Kind : std::uint8_t { connected, message, disconnected };
  Kind kind = Kind::connected;
  ViewerId viewer = 0;
  std::string text{};  ///< of said
};

/// What can wait to be sent, in this order; the last one is binary.
enum class Slot : std::uint8_t { role, scene, note, state, frame };
inline constexpr std::size_t kSlotCount = 5;

struct ServerOptions {
  std::string address = "127.0.0.1";      ///< numbers, of IPv4 or IPv6
  std::uint16_t port = 0;                 ///< 0: a free one
  std::vector<std::string> host_names{};  ///< beside "localhost" and addresses in numbers, what browsers may call this machine
  std::string page;                       ///< HTML; every NONCE in it becomes the word that lets its scripts and styles run
  std::string frame_ancestor{};           ///< "http://127.0.0.1:8888": a page whose frame may show this one; empty: none
};

class Server {
 public:
  /// An address that is none is bad input; a port that is not free an error of the machine.
  static Result<std::unique_ptr<Server>> open(ServerOptions options);
  ~Server();  ///< every connection is closed
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  std::uint16_t port() const;
  /// With the token.
  std::string url() const;

  /// What happened since the last call; where nothing has, waits up to `wait_s` for something, or for a viewer that takes a picture.
  std::vector<ViewerEvent> wait_for_events(double wait_s);
  void send(ViewerId viewer, Slot slot, std::string bytes);
  /// GET /NAME brings this file to who has the cookie, to be kept; an empty path: there is none any more. One file at a time, as long as
  /// it is by then.
  void offer_file(std::string name, std::string path);
  /// Some viewer would be sent a picture at once.
  bool has_ready_viewer() const;

 private:
  Server();
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace catena::http
