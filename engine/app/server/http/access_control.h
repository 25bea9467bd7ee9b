// SPDX-License-Identifier: MIT
/// Decides who may see the page: a browser that has the token, which is printed and exchanged for a cookie, and that sends its requests
/// from a page of this server. Three checks, each against one attack:
///   token, cookie   another user or program of this computer that can reach the port but has not read the terminal
///   Host            a foreign page whose name is made to resolve to this computer (DNS rebinding): names that were not configured are
///                   rejected; numeric addresses cannot be rebound
///   Origin          a foreign page that opens a WebSocket here with the browser's own cookie: only this server's page may
/// Pure except for the generation of secrets; any thread. Memory use is bounded whatever the headers contain.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.h"

namespace catena::http {

/// Returns 128 random bits from the operating system as 32 hexadecimal digits.
std::string generate_secret();
/// Compares two strings in a time that does not depend on where they differ.
bool constant_time_equal(std::string_view a, std::string_view b);

/// The secrets and host names of one server; checks the headers of requests.
class AccessControl {
 public:
  /// `names`: host names of this server, in addition to "localhost" and numeric addresses.
  explicit AccessControl(std::vector<std::string> names);

  /// The token of the URL.
  const std::string& token() const { return token_; }

  /// Checks the header Host: "localhost:8642", "127.0.0.1", "[::1]:8642", or one of the names, with any port (an `ssh -L` tunnel has its
  /// own).
  bool allows_host(std::string_view host) const;
  /// Checks the header Origin of a WebSocket request: the page has the address that the WebSocket connects to. Without an Origin: false.
  static bool allows_origin(std::string_view origin, std::string_view host);
  /// Whether a request target is "/?token=..." with the right token.
  bool has_token(std::string_view target) const;
  /// Whether the header Cookie contains the cookie of set_cookie_header().
  bool has_cookie(std::string_view cookies, std::string_view host) const;
  /// The value of the header Set-Cookie: HttpOnly, SameSite=Strict. The cookie's name contains the port that the browser uses, because
  /// browsers share cookies between the ports of a host.
  std::string set_cookie_header(std::string_view host) const;

 private:
  std::string token_ = generate_secret(), cookie_ = generate_secret();
  std::vector<std::string> names_;
};

}  // namespace catena::http
