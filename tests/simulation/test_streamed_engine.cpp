// Columns of R that come late or never, against the engine that has all of them.
#include <complex>
#include <numbers>
#include <numeric>

#include "common/model/model_file.hpp"
#include "common/response/modal_response.hpp"
#include "common/response/stored_response.hpp"
#include "simulation/engine/response_engine.hpp"
#include "simulation/engine/streamed_engine.hpp"
#include "tests/simulation/pressed_cube.hpp"
#include "tests/simulation/random_numbers.hpp"
#include "tests/support/allocation_guard.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/left_out.hpp"
#include "tests/support/streamed_model.hpp"
#include "tests/support/synthetic_model.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace irdm;
using namespace irdm::test;

namespace {

constexpr double kLateDt = 0.002;
// Of synthetic models and of the cube.
constexpr int kBlendSteps = 25;

Model small_model(int steps = 60) {
  Model modal = synthetic_cube(2, 20, steps);
  add_centrifugal(modal);
  add_gravity(modal);
  return modal;
}

/// Forces on a few nodes, which move about and pause.
class WanderingForces {
 public:
  explicit WanderingForces(int nodes) : nodes_(nodes) {}
  std::vector<NodalForce> next() {
    if (++step_ % 7 == 0) node_ = (node_ + 1) % nodes_;
    if (step_ % 90 > 70) return {};
    std::vector<NodalForce> forces;
    for (int i = 0; i < 3; ++i)
      forces.push_back({(node_ + 5 * i) % nodes_, anywhere(random_, 1.0)});
    return forces;
  }

 private:
  int nodes_;
  int node_ = 0;
  int step_ = 0;
  Random random_{3};
};

ContactPatch some_patch(int node) {
  ContactPatch patch;
  patch.add(node, 0.5);
  patch.add((node + 3) % 20, 0.3);
  patch.add((node + 7) % 20, 0.2);
  return patch;
}

// All that an engine says about the coming steps.
void check_same_answers(ResponseEngine& streamed, ResponseEngine& dense, int node) {
  const std::array<ContactPatch, 2> patches{some_patch(node), some_patch((node + 9) % 20)};
  std::array<Vector3, 2> h;
  std::array<Vector3, 2> expected_h;
  ContactMatrix compliance;
  ContactMatrix expected_compliance;
  streamed.predict(patches, h, compliance);
  dense.predict(patches, expected_h, expected_compliance);
  CHECK(h == expected_h);
  CHECK(compliance == expected_compliance);
  const std::array<NodalForce, 1> held{NodalForce{node, Vector3(1, 2, 3)}};
  std::array<Vector3, 20> path;
  std::array<Vector3, 20> expected_path;
  std::array<Matrix3, 20> response;
  std::array<Matrix3, 20> expected_response;
  streamed.predict_horizon(patches[0], held, path, response);
  dense.predict_horizon(patches[0], held, expected_path, expected_response);
  CHECK(path == expected_path);
  CHECK(response == expected_response);
  streamed.cross_response(patches[0], patches[1], response);
  dense.cross_response(patches[0], patches[1], expected_response);
  CHECK(response == expected_response);
}

template <typename Scalar>
void check_equal(Model dense) {
  const StreamedModel model(std::move(dense));
  const auto streamed = make_engine(model.streamed);
  const auto whole = make_engine(model.dense);
  REQUIRE(dynamic_cast<StreamedEngine<Scalar>*>(streamed.get()) != nullptr);
  CHECK(stored_response(*model.streamed)->zero_lag() == stored_response(*model.dense)->zero_lag());
  const int nodes = model.dense->mesh.surface_node_count();
  WanderingForces forces(nodes);
  Points u;
  Points expected;
  const std::array followed{1, 3, 4, 5, 8};
  Random random(17);
  for (int k = 0; k < 500; ++k) {
    std::vector<NodalForce> now = forces.next();
    if (k > 250) {  // in proportion, as of a contact that sticks
      const Vector3 force = anywhere(random, 1.0);
      now = {{3, 0.2 * force}, {4, 0.7 * force}, {5, 0.1 * force}};
    }
    for (ResponseEngine* engine : {streamed.get(), whole.get()}) {
      if (k % 80 < 3) engine->capabilities().gravity->set_gravity(Vector3(0.5 * k, -9.81, k % 160));
      engine->capabilities().inertial_loading->set_angular_velocity(Vector3(0.1, 0.2, 0.01 * k));
      engine->capabilities().caching->cache_nodes(followed);
      if (k % 40 == 39) engine->add_delayed_force(now, 3);
      engine->advance(now);
    }
    for (int i = 0; i < nodes; ++i) {
      REQUIRE(streamed->free_displacement(i) == whole->free_displacement(i));
    }
    REQUIRE(streamed->free_displacement_bound() == whole->free_displacement_bound());
    if (k % 30 != 0) continue;
    streamed->displacement(u);
    whole->displacement(expected);
    CHECK(u == expected);
    check_same_answers(*streamed, *whole, k % 20);
  }
  CHECK(streamed->capabilities().columns->cache_misses() == 0);
  for (ResponseEngine* engine : {streamed.get(), whole.get()}) {
    CHECK(std::isinf(engine->free_displacement_bound()));
    engine->capabilities().gravity->set_gravity(Vector3::Zero());
    for (int k = 0; k <= model.dense->steps; ++k) engine->advance({});
    CHECK(engine->free_displacement_bound() == 0.0);
  }
}

}  // namespace

