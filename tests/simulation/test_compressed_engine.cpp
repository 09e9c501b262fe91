#include <omp.h>

#include <array>
#include <complex>
#include <random>

#include "common/response/compressed_response.hpp"
#include "common/response/stored_response.hpp"
#include "simulation/engine/response_engine.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/fem_cube.hpp"
#include "tests/support/interaction_suite.hpp"
#include "tests/support/point_loads.hpp"
#include "tests/support/synthetic_model.hpp"

using namespace irdm;
using namespace irdm::test;

namespace {

constexpr int kFir = 3;
constexpr int kRecord = 200;

// A cube with a made-up compressed response: anything that the format can hold.
std::shared_ptr<const Model> made_up(bool integers = false) {
  Model model = synthetic_cube(2, 1, kRecord);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  CompressedResponse response;
  response.fir_steps = kFir;
  const int nodes = model.mesh.surface_node_count();
  std::vector<float> fir(fir_entries(static_cast<std::size_t>(nodes)) * kFir);
  for (float& value : fir) value = static_cast<float>(uniform(random));
  // A node's own block is symmetric.
  for (int i = 0; i < nodes; ++i) {
    for (int entry = 0; entry < 9; ++entry) {
      const int other = 3 * (entry % 3) + entry / 3;
      const auto at = [&](int e) {
        return (static_cast<std::size_t>(i * (i + 1) / 2 + i) * 9 + static_cast<std::size_t>(e)) *
               kFir;
      };
      for (std::size_t s = 0; s < kFir; ++s) {
        fir[at(entry) + s] = fir[at(std::min(entry, other)) + s];
      }
    }
  }
  response.fir = fir;
  if (integers) {
    response.fir_scale.resize(fir.size() / kFir);
    for (std::size_t i = 0; i < response.fir_scale.size(); ++i) {
      const std::size_t axes = i % 9 / 3 + i % 3;  // the same both ways round
      response.fir_scale[i] = 1e-4F * static_cast<float>(1 + i / 9 % 3 + axes);
    }
    std::vector<std::int16_t> numbers(fir.size());
    std::ranges::transform(fir, numbers.begin(), [](float value) {
      return static_cast<std::int16_t>(10'000.0F * value);
    });
    response.fir = std::move(numbers);
  }
  constexpr int kShapes = 7;
  response.shapes.resize(3 * nodes, kShapes);
  for (Eigen::Index i = 0; i < response.shapes.size(); ++i) {
    response.shapes.data()[i] = static_cast<float>(uniform(random));
  }
  response.pole_shape = {0, 0, 1, 2, 2, 2, 4, 5, 6};  // none of shape 3
  const auto poles = static_cast<Eigen::Index>(response.pole_shape.size());
  response.pole.resize(poles);
  response.amplitude.resize(poles);
  for (Eigen::Index j = 0; j < poles; ++j) {
    response.pole(j) = std::polar(0.8 + 0.15 * uniform(random), 1.5 * (1.0 + uniform(random)));
    response.amplitude(j) = {uniform(random), uniform(random)};
  }
  response.pole(2) = -0.7;  // a real one
  model.response = std::move(response);
  return std::make_shared<const Model>(std::move(model));
}

std::vector<std::vector<NodalForce>> random_forces(int nodes, int steps) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::vector<std::vector<NodalForce>> history(static_cast<std::size_t>(steps));
  for (auto& forces : history) {
    for (unsigned i = random() % 4; i > 0; --i) {
      const auto node = static_cast<int>(random() % static_cast<unsigned>(nodes));
      forces.push_back({node, Vector3(uniform(random), uniform(random), uniform(random))});
    }
  }
  return history;
}

// Equation (10) with the columns as they are defined.
Points direct_sum(const Model& model, const std::vector<std::vector<NodalForce>>& history, int k) {
  const auto R = stored_response(model);
  Eigen::VectorXd u = Eigen::VectorXd::Zero(model.degrees_of_freedom());
  for (int age = 0; age <= k; ++age) {
    for (const NodalForce& force : history[static_cast<std::size_t>(k - age)]) {
      for (int b = 0; b < 3; ++b) {
        u += R->column(3 * force.node + b, age + 1).row(age).transpose() * force.force[b];
      }
    }
  }
  return Eigen::Map<const Points>(u.data(), u.size() / 3, 3);
}

Points displacement(const ResponseEngine& engine) {
  Points u;
  engine.displacement(u);
  return u;
}

}  // namespace

