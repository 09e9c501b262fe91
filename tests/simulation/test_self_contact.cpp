// Parts of one body that touch each other: a horseshoe and a frame whose slot is pressed shut.
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <memory>
#include <numbers>
#include <variant>
#include <vector>

#include "precompute/modal/elastic_statics.hpp"
#include "simulation/contact/self_contact.hpp"
#include "simulation/step/nodal_forces.hpp"
#include "simulation/step/simulation.hpp"
#include "tests/simulation/random_numbers.hpp"
#include "tests/support/allocation_guard.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/fem_cube.hpp"
#include "tests/support/left_out.hpp"
#include "tests/support/slotted_body.hpp"
#include "tests/support/static_fem.hpp"

using namespace irdm;
using namespace irdm::test;

namespace {

constexpr double kOutside = 2.5 * kVoxel;  // of the arms [m]
constexpr double kOpenEnd = 9.0 * kVoxel;  // y of the arms [m]

SimulationConfig alone(const std::shared_ptr<const Model>& model, bool self = true) {
  SimulationConfig config;
  config.objects.resize(1);
  config.objects[0].model = model;
  config.objects[0].friction = {0.0, 0.0};
  config.objects[0].damping = {20.0, 20.0};
  config.objects[0].tether = {500.0, 0.5};
  config.styluses.resize(2);
  config.self_contact = self;
  return config;
}

/// Two forces of the same size on the outer faces, against each other.
struct Squeeze {
  double y = 0.0;      // where they act [m], coordinates of the input
  double force = 0.0;  // [N]
};

std::array<int, 2> pressed_nodes(const Model& model, double y) {
  return {corner_node(model, Vector3(-kOutside, y, kVoxel)),
          corner_node(model, Vector3(kOutside, y, kVoxel))};
}

std::array<StylusCommand, 2> squeezing(const Model& model, const Squeeze& squeeze) {
  std::array<StylusCommand, 2> commands;
  const std::array<int, 2> nodes = pressed_nodes(model, squeeze.y);
  for (std::size_t s = 0; s < 2; ++s) {
    commands[s].present = true;
    GivenForce given;
    for (Eigen::Index t = 0; t < model.mesh.triangles.rows(); ++t) {
      const Eigen::Vector3i corners = model.mesh.triangles.row(t).transpose();
      for (int i = 0; i < 3; ++i) {
        if (corners(i) != nodes[s]) continue;
        given.point.nodes = {corners(0), corners(1), corners(2)};
        given.point.weights = {0.0, 0.0, 0.0};
        given.point.weights[static_cast<std::size_t>(i)] = 1.0;
      }
    }
    given.force = Vector3(s == 0 ? squeeze.force : -squeeze.force, 0.0, 0.0);
    commands[s].given = given;
  }
  return commands;
}

/// Nodes that lie across the slot from each other, at rest kVoxel apart.
struct AcrossSlot {
  int left;
  int right;
};

std::vector<AcrossSlot> across_slot(const Model& model) {
  std::vector<AcrossSlot> pairs;
  for (int y = 2; y <= 9; ++y) {
    // Beyond the slot of a frame there is no face.
    if (corner_node(model, kVoxel * Vector3(0.5, y, 1)) < 0) break;
    for (int z = 0; z <= 2; ++z) {
      const int left = corner_node(model, kVoxel * Vector3(-0.5, y, z));
      const int right = corner_node(model, kVoxel * Vector3(0.5, y, z));
      if (left >= 0 && right >= 0) pairs.push_back({left, right});
    }
  }
  return pairs;
}

// How far apart the two of each pair are, across the slot [m].
Eigen::VectorXd gaps(const Model& model, const Points& u) {
  const std::vector<AcrossSlot> pairs = across_slot(model);
  Eigen::VectorXd gaps(static_cast<Eigen::Index>(pairs.size()));
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    gaps(static_cast<Eigen::Index>(i)) = kVoxel + u(pairs[i].right, 0) - u(pairs[i].left, 0);
  }
  return gaps;
}

