#include "common/motion/free_motion.hpp"
#include "simulation/step/energy_account.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;

TEST_CASE("energy account: what hands gave is remembered, and no more than that acts") {
  EnergyAccount account;
  account.begin(3.0);
  CHECK(account.balance() == 0.0);
  CHECK(account.driving_share() == 1.0);
  account.settle(0.05, 3.02);  // 50 mJ from hands, 20 of it motion
  CHECK(account.balance() == Approx(0.03));
  account.settle(-0.01, 3.02);  // 10 mJ given back
  CHECK(account.balance() == Approx(0.02));
  account.settle(0.0, 3.02 + 0.02 + EnergyAccount::kAllowance);
  CHECK(account.balance() == Approx(-EnergyAccount::kAllowance));
  CHECK(account.driving_share() == Approx(1.0));
  account.settle(-0.5 * EnergyAccount::kAllowance, 3.04 + EnergyAccount::kAllowance);
  CHECK(account.driving_share() == Approx(0.5));
  account.settle(-1.0, 3.04 + EnergyAccount::kAllowance);
  CHECK(account.driving_share() == 0.0);
  account.set_energy(0.0);  // another gravity is nobody's work
  account.settle(0.0, 0.0);
  CHECK(account.balance() == EnergyAccount::kLeast);
  account.settle(10.0, 0.0);
  CHECK(account.balance() == EnergyAccount::kMost);
}

TEST_CASE("energy account: a late force adds no more than what is left") {
  EnergyAccount account;
  account.begin(0.0);
  account.settle(0.015, 0.0);
  const double left = 0.015 + EnergyAccount::kAllowance;
  CHECK(account.enter(0.004, 0.002, 0.0) == 1.0);
  // Of what the first one left: s 30 mJ + s^2 40 mJ = 14 mJ.
  const double share = account.enter(0.03, 0.04, 0.0);
  CHECK(share * 0.03 + share * share * 0.04 == Approx(left - 0.006));
  CHECK(account.enter(0.01, 0.01, 0.0) == Approx(0.0).margin(1e-12));
  CHECK(account.enter(0.01, 0.01, 0.03) == 1.0);  // its hand did that work meanwhile
  account.settle(0.0, left);
  CHECK(account.balance() == Approx(-EnergyAccount::kAllowance));
  account.settle(0.0, left + EnergyAccount::kAllowance);
  CHECK(account.enter(0.01, 0.01, 1.0) == Approx(0.0).margin(1e-12));
  CHECK(account.enter(-0.02, 0.001, 0.0) == 1.0);  // what takes energy out may
  // Which leaves 19 mJ less the 5 mJ that are lacking: s^2 1 J - s 20 mJ = 14 mJ.
  const double other = account.enter(-0.02, 1.0, 0.0);
  CHECK(other * other - 0.02 * other == Approx(0.014));
  CHECK(account.enter(1e-300, 0.0, 0.0) == 0.0);
}

TEST_CASE("energy account: what is lacking is forgiven, slowly while a hand touches") {
  EnergyAccount account;
  account.begin(0.0);
  account.settle(0.0, 0.01);
  account.forgive(0.1, false);
  double lacking = -0.01 + 0.1 * EnergyAccount::kForgiven;
  CHECK(account.balance() == Approx(lacking));
  account.forgive(0.1, true);
  lacking += 0.1 * EnergyAccount::kForgivenInTouch;
  CHECK(account.balance() == Approx(lacking));
  account.forgive(100.0, false);
  CHECK(account.balance() == 0.0);
  account.settle(0.01, 0.01);
  account.forgive(1.0, false);
  CHECK(account.balance() == Approx(0.01));
}

TEST_CASE("rigid energy: constant in free flight, in gravity, and on a tether") {
  BodyProperties properties;
  properties.mass = 0.2;
  properties.inertia = Vector3(1e-4, 2e-4, 2.5e-4).asDiagonal();
  const RigidBody body(properties, 1e-3);
  RigidState start;
  start.velocity = Vector3(0.3, 1.0, 0.0);
  start.angular_momentum = Vector3(1e-3, -2e-3, 5e-4);
  const double kinetic = 0.5 * 0.2 * 1.09 + 0.5 * (1e-2 + 2e-2 + 1e-3);
  FreeForces none;
  CHECK(rigid_energy(body, none, start) == Approx(kinetic).epsilon(1e-12));
  FreeForces forces;
  forces.gravity = Vector3(0, -9.81, 0);
  SECTION("gravity") {}
  SECTION("tether") {
    forces.tether = {20.0, 0.01};
  }
  const double before = rigid_energy(body, forces, start);
  RigidState state = start;
  double off = 0.0;
  for (int k = 0; k < 1000; ++k) {
    const FreeMotion motion = free_motion(body, forces, state);
    state = end_of_step(body, forces, motion, Vector3::Zero(), Vector3::Zero());
    off = std::max(off, std::abs(rigid_energy(body, forces, state) - before));
  }
  CHECK(off < 1e-4 * kinetic);
  BodyProperties fixed = properties;
  fixed.support = Support::kFixed;
  CHECK(rigid_energy(RigidBody(fixed, 1e-3), forces, start) == 0.0);
}
