#include "simulation/engine/streamed_engine.hpp"

#include <algorithm>
#include <limits>

#include "common/error.hpp"
#include "simulation/engine/force_history.hpp"
#include "simulation/engine/kernels.hpp"
#include "simulation/engine/patch_response.hpp"

namespace irdm {

template <typename Scalar>
StreamedEngine<Scalar>::StreamedEngine(std::shared_ptr<const Model> model)
    : model_(std::move(model)),
      response_(std::get<StreamedResponse>(model_->response)),
      first_(std::get<std::vector<Scalar>>(response_.first).data()),
      columns_(response_, model_->mesh.surface_node_count(), model_->dt),
      past_(columns_, model_->mesh.surface_node_count()),
      spin_(response_.centrifugal, model_->degrees_of_freedom(), model_->steps),
      gravity_(response_.gravity, model_->degrees_of_freedom(), model_->steps),
      coming_(static_cast<std::size_t>(model_->degrees_of_freedom())) {}

// Once a step, for whichever nodes are asked for in the coming one.
template <typename Scalar>
void StreamedEngine<Scalar>::settle() noexcept {
  for (const int node : columns_.pinned()) {
    if (columns_.whole(node)) continue;
    for (int axis = 0; axis < 3; ++axis) {
      coming_[static_cast<std::size_t>(3 * node + axis)] = settled(node, axis, 1);
    }
  }
}

template <typename Scalar>
double StreamedEngine<Scalar>::first(int a, int b) const noexcept {
  return static_cast<double>(
      first_[static_cast<std::size_t>(b) * columns_.frame().dof + static_cast<std::size_t>(a)]);
}

template <typename Scalar>
double StreamedEngine<Scalar>::rest(int a, int b) const noexcept {
  return static_cast<double>(response_.rest[static_cast<std::size_t>(b) * columns_.frame().dof +
                                            static_cast<std::size_t>(a)]);
}

template <typename Scalar>
double StreamedEngine<Scalar>::entry(std::size_t step, int a, int b) const noexcept {
  if (step == 0) return first(a, b);
  const double share = columns_.share(b / 3);
  double sum = 0.0;
  if (share > 0.0) sum += share * static_cast<double>(columns_.row(a, b)[step]);
  if (share < 1.0) sum += (1.0 - share) * response_.settling[step] * rest(a, b);
  return sum;
}

template <typename Scalar>
typename StreamedEngine<Scalar>::Settled StreamedEngine<Scalar>::settled(int source, int axis,
                                                                         int shift) const noexcept {
  const double weight = 1.0 - columns_.share(source);
  const ForceHistory::Series series = past_.history().series(source, axis);
  Settled settled{static_cast<std::size_t>(3 * source + axis), 0.0, 0.0};
  const int start = series.first_age + shift;
  const int count = std::min(series.count, static_cast<int>(columns_.frame().steps) - start);
  if (count <= 0) return settled;
  settled.past = weight * dot(response_.settling.data() + start, series.force,
                              static_cast<std::size_t>(count));
  if (start == 0) settled.newest = weight * series.force[0];
  return settled;
}

// What forces do on nodes whose columns are not, or not wholly, there.
template <typename Scalar>
void StreamedEngine<Scalar>::add_lacking(int node, int shift, Vector3& u) const noexcept {
  for (const int source : columns_.pinned()) {
    if (columns_.whole(source)) continue;
    const double share = columns_.share(source);
    for (int b = 3 * source; b < 3 * source + 3; ++b) {
      if (share > 0.0) {
        add_convolution(columns_, past_.history(), b, share, node, shift, u);
      }
      const Settled part =
          shift == 1 ? coming_[static_cast<std::size_t>(b)] : settled(source, b % 3, shift);
      for (int row = 0; row < 3; ++row) {
        u[row] += first(3 * node + row, b) * part.newest + rest(3 * node + row, b) * part.past;
      }
    }
  }
}

template <typename Scalar>
Vector3 StreamedEngine<Scalar>::free_displacement(int node) const noexcept {
  Vector3 u = Vector3::Zero();
  past_.add_coming(node, u);
  add_lacking(node, 1, u);
  spin_.add_coming(node, u);
  gravity_.add_coming(node, u);
  return u;
}

// Known only of a body at rest, or that sags.
template <typename Scalar>
double StreamedEngine<Scalar>::free_displacement_bound() const noexcept {
  const bool at_rest = past_.history().active().empty() && spin_.at_rest() && gravity_.steady();
  return at_rest ? gravity_.sag_bound() : std::numeric_limits<double>::infinity();
}

template <typename Scalar>
void StreamedEngine<Scalar>::predict(std::span<const ContactPatch> patches, std::span<Vector3> h,
                                     ContactMatrix& compliance) noexcept {
  predict_patches(
      patches, [&](int node) { return free_displacement(node); },
      [&](int i, int j) { return first(i, j); }, h, compliance);
}

template <typename Scalar>
void StreamedEngine<Scalar>::predict_horizon(const ContactPatch& patch,
                                             std::span<const NodalForce> held,
                                             std::span<Vector3> path,
                                             std::span<Matrix3> response) noexcept {
  const auto steps = static_cast<int>(path.size());
  for (int i = 0; i < patch.count; ++i) {
    const int node = patch.nodes[static_cast<std::size_t>(i)];
    columns_.borrow(node);
    past_.predict_horizon(node, steps);
    spin_.predict_horizon(node, steps);
    gravity_.predict_horizon(node, steps);
  }
  for (const NodalForce& force : held) columns_.borrow(force.node);
  const auto answer = [&](std::size_t step, const auto& from) {
    return patch_response(patch, from, [&](int a, int b) { return entry(step, a, b); });
  };
  const auto place = [&](int node, int shift) {
    Vector3 u = Vector3::Zero();
    past_.add_ahead(node, shift, u);
    add_lacking(node, shift, u);
    spin_.add_ahead(node, shift, u);
    gravity_.add_ahead(node, shift, u);
    return u;
  };
  Vector3 by_held = Vector3::Zero();
  for (std::size_t n = 0; n < path.size(); ++n) {
    if (n < columns_.frame().steps) {
      for (const NodalForce& force : held) by_held += answer(n, force);
    }
    path[n] = by_held + mean(patch, [&](int node) { return place(node, static_cast<int>(n) + 1); });
  }
  for (std::size_t n = 0; n < response.size(); ++n) {
    response[n] = n < columns_.frame().steps ? answer(n, patch) : Matrix3::Zero();
  }
  columns_.return_borrowed();
}

template <typename Scalar>
void StreamedEngine<Scalar>::cross_response(const ContactPatch& to, const ContactPatch& from,
                                            std::span<Matrix3> response) noexcept {
  for (int i = 0; i < to.count; ++i) columns_.borrow(to.nodes[static_cast<std::size_t>(i)]);
  for (int i = 0; i < from.count; ++i) columns_.borrow(from.nodes[static_cast<std::size_t>(i)]);
  for (std::size_t n = 0; n < response.size(); ++n) {
    response[n] = n < columns_.frame().steps
                      ? patch_response(to, from, [&](int a, int b) { return entry(n, a, b); })
                      : Matrix3::Zero();
  }
  columns_.return_borrowed();
}

template <typename Scalar>
void StreamedEngine<Scalar>::add_delayed_force(std::span<const NodalForce> forces,
                                               int age) noexcept {
  if (age >= kMaxHorizon) return;
  past_.add_delayed_force(forces, age);
  settle();
}

template <typename Scalar>
void StreamedEngine<Scalar>::cache_nodes(std::span<const int> nodes) noexcept {
  for (const int node : nodes) {
    past_.cache_node(node);
    spin_.cache_node(node);
    gravity_.cache_node(node);
  }
}

template <typename Scalar>
void StreamedEngine<Scalar>::advance(std::span<const NodalForce> forces) noexcept {
  if (columns_.blend()) past_.clear_cache();
  past_.push(forces);
  settle();
  spin_.advance();
  gravity_.advance();
}

// As ResidentColumns::add_all(), and then what is missing.
template <typename Scalar>
void StreamedEngine<Scalar>::add_columns(Points& u) const {
  const std::vector<NonzeroInterval> intervals = nonzero_intervals(past_.history());
  std::vector<Settled> missing;
  for (const int node : past_.history().active()) {
    if (columns_.whole(node)) continue;
    for (int axis = 0; axis < 3; ++axis) missing.push_back(settled(node, axis, 0));
  }
  const ResidentColumns<Scalar>& frame = columns_.frame();
  const std::size_t rows_at_once = row_block(frame.dof);
  const auto blocks = static_cast<int>((frame.dof + rows_at_once - 1) / rows_at_once);
#pragma omp parallel for schedule(dynamic)
  for (int block = 0; block < blocks; ++block) {
    const std::size_t begin = static_cast<std::size_t>(block) * rows_at_once;
    const std::size_t count = std::min(rows_at_once, frame.dof - begin);
    for (const NonzeroInterval& push : intervals) {
      const double share = columns_.share(static_cast<int>(push.column / 3));
      if (share == 0.0) continue;
      const Scalar* rows = columns_.row(static_cast<int>(begin), static_cast<int>(push.column));
      add_products({rows + push.first_age, frame.steps, count}, push.force, push.count, share,
                   u.data() + begin);
    }
    for (const Settled& part : missing) {
      const int b = static_cast<int>(part.column);
      for (std::size_t i = begin; i < begin + count; ++i) {
        const int a = static_cast<int>(i);
        u.data()[i] += first(a, b) * part.newest + rest(a, b) * part.past;
      }
    }
  }
}

template <typename Scalar>
void StreamedEngine<Scalar>::displacement(Points& u, double /*tolerance*/) const {
  u.setZero(model_->mesh.surface_node_count(), 3);
  add_columns(u);
  spin_.add_all(u);
  gravity_.add_all(u);
}

template <typename Scalar>
void StreamedEngine<Scalar>::reset() noexcept {
  columns_.clear();
  past_.clear();
  spin_.reset();
  gravity_.reset();
}

template <typename Scalar>
void StreamedEngine<Scalar>::archive(StateArchive& /*state*/) {
  throw Error("state", "of an object whose response is read from its file as it is needed",
              "leave out memory_budget");
}

template class StreamedEngine<float>;
template class StreamedEngine<double>;

}  // namespace irdm
