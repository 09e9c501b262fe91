// Contact between bodies against closed forms: Hertz and Mindlin.
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>

#include "simulation/step/simulation.hpp"
#include "tests/simulation/half_space.hpp"
#include "tests/simulation/hertz.hpp"
#include "tests/simulation/touching_cubes.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;
using namespace irdm::test;

namespace {

constexpr double kFlat = std::numeric_limits<double>::infinity();
constexpr double kSoft = 1e5;  // [Pa]

// The first body is fixed, its paraboloid at the origin; the other, upside down, stands on it and
// is pressed on by its weight.
SimulationConfig pressed(const HalfSpace& below, const HalfSpace& above, double force) {
  SimulationConfig config;
  config.objects.resize(2);
  HalfSpace fixed = below;
  fixed.support = Support::kFixed;
  config.objects[0].model = half_space(fixed);
  config.objects[1].model = half_space(above);
  config.objects[1].orientation = Quaternion(0, 1, 0, 0);  // half a turn about x
  config.objects[1].damping = {200.0, 200.0};
  config.objects[1].tether.angular_stiffness = 10.0;
  config.objects[0].friction = config.objects[1].friction = {0.0, 0.0};
  config.gravity = Vector3(0, -force / above.mass, 0);
  config.contact_samples = 10'000;  // each site is one
  return config;
}

struct Pressed {
  double approach = 0.0;        // [m]
  double force = 0.0;           // [N]
  double radius = 0.0;          // of the outermost patch that carries [m]
  double pressure_error = 0.0;  // rms over the mean pressure
};

HertzPair pair_of(const HalfSpace& below, const HalfSpace& above) {
  return hertz_pair({below.youngs_modulus, 0.5, below.radius},
                    {above.youngs_modulus, 0.5, above.radius});
}

Pressed press_together(const HalfSpace& below, const HalfSpace& above, double approach) {
  const HertzPair pair = pair_of(below, above);
  const SimulationConfig config = pressed(below, above, hertz_force(pair, approach));
  Simulation simulation(config);
  const auto record = std::make_unique<StepRecord>();
  for (int k = 0; k < 600; ++k) step_alone(simulation, *record);
  Pressed found;
  found.approach = -record->object[1].position.y();
  found.force = std::abs(force_between(*record, 1, 0).y());
  double sum = 0.0;
  const double a = hertz_contact_radius(pair, approach);
  const double mean = hertz_force(pair, approach) / (std::numbers::pi * a * a);
  for (const BodyContactRecord& contact : record->body_contacts()) {
    const double r = std::hypot(contact.position.x(), contact.position.z());
    const double pressure = contact.force.norm() / contact.area;
    if (pressure > 0.02 * mean) found.radius = std::max(found.radius, r);
    const double off = pressure / mean - hertz_pressure(pair, approach, r) / mean;
    sum += off * off;
  }
  found.pressure_error = std::sqrt(sum / static_cast<double>(record->body_contact.size()));
  return found;
}

}  // namespace

TEST_CASE("hertz: force over approach and radius of contact, equal, unequal, on a plane",
          "[slow]") {
  struct Case {
    const char* name;
    double patches;  // radius of contact in patches
    HalfSpace below, above;
  };
  const HalfSpace ball;
  HalfSpace stiff = ball;
  stiff.youngs_modulus = 10.0 * kSoft;
  HalfSpace plane = ball;
  plane.radius = kFlat;
  HalfSpace smaller = ball;
  smaller.radius = 0.05;
  for (const Case& each :
       {Case{"equal", 4.0, ball, ball}, Case{"equal", 3.0, ball, ball},
        Case{"ten times as stiff", 3.0, stiff, ball}, Case{"on a plane", 3.0, plane, ball},
        Case{"unequal radii", 3.0, ball, smaller}}) {
    const HertzPair pair = pair_of(each.below, each.above);
    const double a = each.patches * ball.spacing;
    const double approach = a * a / pair.radius;
    const Pressed found = press_together(each.below, each.above, approach);
    INFO(each.name << ", a = " << each.patches << " patches: approach " << found.approach / approach
                   << " of the formula's, radius " << found.radius / a << ", pressure off by "
                   << found.pressure_error << " of the mean, rms");
    // F goes with the approach to the power of 1.5: 5 % of F are 3.3 % of the approach.
    CHECK(found.force == Approx(hertz_force(pair, approach)).epsilon(1e-3));
    CHECK(std::pow(found.approach / approach, 1.5) == Approx(1.0).epsilon(0.05));
    CHECK(std::abs(found.radius - a) <= ball.spacing);
    CHECK(found.pressure_error < 0.25);  // most of it at the edge, which runs through patches
  }
}

TEST_CASE("mindlin: a contact that is pushed sideways slips from its edge inwards", "[slow]") {
  const HalfSpace ball;
  const HertzPair pair = pair_of(ball, ball);
  const double a = 4.0 * ball.spacing;
  const double approach = a * a / pair.radius;
  const double mu = 0.5;
  const double force = hertz_force(pair, approach);
  const MindlinContact mindlin{pair, approach, mu};
  SimulationConfig config = pressed(ball, ball, force);
  config.objects[0].friction = config.objects[1].friction = {mu, mu};
  Simulation simulation(config);
  const auto record = std::make_unique<StepRecord>();
  for (int k = 0; k < 600; ++k) step_alone(simulation, *record);
  const double start = record->object[1].position.x();
  Settings settings = simulation.settings();
  for (const double share : {0.3, 0.6, 0.9}) {
    const double before = settings.gravity.x();
    const double after = share * mu * force / ball.mass;
    for (int k = 1; k <= 600; ++k) {
      settings.gravity.x() = before + (after - before) * std::min(1.0, k / 400.0);
      simulation.set(settings);
      step_alone(simulation, *record);
    }
    const double moved = record->object[1].position.x() - start;
    const double wanted = mindlin.displacement(share * mu * force);
    double stick = 0.0;
    for (const BodyContactRecord& contact : record->body_contacts()) {
      if (!contact.slipping) {
        stick = std::max(stick, std::hypot(contact.position.x(), contact.position.z()));
      }
    }
    INFO(share << " of mu F: moved " << moved / wanted << " of the formula's, sticks to "
               << stick / a << " a, by formula " << mindlin.stick_radius(share * mu * force) / a);
    CHECK(moved == Approx(wanted).epsilon(0.1));
  }
  // It begins to slip everywhere between 0.9 and 1.1 of mu F.
  settings.gravity.x() = 1.1 * mu * force / ball.mass;
  simulation.set(settings);
  for (int k = 0; k < 600; ++k) step_alone(simulation, *record);
  CHECK(record->object[1].position.x() - start > 2.0 * mindlin.most_displacement());
}
