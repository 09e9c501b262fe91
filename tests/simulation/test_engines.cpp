#include <omp.h>

#include <deque>
#include <random>

#include "common/response/modal_response.hpp"
#include "simulation/engine/response_engine.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/shared_model.hpp"
#include "tests/support/synthetic_model.hpp"

using namespace irdm;
using irdm::test::add_centrifugal;
using irdm::test::share;
using irdm::test::synthetic_cube;
using irdm::test::with_dense_response;

namespace {

// Contacts that come, move from node to node and go, with silences.
class RandomContacts {
 public:
  explicit RandomContacts(int nodes) : nodes_(nodes) {}
  std::vector<NodalForce> next() {
    std::vector<NodalForce> forces;
    if (left_-- <= 0) {
      active_ = random_() % 3 != 0;
      left_ = 5 + static_cast<int>(random_() % 40);
      node_ = static_cast<int>(random_() % static_cast<unsigned>(nodes_));
    }
    if (!active_) return forces;
    for (int i = 0; i < 3; ++i) {
      forces.push_back(
          {(node_ + i) % nodes_, Vector3(uniform_(random_), uniform_(random_), uniform_(random_))});
    }
    if (random_() % 10 == 0) node_ = (node_ + 1) % nodes_;
    return forces;
  }

 private:
  int nodes_;
  int node_ = 0;
  int left_ = 0;
  bool active_ = false;
  std::mt19937 random_{7};
  std::uniform_real_distribution<double> uniform_{-1.0, 1.0};
};

// Equation (10) written down: u[k] = sum over ages of R[age] f[k - age], over ages first..last - 1.
class DirectSum {
 public:
  DirectSum(const Model& modal, int first, int last) : first_(first), last_(last) {
    const auto& response = std::get<ModalResponse>(modal.response);
    shapes_ = std::get<RowMatrix<double>>(response.shapes);
    h_.resize(response.mode_count(), last);
    for (int i = 0; i < response.mode_count(); ++i) {
      h_.row(i) = held_force_response(held_force_oscillator(response.angular_frequency(i),
                                                            response.decay_rate(i), modal.dt),
                                      last)
                      .transpose();
    }
  }
  void push(const std::vector<NodalForce>& forces) {
    Eigen::VectorXd modal = Eigen::VectorXd::Zero(shapes_.cols());
    for (const NodalForce& force : forces) {
      modal += shapes_.middleRows(3 * force.node, 3).transpose() * force.force;
    }
    history_.push_front(modal);
    if (static_cast<int>(history_.size()) > last_) history_.pop_back();
  }
  Points displacement() const {
    Eigen::VectorXd q = Eigen::VectorXd::Zero(shapes_.cols());
    for (int age = first_; age < static_cast<int>(history_.size()); ++age) {
      q += h_.col(age).cwiseProduct(history_[static_cast<std::size_t>(age)]);
    }
    const Eigen::VectorXd u = shapes_ * q;
    return Eigen::Map<const Points>(u.data(), u.size() / 3, 3);
  }

 private:
  int first_;
  int last_;
  RowMatrix<double> shapes_;
  Eigen::MatrixXd h_;
  std::deque<Eigen::VectorXd> history_;
};

}  // namespace

TEST_CASE("engines equal the direct sum of equation (10) and each other, past the end of R") {
  constexpr int kSteps = 60;
  const Model modal = synthetic_cube(2, 20, kSteps);
  const auto modal_engine = make_engine(share(modal));
  const auto single = make_engine(share(with_dense_response<float>(modal)));
  const auto exact = make_engine(share(with_dense_response<double>(modal)));
  RandomContacts contacts(modal.mesh.surface_node_count());
  DirectSum everything(modal, 0, 4 * kSteps);
  DirectSum truncated(modal, 0, kSteps);
  DirectSum beyond(modal, kSteps, 4 * kSteps);

  double peak = 0.0;
  double tail = 0.0;
  Points u;
  for (int k = 0; k < 4 * kSteps; ++k) {
    const std::vector<NodalForce> forces = contacts.next();
    for (DirectSum* sum : {&everything, &truncated, &beyond}) sum->push(forces);
    for (const auto* engine : {&modal_engine, &single, &exact}) (*engine)->advance(forces);
    const Points all = everything.displacement();
    const Points within = truncated.displacement();
    const Points lost = beyond.displacement();
    peak = std::max(peak, all.cwiseAbs().maxCoeff());
    tail = std::max(tail, lost.cwiseAbs().maxCoeff());
    modal_engine->displacement(u);
    REQUIRE((u - all).cwiseAbs().maxCoeff() <= 1e-11 * (peak + 1e-30));
    exact->displacement(u);
    REQUIRE((u - within).cwiseAbs().maxCoeff() <= 1e-11 * (peak + 1e-30));
    // Single precision; what is cut off at T is accounted for exactly.
    single->displacement(u);
    REQUIRE((u + lost - all).cwiseAbs().maxCoeff() <= 1e-5 * (peak + 1e-30));
  }
  // The run is long enough, and its damping weak enough, for the cut at T to be seen.
  CHECK(tail > 1e-3 * peak);
}

