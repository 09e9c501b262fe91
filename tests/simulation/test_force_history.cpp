#include <catch2/catch.hpp>
#include <random>

#include "server/engine/force_history.hpp"

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
