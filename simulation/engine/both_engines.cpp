#include "simulation/engine/both_engines.hpp"

namespace irdm {

BothEngines::BothEngines(std::unique_ptr<ResponseEngine> first,
                         std::unique_ptr<ResponseEngine> second)
    : engines_{std::move(first), std::move(second)} {}

bool BothEngines::supports_inertial_loading() const noexcept {
  return engines_[0]->supports_inertial_loading() && engines_[1]->supports_inertial_loading();
}

void BothEngines::set_angular_velocity(const Vector3& w) noexcept {
  for (const auto& engine : engines_) engine->set_angular_velocity(w);
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

void BothEngines::prefetch(std::span<const Vector3> tips) noexcept {
  for (const auto& engine : engines_) engine->prefetch(tips);
}

std::uint64_t BothEngines::missed_columns() const noexcept {
  return engines_[0]->missed_columns() + engines_[1]->missed_columns();
}

void BothEngines::add_delayed_force(std::span<const NodalForce> forces, int age) noexcept {
  for (const auto& engine : engines_) engine->add_delayed_force(forces, age);
}

void BothEngines::advance(std::span<const NodalForce> forces) noexcept {
  for (const auto& engine : engines_) engine->advance(forces);
}

void BothEngines::reset() noexcept {
  for (const auto& engine : engines_) engine->reset();
}

}  // namespace irdm
