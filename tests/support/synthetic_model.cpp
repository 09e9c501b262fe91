#include "tests/support/synthetic_model.hpp"

#include <algorithm>
#include <complex>
#include <map>
#include <random>

#include "common/model/dense_file.hpp"
#include "common/response/compressed_response.hpp"
#include "common/response/modal_response.hpp"

namespace irdm::test {
namespace {

// Surface grid of a cube: nodes numbered as they are met, two triangles a square, outward.
void make_surface(int cells, double edge, ModelMesh& mesh) {
  std::map<std::array<int, 3>, int> numbers;
  std::vector<Vector3> nodes;
  std::vector<std::array<int, 3>> triangles;
  const auto node = [&](const std::array<int, 3>& at) {
    const auto [found, added] = numbers.try_emplace(at, static_cast<int>(nodes.size()));
    if (added)
      nodes.push_back(Vector3(at[0], at[1], at[2]) * edge / cells - Vector3::Constant(edge / 2));
    return found->second;
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const int side : {0, cells}) {
      for (int a = 0; a < cells; ++a) {
        for (int b = 0; b < cells; ++b) {
          const auto corner = [&](int u, int v) {
            std::array<int, 3> at{};
            at[axis] = side;
            at[(axis + 1) % 3] = u;
            at[(axis + 2) % 3] = v;
            return node(at);
          };
          std::array<int, 4> q{corner(a, b), corner(a + 1, b), corner(a + 1, b + 1),
                               corner(a, b + 1)};
          if (side == 0) std::swap(q[1], q[3]);
          triangles.push_back({q[0], q[1], q[2]});
          triangles.push_back({q[0], q[2], q[3]});
        }
      }
    }
  }
  mesh.nodes.resize(static_cast<Eigen::Index>(nodes.size()), 3);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    mesh.nodes.row(static_cast<Eigen::Index>(i)) = nodes[i].transpose();
    mesh.surface_nodes.push_back(static_cast<int>(i));
  }
  mesh.triangles.resize(static_cast<Eigen::Index>(triangles.size()), 3);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      mesh.triangles(static_cast<Eigen::Index>(t), static_cast<Eigen::Index>(i)) = triangles[t][i];
    }
  }
  mesh.tets.resize(1, 4);  // one that stands for all
  mesh.tets << numbers.at({0, 0, 0}), numbers.at({cells, 0, 0}), numbers.at({0, cells, 0}),
      numbers.at({0, 0, cells});
  mesh.node_mass = Eigen::VectorXd::Constant(mesh.nodes.rows(), 0.0);
}

}  // namespace

Model synthetic_cube(int cells, int modes, int steps, double edge, unsigned seed) {
  Model model;
  make_surface(cells, edge, model.mesh);
  constexpr double kDensity = 110.0;
  model.body.mass = kDensity * edge * edge * edge;
  model.body.inertia = Matrix3::Identity() * model.body.mass * edge * edge / 6.0;
  model.mesh.node_mass.setConstant(model.body.mass / static_cast<double>(model.mesh.nodes.rows()));
  model.material = {2000.0, 0.49, kDensity, 8.0, 2e-4};
  model.dt = 0.002;
  model.steps = steps;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  ModalResponse response;
  response.angular_frequency.resize(modes);
  response.decay_rate.resize(modes);
  RowMatrix<double> shapes(model.degrees_of_freedom(), modes);
  for (int i = 0; i < modes; ++i) {
    constexpr double kTwoPi = 6.283185307179586;
    const double frequency = 10.0 + 390.0 * i / std::max(1, modes - 1);
    response.angular_frequency(i) = kTwoPi * frequency;
    response.decay_rate(i) = 4.0 + 0.05 * frequency;
  }
  for (Eigen::Index i = 0; i < shapes.size(); ++i) {
    shapes.data()[i] = uniform(random) / std::sqrt(model.body.mass);
  }
  response.shapes = shapes;
  model.response = response;
  return model;
}

void add_centrifugal(Model& modal, unsigned seed) {
  auto& response = std::get<ModalResponse>(modal.response);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  response.centrifugal.resize(response.mode_count(), 6);
  for (Eigen::Index i = 0; i < response.centrifugal.size(); ++i) {
    response.centrifugal.data()[i] = 0.05 * std::sqrt(modal.body.mass) * uniform(random);
  }
}

void add_gravity(Model& modal, bool rest, unsigned seed) {
  auto& response = std::get<ModalResponse>(modal.response);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  response.gravity.resize(response.mode_count(), 3);
  for (double& value : response.gravity.reshaped()) {
    value = 0.2 * std::sqrt(modal.body.mass) * uniform(random);
  }
  if (!rest) return;
  response.gravity_rest.resize(modal.degrees_of_freedom(), 3);
  for (double& value : response.gravity_rest.reshaped()) value = 1e-5 * uniform(random);
}