TEST_CASE(
    "the static answer: of a critically damped oscillator it is that oscillator, and of all "
    "that adds less, passive") {
  for (const double x : {0.01, 0.1, 0.7}) {
    // sum_{s>=1} h / h[0], h[0] = 1 - (1 + x) exp(-x) and the whole sum 1, in units of 1 / omega^2.
    const double start = 1.0 - (1.0 + x) * std::exp(-x);
    CHECK(settling_ratio(x) == Approx(1.0 / start - 1.0).epsilon(1e-9));
  }
  constexpr double kRatio = 140.0;
  const std::vector<double> g = settling_profile(kRatio, 4000);
  CHECK(g[0] == 0.0);
  CHECK(*std::min_element(g.begin(), g.end()) >= 0.0);
  CHECK(std::accumulate(g.begin(), g.end(), 0.0) == Approx(1.0));
  for (const double added : {0.0, 1.0, 30.0, kRatio}) {
    for (double angle = 1e-3; angle < std::numbers::pi; angle *= 1.1) {
      const std::complex<double> back = std::polar(1.0, -angle);
      std::complex<double> K = 1.0;
      std::complex<double> shift = 1.0;
      for (const double value : g) {
        K += added * value * shift;
        shift *= back;
      }
      // The work of a force on the displacement in its step, averaged over a period.
      CHECK(((1.0 - back) * K).real() > 0.0);
    }
  }
  CHECK(settling_profile(10.0, 1) == std::vector<double>{0.0});
}

TEST_CASE(
    "what is estimated of a model's slowest settling is near the largest, and that of its "
    "lowest mode") {
  const StreamedModel model(*fem_cube({2, 2000.0, 8.0, kLateDt, 1000}, ResponseKind::kDense));
  const auto& response = std::get<StreamedResponse>(model.streamed->response);
  const Eigen::Index dof = response.degrees_of_freedom;
  const Eigen::Map<const Eigen::MatrixXf> rest(response.rest.data(), dof, dof);
  const Eigen::MatrixXd first = stored_response(*model.streamed)->zero_lag();
  const double estimate = settling_ratio(first.cast<float>(), rest);
  const auto& modes = std::get<ModalResponse>(fem_cube({2, 2000.0, 8.0, kLateDt, 1000})->response);
  const double x = kLateDt * modes.angular_frequency[0];
  CAPTURE(estimate, 2.0 / (x * x));
  CHECK(estimate < 2.0 / (x * x));
  CHECK(1.5 * estimate > 2.0 / (x * x));
}