TEST_CASE("compressed engine equals the sum of equation (10) over FIR steps and poles") {
  const bool integers = GENERATE(false, true);
  const auto model = made_up(integers);
  const auto engine = make_engine(model);
  const auto history = random_forces(model->mesh.surface_node_count(), 40);
  for (int k = 0; k < 40; ++k) {
    Points expected;
    if (k % 8 == 7) expected = direct_sum(*model, history, k);
    engine->advance(history[static_cast<std::size_t>(k)]);
    if (k % 8 != 7) continue;
    CHECK((displacement(*engine) - expected).norm() < 1e-12 * expected.norm());
  }
}

TEST_CASE("compressed engine predicts the coming step, and R[0] between the contacts") {
  const bool integers = GENERATE(false, true);
  const auto model = made_up(integers);
  const auto engine = make_engine(model);
  const auto history = random_forces(model->mesh.surface_node_count(), 30);
  for (const auto& forces : history) engine->advance(forces);
  const std::array<ContactPatch, 2> points{ContactPatch(SurfacePoint{{0, 1, 2}, {0.2, 0.3, 0.5}}),
                                           ContactPatch(SurfacePoint{{7, 3, 9}, {0.5, 0.5, 0.0}})};
  std::array<Vector3, 2> h;
  ContactMatrix W;
  engine->predict(points, h, W);
  CHECK((W - W.transpose()).norm() == 0.0);
  const std::array<Vector3, 2> f{Vector3(0.3, -0.2, 0.1), Vector3(-0.5, 0.4, 0.6)};
  std::vector<NodalForce> nodal;
  Eigen::Matrix<double, 6, 1> force;
  force << f[0], f[1];
  for (std::size_t a = 0; a < 2; ++a) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(points[a].count); ++i)
      nodal.push_back({points[a].nodes[i], points[a].weights[i] * f[a]});
  }
  const Eigen::Matrix<double, 6, 1> answer = W * force;
  engine->advance(nodal);
  const Points u = displacement(*engine);
  for (std::size_t a = 0; a < 2; ++a) {
    const Vector3 moved = mean(points[a], [&](int i) -> Vector3 { return u.row(i).transpose(); });
    const Vector3 expected = h[a] + answer.segment<3>(static_cast<Eigen::Index>(3 * a));
    CHECK((moved - expected).norm() < 1e-12 * u.norm());
  }
  const Eigen::MatrixXd R = stored_response(*model)->zero_lag();
  CHECK((R - R.transpose()).norm() == 0.0);
}

// Some are told again and again of the steps since, as a bridge behind a bad link does.
TEST_CASE("compressed engine: delayed forces are those of equation (10), on and on",
          "[unsanitized]") {
  const auto model = made_up(GENERATE(false, true));
  const auto engine = make_engine(model);
  const int nodes = model->mesh.surface_node_count();
  auto history = random_forces(nodes, 60);
  const auto enter = [&](int k, int age) {
    const std::vector<NodalForce> tail{{(3 * k + age) % nodes, Vector3(0.1 * age, 1.0, -0.5)},
                                       {(k + 7 * age) % nodes, Vector3(-0.3, 0.0, 0.02 * k)}};
    engine->add_delayed_force(tail, age);
    auto& told = history[static_cast<std::size_t>(k - age)];
    told.insert(told.end(), tail.begin(), tail.end());
  };
  for (int k = 0; k < 45; ++k) {
    engine->advance(history[static_cast<std::size_t>(k)]);
    if (k == 20) {  // those of which some act in the coming step, and others after it
      for (int age = 0; age <= 20; ++age) enter(k, age);
    }
    if (k > 40) enter(k, kFir - 1);
    if (k == 44) {
      for (int age = 0; age < std::min(k, kMaxHorizon); ++age) enter(k, age);
    }
    if (k != 20 && k < 40) continue;
    const Points expected = direct_sum(*model, history, k);
    CHECK((displacement(*engine) - expected).norm() < 1e-12 * expected.norm());
  }
  for (int k = 45; k < 60; ++k) {
    history[static_cast<std::size_t>(k)].clear();
    const Points expected = direct_sum(*model, history, k);
    for (int i = 0; i < nodes; ++i) {
      CHECK((engine->free_displacement(i) - Vector3(expected.row(i))).norm() <
            1e-12 * expected.norm());
    }
    engine->advance({});
    CHECK((displacement(*engine) - expected).norm() < 1e-12 * expected.norm());
  }
}

