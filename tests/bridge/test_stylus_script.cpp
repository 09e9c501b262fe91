#include <cmath>
#include <sstream>
#include <string>

#include "common/error.hpp"
#include "device_bridge/stylus_script.hpp"
#include "tests/support/catch.hpp"

using irdm::Error;
using irdm::Quaternion;
using irdm::StylusPose;
using irdm::StylusScript;
using irdm::Vector3;

namespace {

StylusScript parse(const std::string& text) {
  std::istringstream stream(text);
  return StylusScript::parse(stream, "motion.csv");
}

/// That the text is refused, with these words in the message.
void check_script_refused(const std::string& text, const std::string& words) {
  CHECK_THROWS_WITH(parse(text), Catch::Matchers::ContainsSubstring(words));
  CHECK_THROWS_AS(parse(text), Error);
}

const std::string kHeader = "time,x,y,z\n";

}  // namespace

TEST_CASE("script is linear between rows and rests outside them") {
  const StylusScript script = parse(kHeader + "1,0,0,0\n3,2,4,-6\n");
  CHECK(script.start() == 1.0);
  CHECK(script.end() == 3.0);
  CHECK(script.at(-5.0).tip == Vector3(0, 0, 0));
  CHECK(script.at(1.5).tip.isApprox(Vector3(0.5, 1, -1.5)));
  CHECK(script.at(3.0).tip == Vector3(2, 4, -6));
  CHECK(script.at(99.0).tip == Vector3(2, 4, -6));
  CHECK(script.at(2.0).orientation.coeffs() == Quaternion::Identity().coeffs());
}

TEST_CASE("script turns evenly, the short way") {
  const double half = std::sqrt(0.5);
  std::ostringstream text;
  text.precision(17);
  text << "time,x,y,z,qw,qx,qy,qz\n0,0,0,0,1,0,0,0\n1,0,0,0," << -half << ",0,0," << -half << "\n";
  const Quaternion middle = parse(text.str()).at(0.5).orientation;
  const Quaternion expected(Eigen::AngleAxisd(std::acos(-1.0) / 4, Vector3::UnitZ()));
  CHECK(middle.angularDistance(expected) < 1e-7);
}

TEST_CASE("script keeps the buttons of the row before") {
  const StylusScript script = parse("time,x,y,z,button\n0,0,0,0,0\n1,0,0,0,1\n2,0,0,0,0\n");
  CHECK(script.at(0.99).buttons == 0);
  CHECK(script.at(1.0).buttons == 1);
  CHECK(script.at(1.99).buttons == 1);
  CHECK(script.at(2.0).buttons == 0);
}

TEST_CASE("script may have comments, blank lines, spaces and all columns") {
  const StylusScript script = parse(
      "# a motion\n\n time , x, y,z, qw,qx,qy,qz , button\r\n0, 1,2,3, 1,0,0,0, 1 # here\r\n");
  CHECK(script.at(0.0).tip == Vector3(1, 2, 3));
  CHECK(script.at(0.0).buttons == 1);
}

TEST_CASE("script refuses what does not fit, with file and line") {
  check_script_refused("", "motion.csv: is empty");
  check_script_refused("# nothing\n", "is empty");
  check_script_refused(kHeader, "has no rows");
  check_script_refused("0,0,0,0\n", "motion.csv:1: '0,0,0,0' is not a header");
  check_script_refused("time,x,y\n", "is not a header");
  check_script_refused("time,x,y,z,qw\n", "is not a header");
  check_script_refused("time,x,y,z,button,qw,qx,qy,qz\n", "is not a header");
  check_script_refused(kHeader + "0,0,0\n", "motion.csv:2: has 3 values");
  check_script_refused(kHeader + "0,0,0,0,0\n", "has 5 values");
  check_script_refused(kHeader + "0,0,zero,0\n", "'zero' is not a number");
  check_script_refused(kHeader + "0,0,,0\n", "'' is not a number");
  check_script_refused(kHeader + "0,0,1m,0\n", "'1m' is not a number");
  check_script_refused(kHeader + "0,0,nan,0\n", "'nan' is not finite");
  check_script_refused(kHeader + "0,0,inf,0\n", "'inf' is not finite");
  check_script_refused(kHeader + "0,0,1e999,0\n", "is not finite");
  check_script_refused(kHeader + "0,1001,0,0\n", "motion.csv:2: is out of reach");
  check_script_refused(kHeader + "0,0,0,-1e308\n", "is out of reach");
  check_script_refused(kHeader + "-1e308,0,0,0\n", "is out of reach");
  check_script_refused(kHeader + std::string("0,0,1\0x,0\n", 11), "is not a number");
  check_script_refused(kHeader + "0,0,0,0\n\n0,0,0,0\n",
                       "motion.csv:4: time 0 does not come after");
  check_script_refused(kHeader + "1,0,0,0\n0.5,0,0,0\n", "does not come after");
  check_script_refused("time,x,y,z,qw,qx,qy,qz\n0,0,0,0,0,0,0,0\n", "not of norm 1");
  check_script_refused("time,x,y,z,button\n0,0,0,0,-1\n", "button '-1'");
  check_script_refused("time,x,y,z,button\n0,0,0,0,0.5\n", "button '0.5'");
  CHECK_THROWS_WITH(StylusScript::load("/nowhere/motion.csv"),
                    Catch::Matchers::ContainsSubstring("no such"));
}