/// At rest by finite elements on the whole mesh.
struct Reference {
  double force = 0.0;        // of one arm on the other [N]
  double height = 0.0;       // its mean y [m], B
  double approach = 0.0;     // of the nodes that are pressed [m]
  Eigen::VectorXd gap;       // of across_slot() [m]
  Eigen::VectorXd pressure;  // [N], the same
};

// Nodes across the slot must not come through each other, without friction: projected
// Gauss-Seidel.
Reference reference(const Model& model, const Squeeze& squeeze) {
  const precompute::ElasticStatics statics(stiffness_of(model), model.mesh.nodes,
                                           model.mesh.node_mass, {});
  const auto row = [&](int node) {
    return 3 * model.mesh.surface_nodes[static_cast<std::size_t>(node)];
  };
  const std::vector<AcrossSlot> pairs = across_slot(model);
  const auto m = static_cast<Eigen::Index>(pairs.size());
  Eigen::MatrixXd load = Eigen::MatrixXd::Zero(statics.degrees_of_freedom(), m + 1);
  for (Eigen::Index i = 0; i < m; ++i) {
    load(row(pairs[static_cast<std::size_t>(i)].right), i) = 1.0;
    load(row(pairs[static_cast<std::size_t>(i)].left), i) = -1.0;
  }
  const std::array<int, 2> nodes = pressed_nodes(model, squeeze.y);
  load(row(nodes[0]), m) = squeeze.force;
  load(row(nodes[1]), m) = -squeeze.force;
  const Eigen::MatrixXd u = statics.displacement(load);
  const Eigen::MatrixXd C = load.leftCols(m).transpose() * u.leftCols(m);
  const Eigen::VectorXd open =
      Eigen::VectorXd::Constant(m, kVoxel) + load.leftCols(m).transpose() * u.col(m);
  Reference found;
  found.pressure = Eigen::VectorXd::Zero(m);
  for (int sweep = 0; sweep < 20'000; ++sweep) {
    for (Eigen::Index i = 0; i < m; ++i) {
      const double gap = open(i) + C.row(i).dot(found.pressure);
      found.pressure(i) = std::max(0.0, found.pressure(i) - gap / C(i, i));
    }
  }
  found.gap = open + C * found.pressure;
  found.force = found.pressure.sum();
  const Eigen::VectorXd moved = u.leftCols(m) * found.pressure + u.col(m);
  found.approach = moved(row(nodes[0])) - moved(row(nodes[1]));
  for (Eigen::Index i = 0; i < m; ++i) {
    const int node = pairs[static_cast<std::size_t>(i)].left;
    found.height += found.pressure(i) * model.mesh.rest_position(node).y() / found.force;
  }
  return found;
}

struct Pressed {
  double force = 0.0;
  double height = 0.0;
  double approach = 0.0;
  double moves = 0.0;  // of the force from step to step at the end [N]
  Eigen::VectorXd gap;
  double least_gap = 0.0;  // in any step [m]
  double residual = 0.0;   // [m]
};

// Under forces that grow within 1 s, until all is at rest.
Pressed press_shut(const std::shared_ptr<const Model>& model, const Squeeze& squeeze) {
  Simulation simulation(alone(model));
  const auto record = std::make_unique<StepRecord>();
  Pressed found;
  Points u;
  const auto steps = static_cast<int>(3.0 / model->dt);
  for (int k = 1; k <= steps; ++k) {
    const double share = std::min(1.0, 3.0 * k / steps);
    const RigidState& state = simulation.object(0).state();
    simulation.step(squeezing(*model, {squeeze.y, share * squeeze.force}), *record);
    simulation.object(0).engine().displacement(u);
    found.gap = gaps(*model, u);
    found.least_gap = std::min(found.least_gap, found.gap.minCoeff());
    found.residual = std::max(found.residual, record->object[0].residual);
    double force = 0.0;
    double height = 0.0;
    const Matrix3 to_body = state.orientation.conjugate().toRotationMatrix();
    for (const BodyContactRecord& contact : record->body_contacts()) {
      REQUIRE((contact.object == 0 && contact.other == 0));
      const double push = std::abs((to_body * contact.force).x());
      force += push;
      height += push * (to_body * (contact.position - state.position)).y();
    }
    if (k > steps - 20) found.moves = std::max(found.moves, std::abs(force - found.force));
    found.force = force;
    found.height = force > 0.0 ? height / force : 0.0;
  }
  const std::array<int, 2> nodes = pressed_nodes(*model, squeeze.y);
  found.approach = u(nodes[0], 0) - u(nodes[1], 0);
  return found;
}