TEST_CASE("compressed engine: the steps to come, and what a force does in them, are equation (10)",
          "[slow]") {
  const auto model = made_up(GENERATE(false, true));
  const auto engine = make_engine(model);
  constexpr int kNow = 30;
  auto history = random_forces(model->mesh.surface_node_count(), kNow);
  for (const auto& forces : history) engine->advance(forces);
  const ContactPatch patch(SurfacePoint{{3, 7, 11}, {0.5, 0.3, 0.2}});
  const std::vector<NodalForce> held{{2, Vector3(0.1, -0.2, 0.3)}, {9, Vector3(-0.4, 0, 0)}};
  std::vector<Vector3> path(kMaxHorizon);
  std::vector<Matrix3> response(kMaxHorizon);
  engine->predict_horizon(patch, held, path, response);
  const Vector3 f(1, -2, 0.5);
  std::vector<std::vector<NodalForce>> push(1);
  for (std::size_t i = 0; i < 3; ++i) push[0].push_back({patch.nodes[i], patch.weights[i] * f});
  const auto mean_of = [&](const Points& u) {
    return mean(patch, [&](int i) -> Vector3 { return u.row(i).transpose(); });
  };
  for (int n = 0; n < kMaxHorizon; ++n) {
    CAPTURE(n);
    history.push_back(held);
    const Points u = direct_sum(*model, history, kNow + n);
    CHECK((path[static_cast<std::size_t>(n)] - mean_of(u)).norm() < 1e-12 * u.norm());
    if (n > 0) push.emplace_back();
    const Points v = direct_sum(*model, push, n);
    CHECK((response[static_cast<std::size_t>(n)] * f - mean_of(v)).norm() < 1e-12 * v.norm());
  }
}

TEST_CASE("compressed engine: the settled displacement is the static compliance") {
  const auto model = made_up(GENERATE(false, true));
  const auto engine = make_engine(model);
  const int nodes = model->mesh.surface_node_count();
  const Vector3 d = Vector3(1, 2, -2) / 3.0;
  const std::vector<Vector3> directions(static_cast<std::size_t>(nodes), d);
  const Eigen::VectorXd compliance = static_compliance(*model, test::point_loads(directions));
  const NodalForce force{5, d};
  for (int k = 0; k < 1000; ++k) engine->advance({&force, 1});
  const Points u = displacement(*engine);
  CHECK(compliance(5) == Approx(Vector3(u.row(5)).dot(d)).epsilon(1e-5));
}

TEST_CASE("compressed engine: same bits with one and two threads, forgets on reset, rests") {
  const auto model = made_up(GENERATE(false, true));
  const auto engine = make_engine(model);
  for (const auto& forces : random_forces(model->mesh.surface_node_count(), 30)) {
    engine->advance(forces);
  }
  omp_set_num_threads(1);
  const Points one = displacement(*engine);
  omp_set_num_threads(2);
  CHECK((one.array() == displacement(*engine).array()).all());
  CHECK(one.norm() > 0.0);
  for (int k = 0; k < 20'000; ++k) engine->advance({});
  CHECK(displacement(*engine).norm() == 0.0);
  const NodalForce force{1, Vector3(1, 1, 1)};
  engine->advance({&force, 1});
  engine->reset();
  for (int k = 0; k < 10; ++k) engine->advance({});
  CHECK(displacement(*engine).norm() == 0.0);
}

TEST_CASE("compressed to 5 %: forces of an interaction of each kind are those of dense R",
          "[slow]") {
  const FemCube cube{.cells = 3, .rayleigh_alpha = 16.0, .steps = 300};
  const auto dense = fem_cube(cube, ResponseKind::kDense);
  const auto compressed = fem_cube(cube, ResponseKind::kCompressed);
  for (int number = 0; number < 5; ++number) {
    const Interaction what = interaction(number);
    CAPTURE(number, what.kind);
    const ForceDifference difference =
        compare(run_interaction(what, dense, 0.5), run_interaction(what, compressed, 0.5));
    CHECK(difference.peak > 0.05);
    CHECK(difference.rms < 0.05);
  }
}