TEST_CASE("streamed equals dense to the bit while all columns are there") {
  const Model modal = small_model();
  SECTION("single") {
    check_equal<float>(with_dense_response<float>(modal));
  }
  SECTION("double") {
    check_equal<double>(with_dense_response<double>(modal));
  }
}

TEST_CASE("without columns a force is answered by R[0] at first and settles where it should") {
  constexpr int kSteps = 400;
  const Model modal = small_model(kSteps);
  const StreamedModel model(with_dense_response<double>(modal));
  model.supply->there = [](int) { return false; };
  const auto streamed = make_engine(model.streamed);
  const auto whole = make_engine(model.dense);
  const std::array<NodalForce, 2> forces{NodalForce{3, Vector3(1, -2, 0.5)},
                                         NodalForce{11, Vector3(0, 1, 1)}};
  Points u;
  Points expected;
  std::vector<Points> way;
  std::vector<Points> coming;  // of the step after, without a force in it
  for (int k = 0; k < kSteps; ++k) {
    streamed->advance(forces);
    whole->advance(forces);
    streamed->displacement(u);
    way.push_back(u);
    Points& next = coming.emplace_back(u.rows(), 3);
    for (int i = 0; i < u.rows(); ++i) next.row(i) = streamed->free_displacement(i).transpose();
    if (k > 0) continue;
    whole->displacement(expected);
    CHECK((u - expected).cwiseAbs().maxCoeff() < 1e-12);  // R[0]
  }
  whole->displacement(expected);  // the sum of all R[s]
  const double size = expected.cwiseAbs().maxCoeff();
  CHECK((u - expected).cwiseAbs().maxCoeff() < 1e-5 * size);
  // From the one to the other along the settling profile, which never overshoots. The sums are kept
  // in single precision: 6e-8 of the largest, of six columns.
  const auto& settling = std::get<StreamedResponse>(model.streamed->response).settling;
  const Points first = way.front();
  double settled = 0.0;
  for (std::size_t k = 0; k < way.size(); ++k) {
    settled += settling[k];
    const Points between = first + settled * (expected - first);
    REQUIRE((way[k] - between).cwiseAbs().maxCoeff() < 1e-6 * size);
    const Points left = between - first;  // all but what R[0] does at once
    if (k > 0) REQUIRE((coming[k - 1] - left).cwiseAbs().maxCoeff() < 1e-6 * size);
  }
  CHECK(settled == Approx(1.0));
  CHECK(streamed->capabilities().columns->cache_misses() == 2);
  streamed->reset();
  streamed->displacement(u);
  CHECK(u.isZero(0.0));
}

