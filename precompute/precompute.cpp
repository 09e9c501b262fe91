#include "precompute/precompute.hpp"

#include <omp.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>
#include <numbers>

#include "common/error.hpp"
#include "common/model/model_check.hpp"
#include "common/number_text.hpp"
#include "common/process/signal_cleanup.hpp"
#include "precompute/blas.hpp"
#include "precompute/columns/assemble.hpp"
#include "precompute/columns/compute_columns.hpp"
#include "precompute/columns/work_file.hpp"
#include "precompute/dynamics/stepping_method.hpp"
#include "precompute/fem/assembly.hpp"
#include "precompute/fem/mass_properties.hpp"
#include "precompute/mesh/make_mesh.hpp"
#include "precompute/mesh/mesh_check.hpp"
#include "precompute/mesh/region.hpp"
#include "precompute/mesh/surface.hpp"
#include "precompute/mesh/tet_mesh.hpp"
#include "precompute/modal/elastic_statics.hpp"
#include "precompute/modal/element_error.hpp"
#include "precompute/modal/lowest_modes.hpp"
#include "precompute/modal/modal_method.hpp"
#include "precompute/modal/reduced_modes.hpp"
#include "precompute/modal/shared_modes.hpp"

namespace irdm::precompute {
namespace {

constexpr double kMaxDecayLeft = 0.01;
constexpr double kMaxForceError = 0.05;

void warn(const std::string& text) {
  std::cerr << "irdm-precompute: warning: " << text << std::endl;
}

// Linear or quadratic, as the configuration says.
TetMesh mesh_of(const PrecomputeConfig& config) {
  MadeMesh made = make_mesh(config.mesh);
  if (made.unused_nodes > 0) {
    warn(std::get<std::filesystem::path>(config.mesh.source).string() + ": left out " +
         std::to_string(made.unused_nodes) + " nodes that belong to no tetrahedron");
  }
  return std::move(made.mesh);
}

// Modes and R rest on point masses at the nodes; what does not deform has the mass of the solid.
MassProperties body_of(const TetMesh& mesh, const Model& model, bool rigid) {
  return rigid ? solid_mass_properties(mesh, model.material)
               : nodal_mass_properties(mesh.nodes, model.mesh.node_mass);
}

// All of a rigid body's model, and of others all but the response; the nodes move into the body
// frame.
Model describe(const TetMesh& mesh, const std::string& name, const PrecomputeConfig& config) {
  Model model;
  Surface surface = extract_surface(mesh, name);
  model.material = config.material;
  model.material.elements =
      element_materials(mesh, config.material, config.regions, config.rigid, config.name);
  model.mesh.node_mass = lumped_mass(mesh, model.material);
  const MassProperties body = body_of(mesh, model, config.rigid);
  model.mesh.com_offset = body.centre_of_mass;
  model.mesh.nodes = mesh.nodes.rowwise() - body.centre_of_mass.transpose();
  model.mesh.tets = mesh.tets;
  model.mesh.surface_nodes = std::move(surface.nodes);
  model.mesh.triangles = std::move(surface.triangles);
  const bool clamped = config.support.has_value();
  model.body = {body.mass, body.inertia, clamped ? Support::kFixed : config.response.support};
  model.dt = config.response.dt;
  model.steps = config.response.steps;
  if (config.rigid) model.response = RigidResponse{};
  if (config.display) model.display = make_display_mesh(*config.display, model.mesh);
  if (const auto fault = description_fault(model)) {
    throw Error(name, "makes a model whose " + *fault, "correct the mesh, its unit or the density");
  }
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

// A part of the modes is of use with what the others add, which only the modal form has.
void check_modes(const PrecomputeConfig& config) {
  if (config.modes.all()) return;
  if (config.response.method != Method::kModal) {
    throw Error(config.name, "[modes] belongs to method = \"modal\"",
                "leave the table out, or change response.method");
  }
  if (config.response.storage != Storage::kModal) {
    throw Error(config.name, "dense R is made of all modes, and [modes] asks for some",
                "leave [modes] out, or set response.storage = \"modal\"");
  }
}

void check_rigid(const PrecomputeConfig& config, const std::optional<ColumnRange>& slice,
                 const Ranks& ranks) {
  const bool modal =
      config.response.method == Method::kModal && config.response.storage == Storage::kModal;
  if (!config.rigid || (modal && !slice && ranks.size() == 1)) return;
  throw Error(config.name, "is of a rigid body, of which no R is computed",
              "leave --method, --storage, --columns and mpirun out");
}

// Says early that the work cannot be done here, instead of dying of it later.
void check_resources(const PrecomputeConfig& config, const TetMesh& mesh, const Model& model,
                     int columns, const std::filesystem::path& output) {
  if (config.rigid) return;
  const double memory =
      static_cast<double>(::sysconf(_SC_PHYS_PAGES)) * static_cast<double>(::sysconf(_SC_PAGESIZE));
  const Eigen::Index unknowns = 3 * static_cast<Eigen::Index>(mesh.node_count());
  if (config.response.method == Method::kModal && config.modes.all() &&
      (unknowns > kMaxEigenSize || symmetric_eigen_bytes(unknowns) > memory)) {
    throw Error(config.name,
                std::to_string(mesh.node_count()) +
                    " nodes are too many for all modes on this "
                    "machine",
                "ask for some of them, as with error = 0.01 in [modes], or use a coarser mesh (at "
                "most " +
                    std::to_string(kMaxEigenSize / 3) +
                    " nodes); of a surface, with a larger mesh.edge_length");
  }
  if (config.response.storage == Storage::kModal) return;
  const double size =
      static_cast<double>(columns) * model.degrees_of_freedom() * model.steps *
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

ColumnFileHeader column_header(const PrecomputeConfig& config, const Model& model,
                               const std::vector<int>& clamped, const ColumnRange& range,
                               const ColumnSource& source) {
  return {range,
          model.degrees_of_freedom(),
          model.steps,
          config.response.precision,
          source.has_centrifugal(),
          source.has_gravity(),
          settings_text(config, clamped),
          description_of(model)};
}

bool shares_modes(const PrecomputeConfig& config) {
  return !config.modes.all() && config.modes.solver != ModeSolver::kSpectra;
}

// All modes, or some; nothing on another rank than the first, which only helps.
ModalResponse chosen_modes(const PrecomputeConfig& config, const TetMesh& mesh,
                           const std::vector<int>& clamped, const Model& model, int threads,
                           const Ranks& ranks, const Console& console) {
  if (config.modes.all()) return compute_modes(mesh, clamped, model, console);
  if (!shares_modes(config)) {
    return compute_reduced_modes(mesh, clamped, model, config.modes, threads, console);
  }
  const SingleThreadedBlas single;
  const auto shared = make_shared_modes(mesh, model.material, model.mesh.node_mass, clamped,
                                        config.modes.solver, ranks);
  if (ranks.rank() > 0) {
    shared->help();
    return {};
  }
  SharedSolvers solvers;
  solvers.modes = [&shared](int count) { return shared->lowest(count); };
  // Alone, a process is quicker with its threads.
  if (ranks.size() > 1) solvers.statics = shared->solver();
  return compute_reduced_modes(mesh, clamped, model, config.modes, threads, console,
                               std::move(solvers));
}

// As chosen_modes(). Where modes are lost and an element is flat, that is the cause.
ModalResponse modes_of(const PrecomputeConfig& config, const TetMesh& mesh,
                       const std::vector<int>& clamped, const Model& model, int threads,
                       const Ranks& ranks, const Console& console) {
  try {
    return chosen_modes(config, mesh, clamped, model, threads, ranks, console);
  } catch (const LostModes&) {
    const auto flattest = flattest_element(mesh);
    if (!flattest) throw;
    throw Error("mesh",
                "the lowest modes are lost in rounding beside the stiffness of " + *flattest,
                "remove that tetrahedron, or optimise the mesh (gmsh -optimize)");
  }
}

// The columns that are asked for, of all of them.
ColumnRange wanted_columns(const PrecomputeConfig& config, const Model& model,
                           const std::optional<ColumnRange>& slice, const Ranks& ranks) {
  const ColumnRange all{0, model.degrees_of_freedom()};
  if (!slice && (ranks.size() == 1 || shares_modes(config))) return all;
  if (config.response.storage != Storage::kDense) {
    throw Error(
        config.name, "only dense R has columns that can be shared out",
        "set response.storage = \"dense\" (or --storage dense); ranks share [modes] with solver "
        "= \"slepc\"");
  }
  if (!slice) return all;
  if (ranks.size() > 1) {
    throw Error(config.name, "--columns and mpirun do not go together", "use one of them");
  }
  if (slice->end > all.end) {
    throw Error(
        config.name,
        "columns " + to_text(*slice) + " are asked for and R has " + std::to_string(all.end),
        "ask for some of " + to_text(all));
  }
  return *slice;
}

// A whole model file, with the response that `write_response` adds.
template <typename WriteResponse>
void write_model(const Model& model, const std::filesystem::path& output,
                 const WriteResponse& write_response) {
  ModelFileWriter writer(output);
  const SignalCleanup cleanup({.remove = writer.temporary_path()});
  writer.write_description(model);
  write_response(writer);
  writer.commit();
}

Summary describe_work(const TetMesh& mesh, const Model& model, std::size_t clamped) {
  Summary summary;
  summary.free_nodes = model.mesh.surface_node_count();
  summary.triangles = static_cast<int>(model.mesh.triangles.rows());
  summary.nodes = mesh.node_count();
  summary.clamped_nodes = static_cast<int>(clamped);
  summary.tetrahedra = mesh.tet_count();
  summary.order = mesh.order();
  summary.mesh = report_mesh(mesh);
  summary.regions = report_regions(mesh, model.material);
  summary.mass = model.body.mass;
  summary.inertia_excess =
      inertia_excess(model.body.inertia, solid_mass_properties(mesh, model.material).inertia);
  summary.blas_kernel = blas_kernel();
  return summary;
}

std::string display_text(const Model& model) {
  const double away = std::round(1e5 * largest_distance(model.display, model.mesh)) / 100.0;
  return "display mesh: " + std::to_string(model.display.positions.rows()) + " vertices, " +
         std::to_string(model.display.triangles.rows()) + " triangles, at most " +
         number_text(away) + " mm off the surface";
}

void warn_of_elements(const TetMesh& mesh, const Material& material, const Console& console) {
  if (const auto hint = locking_hint(mesh.order(), material)) warn(*hint);
  const ElementReport report = report_elements(mesh, material);
  console.line("elements: " + report.found);
  if (report.warning) warn(*report.warning);
}

// Before anything is computed.
void warn_of_input(const PrecomputeConfig& config, const TetMesh& mesh, const Model& model,
                   const Summary& summary, const Console& console) {
  if (const auto hint = unit_hint(summary.mesh.extent)) warn(*hint);
  if (config.rigid) return;
  warn_of_elements(mesh, model.material, console);
  int number = 0;
  for (const MaterialRegion& region : config.regions) {
    if (const auto hint = step_hint(mesh, region, ++number)) warn(*hint);
  }
  for (const RegionReport& region : summary.regions) {
    if (const auto hint = coarseness_hint(region)) warn(*hint);
  }
}

void warn_of_result(const Summary& summary) {
  if (summary.reduction && summary.reduction->force_error > kMaxForceError) {
    warn("with so few modes the force under a fingertip is off by more than 5 %; ask for more");
  }
  if (summary.decay_left.value_or(0.0) > kMaxDecayLeft) {
    warn("more than 1 % of R is left at the last step; raise response.steps or the damping");
  }
}

}  // namespace

Summary precompute_model(const PrecomputeConfig& given, const std::filesystem::path& output,
                         const Console& console, const std::optional<ColumnRange>& slice,
                         const Ranks& ranks) {
  const auto start = std::chrono::steady_clock::now();
  PrecomputeConfig config = given;
  const bool stepping = config.response.method == Method::kTimeStepping;
  check_modes(config);
  check_rigid(config, slice, ranks);
  const TetMesh mesh = mesh_of(config);
  const Model model = describe(mesh, config.name, config);
  if (stepping) {
    check_time_stepping(config.name, mesh, model, config.response.storage == Storage::kDense);
  }
  const std::vector<int> clamped = clamped_nodes(config, mesh, model);
  const ColumnRange columns = wanted_columns(config, model, slice, ranks);
  const int unknowns = 3 * (mesh.node_count() - static_cast<int>(clamped.size()));
  const bool fewer = takes_fewer_modes(config, unknowns);
  if (fewer) config.modes = fewer_modes();
  check_resources(config, mesh, model, columns.count(), output);
  console.line("mesh: " + std::to_string(mesh.node_count()) + " nodes, " +
               std::to_string(mesh.tet_count()) + " tetrahedra, " +
               std::to_string(model.mesh.surface_node_count()) + " surface nodes");
  if (!model.display.empty()) console.line(display_text(model));

  Summary summary = describe_work(mesh, model, clamped.size());
  if (fewer) console.line(fewer_modes_text(unknowns));
  if (ranks.rank() == 0) warn_of_input(config, mesh, model, summary, console);
  const int threads = config.threads > 0 ? config.threads : omp_get_num_procs();
  const auto by_columns = [&](const ColumnSource& source) {
    const ColumnsDone done =
        write_by_columns(source,
                         {output, column_header(config, model, clamped, columns, source),
                          slice.has_value(), threads},
                         ranks, console);
    summary.columns = done.computed;
    summary.slice = slice.has_value();
    if (stepping) summary.decay_left = done.decay_left;
  };
  if (config.rigid) {
    write_model(model, output, [](ModelFileWriter&) {});
    summary.columns = columns.count();
  } else if (stepping) {
    by_columns(*stepped_columns(config, mesh, model, threads, console));
  } else {
    ModalResponse response = modes_of(config, mesh, clamped, model, threads, ranks, console);
    if (shares_modes(config) && ranks.rank() > 0) return summary;
    summary.modes = response.mode_count();
    if (!response.residual.empty()) summary.reduction = response.residual.reduction;
    summary.lowest_frequency = response.angular_frequency(0) / (2.0 * std::numbers::pi);
    summary.decay_left = decay_left(response, model.dt, model.steps);
    if (slice || (ranks.size() > 1 && !shares_modes(config))) {
      by_columns(*modal_columns(response, model, config.response.precision));
    } else {
      write_model(model, output, [&](ModelFileWriter& writer) {
        write_modal_response(writer, std::move(response), model, config.response, threads, console);
      });
      summary.columns = columns.count();
    }
  }
  if (ranks.rank() > 0) return summary;
  summary.file_bytes = std::filesystem::file_size(output);
  summary.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  warn_of_result(summary);
  return summary;
}

}  // namespace irdm::precompute