TEST_CASE("engines predict the coming step: free displacement, and R[0] between the contacts") {
  const Model modal = synthetic_cube(2, 20, 80);
  const auto engine = GENERATE_COPY(
      as<std::shared_ptr<ResponseEngine>>{},
      std::shared_ptr<ResponseEngine>(make_engine(share(modal))),
      std::shared_ptr<ResponseEngine>(make_engine(share(with_dense_response<double>(modal)))));
  RandomContacts contacts(modal.mesh.surface_node_count());
  for (int k = 0; k < 30; ++k) engine->advance(contacts.next());

  const std::array<ContactPatch, 2> points{ContactPatch(SurfacePoint{{0, 1, 2}, {0.2, 0.3, 0.5}}),
                                           ContactPatch(SurfacePoint{{7, 3, 9}, {1.0, 0.0, 0.0}})};
  std::array<Vector3, 2> h;
  ContactMatrix W;
  engine->predict(points, h, W);
  CHECK((h[1] - engine->free_displacement(7)).norm() < 1e-15);
  const std::array<Vector3, 2> f{Vector3(0.3, -0.2, 0.1), Vector3(-0.5, 0.4, 0.6)};
  std::vector<NodalForce> nodal;
  for (std::size_t a = 0; a < 2; ++a) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(points[a].count); ++i)
      nodal.push_back({points[a].nodes[i], points[a].weights[i] * f[a]});
  }
  engine->advance(nodal);
  Points u;
  engine->displacement(u);
  Eigen::Matrix<double, 6, 1> force;
  force << f[0], f[1];
  const Eigen::Matrix<double, 6, 1> answer = W * force;
  CHECK((W - W.transpose()).norm() < 1e-12 * W.norm());
  for (std::size_t a = 0; a < 2; ++a) {
    const Vector3 moved = mean(points[a], [&](int i) -> Vector3 { return u.row(i).transpose(); });
    const Vector3 predicted = h[a] + answer.segment<3>(static_cast<Eigen::Index>(3 * a));
    CHECK((moved - predicted).norm() < 1e-12 * u.norm());
  }
}

TEST_CASE(
    "engines predict contacts that stay, change, come and go as an engine that sees them "
    "for the first time, to the bit") {
  const auto model = share(synthetic_cube(3, 70, 80));
  const auto engine = make_engine(model);
  std::mt19937 random(3);
  const auto patch = [&](int first) {
    ContactPatch at;
    for (int i = 0; i < 4 + first % 3; ++i) at.add((5 * first + 3 * i) % 56, 0.1 + 0.05 * i);
    return at;
  };
  std::vector<ContactPatch> patches{patch(0), patch(1), patch(2)};
  std::vector<std::vector<NodalForce>> history;
  for (int k = 0; k < 60; ++k) {
    if (k % 4 == 1) patches[random() % patches.size()] = patch(static_cast<int>(random() % 11));
    if (k % 7 == 2) patches[random() % patches.size()].weights[1] += 0.01;
    if (k % 9 == 3 && patches.size() > 1) patches.erase(patches.begin());
    if (k % 5 == 4) patches.push_back(patch(static_cast<int>(random() % 11)));
    const double damping = k < 40 ? 1.0 : 1.5;
    if (k == 40) engine->capabilities().damping->scale_damping(damping);
    std::vector<Vector3> h(patches.size());
    ContactMatrix W;
    engine->predict(patches, h, W);

    const auto fresh = make_engine(model);
    for (std::size_t i = 0; i < history.size(); ++i) {
      if (i == 40) fresh->capabilities().damping->scale_damping(damping);
      fresh->advance(history[i]);
    }
    if (history.size() == 40) fresh->capabilities().damping->scale_damping(damping);
    std::vector<Vector3> expected(patches.size());
    ContactMatrix expected_W;
    fresh->predict(patches, expected, expected_W);
    REQUIRE(h == expected);
    REQUIRE(W == expected_W);
    history.push_back(
        {{k % 56, Vector3(0.1 * k, -1.0, 0.3)}, {(k + 7) % 56, Vector3(0.2, 0.5, 0.02 * k)}});
    engine->advance(history.back());
  }
}

