#include "server/engine/streamed_engine.hpp"

#include <algorithm>

#include "server/engine/force_stretches.hpp"
#include "server/engine/kernels.hpp"
#include "server/engine/patch_response.hpp"

namespace irdm {

template <typename Scalar>
StreamedEngine<Scalar>::StreamedEngine(std::shared_ptr<const Model> model)
    : model_(std::move(model)),
      response_(std::get<StreamedResponse>(model_->response)),
      supply_(*response_.columns),
      frame_{nullptr, response_.scales.empty() ? nullptr : response_.scales.data(),
             static_cast<std::size_t>(response_.degrees_of_freedom),
             static_cast<std::size_t>(response_.steps)},
      first_(std::get<std::vector<Scalar>>(response_.first).data()),
      history_(model_->mesh.surface_node_count(), model_->steps),
      spin_(response_.centrifugal, model_->degrees_of_freedom(), model_->steps),
      blend_step_(std::min(1.0, model_->dt / kBlendTime)),
      columns_(static_cast<std::size_t>(model_->mesh.surface_node_count())),
      coming_(3 * columns_.size()) {
  followed_.reserve(columns_.size());
  borrowed_.reserve(columns_.size());
}

template <typename Scalar>
StreamedEngine<Scalar>::~StreamedEngine() {
  reset();
}

template <typename Scalar>
bool StreamedEngine<Scalar>::take(Columns& columns, int node) noexcept {
  if (taken_ >= supply_.share()) return false;
  columns.values = static_cast<const Scalar*>(supply_.take(node));
  if (columns.values == nullptr) return false;
  ++taken_;
  return true;
}

template <typename Scalar>
void StreamedEngine<Scalar>::give_back(int node) noexcept {
  Columns& columns = columns_[static_cast<std::size_t>(node)];
  if (columns.values != nullptr) {
    supply_.give_back(node);
    --taken_;
  }
  columns = Columns{};
}

// Columns of nodes that the history has forgotten go, those of nodes that are new to it come.
template <typename Scalar>
void StreamedEngine<Scalar>::follow_history() noexcept {
  std::erase_if(followed_, [&](int node) {
    if (history_.holds(node)) return false;
    give_back(node);
    return true;
  });
  for (const int node : history_.active()) {
    Columns& columns = columns_[static_cast<std::size_t>(node)];
    if (columns.values != nullptr) continue;
    const bool is_new = !columns.followed;
    if (is_new) followed_.push_back(node);
    columns.followed = true;
    if (take(columns, node)) {
      columns.share = is_new ? 1.0 : blend_step_;
    } else if (is_new) {
      ++missed_;
    }
  }
}

// Once a step, for whichever nodes are asked for in the coming one.
template <typename Scalar>
void StreamedEngine<Scalar>::settle() noexcept {
  for (const int node : followed_) {
    const auto index = static_cast<std::size_t>(node);
    if (columns_[index].share >= 1.0) continue;
    for (int axis = 0; axis < 3; ++axis) {
      coming_[3 * index + static_cast<std::size_t>(axis)] = settled(node, axis, 1);
    }
  }
}

template <typename Scalar>
void StreamedEngine<Scalar>::borrow(int node) noexcept {
  Columns& columns = columns_[static_cast<std::size_t>(node)];
  if (columns.followed || columns.values != nullptr || !take(columns, node)) return;
  columns.share = 1.0;
  borrowed_.push_back(node);
}

template <typename Scalar>
void StreamedEngine<Scalar>::return_borrowed() noexcept {
  for (const int node : borrowed_) give_back(node);
  borrowed_.clear();
}

template <typename Scalar>
double StreamedEngine<Scalar>::first(int a, int b) const noexcept {
  const auto column = static_cast<std::size_t>(b);
  return frame_.scale(column) *
         to_double(first_[column * frame_.dof + static_cast<std::size_t>(a)]);
}

template <typename Scalar>
double StreamedEngine<Scalar>::rest(int a, int b) const noexcept {
  return static_cast<double>(
      response_.rest[static_cast<std::size_t>(b) * frame_.dof + static_cast<std::size_t>(a)]);
}

template <typename Scalar>
double StreamedEngine<Scalar>::entry(std::size_t step, int a, int b) const noexcept {
  if (step == 0) return first(a, b);
  const Columns& columns = columns_[static_cast<std::size_t>(b / 3)];
  double sum = 0.0;
  if (columns.share > 0.0) {
    const ResidentColumns<Scalar> here{columns.values, nullptr, frame_.dof, frame_.steps};
    sum += frame_.scale(static_cast<std::size_t>(b)) * columns.share *
           to_double(here.row(a, b % 3)[step]);
  }
  if (columns.share < 1.0) sum += (1.0 - columns.share) * response_.settling[step] * rest(a, b);
  return sum;
}

template <typename Scalar>
typename StreamedEngine<Scalar>::Settled StreamedEngine<Scalar>::settled(int source, int axis,
                                                                         int shift) const noexcept {
  const double weight = 1.0 - columns_[static_cast<std::size_t>(source)].share;
  const ForceHistory::Series series = history_.series(source, axis);
  Settled settled{static_cast<std::size_t>(3 * source + axis), 0.0, 0.0};
  const int start = series.first_age + shift;
  const int count = std::min(series.count, static_cast<int>(frame_.steps) - start);
  if (count <= 0) return settled;
  settled.past = weight * dot(response_.settling.data() + start, series.force,
                              static_cast<std::size_t>(count));
  if (start == 0) settled.newest = weight * series.force[0];
  return settled;
}

template <typename Scalar>
void StreamedEngine<Scalar>::convolve(int node, int shift, Vector3& u) const noexcept {
  for (const int source : history_.active()) {
    const Columns& columns = columns_[static_cast<std::size_t>(source)];
    for (int axis = 0; axis < 3 && columns.share > 0.0; ++axis) {
      const ForceHistory::Series series = history_.series(source, axis);
      const int start = series.first_age + shift;
      const int count = std::min(series.count, static_cast<int>(frame_.steps) - start);
      if (count <= 0) continue;
      const ResidentColumns<Scalar> here{columns.values, nullptr, frame_.dof, frame_.steps};
      add_products({here.row(3 * node, axis) + start, frame_.steps, 3}, series.force,
                   static_cast<std::size_t>(count),
                   frame_.scale(static_cast<std::size_t>(3 * source + axis)) * columns.share,
                   u.data());
    }
    for (int axis = 0; axis < 3 && columns.share < 1.0; ++axis) {
      const Settled part = shift == 1 ? coming_[static_cast<std::size_t>(3 * source + axis)]
                                      : settled(source, axis, shift);
      const int b = static_cast<int>(part.column);
      for (int row = 0; row < 3; ++row) {
        u[row] += first(3 * node + row, b) * part.newest + rest(3 * node + row, b) * part.past;
      }
    }
  }
}

template <typename Scalar>
Vector3 StreamedEngine<Scalar>::free_displacement(int node) const noexcept {
  Vector3 u = Vector3::Zero();
  convolve(node, 1, u);
  spin_.add_coming(node, u);
  return u;
}

template <typename Scalar>
void StreamedEngine<Scalar>::predict(std::span<const ContactPatch> patches, std::span<Vector3> h,
                                     ContactMatrix& compliance) noexcept {
  predict_patches(
      patches, [&](int node) { return free_displacement(node); },
      [&](int i, int j) { return first(i, j); }, h, compliance);
}

template <typename Scalar>
void StreamedEngine<Scalar>::foresee(const ContactPatch& patch, std::span<const NodalForce> held,
                                     std::span<Vector3> path,
                                     std::span<Matrix3> response) noexcept {
  for (int i = 0; i < patch.count; ++i) borrow(patch.nodes[static_cast<std::size_t>(i)]);
  for (const NodalForce& force : held) borrow(force.node);
  const auto answer = [&](std::size_t step, const auto& from) {
    return patch_response(patch, from, [&](int a, int b) { return entry(step, a, b); });
  };
  const auto place = [&](int node, int shift) {
    Vector3 u = Vector3::Zero();
    convolve(node, shift, u);
    spin_.add_foreseen(node, shift, u);
    return u;
  };
  Vector3 by_held = Vector3::Zero();
  for (std::size_t n = 0; n < path.size(); ++n) {
    if (n < frame_.steps) {
      for (const NodalForce& force : held) by_held += answer(n, force);
    }
    path[n] = by_held + mean(patch, [&](int node) { return place(node, static_cast<int>(n) + 1); });
  }
  for (std::size_t n = 0; n < response.size(); ++n) {
    response[n] = n < frame_.steps ? answer(n, patch) : Matrix3::Zero();
  }
  return_borrowed();
}

template <typename Scalar>
void StreamedEngine<Scalar>::add_past(std::span<const NodalForce> forces, int age) noexcept {
  if (age >= kMaxHorizon) return;
  history_.add_past(forces, age);
  follow_history();
  settle();
}

template <typename Scalar>
void StreamedEngine<Scalar>::advance(std::span<const NodalForce> forces) noexcept {
  for (const int node : followed_) {
    Columns& columns = columns_[static_cast<std::size_t>(node)];
    if (columns.values != nullptr) columns.share = std::min(1.0, columns.share + blend_step_);
  }
  history_.push(forces);
  follow_history();
  settle();
  spin_.advance();
}

// As ResidentColumns::add_all(), and then what is missing.
template <typename Scalar>
void StreamedEngine<Scalar>::add_columns(Points& u) const {
  const std::vector<ForceStretch> stretches = force_stretches(history_);
  std::vector<Settled> missing;
  for (const int node : history_.active()) {
    if (columns_[static_cast<std::size_t>(node)].share >= 1.0) continue;
    for (int axis = 0; axis < 3; ++axis) missing.push_back(settled(node, axis, 0));
  }
  const auto blocks = static_cast<int>((frame_.dof + kRowBlock - 1) / kRowBlock);
#pragma omp parallel for schedule(dynamic)
  for (int block = 0; block < blocks; ++block) {
    const std::size_t begin = static_cast<std::size_t>(block) * kRowBlock;
    const std::size_t count = std::min(kRowBlock, frame_.dof - begin);
    for (const ForceStretch& push : stretches) {
      const Columns& columns = columns_[push.column / 3];
      if (columns.share == 0.0) continue;
      const Scalar* rows =
          columns.values + (push.column % 3 * frame_.dof + begin) * frame_.steps + push.first_age;
      add_products({rows, frame_.steps, count}, push.force, push.count,
                   frame_.scale(push.column) * columns.share, u.data() + begin);
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
}

template <typename Scalar>
Eigen::MatrixXd StreamedEngine<Scalar>::instant_compliance() const {
  return whole_response(response_.degrees_of_freedom, [&](int a, int b) { return first(a, b); });
}

template <typename Scalar>
void StreamedEngine<Scalar>::reset() noexcept {
  for (const int node : followed_) give_back(node);
  followed_.clear();
  history_.clear();
  spin_.reset();
}

template class StreamedEngine<Half>;
template class StreamedEngine<float>;
template class StreamedEngine<double>;

}  // namespace irdm
