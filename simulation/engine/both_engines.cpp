#include "simulation/engine/both_engines.hpp"

namespace irdm {

BothEngines::BothEngines(std::unique_ptr<ResponseEngine> first,
                         std::unique_ptr<ResponseEngine> second)
    : engines_{std::move(first), std::move(second)} {}

bool BothEngines::takes_spin() const noexcept {
  return engines_[0]->takes_spin() && engines_[1]->takes_spin();
}

void BothEngines::hold_spin(const Vector3& w) noexcept {
  for (const auto& engine : engines_) engine->hold_spin(w);
}

bool BothEngines::takes_gravity() const noexcept {
  return engines_[0]->takes_gravity() && engines_[1]->takes_gravity();
}

void BothEngines::set_gravity(const Vector3& gravity) noexcept {
  for (const auto& engine : engines_) engine->set_gravity(gravity);
}

void BothEngines::use(EngineKind kind) noexcept {
  answering_ = engines_[0]->kind() == kind ? 0 : 1;
}

void BothEngines::expect(std::span<const Vector3> tips) noexcept {
  for (const auto& engine : engines_) engine->expect(tips);
}

std::uint64_t BothEngines::missed_columns() const noexcept {
  return engines_[0]->missed_columns() + engines_[1]->missed_columns();
}

void BothEngines::add_past(std::span<const NodalForce> forces, int age) noexcept {
  for (const auto& engine : engines_) engine->add_past(forces, age);
}

void BothEngines::advance(std::span<const NodalForce> forces) noexcept {
  for (const auto& engine : engines_) engine->advance(forces);
}

void BothEngines::reset() noexcept {
  for (const auto& engine : engines_) engine->reset();
}

}  // namespace irdm
