#include "precompute/precompute.hpp"

#include <unistd.h>

#include <chrono>
#include <cmath>
#include <iostream>
#include <numbers>

#include "common/error.hpp"
#include "precompute/blas_kernel.hpp"
#include "precompute/dynamics/write_stepped.hpp"
#include "precompute/fem/assembly.hpp"
#include "precompute/fem/mass_properties.hpp"
#include "precompute/mesh/box_mesh.hpp"
#include "precompute/mesh/mesh_check.hpp"
#include "precompute/mesh/mesh_file.hpp"
#include "precompute/mesh/mesh_report.hpp"
#include "precompute/mesh/quadratic_mesh.hpp"
#include "precompute/mesh/region.hpp"
#include "precompute/mesh/surface.hpp"
#include "precompute/mesh/tetgen_program.hpp"
#include "precompute/modal/dense_columns.hpp"
#include "precompute/modal/elastic_modes.hpp"
#include "precompute/modal/held_responses.hpp"
#include "precompute/modal/symmetric_eigen.hpp"
#include "precompute/process/remove_on_signal.hpp"

namespace irdm::precompute {
namespace {

// Above this, linear tetrahedra are far too stiff: they lock (docs/convergence.md).
constexpr double kLockingPoissonRatio = 0.45;
constexpr double kMaxDecayLeft = 0.01;

void warn(const std::string& text) {
  std::cerr << "irdm-precompute: warning: " << text << std::endl;
}

TetMesh make_linear_mesh(const MeshConfig& config) {
  if (const auto* box = std::get_if<BoxConfig>(&config.source)) {
    TetMesh mesh = tetrahedralise(box_surface(box->size, box->cells));
    check_mesh(mesh, "mesh of the box");
    return mesh;
  }
  const auto& path = std::get<std::filesystem::path>(config.source);
  std::optional<double> edge_length = config.edge_length;
  if (edge_length) *edge_length /= config.unit;
  TetMesh mesh = read_mesh_file(path, edge_length);
  mesh.nodes *= config.unit;
  const int unused = drop_unused_nodes(mesh);
  check_mesh(mesh, path.string());
  if (unused > 0) {
    warn(path.string() + ": left out " + std::to_string(unused) +
         " nodes that belong to no tetrahedron");
  }
  return mesh;
}

TetMesh make_mesh(const MeshConfig& config) {
  TetMesh mesh = make_linear_mesh(config);
  return config.order == 1 ? mesh : quadratic_mesh(mesh);
}

// Everything of the model but its response; the nodes move into the body frame.
Model describe(const TetMesh& mesh, const std::string& name, const PrecomputeConfig& config) {
  Model model;
  Surface surface = extract_surface(mesh, name);
  model.mesh.node_mass = lumped_mass(mesh, config.material.density);
  const MassProperties body = nodal_mass_properties(mesh.nodes, model.mesh.node_mass);
  model.mesh.com_offset = body.centre_of_mass;
  model.mesh.nodes = mesh.nodes.rowwise() - body.centre_of_mass.transpose();
  model.mesh.tets = mesh.tets;
  model.mesh.surface_nodes = std::move(surface.nodes);
  model.mesh.triangles = std::move(surface.triangles);
  model.body = {body.mass, body.inertia, config.support ? Support::kFixed : Support::kFloating};
  model.material = config.material;
  model.dt = config.response.dt;
  model.steps = config.response.steps;
  return model;
}

// Nodes that do not move; none of a floating body.
std::vector<int> clamped_nodes(const PrecomputeConfig& config, const TetMesh& mesh,
                               const Model& model) {
  if (!config.support) return {};
  std::vector<int> clamped = nodes_in(mesh, *config.support, config.name);
  check_clamped(mesh, clamped, model.mesh.surface_nodes, config.name);
  return clamped;
}

double inertia_excess(const Matrix3& nodal, const Matrix3& solid) {
  return (nodal.diagonal().cwiseQuotient(solid.diagonal()).array() - 1.0).maxCoeff();
}

// Says early that the work cannot be done here, instead of dying of it later.
void check_resources(const PrecomputeConfig& config, const TetMesh& mesh, const Model& model,
                     const std::filesystem::path& output) {
  const double memory =
      static_cast<double>(::sysconf(_SC_PHYS_PAGES)) * static_cast<double>(::sysconf(_SC_PAGESIZE));
  const Eigen::Index unknowns = 3 * static_cast<Eigen::Index>(mesh.node_count());
  if (config.response.method == Method::kModal &&
      (unknowns > kMaxEigenSize || symmetric_eigen_bytes(unknowns) > memory)) {
    throw Error(config.name,
                std::to_string(mesh.node_count()) +
                    " nodes are too many for all modes on this "
                    "machine",
                "use a coarser mesh (at most " + std::to_string(kMaxEigenSize / 3) +
                    " nodes); of a surface, with a larger mesh.edge_length");
  }
  if (config.response.storage == Storage::kModal) return;
  const double dof = model.degrees_of_freedom();
  const double size =
      dof * dof * model.steps *
      (config.response.precision == Precision::kSingle ? sizeof(float) : sizeof(double));
  std::error_code error;
  const auto space = std::filesystem::space(std::filesystem::absolute(output).parent_path(), error);
  if (!error && static_cast<double>(space.available) < size) {
    throw Error(output.string(),
                "dense R needs " + std::to_string(static_cast<long>(size / 1e6)) +
                    " MB and the disk has less left",
                "use storage = \"modal\" or another folder");
  }
}

ModalResponse compute_modes(const TetMesh& mesh, const std::vector<int>& clamped,
                            const Model& model, const Console& console) {
  const SparseMatrix stiffness = assemble_stiffness(mesh, lame_parameters(model.material));
  // Measured: 26 s for 4080 unknowns on two cores.
  const auto unknowns = 3 * (static_cast<std::size_t>(mesh.node_count()) - clamped.size());
  const double estimate = 26.0 * std::pow(static_cast<double>(unknowns) / 4080.0, 3);
  console.line("modes: " + std::to_string(unknowns) + " unknowns, all modes by LAPACK; about " +
               format_duration(estimate) + " on two cores");
  const ElasticModes modes = model.body.support == Support::kFixed
                                 ? fixed_modes(stiffness, model.mesh.node_mass, clamped)
                                 : elastic_modes(stiffness, model.mesh.nodes, model.mesh.node_mass);
  return modal_response(modes, model.mesh.surface_nodes, model.material);
}

template <typename Scalar>
void write_dense(ModelFileWriter& writer, const ModalResponse& response, const Model& model,
                 Precision precision, const Console& console) {
  const int dof = model.degrees_of_freedom();
  DenseColumns<Scalar> columns(response, model.dt, model.steps);
  writer.begin_dense(dof, model.steps, precision);
  Progress progress(console, "columns of R", dof);
  for (int b = 0; b < dof; ++b) {
    writer.write_dense_column(b, columns.column(b).data());
    progress.update(b + 1);
  }
}

void write_responses(ModelFileWriter& writer, ModalResponse response, const Model& model,
                     const ResponseConfig& config, const Console& console) {
  const bool single = config.precision == Precision::kSingle;
  if (config.storage != Storage::kModal) {
    if (single) {
      write_dense<float>(writer, response, model, config.precision, console);
    } else {
      write_dense<double>(writer, response, model, config.precision, console);
    }
  }
  if (config.storage == Storage::kDense) return;
  if (single) {
    const RowMatrix<float> shapes = std::get<RowMatrix<double>>(response.shapes).cast<float>();
    response.shapes = shapes;
  }
  writer.write_modal(response);
}

void warn_about(const PrecomputeConfig& config, const Summary& summary) {
  if (config.mesh.order == 1 && config.material.poisson_ratio > kLockingPoissonRatio) {
    warn(
        "poisson_ratio above 0.45: linear tetrahedra lock, the body comes out too stiff; use "
        "mesh.order = 2 with half the cells an edge");
  }
  if (const auto hint = unit_hint(summary.mesh.extent)) warn(*hint);
  if (summary.decay_left > kMaxDecayLeft) {
    warn("more than 1 % of R is left at the last step; raise response.steps or the damping");
  }
}

}  // namespace

Summary precompute_model(const PrecomputeConfig& config, const std::filesystem::path& output,
                         const Console& console) {
  const auto start = std::chrono::steady_clock::now();
  const TetMesh mesh = make_mesh(config.mesh);
  const Model model = describe(mesh, config.name, config);
  if (config.response.method == Method::kTimeStepping) {
    check_time_stepping(config.name, mesh, model, config.response.storage == Storage::kDense);
  }
  const std::vector<int> clamped = clamped_nodes(config, mesh, model);
  check_resources(config, mesh, model, output);
  console.line("mesh: " + std::to_string(mesh.node_count()) + " nodes, " +
               std::to_string(mesh.tet_count()) + " tetrahedra, " +
               std::to_string(model.mesh.surface_node_count()) + " surface nodes");

  ModelFileWriter writer(output);
  const RemoveOnSignal cleanup(writer.temporary_path());
  writer.write_description(model);
  Summary summary;
  summary.free_nodes = model.mesh.surface_node_count();
  summary.triangles = static_cast<int>(model.mesh.triangles.rows());
  summary.nodes = mesh.node_count();
  summary.clamped_nodes = static_cast<int>(clamped.size());
  summary.tetrahedra = mesh.tet_count();
  summary.order = mesh.order();
  summary.mesh = report_mesh(mesh);
  summary.mass = model.body.mass;
  summary.inertia_excess = inertia_excess(
      model.body.inertia, solid_mass_properties(mesh, config.material.density).inertia);
  summary.blas_kernel = blas_kernel();
  if (config.response.method == Method::kTimeStepping) {
    summary.decay_left = write_stepped_columns(
        writer, mesh, model,
        {config.name, config.time_stepping, config.response.precision, config.threads}, console);
  } else {
    ModalResponse response = compute_modes(mesh, clamped, model, console);
    summary.modes = response.mode_count();
    summary.lowest_frequency = response.angular_frequency(0) / (2.0 * std::numbers::pi);
    summary.decay_left = decay_left(response, model.dt, model.steps);
    write_responses(writer, std::move(response), model, config.response, console);
  }
  writer.commit();
  summary.file_bytes = std::filesystem::file_size(output);
  summary.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  warn_about(config, summary);
  return summary;
}

}  // namespace irdm::precompute
