#include <algorithm>
#include <string>

#include "common/wire/open_endpoints.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;
using Catch::Matchers::StartsWith;

TEST_CASE("an address of its own is where a program is reached") {
  using Endpoints = std::vector<std::string>;
  CHECK(wire::open_endpoints("127.0.0.1", 80) == Endpoints{"127.0.0.1:80"});
  CHECK(wire::open_endpoints("::1", 47000) == Endpoints{"[::1]:47000"});
}

TEST_CASE("where all addresses are listened on, those that can be opened are named") {
  const std::vector<std::string> v4 = wire::open_endpoints("0.0.0.0", 8080);
  CHECK_THAT(v4.at(0), StartsWith("127.") && Catch::Matchers::EndsWith(":8080"));
  const std::vector<std::string> both = wire::open_endpoints("::", 8080);
  for (const std::vector<std::string>& endpoints : {v4, both}) {
    for (const std::string& each : endpoints) {
      CHECK_THAT(each, !StartsWith("0.0.0.0") && !StartsWith("[::]") && !StartsWith("[fe80"));
      CHECK(std::count(endpoints.begin(), endpoints.end(), each) == 1);
    }
  }
  for (const std::string& each : v4) {
    CHECK(std::count(both.begin(), both.end(), each) == 1);
  }
}
