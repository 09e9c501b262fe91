#pragma once

#include <cstddef>

#include "trace/trace_writer.hpp"

namespace irdm::test {

inline TraceHeader header(int styluses) {
  return {{{"cube", "cube.h5", "c0ffee"}}, "[[object]]\n", 0.002, styluses, false};
}

/// Step k of no simulation: every number another. Contact states take turns, free in row 0.
inline StepRecord record(std::size_t k) {
  double next = 1000.0 * static_cast<double>(k);
  const auto vector = [&next] {
    next += 3.0;
    return Vector3(next + 0.25, -next - 1.25, next + 2.25);
  };
  StepRecord record;
  record.force_step = k;
  record.time = 0.002 * static_cast<double>(k + 1);
  record.reset = k % 3 == 1;
  record.object_count = 1;
  ObjectRecord& object = record.object[0];
  object.position = vector();
  object.orientation = Quaternion(0.5, -0.5, 0.5, -0.5);
  object.orientation.coeffs() *= k % 2 == 0 ? 1.0 : -1.0;
  object.velocity = vector();
  object.angular_velocity = vector();
  object.residual = 1e-9 * static_cast<double>(k + 1);
  object.sweeps = static_cast<int>(k + 5);
  object.floor_count = static_cast<int>(k % 4);  // none in row 0
  for (std::size_t i = 0; i < k % 4; ++i) {
    object.floor[i] = {static_cast<int>(7 * k + i), vector().cast<float>()};
  }
  record.stylus_count = 2;
  for (std::size_t s = 0; s < 2; ++s) {
    StylusRecord& stylus = record.stylus[s];
    stylus.present = (k + s) % 5 != 0;
    stylus.contact = static_cast<ContactState>((k + s) % 3);
    stylus.object = stylus.contact == ContactState::kFree ? -1 : 0;
    stylus.buttons = static_cast<std::uint32_t>(k + 2 * s);
    stylus.tip = vector();
    stylus.proxy = vector();
    stylus.force = vector();
    ContactRecord& contact = object.contact[s];
    contact.state = stylus.contact;
    contact.slipping = k % 2 == 1;
    contact.offset = vector();
    const int node = static_cast<int>(10 * k + s);
    contact.point = {{node, node + 1, node + 2}, {0.5, 0.375, 0.125}};
  }
  return record;
}

}  // namespace irdm::test