TEST_CASE(
    "a column that comes late takes its share of the answer evenly, to the very answer of "
    "the dense engine") {
  const StreamedModel model(with_dense_response<double>(small_model(200)));
  const StreamedModel never(with_dense_response<double>(small_model(200)));
  constexpr int kComes = 40;
  int k = 0;
  model.supply->there = [&k](int) { return k >= kComes; };
  never.supply->there = [](int) { return false; };
  const auto late = make_engine(model.streamed);
  const auto without = make_engine(never.streamed);
  const auto whole = make_engine(model.dense);
  const int nodes = model.dense->mesh.surface_node_count();
  for (; k < kComes + 2 * kBlendSteps; ++k) {
    const std::array<NodalForce, 1> force{NodalForce{4, Vector3(std::sin(0.1 * k), 1.0, 0.2)}};
    for (ResponseEngine* engine : {late.get(), without.get(), whole.get()}) engine->advance(force);
    const double share = std::clamp((k - kComes + 1.0) / kBlendSteps, 0.0, 1.0);
    for (int i = 0; i < nodes; ++i) {
      const Vector3 expected =
          share * whole->free_displacement(i) + (1.0 - share) * without->free_displacement(i);
      REQUIRE((late->free_displacement(i) - expected).norm() < 1e-12);
    }
    // What a bridge is told of the coming steps is blended alike.
    std::array<std::array<Vector3, 12>, 3> path;
    std::array<std::array<Matrix3, 12>, 3> response;
    const ContactPatch patch(SurfacePoint{{4, 5, 6}, {1.0, 0.0, 0.0}});
    const std::array<NodalForce, 1> held{NodalForce{4, Vector3(0.3, -1.0, 0.5)}};
    late->predict_horizon(patch, held, path[0], response[0]);
    whole->predict_horizon(patch, held, path[1], response[1]);
    without->predict_horizon(patch, held, path[2], response[2]);
    for (std::size_t n = 0; n < path[0].size(); ++n) {
      const Vector3 expected = share * path[1][n] + (1.0 - share) * path[2][n];
      REQUIRE((path[0][n] - expected).norm() < 1e-12);
      const Matrix3 blended = share * response[1][n] + (1.0 - share) * response[2][n];
      REQUIRE((response[0][n] - blended).norm() < 1e-12);
    }
  }
  for (int i = 0; i < nodes; ++i) {
    CHECK(late->free_displacement(i) == whole->free_displacement(i));
  }
  CHECK(late->capabilities().columns->cache_misses() == 1);
}

TEST_CASE(
    "columns are kept while the history needs them, never more than the share, and then "
    "given back") {
  constexpr int kSteps = 60;
  const StreamedModel model(with_dense_response<float>(small_model(kSteps)));
  model.supply->most = 8;
  auto engine = make_engine(model.streamed);
  const std::array<Vector3, 2> tips{Vector3::Zero(), Vector3::Ones()};
  engine->capabilities().columns->prefetch(tips);
  CHECK(model.supply->tips() == 2);
  WanderingForces forces(model.dense->mesh.surface_node_count());
  int most = 0;
  for (int k = 0; k < 600; ++k) {
    engine->advance(forces.next());
    most = std::max(most, model.supply->taken());
    REQUIRE(model.supply->taken() <= 8);
    if (k % 50 == 0) check_same_answers(*engine, *engine, k % 20);
  }
  CHECK(most == 8);
  CHECK(engine->capabilities().columns->cache_misses() > 0);
  const std::array<NodalForce, 1> force{NodalForce{2, Vector3::Ones()}};
  engine->reset();
  CHECK(model.supply->taken() == 0);
  engine->advance(force);
  for (int k = 0; k < kSteps - 1; ++k) engine->advance({});
  CHECK(model.supply->taken(2) == 1);
  engine->advance({});
  CHECK(model.supply->taken() == 0);
  engine->advance(force);
  engine.reset();
  CHECK(model.supply->taken() == 0);
}

