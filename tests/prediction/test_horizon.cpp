#include <array>
#include <random>

#include "simulation/engine/response_engine.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/fem_cube.hpp"
#include "tests/support/fixed_box.hpp"

// What the engines say of coming steps, and what they make of forces that come late, against plain
// stepping.

using namespace irdm;

namespace {

constexpr int kSteps = kMaxHorizon;
constexpr std::array kKinds{ResponseKind::kModal, ResponseKind::kDense, ResponseKind::kCompressed};

std::shared_ptr<const Model> model(ResponseKind kind) {
  return test::fem_cube({.cells = 2, .steps = 100}, kind);
}

// Forces on a few nodes, some steps without.
std::vector<std::vector<NodalForce>> random_history(int nodes, int steps, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto number = [&] { return static_cast<double>(random() >> 11) * 0x1p-52 - 1.0; };
  std::vector<std::vector<NodalForce>> history(static_cast<std::size_t>(steps));
  for (auto& forces : history) {
    for (std::uint64_t i = random() % 4; i > 0; --i) {
      const int node = static_cast<int>(random() % static_cast<std::uint64_t>(nodes));
      forces.push_back({node, Vector3(number(), number(), number())});
    }
  }
  return history;
}

ContactPatch some_patch() {
  ContactPatch patch;
  patch.add(3, 0.5);
  patch.add(7, 0.3);
  patch.add(11, 0.2);
  return patch;
}

Points displacement(const ResponseEngine& engine) {
  Points u;
  engine.displacement(u);
  return u;
}

}  // namespace

TEST_CASE("foresight: path and response are what stepping on brings") {
  const double damping = GENERATE(1.0, 4.0);
  for (const ResponseKind kind : kKinds) {
    const auto cube = model(kind);
    const int nodes = cube->mesh.surface_node_count();
    const auto engine = make_engine(cube);
    for (const auto& forces : random_history(nodes, 40, 1)) engine->advance(forces);
    if (engine->capabilities().damping != nullptr)
      engine->capabilities().damping->scale_damping(damping);
    const ContactPatch patch = some_patch();
    const std::vector<NodalForce> held{{2, Vector3(0.1, -0.2, 0.3)}, {9, Vector3(-0.4, 0, 0)}};
    std::vector<Vector3> path(kSteps);
    std::vector<Matrix3> response(kSteps);
    engine->predict_horizon(patch, held, path, response);
    const ContactPatch far(SurfacePoint{{0, 5, 7}, {0.2, 0.5, 0.3}});
    std::vector<Matrix3> cross(kSteps);
    std::vector<Matrix3> back(kSteps);
    engine->cross_response(far, patch, cross);
    engine->cross_response(patch, far, back);
    for (std::size_t n = 0; n < kSteps; ++n) {
      CHECK((cross[n] - back[n].transpose()).norm() < 1e-6 * response[0].norm());
    }
    const auto other = make_engine(cube);
    if (other->capabilities().damping != nullptr)
      other->capabilities().damping->scale_damping(damping);
    for (int n = 0; n < kSteps; ++n) {
      engine->advance(held);
      const Points u = displacement(*engine);
      const Vector3 mean_u = mean(patch, [&](int i) { return Vector3(u.row(i)); });
      CHECK((path[static_cast<std::size_t>(n)] - mean_u).norm() < 1e-6 * mean_u.norm());
      std::vector<NodalForce> pushed;
      const Vector3 force(1, -2, 0.5);
      for (std::size_t i = 0; i < 3; ++i)
        pushed.push_back({patch.nodes[i], patch.weights[i] * force});
      other->advance(n == 0 ? pushed : std::vector<NodalForce>{});
      const Points v = displacement(*other);
      const Vector3 mean_v = mean(patch, [&](int i) { return Vector3(v.row(i)); });
      const Vector3 far_v = mean(far, [&](int i) { return Vector3(v.row(i)); });
      CHECK((cross[static_cast<std::size_t>(n)] * force - far_v).norm() <
            1e-5 * (response[0] * force).norm());
      CHECK((response[static_cast<std::size_t>(n)] * force - mean_v).norm() <
            1e-5 * (response[0] * force).norm());
    }
  }
}

