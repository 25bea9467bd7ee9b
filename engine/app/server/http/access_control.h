/// Who may see the page: whoever knows the token, which is printed once and exchanged for a cookie, and comes through a page of this very
/// server. Three checks, each for an attack of its own:
///   token, cookie   another user or program of this machine, which reaches the port but has not read the terminal
///   Host            a stranger's page whose name is made to mean this machine (DNS rebinding): a name that was not given is refused;
///                   numbers of an address cannot be rebound
///   Origin          a stranger's page that opens a WebSocket here with the browser's own cookie: only this server's page may
/// Pure but for the making of secrets; any thread. Nothing here allocates on the word of who asks.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.h"

namespace catena::http {

/// 128 random bits of the operating system as 32 hexadecimal digits.
std::string generate_secret();
/// Equal, in a time that does not tell where they differ.
bool constant_time_equal(std::string_view a, std::string_view b);

class AccessControl {
 public:
  /// `names`: what a browser may call this machine beside "localhost" and the numbers of an address.
  explicit AccessControl(std::vector<std::string> names);

  const std::string& token() const { return token_; }

  /// The header Host: "localhost:8642", "127.0.0.1", "[::1]:8642", or one of the names, with any port (an `ssh -L` has one of its own).
  bool allows_host(std::string_view host) const;
  /// The header Origin of a WebSocket: the page came from the very address that the WebSocket goes to. No Origin: refused.
  static bool allows_origin(std::string_view origin, std::string_view host);
  /// A target "/?token=..." with the right token.
  bool has_token(std::string_view target) const;
  /// The header Cookie has the cookie that set_cookie_header gave.
  bool has_cookie(std::string_view cookies, std::string_view host) const;
  /// The header Set-Cookie: HttpOnly, SameSite=Strict. Its name has the port that the browser uses, for cookies of one machine are shared
  /// by its ports.
  std::string set_cookie_header(std::string_view host) const;

 private:
  std::string token_ = generate_secret(), cookie_ = generate_secret();
  std::vector<std::string> names_;
};

}  // namespace catena::http