namespace {

/// A tip that presses near the middle of the top (a coarse mesh is rounded off far from its edges),
/// slides and comes back.
struct PressCycle {
  PressCycle(const Model& model, unsigned seed)
      : random(seed), top(model.mesh.nodes.col(1).maxCoeff()) {
    where = Vector3(between(random, -0.015, 0.015), 0.0, between(random, -0.015, 0.015));
    aside = anywhere(random, 0.012);
    aside.y() = 0.0;
    depth = between(random, 0.004, 0.01);
  }
  Vector3 tip(int k) const {
    const double s = std::sin(std::numbers::pi * std::min(1.0, k / 800.0));
    return where + s * s * aside + Vector3(0, top + 0.015 - (0.015 + depth) * s * s, 0);
  }
  Random random;
  double top;  ///< of the cube [m]
  Vector3 where, aside;
  double depth;
};

struct Felt {
  double work = 0.0;          ///< that the hand did on the object [J]
  double put_in = 0.0;        ///< the sum of what it put in [J]
  double peak = 0.0;          ///< of the force [N]
  double largest_step = 0.0;  ///< of the force from one step to the next [N]
  std::uint64_t missed = 0;
};

Felt feel_cycle(const std::shared_ptr<const Model>& model, const PressCycle& cycle, double radius,
                int* step = nullptr) {
  SimulationConfig config = tethered({2}, radius, {0.4, 0.3});
  config.objects[0].model = model;
  Simulation simulation(config);
  StepRecord record;
  Felt felt;
  Vector3 last_tip = cycle.tip(0);
  Vector3 last_force = Vector3::Zero();
  for (int k = 0; k < 900; ++k) {
    if (step != nullptr) *step = k;
    const StylusCommand command = at_tip(cycle.tip(k));
    simulation.step({&command, 1}, record);
    const Vector3& force = record.stylus[0].force;
    REQUIRE(force.allFinite());
    const double done = -force.dot(command.tip - last_tip);
    felt.work += done;
    felt.put_in += std::max(0.0, done);
    felt.peak = std::max(felt.peak, force.norm());
    felt.largest_step = std::max(felt.largest_step, (force - last_force).norm());
    last_tip = command.tip;
    last_force = force;
  }
  felt.missed = simulation.cache_misses();
  return felt;
}

}  // namespace

TEST_CASE(
    "pressing and sliding while columns are late, come and go, or never come: as strong as "
    "with all of them, without jumps, and no energy comes out",
    "[unsanitized]") {
  const StreamedModel model(*fem_cube({2, 2000.0, 8.0, kLateDt, 500}, ResponseKind::kDense));
  for (unsigned seed = 1; seed <= 12; ++seed) {
    const PressCycle cycle(*model.dense, seed);
    const double radius = seed % 2 == 0 ? 0.0 : 0.01;
    const Felt whole = feel_cycle(model.dense, cycle, radius);
    Random random(seed);
    std::vector<int> comes;
    for (int i = 0; i < model.dense->mesh.surface_node_count(); ++i) {
      comes.push_back(static_cast<int>(between(random, 0.0, 800.0)));
    }
    int k = 0;
    for (const bool never : {true, false}) {
      model.supply->there = [&](int node) {
        return !never && k >= comes[static_cast<std::size_t>(node)];
      };
      const Felt felt = feel_cycle(model.streamed, cycle, radius, &k);
      CAPTURE(seed, never, whole.peak, felt.peak, whole.largest_step, felt.largest_step, whole.work,
              felt.work, felt.put_in);
      CHECK((!never || felt.missed > 0));
      CHECK(felt.work >= -0.01 * felt.put_in);
      CHECK(felt.peak == Approx(whole.peak).epsilon(0.05));
      CHECK(felt.largest_step < 1.3 * whole.largest_step);
    }
  }
}

TEST_CASE("a streamed step allocates nothing, whatever becomes of the columns") {
  if (!AllocationGuard::active()) return leave_out(kNotCounted);
  const StreamedModel model(*fem_cube({2, 2000.0, 8.0, kLateDt, 100}, ResponseKind::kDense));
  SimulationConfig config = tethered({2}, 0.01, {0.4, 0.3});
  config.objects[0].model = model.streamed;
  int k = 0;
  model.supply->there = [&k](int node) { return (k % 900 + 200 * node) % 900 > 300; };
  model.supply->most = 12;
  Simulation simulation(config);
  StepRecord record;
  ContactModel predicted;
  const PressCycle cycle(*model.dense, 1);
  std::uint64_t touching = 0;
  const AllocationGuard guard;
  for (; k < 1500; ++k) {
    const StylusCommand command = at_tip(cycle.tip(k % 900));
    simulation.step({&command, 1}, record, k == 1000);
    simulation.predict_horizon(0, command.tip, 20, predicted);
    touching += record.stylus[0].contact == ContactState::kTouching ? 1 : 0;
  }
  CHECK(guard.count() == 0);
  CHECK(touching > 300);
  CHECK(simulation.cache_misses() > 0);
}
