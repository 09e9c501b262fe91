#include <catch2/catch.hpp>
#include <sstream>

#include "device_bridge/virtual_stylus.hpp"

using namespace irdm;

namespace {

StylusScript script() {
  std::istringstream text("time,x,y,z,button\n0,0,0,0,0\n1,0.1,0,0,1\n");
  return StylusScript::parse(text, "motion.csv");
}

}  // namespace

TEST_CASE("virtual stylus without a hand moves exactly as scripted, whatever the force") {
  VirtualStylus stylus(script());
  stylus.write(Vector3(0, 9, 0));
  CHECK(stylus.read(0.5).tip.isApprox(Vector3(0.05, 0, 0)));
  CHECK(stylus.read(1.0).buttons == 1);
  CHECK(stylus.duration() == 1.0);
  CHECK(stylus.simulated());
}

TEST_CASE("virtual stylus with a hand follows the script and gives way to the force") {
  VirtualStylus stylus(script(), HandParameters{});
  stylus.write(Vector3(0, 3, 0));
  CHECK(stylus.read(0.0).tip == Vector3::Zero());
  for (int tick = 1; tick <= 5000; ++tick) stylus.read(1e-3 * tick);
  CHECK((stylus.read(5.0).tip - Vector3(0.1, 0.01, 0)).norm() < 1e-9);
}
