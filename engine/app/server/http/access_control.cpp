// SPDX-License-Identifier: MIT
#include "engine/app/server/http/access_control.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <boost/asio/ip/address.hpp>
#include <cctype>
#include <cstdint>

namespace catena::http {

namespace {

constexpr std::size_t kLongestName = 255;  // maximum length of a host name

struct HostParts {
  std::string name, port;  ///< lower case, without brackets; digits or empty
};

HostParts parts_of(std::string_view host) {
  if (host.size() > kLongestName + 8) return {};
  std::string_view name = host, port;
  if (host.starts_with('[')) {
    const auto close = host.find(']');
    if (close == std::string_view::npos) return {};
    name = host.substr(1, close - 1);
    port = host.substr(close + 1);
  } else if (const auto colon = host.find(':'); colon != std::string_view::npos) {
    name = host.substr(0, colon);
    port = host.substr(colon);
  }
  const bool good = port.empty() || (port.size() >= 2 && port.size() <= 6 && port.front() == ':' &&
                                     port.find_first_not_of("0123456789", 1) == std::string_view::npos);
  if (!good || name.empty()) return {};
  HostParts parts{std::string(name), port.empty() ? "" : std::string(port.substr(1))};
  for (char& c : parts.name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return parts;
}

std::string cookie_name(std::string_view host) { return "catena_" + parts_of(host).port; }

}  // namespace

std::string generate_secret() {
  std::array<std::uint8_t, 16> bytes{};
  CATENA_ASSERT(getentropy(bytes.data(), bytes.size()) == 0);
  std::string text;
  for (const std::uint8_t byte : bytes) {
    text += "0123456789abcdef"[byte >> 4];
    text += "0123456789abcdef"[byte & 15];
  }
  return text;
}

bool constant_time_equal(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  unsigned differ = 0;
  for (std::size_t i = 0; i < a.size(); ++i) differ |= static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]);
  return differ == 0;
}

AccessControl::AccessControl(std::vector<std::string> names) : names_(std::move(names)) {
  for (std::string& name : names_) name = parts_of(name).name;
}

bool AccessControl::allows_host(std::string_view host) const {
  const HostParts parts = parts_of(host);
  if (parts.name.empty()) return false;
  boost::system::error_code wrong;
  boost::asio::ip::make_address(parts.name, wrong);
  return !wrong || parts.name == "localhost" || std::find(names_.begin(), names_.end(), parts.name) != names_.end();
}

bool AccessControl::allows_origin(std::string_view origin, std::string_view host) {
  constexpr std::string_view kScheme = "http://";
  return !host.empty() && origin.starts_with(kScheme) && origin.substr(kScheme.size()) == host;
}

bool AccessControl::has_token(std::string_view target) const {
  constexpr std::string_view kPlace = "/?token=";
  return target.starts_with(kPlace) && constant_time_equal(target.substr(kPlace.size()), token_);
}

bool AccessControl::has_cookie(std::string_view cookies, std::string_view host) const {
  const std::string name = cookie_name(host) + "=";
  for (std::size_t at = 0; at < cookies.size();) {
    const std::size_t end = std::min(cookies.find(';', at), cookies.size());
    std::string_view cookie = cookies.substr(at, end - at);
    cookie.remove_prefix(std::min(cookie.find_first_not_of(' '), cookie.size()));
    if (cookie.starts_with(name) && constant_time_equal(cookie.substr(name.size()), cookie_)) return true;
    at = end + 1;
  }
  return false;
}

std::string AccessControl::set_cookie_header(std::string_view host) const {
  return cookie_name(host) + "=" + cookie_ + "; HttpOnly; SameSite=Strict; Path=/";
}

}  // namespace catena::http
