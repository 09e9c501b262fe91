#include "bench/held_step.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "bench/statistics.hpp"
#include "common/contact/contact_problem.hpp"
#include "simulation/collision/rest_surface.hpp"
#include "simulation/engine/response_engine.hpp"
#include "simulation/step/simulation.hpp"

namespace irdm::bench {
namespace {

constexpr int kMostPoints = 8;
constexpr double kOutside = 0.061;
constexpr double kInside = 0.059;

// Places between nodes at every size, and the way in. Two on each of four faces.
struct Place {
  Vector3 at;
  Vector3 out;
};
const std::array<Place, kMostPoints> kPlaces{{
    {{0.0013, 0, 0.0011}, {0, 1, 0}},
    {{0.0013, 0, -0.0011}, {0, -1, 0}},
    {{0, 0.0013, 0.0011}, {1, 0, 0}},
    {{0, 0.0013, -0.0011}, {-1, 0, 0}},
    {{0.0313, 0, 0.0311}, {0, 1, 0}},
    {{0.0313, 0, -0.0311}, {0, -1, 0}},
    {{0, 0.0313, 0.0311}, {1, 0, 0}},
    {{0, 0.0313, -0.0311}, {-1, 0, 0}},
}};

SimulationConfig scene(std::shared_ptr<const Model> model, int styluses) {
  SimulationConfig config;
  config.objects.resize(1);
  config.objects[0].model = std::move(model);
  config.styluses.assign(static_cast<std::size_t>(styluses), {0.0, 2000.0, 0.0});
  return config;
}

std::vector<StylusCommand> commands(int styluses, int k, double dt) {
  std::vector<StylusCommand> now;
  for (int s = 0; s < styluses; ++s) {
    const Place& place = kPlaces[static_cast<std::size_t>(s)];
    const double swing = 0.0003 * std::sin(9.0 * k * dt);
    const Vector3 tip = place.at + (k < 2 ? kOutside : kInside + swing) * place.out;
    now.push_back({true, kGrabButton, tip, {}});
  }
  return now;
}

// Between the three nodes of a triangle, where the place is.
std::vector<SurfacePoint> held_points(const Model& model, int points) {
  const RestSurface surface(model.mesh);
  std::vector<SurfacePoint> found;
  for (int i = 0; i < points; ++i) {
    const Place& place = kPlaces[static_cast<std::size_t>(i)];
    found.push_back(surface.closest(place.at + kInside * place.out).point);
  }
  return found;
}

void check_held(const StepRecord& record, const std::vector<SurfacePoint>& points) {
  for (std::size_t s = 0; s < points.size(); ++s) {
    const ContactRecord& contact = record.object[0].contact[s];
    if (contact.state != ContactState::kHeld || contact.point.nodes != points[s].nodes) {
      throw std::runtime_error("a stylus does not hold its point; these times mean nothing");
    }
  }
}

}  // namespace

StepTimes held_steps(std::shared_ptr<const Model> model, int styluses, int measured) {
  const int steps = model->steps;
  const std::vector<SurfacePoint> points = held_points(*model, styluses);
  Simulation simulation(scene(std::move(model), styluses));
  StepRecord record;
  std::vector<double> times;
  for (int k = 0; k < steps + measured; ++k) {
    const std::vector<StylusCommand> now = commands(styluses, k, simulation.dt());
    const double time = seconds([&] { simulation.step(now, record); });
    if (k >= steps) times.push_back(1e6 * time);
  }
  check_held(record, points);
  return {percentile(times, 0.5), percentile(times, 0.99), percentile(times, 0.999)};
}

StepTimes eight_contacts(const std::shared_ptr<const Model>& model, int measured) {
  const auto engine = make_engine(model);
  std::vector<ContactPatch> patches;
  for (const SurfacePoint& point : held_points(*model, kMostPoints)) patches.emplace_back(point);
  ContactProblem problem(kMostPoints);
  ContactSolver solver(kMostPoints);
  std::array<Vector3, kMostPoints> h;
  ContactMatrix compliance;
  std::vector<NodalForce> forces;
  forces.reserve(3 * patches.size());
  const auto step = [&](int k) {
    engine->predict(patches, h, compliance);
    problem.begin(kMostPoints);
    for (int a = 0; a < kMostPoints; ++a) {
      const Vector3 wanted = -0.001 * kPlaces[static_cast<std::size_t>(a)].out;
      problem.contact(a).gap =
          (1.0 + 0.3 * std::sin(0.018 * k)) * wanted - h[static_cast<std::size_t>(a)];
      for (int b = 0; b < kMostPoints; ++b) {
        problem.elastic(a, b) = compliance.block<3, 3>(3 * a, 3 * b);
      }
      problem.elastic(a, a).diagonal().array() += 1.0 / 2000.0;
    }
    solver.solve(problem);
    forces.clear();
    for (int a = 0; a < kMostPoints; ++a) {
      const ContactPatch& patch = patches[static_cast<std::size_t>(a)];
      for (std::size_t i = 0; i < static_cast<std::size_t>(patch.count); ++i) {
        forces.push_back({patch.nodes[i], patch.weights[i] * problem.contact(a).force});
      }
      if (PredictionCaching* const caching = engine->capabilities().caching) {
        caching->cache_nodes(std::span(patch.nodes).first(static_cast<std::size_t>(patch.count)));
      }
    }
    engine->advance(forces);
  };
  std::vector<double> times;
  for (int k = 0; k < model->steps + measured; ++k) {
    const double time = seconds([&] { step(k); });
    if (k >= model->steps) times.push_back(1e6 * time);
  }
  return {percentile(times, 0.5), percentile(times, 0.99), percentile(times, 0.999)};
}

std::vector<int> held_nodes(const Model& model, int points) {
  std::vector<int> nodes;
  for (const SurfacePoint& point : held_points(model, points)) {
    nodes.insert(nodes.end(), point.nodes.begin(), point.nodes.end());
  }
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

}  // namespace irdm::bench
