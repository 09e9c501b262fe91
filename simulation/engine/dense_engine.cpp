#include "simulation/engine/dense_engine.hpp"

#include <limits>

#include "simulation/engine/patch_response.hpp"
#include "simulation/state/state_archive.hpp"

namespace irdm {
namespace {

template <typename Scalar>
ResidentColumns<Scalar> columns_of(const DenseResponse& response) {
  return {std::get<std::vector<Scalar>>(response.values).data(),
          static_cast<std::size_t>(response.degrees_of_freedom),
          static_cast<std::size_t>(response.steps)};
}

}  // namespace

template <typename Scalar>
DenseEngine<Scalar>::DenseEngine(std::shared_ptr<const Model> model)
    : model_(std::move(model)),
      R_(columns_of<Scalar>(std::get<DenseResponse>(model_->response))),
      past_(R_, model_->mesh.surface_node_count()),
      spin_(std::get<DenseResponse>(model_->response).centrifugal, model_->degrees_of_freedom(),
            model_->steps),
      gravity_(std::get<DenseResponse>(model_->response).gravity, model_->degrees_of_freedom(),
               model_->steps) {}

template <typename Scalar>
Vector3 DenseEngine<Scalar>::free_displacement(int node) const noexcept {
  Vector3 u = Vector3::Zero();
  past_.add_coming(node, u);
  spin_.add_coming(node, u);
  gravity_.add_coming(node, u);
  return u;
}

// Known only of a body at rest, or that sags.
template <typename Scalar>
double DenseEngine<Scalar>::free_displacement_bound() const noexcept {
  const bool at_rest = past_.history().active().empty() && spin_.at_rest() && gravity_.steady();
  return at_rest ? gravity_.sag_bound() : std::numeric_limits<double>::infinity();
}

template <typename Scalar>
double DenseEngine<Scalar>::entry(std::size_t step, int a, int b) const noexcept {
  return static_cast<double>(R_.row(a, b)[step]);
}

template <typename Scalar>
template <typename From>
auto DenseEngine<Scalar>::after(std::size_t step, const ContactPatch& a,
                                const From& b) const noexcept {
  return patch_response(a, b, [&](int i, int j) { return entry(step, i, j); });
}

template <typename Scalar>
void DenseEngine<Scalar>::predict(std::span<const ContactPatch> patches, std::span<Vector3> h,
                                  ContactMatrix& compliance) noexcept {
  predict_patches(
      patches, [&](int node) { return free_displacement(node); },
      [&](int i, int j) { return entry(0, i, j); }, h, compliance);
}

template <typename Scalar>
void DenseEngine<Scalar>::predict_horizon(const ContactPatch& patch,
                                          std::span<const NodalForce> held, std::span<Vector3> path,
                                          std::span<Matrix3> response) noexcept {
  const auto steps = static_cast<int>(path.size());
  for (int i = 0; i < patch.count; ++i) {
    past_.predict_horizon(patch.nodes[static_cast<std::size_t>(i)], steps);
    spin_.predict_horizon(patch.nodes[static_cast<std::size_t>(i)], steps);
    gravity_.predict_horizon(patch.nodes[static_cast<std::size_t>(i)], steps);
  }
  const auto place = [&](int node, int n) {
    Vector3 u = Vector3::Zero();
    past_.add_ahead(node, n, u);
    spin_.add_ahead(node, n, u);
    gravity_.add_ahead(node, n, u);
    return u;
  };
  Vector3 by_held = Vector3::Zero();
  for (std::size_t n = 0; n < path.size(); ++n) {
    if (n < R_.steps) {
      for (const NodalForce& force : held) by_held += after(n, patch, force);
    }
    path[n] = by_held + mean(patch, [&](int node) { return place(node, static_cast<int>(n) + 1); });
  }
  for (std::size_t n = 0; n < response.size(); ++n) {
    response[n] = n < R_.steps ? after(n, patch, patch) : Matrix3::Zero();
  }
}

template <typename Scalar>
void DenseEngine<Scalar>::cross_response(const ContactPatch& to, const ContactPatch& from,
                                         std::span<Matrix3> response) noexcept {
  for (std::size_t n = 0; n < response.size(); ++n) {
    response[n] = n < R_.steps ? after(n, to, from) : Matrix3::Zero();
  }
}

template <typename Scalar>
void DenseEngine<Scalar>::cache_nodes(std::span<const int> nodes) noexcept {
  for (const int node : nodes) {
    past_.cache_node(node);
    spin_.cache_node(node);
    gravity_.cache_node(node);
  }
}

template <typename Scalar>
void DenseEngine<Scalar>::add_delayed_force(std::span<const NodalForce> forces, int age) noexcept {
  if (age < kMaxHorizon) past_.add_delayed_force(forces, age);
}

template <typename Scalar>
void DenseEngine<Scalar>::advance(std::span<const NodalForce> forces) noexcept {
  past_.push(forces);
  spin_.advance();
  gravity_.advance();
}

template <typename Scalar>
void DenseEngine<Scalar>::displacement(Points& u, double /*tolerance*/) const {
  u.setZero(model_->mesh.surface_node_count(), 3);
  R_.add_all(past_.history(), u);
  spin_.add_all(u);
  gravity_.add_all(u);
}

template <typename Scalar>
void DenseEngine<Scalar>::reset() noexcept {
  past_.clear();
  spin_.reset();
  gravity_.reset();
}

template <typename Scalar>
void DenseEngine<Scalar>::archive(StateArchive& state) {
  past_.archive(state);
  spin_.archive(state);
  gravity_.archive(state);
}

template class DenseEngine<float>;
template class DenseEngine<double>;

}  // namespace irdm