TEST_CASE("foresight: a force that comes late does what it would have done in time") {
  for (const ResponseKind kind : kKinds) {
    const auto cube = model(kind);
    const int nodes = cube->mesh.surface_node_count();
    const auto history = random_history(nodes, 60, 2);
    const auto late_ones = random_history(nodes, 60, 3);
    const auto in_time = make_engine(cube);
    const auto late = make_engine(cube);
    for (int k = 0; k < 60; ++k) {
      const auto step = static_cast<std::size_t>(k);
      std::vector<NodalForce> both = history[step];
      both.insert(both.end(), late_ones[step].begin(), late_ones[step].end());
      in_time->advance(both);
      late->advance(history[step]);
    }
    for (int k = 59; k > 59 - kMaxHorizon; --k) {
      late->add_delayed_force(late_ones[static_cast<std::size_t>(k)], 59 - k);
    }
    late->add_delayed_force(late_ones[0], kMaxHorizon);  // too long ago
    // Those that are too old to be entered are taken out of the comparison.
    std::vector<std::vector<NodalForce>> rest(late_ones.begin(),
                                              late_ones.begin() + 60 - kMaxHorizon);
    const auto only_old = make_engine(cube);
    for (const auto& forces : rest) only_old->advance(forces);
    for (int k = 0; k < kMaxHorizon; ++k) only_old->advance({});
    for (int k = 0; k < 5; ++k) {
      const Points expected = displacement(*in_time) - displacement(*only_old);
      CHECK((displacement(*late) - expected).norm() < 1e-6 * expected.norm());
      in_time->advance({});
      late->advance({});
      only_old->advance({});
    }
  }
}

// What is kept from step to step must be what somebody finds who looks for the first time.
TEST_CASE("foresight: a prediction that goes on is the one that is computed anew", "[slow]") {
  for (const bool fixed : {false, true}) {
    for (const ResponseKind kind : kKinds) {
      if (fixed && kind == ResponseKind::kCompressed) continue;  // there is none of it
      const auto cube = fixed ? test::fixed_box({}, kind) : model(kind);
      const int nodes = cube->mesh.surface_node_count();
      auto history = random_history(nodes, 60, 4);
      for (std::size_t k = 20; k < 60; k += 3) {  // on the patch alone
        const Vector3 force(0.1, -0.02 * static_cast<double>(k), 0.3);
        const ContactPatch patch = some_patch();
        history[k].clear();
        for (std::size_t i = 0; i < 3; ++i) {
          history[k].push_back({patch.nodes[i], patch.weights[i] * force});
        }
      }
      const auto engine = make_engine(cube);
      const auto act = [&](ResponseEngine& on, int k) {
        const EngineCapabilities can = on.capabilities();
        if (can.gravity != nullptr && k % 20 == 5) can.gravity->set_gravity({0, 0.3 * k, -9.81});
        if (can.damping != nullptr && k == 31) can.damping->scale_damping(2.0);
        if (k == 17 || k == 40) {
          on.add_delayed_force(std::vector<NodalForce>{{1, Vector3(0.1, 0.2, -0.3)}}, 3);
        }
        if (can.inertial_loading != nullptr && k % 7 > 2) {
          can.inertial_loading->set_angular_velocity({0.1 * k, 5.0, -3.0});
        }
        on.advance(history[static_cast<std::size_t>(k)]);
        if (k == 45) on.reset();
      };
      ContactPatch other = some_patch();
      other.weights[0] = 0.6;
      other.weights[1] = 0.2;
      constexpr std::size_t kAhead = 20;
      for (int k = 0; k < 60; ++k) {
        act(*engine, k);
        if (k % 13 == 12) continue;  // nobody looks
        const auto anew = make_engine(cube);
        for (int i = 0; i <= k; ++i) act(*anew, i);
        const std::vector<NodalForce> held{{2, Vector3(0.1, -0.2, 0.3)}};
        for (const ContactPatch& patch : {some_patch(), other}) {
          if (patch.weights[0] == 0.6 && k % 5 == 0) continue;
          std::array<Vector3, kAhead> path;
          std::array<Vector3, kAhead> expected;
          std::array<Matrix3, kAhead> response;
          std::array<Matrix3, kAhead> expected_response;
          const std::span<const NodalForce> others =
              k % 2 == 0 ? std::span<const NodalForce>(held) : std::span<const NodalForce>();
          engine->predict_horizon(patch, others, path, response);
          anew->predict_horizon(patch, others, expected, expected_response);
          double largest = 0.0;
          for (const Vector3& place : expected) largest = std::max(largest, place.norm());
          CAPTURE(fixed, static_cast<int>(kind), k);
          for (std::size_t n = 0; n < kAhead; ++n) {
            CHECK((path[n] - expected[n]).norm() <= 1e-11 * largest);
            CHECK((response[n] - expected_response[n]).norm() <= 1e-11 * response[0].norm());
          }
        }
      }
    }
  }
}