/// The elastic motion of a body under recorded forces, each mode by itself: no engine.
class Oscillators {
 public:
  explicit Oscillators(const SimulationConfig& config)
      : model_(*config.objects[0].model),
        surface_(model_.mesh),
        forces_(config, 0, surface_),
        modal_(std::get<ModalResponse>(model_.response)),
        q_(Eigen::VectorXd::Zero(modal_.mode_count())),
        v_(q_) {
    std::visit([&](const auto& shapes) { shapes_ = shapes.template cast<double>(); },
               modal_.shapes);
  }

  void advance(const StepRecord& record) {
    Eigen::VectorXd force = Eigen::VectorXd::Zero(q_.size());
    for (const NodalForce& each : forces_.of(record.object[0], record.body_contacts())) {
      force += shapes_.middleRows<3>(3 * each.node).transpose() * each.force;
    }
    for (Eigen::Index i = 0; i < q_.size(); ++i) advance(i, force(i));
  }

  double energy() const {  ///< [J]
    return 0.5 * v_.squaredNorm() + 0.5 * modal_.angular_frequency.cwiseProduct(q_).squaredNorm();
  }
  Points displacement() const {  ///< of the surface (n, 3) [m], B
    const Eigen::VectorXd u = shapes_ * q_;
    return Eigen::Map<const Points>(u.data(), u.size() / 3, 3);
  }

 private:
  void advance(Eigen::Index i, double force) {
    using Complex = std::complex<double>;
    const double square = std::pow(modal_.angular_frequency(i), 2);
    const double decay = modal_.decay_rate(i);
    const Complex root = std::sqrt(Complex(decay * decay - square));
    const Complex fast = -decay - root;
    const Complex slow = -decay + root;
    const double away = q_(i) - force / square;
    const Complex a = (v_(i) - fast * away) / (slow - fast);
    const Complex b = away - a;
    const Complex ea = a * std::exp(slow * model_.dt);
    const Complex eb = b * std::exp(fast * model_.dt);
    q_(i) = force / square + (ea + eb).real();
    v_(i) = (slow * ea + fast * eb).real();
  }

  const Model& model_;
  RestSurface surface_;
  RecordedForces forces_;
  const ModalResponse& modal_;
  RowMatrix<double> shapes_;
  Eigen::VectorXd q_, v_;
};

/// A body that flies and turns, and whose arms are struck for a moment: half a wave of a force.
struct Strike {
  Squeeze squeeze;  // its peak
  int steps = 0;
  Vector3 turns = Vector3::Zero();  // [rad/s]
};

Strike random_strike(Random& random, const Model& model, double size) {
  // Such that the arms would come a few widths of the slot through each other.
  const int steps = 4 + static_cast<int>(between(random, 0.0, 6.0));
  const double impulse =
      size * std::sqrt(model.material.youngs_modulus / 2e5) * between(random, 0.5, 2.0);
  const int y = 5 + static_cast<int>(between(random, 0.0, 4.99));
  return {{y * kVoxel, 0.5 * std::numbers::pi * impulse / (steps * model.dt)},
          steps,
          anywhere(random, 2.0)};
}

SimulationConfig struck(const std::shared_ptr<const Model>& model, const Strike& strike,
                        bool self = true) {
  SimulationConfig config = alone(model, self);
  config.objects[0].tether = {};
  config.objects[0].damping = {};
  config.objects[0].velocity = Vector3(0.1, -0.2, 0.3);
  config.objects[0].angular_velocity = strike.turns;
  return config;
}

std::array<StylusCommand, 2> striking(const Model& model, const Strike& strike, int k) {
  if (k >= strike.steps) return {};
  const double share = std::sin(std::numbers::pi * (k + 0.5) / strike.steps);
  return squeezing(model, {strike.squeeze.y, share * strike.squeeze.force});
}

}  // namespace

