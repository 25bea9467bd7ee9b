// SPDX-License-Identifier: MIT
#include "engine/app/server/http/access_control.h"

#include <gtest/gtest.h>

namespace access_control_test {

using catena::http::AccessControl;

TEST(AccessControl, AnUnknownHostNameIsRefused) {
  const AccessControl access({"gpu.lab", "Big-Machine"});
  for (const char* good :
       {"localhost", "localhost:8642", "LOCALHOST:1", "127.0.0.1:8642", "192.168.1.7", "[::1]:8642", "gpu.lab:80", "big-machine"})
    EXPECT_TRUE(access.allows_host(good)) << good;
  for (const char* bad : {"", ":8642", "evil.example", "localhost.evil.example", "127.0.0.1.evil.example", "gpu.lab.evil.example:8642",
                          "localhost:", "localhost:x", "localhost:8642:1", "[::1", "[::1]x", "127.0.0.1:8642 evil", "localhost:1234567"})
    EXPECT_FALSE(access.allows_host(bad)) << bad;
  EXPECT_FALSE(access.allows_host(std::string(100000, 'a')));
}

TEST(AccessControl, ASocketNeedsTheServersOwnOrigin) {
  EXPECT_TRUE(AccessControl::allows_origin("http://127.0.0.1:8642", "127.0.0.1:8642"));
  for (const char* bad : {"", "null", "http://evil.example", "http://127.0.0.1:8643", "http://localhost:8642", "https://127.0.0.1:8642",
                          "http://127.0.0.1:8642.evil.example", "http://127.0.0.1:8642/"})
    EXPECT_FALSE(AccessControl::allows_origin(bad, "127.0.0.1:8642")) << bad;
  EXPECT_FALSE(AccessControl::allows_origin("http://", ""));
}

TEST(AccessControl, TheTokenAndTheCookieAreDifferentSecrets) {
  const AccessControl access({}), other({});
  EXPECT_EQ(access.token().size(), 32u);
  EXPECT_NE(access.token(), other.token());
  EXPECT_TRUE(access.has_token("/?token=" + access.token()));
  EXPECT_FALSE(access.has_token("/?token=" + other.token()));
  EXPECT_FALSE(access.has_token("/?token=" + access.token() + "0"));
  EXPECT_FALSE(access.has_token("/?token="));
  EXPECT_FALSE(access.has_token("/" + access.token()));

  const std::string set = access.set_cookie_header("localhost:9000"), cookie = set.substr(0, set.find(';'));
  EXPECT_EQ(set.find(access.token()), std::string::npos);
  EXPECT_NE(set.find("; HttpOnly"), std::string::npos);
  EXPECT_NE(set.find("; SameSite=Strict"), std::string::npos);
  EXPECT_TRUE(access.has_cookie(cookie, "localhost:9000"));
  EXPECT_TRUE(access.has_cookie("a=b; " + cookie + "; c=d", "localhost:9000"));
  EXPECT_FALSE(access.has_cookie(cookie, "localhost:9001")) << "another server's of this machine";
  EXPECT_FALSE(other.has_cookie(cookie, "localhost:9000"));
  for (const char* bad : {"", ";", ";;; ;", "catena_9000", "catena_9000=", "=", "catena_9000=; catena_9000"})
    EXPECT_FALSE(access.has_cookie(bad, "localhost:9000")) << bad;
}

}  // namespace access_control_test