void add_residual(Model& modal, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0.0, 0.01);
  std::map<std::pair<int, int>, Matrix3> blocks;  // on and above the diagonal
  const Triangles& triangles = modal.mesh.triangles;
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    Eigen::Matrix<double, 9, 9> root;
    for (double& value : root.reshaped()) value = normal(random);
    const Eigen::Matrix<double, 9, 9> square = root * root.transpose();
    for (int a = 0; a < 3; ++a) {
      for (int b = 0; b < 3; ++b) {
        if (triangles(t, a) > triangles(t, b)) continue;
        auto& block =
            blocks.try_emplace({triangles(t, a), triangles(t, b)}, Matrix3::Zero()).first->second;
        block += square.block<3, 3>(3 * a, 3 * b);
      }
    }
  }
  UpperBlocks upper;
  for (const auto& [place, block] : blocks) {
    upper.row_start.resize(static_cast<std::size_t>(place.first) + 2);
    upper.nodes.push_back(place.second);
    const UpperBlocks::Block single = block.cast<float>();
    upper.blocks.insert(upper.blocks.end(), single.data(), single.data() + 9);
    upper.row_start.back() = static_cast<std::int32_t>(upper.nodes.size());
  }
  std::get<ModalResponse>(modal.response).residual = both_halves(upper);
}

Model made_rigid(Model model) {
  const double density = model.material.density;
  model.material = Material{};
  model.material.density = density;
  model.steps = 1;
  model.response = RigidResponse{};
  return model;
}

CompressedResponse compressed_response(const Model& model) {
  CompressedResponse response;
  response.fir_steps = 2;
  const auto nodes = static_cast<std::size_t>(model.mesh.surface_node_count());
  response.fir = std::vector<std::int16_t>(fir_entries(nodes) * 2, 1000);
  response.fir_scale.assign(fir_entries(nodes), 1e-6F);
  response.shapes = RowMatrix<float>::Identity(model.degrees_of_freedom(), 2);
  response.pole_shape = {0, 1};
  using Number = std::complex<double>;
  response.pole = Eigen::Vector2cd(Number(0.5, 0.1), Number(0.9, 0.0));
  response.amplitude = Eigen::Vector2cd(Number(1e-3, 0.0), Number(0.0, 1e-4));
  return response;
}

// R[0] of column b, at the first step.
template <typename Scalar>
void add_to_first_step(const ResidualCompliance& residual, int steps, std::vector<Scalar>& values) {
  const auto dof = 3 * (residual.row_start.size() - 1);
  for (std::size_t b = 0; b < dof; ++b) {
    for (int k = residual.row_start[b / 3]; k < residual.row_start[b / 3 + 1]; ++k) {
      const auto place = static_cast<std::size_t>(k);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t a = 3 * static_cast<std::size_t>(residual.nodes[place]) + axis;
        values[(b * dof + a) * static_cast<std::size_t>(steps)] +=
            static_cast<Scalar>(residual.blocks[9 * place + 3 * (b % 3) + axis]);
      }
    }
  }
}

template <typename Scalar>
Model with_dense_response(const Model& modal) {
  const auto& response = std::get<ModalResponse>(modal.response);
  const auto& shapes = std::get<RowMatrix<double>>(response.shapes);
  const int dof = modal.degrees_of_freedom();
  std::vector<Scalar> values(static_cast<std::size_t>(dof) * static_cast<std::size_t>(dof) *
                             static_cast<std::size_t>(modal.steps));
  Eigen::MatrixXd h(response.mode_count(), modal.steps);
  for (int i = 0; i < response.mode_count(); ++i) {
    h.row(i) = held_force_response(held_force_oscillator(response.angular_frequency(i),
                                                         response.decay_rate(i), modal.dt),
                                   modal.steps)
                   .transpose();
  }
  // Entry (a, b, s) of Phi diag(load_b) h.
  const auto fill = [&](const RowMatrix<double>& loads, const Eigen::MatrixXd& answer,
                        std::vector<Scalar>& into) {
    for (Eigen::Index b = 0; b < loads.rows(); ++b) {
      const RowMatrix<double> column = shapes * loads.row(b).asDiagonal() * answer;  // (3n, T)
      std::transform(column.data(), column.data() + column.size(), into.begin() + b * column.size(),
                     [](double value) { return static_cast<Scalar>(value); });
    }
  };
  fill(shapes, h, values);
  if (!response.residual.empty()) add_to_first_step(response.residual, modal.steps, values);
  std::vector<Scalar> centrifugal(
      static_cast<std::size_t>(response.centrifugal.size() == 0 ? 0 : 6) *
      static_cast<std::size_t>(dof) * static_cast<std::size_t>(modal.steps));
  fill(response.centrifugal.transpose(), h, centrifugal);
  Model dense = modal;
  DenseResponse made{dof, modal.steps, std::move(values), std::move(centrifugal)};
  if (response.gravity.rows() > 0) {
    for (Eigen::Index s = 1; s < h.cols(); ++s) h.col(s) += h.col(s - 1);
    std::vector<Scalar> gravity(3 * static_cast<std::size_t>(dof) *
                                static_cast<std::size_t>(modal.steps));
    fill(response.gravity.transpose(), h, gravity);
    made.gravity = gravity_response(std::move(gravity), dof, modal.steps);
  }
  dense.response = std::move(made);
  return dense;
}

template Model with_dense_response<float>(const Model&);
template Model with_dense_response<double>(const Model&);

}  // namespace irdm::test
