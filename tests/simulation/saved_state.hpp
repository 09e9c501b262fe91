#pragma once

#include <memory>
#include <span>
#include <vector>

#include "simulation/state/state_archive.hpp"
#include "simulation/step/simulation.hpp"
#include "tests/support/catch.hpp"

namespace irdm::test {

inline std::vector<std::byte> save(Simulation& simulation) {
  StateArchive state;
  simulation.archive(state);
  return state.take();
}

inline void load(Simulation& simulation, std::span<const std::byte> bytes) {
  StateArchive state(bytes);
  simulation.archive(state);
  state.end();
}

/// What a step did, as numbers.
inline std::vector<double> numbers_of(const StepRecord& record) {
  std::vector<double> numbers;
  const auto add = [&](const auto& vector) {
    numbers.insert(numbers.end(), vector.data(), vector.data() + vector.size());
  };
  numbers.push_back(record.time);
  for (std::size_t i = 0; i < static_cast<std::size_t>(record.object_count); ++i) {
    const ObjectRecord& object = record.object[i];
    add(object.position);
    add(object.orientation.coeffs());
    add(object.velocity);
    add(object.angular_velocity);
    add(object.floor_force);
    numbers.push_back(object.asleep ? 1.0 : 0.0);
    numbers.push_back(object.floor_count);
    numbers.push_back(object.residual);
  }
  for (std::size_t s = 0; s < static_cast<std::size_t>(record.stylus_count); ++s) {
    add(record.stylus[s].force);
    add(record.stylus[s].torque);
    add(record.stylus[s].proxy);
  }
  for (const BodyContactRecord& contact : record.body_contacts()) {
    numbers.push_back(contact.sample);
    add(contact.force);
    add(contact.position);
    add(contact.slip);
  }
  return numbers;
}

/// A simulation is saved after `before` steps and goes on for `after` more. Another one that loads
/// the state, and then itself, has to do the same to the bit.
/// @param commands of a step: a container of StylusCommand
template <typename Commands>
void check_saved_state(const SimulationConfig& config, int before, int after,
                       const Commands& commands) {
  const auto record = std::make_unique<StepRecord>();
  const auto go = [&](Simulation& simulation, int k) {
    const auto those = commands(k);
    simulation.step(those, *record);
    return numbers_of(*record);
  };
  Simulation first(config);
  for (int k = 0; k < before; ++k) go(first, k);
  const std::vector<std::byte> state = save(first);
  std::vector<std::vector<double>> expected;
  for (int k = before; k < before + after; ++k) expected.push_back(go(first, k));
  Simulation second(config);
  for (int k = 0; k < before / 3; ++k) go(second, k);
  for (Simulation* simulation : {&second, &first}) {
    load(*simulation, state);
    REQUIRE(save(*simulation) == state);
    for (int k = before; k < before + after; ++k) {
      INFO("step " << k << ", saved before " << before
                   << (simulation == &first ? ", by itself" : ""));
      REQUIRE(go(*simulation, k) == expected[static_cast<std::size_t>(k - before)]);
    }
  }
}

}  // namespace irdm::test
