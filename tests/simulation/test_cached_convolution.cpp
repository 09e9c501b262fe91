#include <random>

#include "simulation/engine/prediction_cache.hpp"
#include "tests/simulation/random_numbers.hpp"
#include "tests/support/allocation_guard.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/left_out.hpp"

using namespace irdm;
using namespace irdm::test;

namespace {

constexpr int kSources = 6;

/// Any response, and every force there was: the sum as it is written.
template <typename Number>
struct PlainConvolution {
  PlainConvolution(int nodes, int length, int sources = kSources) : dof(3 * nodes), steps(length) {
    Random random(5);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    for (int i = 0; i < dof * 3 * sources * steps; ++i) {
      values.push_back(static_cast<Number>(uniform(random)));
    }
  }
  ResidentColumns<Number> columns() const {
    return {values.data(), static_cast<std::size_t>(dof), static_cast<std::size_t>(steps)};
  }
  Vector3 coming(int node, int n) const {
    Vector3 u = Vector3::Zero();
    for (std::size_t k = 0; k < past.size(); ++k) {
      const auto age = static_cast<int>(past.size() - 1 - k) + n;
      if (age >= steps) continue;
      for (const NodalForce& nodal : past[k]) {
        for (int row = 0; row < 3; ++row) {
          for (int axis = 0; axis < 3; ++axis) {
            const int b = 3 * nodal.node + axis;
            u[row] +=
                nodal.force[axis] * static_cast<double>(columns().row(3 * node + row, b)[age]);
          }
        }
      }
    }
    return u;
  }

  int dof;
  int steps;
  std::vector<Number> values;
  std::vector<std::vector<NodalForce>> past;
};

std::vector<NodalForce> some_forces(Random& random) {
  std::vector<NodalForce> forces(random() % 4);
  for (NodalForce& force : forces) {
    force = {static_cast<int>(random() % kSources), anywhere(random, 1.0)};
  }
  return forces;
}

}  // namespace

TEMPLATE_TEST_CASE("what is kept ahead is the convolution, whoever asks when, late forces included",
                   "", float, double) {
  constexpr int kNodes = 40;
  const int steps = GENERATE(3, 16, 40, 150);
  PlainConvolution<TestType> plain(kNodes, steps);
  ResidentColumns<TestType> columns = plain.columns();
  CachedConvolution running(columns, kSources);
  Random random(7);
  double worst = 0.0;
  double largest = 0.0;
  for (int k = 0; k < 500; ++k) {
    // Touches, and silences longer than the response.
    const bool silent = k % 250 > 240 - steps && k % 250 > 60;
    const std::vector<NodalForce> now = silent ? std::vector<NodalForce>() : some_forces(random);
    running.push(now);
    plain.past.push_back(now);
    if (k % 3 == 0 && k > 60 && !silent) {
      const std::vector<NodalForce> late = some_forces(random);
      const auto age = static_cast<int>(random() % kMaxHorizon);
      running.add_delayed_force(late, age);
      if (age < steps) {
        auto& then = plain.past[plain.past.size() - 1 - static_cast<std::size_t>(age)];
        then.insert(then.end(), late.begin(), late.end());
      }
    }
    // A few nodes always, others now and then; one step ahead, or many.
    for (int node = 0; node < kNodes; ++node) {
      if (node >= 4 && random() % 16 != 0) continue;
      const int n = node == 1 ? kMaxHorizon : 1 + static_cast<int>(random() % 3);
      const bool stepped = node % 2 == 0;
      Vector3 u = Vector3::Zero();
      if (stepped) {
        running.add_coming(node, u);
        running.cache_node(node);
      } else {
        running.predict_horizon(node, n);
        running.add_ahead(node, n, u);
      }
      const Vector3 expected = plain.coming(node, stepped ? 1 : n);
      worst = std::max(worst, (u - expected).norm());
      largest = std::max(largest, expected.norm());
    }
  }
  CHECK(worst < 1e-14 * largest);
}

// Contacts that stick: their nodes' forces keep in proportion, and are convolved together; one
// slips for a while, and late forces come that keep the proportion, and that do not.
TEMPLATE_TEST_CASE("forces that keep in proportion are convolved together, with the same result",
                   "", float, double) {
  constexpr int kNodes = 10;
  const int steps = GENERATE(20, 120);
  PlainConvolution<TestType> plain(kNodes, steps);
  ResidentColumns<TestType> columns = plain.columns();
  CachedConvolution running(columns, kSources);
  Random random(13);
  double worst = 0.0;
  double largest = 0.0;
  int together = 0;
  for (int k = 0; k < 700; ++k) {
    const Vector3 first = anywhere(random, 1.0);
    const Vector3 second = anywhere(random, 1.0);
    const double slip = k > 200 && k < 210 ? 0.01 * (k - 200) : 0.0;
    const auto touch = [&](double share) {
      return std::vector<NodalForce>{{0, 0.3 * first},
                                     {1, (0.1 + slip) * first},
                                     {2, (0.6 - slip) * first},
                                     {4, share * second},
                                     {5, (1.0 - share) * second}};
    };
    const std::vector<NodalForce> now = touch(0.7);
    running.push(now);
    plain.past.push_back(now);
    if (k > 400 && k % 7 == 0) {
      const std::vector<NodalForce> late = touch(k > 500 && k < 520 ? 0.4 : 0.7);
      running.add_delayed_force(late, 3);
      auto& then = plain.past[plain.past.size() - 4];
      then.insert(then.end(), late.begin(), late.end());
    }
    together += running.history().multiple(1, 0) > 0.0 ? 1 : 0;
    together += running.history().multiple(5, 4) > 0.0 ? 1 : 0;
    for (int node = 0; node < kNodes; ++node) {
      Vector3 u = Vector3::Zero();
      running.add_coming(node, u);
      running.cache_node(node);
      const Vector3 expected = plain.coming(node, 1);
      worst = std::max(worst, (u - expected).norm());
      largest = std::max(largest, expected.norm());
    }
  }
  CHECK(worst < 1e-14 * largest);
  // Slipping from step 201 to 209, and late forces from step 504 on that last changed step 515, are
  // seen until they are forgotten.
  CHECK(together == 2 * 700 - (209 + steps - 201) - (515 + steps - 504));
}

