#include "simulation/engine/residual_part.hpp"
#include "simulation/state/state_archive.hpp"

namespace irdm {
ResidualPart::ResidualPart(const ResidualCompliance& compliance, int surface_nodes)
    : compliance_(compliance) {
  if (compliance.empty()) return;
  field_.assign(index(surface_nodes), Matrix3::Zero());
  force_.assign(index(surface_nodes), Vector3::Zero());
  is_loaded_.assign(index(surface_nodes), 0);
  loaded_.reserve(index(surface_nodes));
}

void ResidualPart::spread(const ContactPatch& patch) noexcept {
  for (std::size_t i = 0; i < index(patch.count); ++i) {
    for (int k = compliance_.begin_of(patch.nodes[i]); k < compliance_.end_of(patch.nodes[i]);
         ++k) {
      field_[index(neighbour(k))] += patch.weights[i] * compliance_.block(k).cast<double>();
    }
  }
}

void ResidualPart::clear(const ContactPatch& patch) noexcept {
  for (std::size_t i = 0; i < index(patch.count); ++i) {
    for (int k = compliance_.begin_of(patch.nodes[i]); k < compliance_.end_of(patch.nodes[i]);
         ++k) {
      field_[index(neighbour(k))].setZero();
    }
  }
}

// G is symmetric: the field of contact b at the nodes of a, transposed, is block (b, a).
void ResidualPart::add_compliance(std::span<const ContactPatch> patches,
                                  ContactMatrix& compliance) noexcept {
  if (compliance_.empty()) return;
  for (std::size_t b = 0; b < patches.size(); ++b) {
    spread(patches[b]);
    for (std::size_t a = 0; a <= b; ++a) {
      Matrix3 sum = Matrix3::Zero();
      for (std::size_t i = 0; i < index(patches[a].count); ++i) {
        sum += patches[a].weights[i] * field_[index(patches[a].nodes[i])];
      }
      const auto row = static_cast<Eigen::Index>(3 * b);
      const auto column = static_cast<Eigen::Index>(3 * a);
      if (a == b) sum = 0.5 * (sum + sum.transpose()).eval();
      compliance.block<3, 3>(row, column) += sum;
      if (a != b) compliance.block<3, 3>(column, row) += sum.transpose();
    }
    clear(patches[b]);
  }
}

Matrix3 ResidualPart::compliance(const ContactPatch& patch) noexcept {
  const Matrix3 sum = compliance(patch, patch);
  return 0.5 * (sum + sum.transpose());
}

Matrix3 ResidualPart::compliance(const ContactPatch& to, const ContactPatch& from) noexcept {
  Matrix3 sum = Matrix3::Zero();
  if (compliance_.empty()) return sum;
  spread(to);
  for (std::size_t i = 0; i < index(from.count); ++i) {
    sum += from.weights[i] * field_[index(from.nodes[i])];
  }
  clear(to);
  return sum;
}

Vector3 ResidualPart::displacement(const ContactPatch& patch,
                                   std::span<const NodalForce> forces) noexcept {
  Vector3 sum = Vector3::Zero();
  if (compliance_.empty() || forces.empty()) return sum;
  spread(patch);
  for (const NodalForce& nodal : forces) {
    sum += field_[index(nodal.node)] * nodal.force;
  }
  clear(patch);
  return sum;
}

void ResidualPart::release() noexcept {
  for (const int node : loaded_) {
    force_[index(node)].setZero();
    is_loaded_[index(node)] = 0;
  }
  loaded_.clear();
}

void ResidualPart::hold_more(std::span<const NodalForce> forces) noexcept {
  if (compliance_.empty()) return;
  for (const NodalForce& nodal : forces) {
    if (is_loaded_[index(nodal.node)] == 0) loaded_.push_back(nodal.node);
    is_loaded_[index(nodal.node)] = 1;
    force_[index(nodal.node)] += nodal.force;
  }
}

void ResidualPart::hold(std::span<const NodalForce> forces) noexcept {
  release();
  hold_more(forces);
}

double ResidualPart::energy() const noexcept {
  double sum = 0.0;
  for (const int node : loaded_) {
    for (int k = compliance_.begin_of(node); k < compliance_.end_of(node); ++k) {
      const Vector3& there = force_[index(neighbour(k))];
      sum += 0.5 * force_[index(node)].dot(compliance_.block(k).cast<double>() * there);
    }
  }
  return sum;
}

void ResidualPart::archive(StateArchive& state) {
  if (state.reading()) release();
  state.list(loaded_);
  for (const int node : loaded_) {
    state.value(force_[index(node)]);
    is_loaded_[index(node)] = 1;
  }
}

void ResidualPart::add_displacement(Points& u) const noexcept {
  for (const int node : loaded_) {
    for (int k = compliance_.begin_of(node); k < compliance_.end_of(node); ++k) {
      u.row(neighbour(k)) +=
          (compliance_.block(k).cast<double>().transpose() * force_[index(node)]).transpose();
    }
  }
}

}  // namespace irdm
