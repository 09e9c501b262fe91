// Which pages of which hosts may talk to the viewer's server.
#include <string>

#include "tests/support/catch.hpp"
#include "viewer/request_rules.hpp"

using namespace irdm::viewer;

TEST_CASE("which origins are allowed") {
  CHECK(origin_allowed("http://localhost:8080", "LOCALHOST:8080", false));
  CHECK(origin_allowed("https://[::1]:8080", "[::1]:8080", false));
  CHECK(origin_allowed("https://lab.example", "lab.example", true));
  CHECK_FALSE(origin_allowed("https://lab.example", "lab.example", false));
  CHECK_FALSE(origin_allowed("null", "127.0.0.1", false));
  CHECK_FALSE(origin_allowed("http://", "", true));
  CHECK_FALSE(origin_allowed("http://127.0.0.1:1", "127.0.0.1:2", false));
  CHECK_FALSE(origin_allowed("http://127.0.0.1.evil.example", "127.0.0.1.evil.example", false));
}

TEST_CASE("a host that is none is no origin, with a token or without") {
  const bool token_needed = GENERATE(false, true);
  const std::string host = GENERATE(
      "[::1].evil.com", "127.0.0.1:1@evil.com", "127.0.0.1:80#.evil.com", "[::1]:1@evil.com",
      "[::1]x:80", "[::1", "::1", "[127.0.0.1]", "[::1%25lo]", "[::1%lo]", "localhost:", ":80",
      "localhost:65536", "localhost:+80", "localhost:80:80", "localhost:8 0", "localhost/x",
      "localhost?x", "user@localhost", "127.0.0.1#", "127.0.0.1\t");
  CAPTURE(host);
  CHECK_FALSE(origin_allowed("http://" + host, host, token_needed));
}

TEST_CASE("which hosts are of this machine") {
  const std::string local = GENERATE("127.0.0.1", "127.0.0.1:80", "10.0.0.7:65535", "[::1]",
                                     "[fe80::1]:8080", "[::ffff:127.0.0.1]:1", "Localhost");
  CAPTURE(local);
  CHECK(origin_allowed("http://" + local, local, false));
  const std::string named = GENERATE("127.0.0.1.evil.com", "lab-2.example_x:80", "127.1", "0x7f.1");
  CAPTURE(named);
  CHECK_FALSE(origin_allowed("http://" + named, named, false));
  CHECK(origin_allowed("http://" + named, named, true));
}