TEST_CASE("self-contact: a cube has none; the faces of a slot see each other") {
  const auto reach_of = [](const Model& model, int samples) {
    const RestSurface surface(model.mesh);
    const ContactSampling sampling(surface, samples);
    return std::make_unique<SelfReach>(surface, sampling);
  };
  CHECK_FALSE(reach_of(*fem_cube({.cells = 3}), 384)->any());
  for (const bool closed : {false, true}) {
    const auto model = slotted_body({closed});
    const RestSurface surface(model->mesh);
    const ContactSampling sampling(surface, 384);
    const SelfReach reach(surface, sampling);
    REQUIRE(reach.any());
    int patches = 0;
    for (int s = 0; s < sampling.first_edge(); ++s) {
      const ContactSampling::Sample& sample = sampling.samples()[static_cast<std::size_t>(s)];
      const TriangleSet across = reach.across(s);
      if (across.empty() || std::abs(sample.normal.x()) < 0.9) continue;
      ++patches;
      CHECK(std::abs(sample.place.position.x()) < 0.51 * kVoxel);
      CHECK(reach.gap(s) == Approx(kVoxel));
      for (std::size_t t = 0; t < across.size(); ++t) {
        if (across[t] == 0) continue;
        CHECK(surface.plane(static_cast<int>(t)).normal.dot(sample.normal) < -0.999);
      }
    }
    CHECK(patches >= 8);
  }
}

TEST_CASE("self-contact: a slot that is pressed shut carries what it does by finite elements",
          "[slow]") {
  struct Case {
    bool closed;
    double y;
    double force;
  };
  for (const Case& each : {Case{true, 5 * kVoxel, 2.4}, Case{true, 5 * kVoxel, 2.0},
                           Case{false, kOpenEnd, 0.025}, Case{false, 6 * kVoxel, 0.06}}) {
    const auto model = slotted_body({each.closed, 2e4});
    const Squeeze squeeze{each.y, each.force};
    const Reference fem = reference(*model, squeeze);
    const Pressed run = press_shut(model, squeeze);
    INFO((each.closed ? "frame" : "horseshoe")
         << ", " << each.force << " N at " << each.y << " m: force " << run.force << " of "
         << fem.force << " N at " << run.height << " of " << fem.height << " m, approach "
         << run.approach << " of " << fem.approach << " m, least gap " << run.gap.minCoeff()
         << " of " << fem.gap.minCoeff() << ", ever " << run.least_gap << ", force moves by "
         << run.moves << " N, residual " << run.residual);
    CHECK(fem.force > 0.01);
    CHECK(run.force == Approx(fem.force).epsilon(0.03));
    CHECK(run.approach == Approx(fem.approach).epsilon(0.03));
    CHECK(run.least_gap > -5e-4);
    CHECK(run.residual < 1e-5);
    CHECK(run.moves < 1e-3 * fem.force);
  }
}

