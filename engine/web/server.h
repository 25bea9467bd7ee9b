/// Server shows one page over HTTP and talks with it over WebSockets: words come from the pages (viewers), words and pictures go to them.
/// It knows nothing of what they mean. One thread of its own does all of the network; the functions here are called by one other thread,
/// and none of them waits for a viewer.
///
/// What a viewer may cost is bounded, whatever it does:
///   to it      one message is under way and one of each Slot waits: a newer one takes the place of an older one that has not left. Of
///              pictures no more than kPicturesAhead are on the way that the viewer has not said to have shown
///   from it    a message has at most kLongestMessage bytes; when kMostWaiting of them wait to be read here, no more are taken from the
///              network; what is no message of the protocol ends the connection
///   at all     kMostConnections, kMostViewers; a request has kPatienceS seconds and 8 KiB of headers; silence of kSilenceS seconds, with
///              a ping between, ends a connection
/// Messages: text is words (UTF-8) both ways; binary is a picture from here, and from a viewer four bytes, "one more picture has been
/// shown".
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "engine/base/result.h"

namespace catena::web {

inline constexpr std::size_t kLongestMessage = 16384, kMostWaiting = 64;
inline constexpr int kPicturesAhead = 2, kMostViewers = 16, kMostConnections = 64, kPatienceS = 10, kSilenceS = 60;

using ViewerId = std::uint64_t;
inline constexpr ViewerId kAllViewers = 0;

/// What a viewer did since it was last asked for.
struct News {
  enum class What : std::uint8_t { came, said, left };
  What what = What::came;
  ViewerId viewer = 0;
  std::string words{};  ///< of said
};

/// What can wait to be sent, in this order; the last one is binary.
enum class Slot : std::uint8_t { role, scene, note, state, picture };
inline constexpr std::size_t kSlots = 5;

struct ServerOptions {
  std::string address = "127.0.0.1";  ///< numbers, of IPv4 or IPv6
  std::uint16_t port = 0;             ///< 0: a free one
  std::vector<std::string> names{};   ///< beside "localhost" and addresses in numbers, what browsers may call this machine
  std::string page;                   ///< HTML; every NONCE in it becomes the word that lets its scripts and styles run
  std::string framed_by{};            ///< "http://127.0.0.1:8888": a page whose frame may show this one; empty: none
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
  std::vector<News> take(double wait_s);
  void send(ViewerId viewer, Slot slot, std::string bytes);
  /// GET /NAME brings this file to who has the cookie, to be kept; an empty path: there is none any more. One file at a time, as long as
  /// it is by then.
  void offer(std::string name, std::string path);
  /// Some viewer would be sent a picture at once.
  bool wants_picture() const;

 private:
  Server();
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace catena::web