TEST_CASE("engine's surface is the same to the bit with one, two and three OpenMP threads",
          "[slow]") {
  const Model modal = synthetic_cube(5, 200, 50);
  for (const Model& model : {modal, with_dense_response<float>(modal)}) {
    const auto engine = make_engine(share(model));
    RandomContacts contacts(modal.mesh.surface_node_count());
    for (int k = 0; k < 70; ++k) engine->advance(contacts.next());
    for (const double tolerance : {0.0, 1e-4}) {
      Points one, several;
      omp_set_num_threads(1);
      engine->displacement(one, tolerance);
      CHECK(one.norm() > 0);
      for (const int threads : {2, 3}) {
        omp_set_num_threads(threads);
        engine->displacement(several, tolerance);
        CHECK((one.array() == several.array()).all());
      }
    }
  }
  omp_set_num_threads(omp_get_num_procs());
}

TEST_CASE("modal surface is within the tolerance of the whole one, with fewer modes") {
  const Model modal = synthetic_cube(3, 300, 50);
  const auto engine = make_engine(share(modal));
  RandomContacts contacts(modal.mesh.surface_node_count());
  for (int k = 0; k < 70; ++k) engine->advance(contacts.next());
  for (int k = 0; k < 200; ++k) engine->advance({});  // the higher modes die down first
  Points whole, less;
  engine->displacement(whole);
  for (const double share : {1e-6, 1e-3, 0.1}) {
    const double tolerance = share * whole.cwiseAbs().maxCoeff();
    engine->displacement(less, tolerance);
    CHECK((whole - less).cwiseAbs().maxCoeff() <= tolerance);
  }
  CHECK((whole - less).norm() > 0.0);
}

TEST_CASE("engine forgets everything on reset") {
  const Model modal = synthetic_cube(2, 10, 50);
  for (const Model& model : {modal, with_dense_response<float>(modal)}) {
    const auto engine = make_engine(share(model));
    RandomContacts contacts(modal.mesh.surface_node_count());
    for (int k = 0; k < 20; ++k) engine->advance(contacts.next());
    engine->reset();
    engine->advance({});
    Points u;
    engine->displacement(u);
    CHECK(u.norm() == 0.0);
  }
}