TEMPLATE_TEST_CASE("patches of any size are convolved together", "", float, double) {
  constexpr int kPause = 40;  // longer than the response
  const int size = GENERATE(1, 2, 4, 5, 7, 32, 33, 40);
  PlainConvolution<TestType> plain(size, 30, size);
  ResidentColumns<TestType> columns = plain.columns();
  CachedConvolution running(columns, size);
  Random random(19);
  double worst = 0.0;
  double largest = 0.0;
  for (int k = 0; k < 200; ++k) {
    std::vector<NodalForce> now;
    const Vector3 force = anywhere(random, 1.0);
    for (int node = 0; node < size && k % 100 >= kPause; ++node) {
      now.push_back({node, (0.1 + 0.03 * node) * force});
    }
    running.push(now);
    plain.past.push_back(now);
    for (int node = 0; node < std::min(size, 3); ++node) {
      Vector3 u = Vector3::Zero();
      running.add_coming(node, u);
      running.cache_node(node);
      running.predict_horizon(node, 20);
      const Vector3 expected = plain.coming(node, 1);
      worst = std::max(worst, (u - expected).norm());
      Vector3 ahead = Vector3::Zero();
      running.add_ahead(node, 20, ahead);
      worst = std::max(worst, (ahead - plain.coming(node, 20)).norm());
      largest = std::max(largest, expected.norm());
    }
  }
  CHECK(worst < 1e-14 * largest);
}

TEST_CASE("what a step sees has the same bits whether somebody predicts or not") {
  PlainConvolution<float> plain(40, 100);
  ResidentColumns<float> columns = plain.columns();
  CachedConvolution watched(columns, kSources);
  CachedConvolution alone(columns, kSources);
  Random random(9);
  int differs_from_plain = 0;
  for (int k = 0; k < 300; ++k) {
    const std::vector<NodalForce> now = some_forces(random);
    plain.past.push_back(now);
    for (auto* running : {&watched, &alone}) {
      running->push(now);
      if (k % 5 == 4) running->add_delayed_force(now, 4);
    }
    if (k % 5 == 4) {
      auto& then = plain.past[plain.past.size() - 5];
      then.insert(then.end(), now.begin(), now.end());
    }
    for (int node = k / 10; node < k / 10 + 4; ++node) {
      Vector3 here = Vector3::Zero();
      Vector3 there = Vector3::Zero();
      watched.predict_horizon(node, 20);
      watched.add_ahead(node, 20, here);
      watched.add_coming(node, there);
      here.setZero();
      alone.add_coming(node, here);
      REQUIRE(here == there);
      differs_from_plain += here == plain.coming(node, 1) ? 0 : 1;
      watched.cache_node(node);
      alone.cache_node(node);
    }
  }
  CHECK(differs_from_plain > 100);  // else there were nothing to keep apart
}

TEST_CASE("more nodes than can be followed are answered, too, and nothing allocates",
          "[unsanitized]") {
  if (!AllocationGuard::active()) return leave_out(kNotCounted);
  constexpr int kNodes = 400;
  PlainConvolution<double> plain(kNodes, 20);
  ResidentColumns<double> columns = plain.columns();
  CachedConvolution running(columns, kSources);
  const std::vector<NodalForce> forces{{2, Vector3(1, -2, 3)}};
  for (int k = 0; k < 30; ++k) plain.past.push_back(forces);
  std::vector<Vector3> u(kNodes, Vector3::Zero());
  {
    const AllocationGuard guard;
    for (int k = 0; k < 30; ++k) {
      running.push(forces);
      for (int node = 0; node < kNodes; ++node) {
        u[static_cast<std::size_t>(node)].setZero();
        running.add_coming(node, u[static_cast<std::size_t>(node)]);
        running.cache_node(node);
      }
    }
    CHECK(guard.count() == 0);
  }
  for (int node = 0; node < kNodes; ++node) {
    REQUIRE((u[static_cast<std::size_t>(node)] - plain.coming(node, 1)).norm() < 1e-12);
  }
  running.clear();
  Vector3 nothing = Vector3::Zero();
  running.push({});
  running.add_coming(3, nothing);
  CHECK(nothing.isZero(0.0));
}
