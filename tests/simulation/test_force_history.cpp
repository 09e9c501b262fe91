#include <random>

#include "simulation/engine/force_history.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;

TEST_CASE("force history gives back every force of the last T steps at its age") {
  constexpr int kNodes = 6;
  constexpr int kSteps = 7;
  ForceHistory history(kNodes, kSteps);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::vector<Points> past;  // newest last, all nodes
  for (int k = 0; k < 100; ++k) {
    Points now = Points::Zero(kNodes, 3);
    std::vector<NodalForce> forces;
    // Bursts and silences longer and shorter than the window.
    const int count = (k / 9) % 3 == 2 ? 0 : static_cast<int>(random() % 4);
    for (int i = 0; i < count; ++i) {
      const NodalForce force{static_cast<int>(random() % kNodes),
                             Vector3(uniform(random), uniform(random), uniform(random))};
      forces.push_back(force);
      now.row(force.node) += force.force.transpose();
    }
    history.push(forces);
    past.push_back(now);

    Eigen::MatrixXd seen = Eigen::MatrixXd::Zero(3 * kNodes, kSteps);
    for (const int node : history.active()) {
      for (int axis = 0; axis < 3; ++axis) {
        const ForceHistory::Series series = history.series(node, axis);
        REQUIRE(series.first_age >= 0);
        REQUIRE(series.first_age + series.count <= kSteps);
        for (int i = 0; i < series.count; ++i) {
          seen(3 * node + axis, series.first_age + i) = series.force[i];
        }
      }
    }
    for (int age = 0; age < kSteps; ++age) {
      for (int dof = 0; dof < 3 * kNodes; ++dof) {
        const double expected =
            age <= k ? past[static_cast<std::size_t>(k - age)](dof / 3, dof % 3) : 0.0;
        REQUIRE(seen(dof, age) == expected);
      }
    }
  }
}

TEST_CASE("force history forgets nodes whose last force has left the window") {
  ForceHistory history(4, 5);
  const NodalForce force{2, Vector3(1, 0, 0)};
  history.push({&force, 1});
  for (int k = 0; k < 4; ++k) history.push({});
  CHECK(history.active().size() == 1);
  history.push({});
  CHECK(history.active().empty());
}

TEST_CASE("forces are a multiple of others if they were so at every age that is kept") {
  constexpr int kSteps = 12;
  ForceHistory history(4, kSteps);
  const auto push = [&](const Vector3& force, double factor) {
    history.push(std::vector<NodalForce>{{0, force}, {2, factor * force}});
  };
  for (int k = 0; k < 5; ++k) push(Vector3(0.1 * k, 1.0 - k, 0.3), 0.7);
  CHECK(history.multiple(2, 0) == Approx(0.7).epsilon(1e-15));
  CHECK(history.multiple(0, 2) == Approx(1.0 / 0.7).epsilon(1e-15));
  CHECK(history.multiple(0, 0) == 1.0);

  SECTION("a step with another proportion counts until it is forgotten") {
    push(Vector3(1, 2, 3), 0.7 + 1e-13);
    for (int k = 0; k < kSteps - 1; ++k) {
      CHECK(history.multiple(2, 0) == 0.0);
      push(Vector3(0.1 * k, 1.0, 0.3), 0.7);
    }
    CHECK(history.multiple(2, 0) == 0.0);
    push(Vector3(0.1, 1.0, 0.3), 0.7);
    CHECK(history.multiple(2, 0) == Approx(0.7).epsilon(1e-15));
  }
  SECTION("one that began later is none") {
    history.push(std::vector<NodalForce>{{0, Vector3(1, 0, 0)}, {1, Vector3(2, 0, 0)}});
    CHECK(history.multiple(1, 0) == 0.0);
  }
  SECTION("another direction is none, whatever its length") {
    history.push(std::vector<NodalForce>{{0, Vector3(1, 0, 0)}, {2, Vector3(0, 0.7, 0)}});
    CHECK(history.multiple(2, 0) == 0.0);
    CHECK(history.multiple(0, 2) == 0.0);
  }
  SECTION("late forces are counted where they belong") {
    history.add_delayed_force(std::vector<NodalForce>{{0, Vector3(1, 2, 3)}}, 3);
    CHECK(history.multiple(2, 0) == 0.0);
    history.add_delayed_force(std::vector<NodalForce>{{2, 0.7 * Vector3(1, 2, 3)}}, 3);
    CHECK(history.multiple(2, 0) == Approx(0.7).epsilon(1e-15));
  }
  SECTION("the newest force tells the factor, where there is one") {
    push(Vector3::Zero(), 0.7);
    CHECK(history.multiple(2, 0) == 0.0);
  }
}