TEST_CASE("modal engine comes to rest exactly, instead of going on with denormal numbers") {
  const Model modal = synthetic_cube(2, 20, 50);
  const auto engine = make_engine(share(modal));
  const NodalForce force{3, Vector3(1, -2, 0.5)};
  engine->advance({&force, 1});
  Points u;
  engine->displacement(u);
  REQUIRE(u.norm() > 0);
  // The slowest mode decays by exp(-4.5) a second: 60 s are enough for 100 orders of magnitude.
  for (int k = 0; k < 30'000; ++k) engine->advance({});
  engine->displacement(u);
  CHECK(u.norm() == 0.0);
}

TEST_CASE("no node's free displacement is beyond its bound, where an engine knows one") {
  Model modal = synthetic_cube(3, 40, 50);
  add_centrifugal(modal);
  Model single = modal;
  auto& shapes = std::get<ModalResponse>(single.response).shapes;
  shapes = RowMatrix<float>(std::get<RowMatrix<double>>(shapes).cast<float>());
  const int nodes = modal.mesh.surface_node_count();
  const auto dense = share(with_dense_response<double>(modal));
  std::vector<std::unique_ptr<ResponseEngine>> engines;
  engines.push_back(make_engine(share(modal)));
  engines.push_back(make_engine(share(single)));
  engines.push_back(make_engine(dense));
  for (const auto& engine : engines) {
    const bool by_history = engine == engines.back();
    CHECK(engine->free_displacement_bound() == 0.0);
    RandomContacts contacts(nodes);
    double largest_share = 0.0;
    for (int k = 0; k < 300; ++k) {
      if (k > 100 && k < 150)
        engine->capabilities().inertial_loading->set_angular_velocity(
            Vector3(0.1 * (k - 100), 2.0, -1.0));
      double largest = 0.0;
      std::vector<Vector3> before;
      for (int node = 0; node < nodes; ++node) {
        before.push_back(engine->free_displacement(node));
        largest = std::max(largest, before.back().cwiseAbs().maxCoeff());
      }
      const double bound = engine->free_displacement_bound();
      REQUIRE(largest <= (1.0 + 1e-12) * bound);
      if (!by_history) CHECK(std::isfinite(bound));
      if (std::isfinite(bound) && bound > 0.0) {
        largest_share = std::max(largest_share, largest / bound);
      }
      engine->advance(k < 200 ? contacts.next() : std::vector<NodalForce>());
      double change = 0.0;
      for (int node = 0; node < nodes; ++node) {
        const Vector3 now = engine->free_displacement(node);
        change =
            std::max(change, (now - before[static_cast<std::size_t>(node)]).cwiseAbs().maxCoeff());
      }
      const double change_bound = engine->free_change_bound();
      REQUIRE(change <= (1.0 + 1e-12) * change_bound);
      const bool loaded = k > 100 && k < 150;
      CHECK(std::isfinite(change_bound) == (!by_history && !loaded));
      if (std::isfinite(change_bound) && change > 0.0) CHECK(change > 0.02 * change_bound);
    }
    // The last force is 100 steps old, and T is 50.
    if (by_history) CHECK(engine->free_displacement_bound() == 0.0);
    // Of use where it is known: not beyond all measure.
    if (!by_history) CHECK(largest_share > 0.1);
    engine->reset();
    CHECK(engine->free_displacement_bound() == 0.0);
  }
}

TEST_CASE("surfaces of several engines at once are those of each, to the bit") {
  const Model modal = synthetic_cube(3, 100, 50);
  const auto shared = share(modal);
  const auto dense = share(with_dense_response<double>(modal));
  std::vector<std::unique_ptr<ResponseEngine>> engines;
  engines.push_back(make_engine(shared));
  engines.push_back(make_engine(dense));
  engines.push_back(make_engine(share(synthetic_cube(2, 30, 50))));
  engines.push_back(make_engine(shared));
  engines.push_back(make_engine(dense));
  engines.push_back(make_engine(shared));
  for (std::size_t i = 0; i < engines.size(); ++i) {
    for (int k = 0; k < 10; ++k) {
      const NodalForce force{static_cast<int>(i) + k % 3, Vector3(1.0, 0.1 * k, -0.5)};
      engines[i]->advance({&force, 1});
    }
  }
  for (const int threads : {1, 2, 3}) {
    omp_set_num_threads(threads);
    std::vector<Points> together(engines.size());
    std::vector<SurfaceRequest> requests;
    for (std::size_t i = 0; i < engines.size(); ++i) {
      requests.push_back({engines[i].get(), i == 3 ? 1e-4 : 0.0, &together[i]});
    }
    displacements(requests);
    for (std::size_t i = 0; i < engines.size(); ++i) {
      Points alone;
      engines[i]->displacement(alone, i == 3 ? 1e-4 : 0.0);
      REQUIRE(together[i] == alone);
      REQUIRE(alone.norm() > 0.0);
    }
  }
  omp_set_num_threads(omp_get_num_procs());
  CHECK(dynamic_cast<const SharedSurface&>(*engines[0]).shared_surface() ==
        dynamic_cast<const SharedSurface&>(*engines[3]).shared_surface());
  CHECK(dynamic_cast<const SharedSurface&>(*engines[0]).shared_surface() !=
        dynamic_cast<const SharedSurface&>(*engines[2]).shared_surface());
}

TEST_CASE("engines: what a share of a force changes the energy by is what it changes it by") {
  const Model modal = synthetic_cube(2, 20, 60);
  const auto engine = make_engine(share(modal));
  const auto other = make_engine(share(modal));
  RandomContacts contacts(modal.mesh.surface_node_count());
  RandomContacts late(modal.mesh.surface_node_count() / 2);
  int told = 0;
  for (int k = 0; k < 200; ++k) {
    std::vector<NodalForce> forces = late.next();
    const double part = 0.25 * (k % 5);
    const int age = k % 7 - 1;
    const auto change = engine->energy_change(forces, age);
    REQUIRE(change);
    const double expected = part * (change->along + part * change->own);
    for (NodalForce& force : forces) force.force *= part;
    if (age >= 0) {
      const double before = engine->energy();
      engine->add_delayed_force(forces, age);
      other->add_delayed_force(forces, age);
      CHECK(engine->energy() - before == Approx(expected).epsilon(1e-9).margin(1e-15));
      engine->advance({});
      other->advance({});
    } else {
      engine->advance(forces);
      other->advance({});
      CHECK(engine->energy() - other->energy() == Approx(expected).epsilon(1e-9).margin(1e-15));
      other->add_delayed_force(forces, 0);
    }
    told += expected != 0.0 ? 1 : 0;
    const std::vector<NodalForce> held = contacts.next();
    engine->advance(held);
    other->advance(held);
  }
  CHECK(told > 50);
  CHECK(!make_engine(share(with_dense_response<double>(modal)))->energy_change({}, 0));
}