TEST_CASE("self-contact: arms that clap make no energy, and no momentum", "[slow]") {
  for (const double youngs_modulus : {2e3, 2e4, 2e5, 1e6}) {
    for (const bool closed : {false, true}) {
      const auto model = slotted_body({closed, youngs_modulus});
      double worst = 0.0;
      double worst_gap = 1.0;
      double off = 0.0;
      int clapped = 0;
      double residual = 0.0;
      double rise = 0.0;
      for (unsigned seed = 0; seed < 4; ++seed) {
        Random random(seed);
        const Strike strike = random_strike(random, *model, closed ? 0.016 : 0.004);
        const SimulationConfig config = struck(model, strike);
        Simulation simulation(config);
        Oscillators elastic(config);
        const auto record = std::make_unique<StepRecord>();
        double begun = 0.0;
        double before = 0.0;
        RigidState last;
        bool touched = false;
        for (int k = 0; k < 500; ++k) {
          simulation.step(striking(*model, strike, k), *record);
          elastic.advance(*record);
          const RigidState& now = simulation.object(0).state();
          const double energy = elastic.energy();
          if (k < strike.steps) {
            begun = energy;
          } else {
            off = std::max({off, (now.velocity - last.velocity).norm() * model->body.mass,
                            (now.angular_momentum - last.angular_momentum).norm()});
            worst = std::max(worst, energy / begun);
            rise = std::max(rise, (energy - before) / begun);
          }
          last = now;
          before = energy;
          touched = touched || !record->body_contacts().empty();
          residual = std::max(residual, record->object[0].residual);
          worst_gap = std::min(worst_gap, gaps(*model, elastic.displacement()).minCoeff());
        }
        clapped += touched ? 1 : 0;
      }
      INFO("E " << youngs_modulus << (closed ? ", frame: " : ", horseshoe: ") << clapped
                << " of 4 clap; energy at most " << worst
                << " of what the strike gave, it rises in a step by " << rise
                << ", momentum off by " << off << ", least gap " << worst_gap << " m, residual "
                << residual);
      CHECK(worst < 1.0);
      CHECK(rise < 1e-9);
      CHECK(residual < 1e-5);
      // Patches touch at their centroids: the corner of a tip, beyond them, bends through.
      CHECK(worst_gap > (youngs_modulus > 1e4 ? -1e-3 : -3e-3));
      CHECK(off < 1e-10);
    }
  }
}

TEST_CASE("self-contact: with all engines it is the same to the bit again, and nothing allocates",
          "[slow]") {
  if (!AllocationGuard::active()) return leave_out(kNotCounted);
  const ResponseKind kind =
      GENERATE(ResponseKind::kModal, ResponseKind::kDense, ResponseKind::kCompressed);
  const SlottedBody body{false, 2e4};
  const auto model = slotted_body(body, kind);
  const Strike strike{{kOpenEnd, 0.3}, 5, Vector3(0.3, -0.2, 0.5)};
  SimulationConfig config = struck(model, strike);
  config.objects[0].friction = {0.6, 0.5};
  Simulation first(config);
  Simulation second(config);
  const auto one = std::make_unique<StepRecord>();
  const auto two = std::make_unique<StepRecord>();
  for (int k = 0; k < 100; ++k) second.step(striking(*model, strike, k), *two);
  second.reset();
  std::size_t contacts = 0;
  double impulse = 0.0;
  for (int k = 0; k < 200; ++k) {
    const auto commands = striking(*model, strike, k);
    {
      const AllocationGuard guard;
      first.step(commands, *one);
      REQUIRE(guard.count() == 0);
    }
    second.step(commands, *two);
    REQUIRE(one->body_contact.size() == two->body_contact.size());
    for (std::size_t c = 0; c < one->body_contact.size(); ++c) {
      REQUIRE(one->body_contact[c].force == two->body_contact[c].force);
      impulse += one->body_contact[c].force.norm();
    }
    contacts += one->body_contact.size();
    REQUIRE(one->object[0].position == two->object[0].position);
  }
  CHECK(contacts > 0);
  CHECK(impulse > 0.0);
}

TEST_CASE("self-contact: what does not touch itself moves as without, to the bit",
          "[unsanitized]") {
  const auto model = slotted_body({true, 2e5});
  const Strike strike{{5 * kVoxel, 0.05}, 5, Vector3(0.3, -0.2, 0.5)};
  Simulation with(struck(model, strike, true));
  Simulation without(struck(model, strike, false));
  const auto one = std::make_unique<StepRecord>();
  const auto two = std::make_unique<StepRecord>();
  Points u;
  Points v;
  for (int k = 0; k < 200; ++k) {
    const auto commands = striking(*model, strike, k);
    with.step(commands, *one);
    without.step(commands, *two);
    REQUIRE(one->body_contacts().empty());
    REQUIRE(one->object[0].position == two->object[0].position);
    REQUIRE(one->object[0].orientation.coeffs() == two->object[0].orientation.coeffs());
  }
  with.object(0).engine().displacement(u);
  without.object(0).engine().displacement(v);
  CHECK(u.norm() > 0.0);
  CHECK(u == v);
}
