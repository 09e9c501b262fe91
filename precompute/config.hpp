#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "common/config/toml_reader.hpp"
#include "common/model/model.hpp"
#include "common/model/model_file.hpp"
#include "precompute/display/make_display_mesh.hpp"
#include "precompute/dynamics/rigid_extraction.hpp"
#include "precompute/dynamics/soft_body.hpp"
#include "precompute/mesh/material_regions.hpp"
#include "precompute/mesh/mesh_config.hpp"
#include "precompute/mesh/region.hpp"

namespace irdm::precompute {

/// [time_stepping]: how method = "time-stepping" obtains R. The first `hold` response intervals are
/// divided into steps of first_step, every further `hold` intervals into half as many (rounded
/// up), until a step is as long as last_step. Steps always divide the interval.
struct TimeSteppingConfig {
  Elasticity model = Elasticity::kCorotational;  ///< "corotational" | "linear"
  double first_step = 0.0;  ///< [s], divides dt; default: dt over a whole number, 1e-4 at most
  double last_step = 0.0;   ///< [s], divides dt, first_step at least; default: dt
  int hold = 10;            ///< 1..1 000 000
  /// Force that a column is simulated with [N], above 0; the response is divided by it. 0 (key left
  /// out): see default_force(). Much smaller ones lose digits to rounding
  /// (0.5 % of R at 1e-13 N on a cube of 12 cm), larger ones leave the linear range.
  double force = 0.0;
  RotationWeights rotation_weights = RotationWeights::kMass;  ///< "mass" | "none"
};

/// @param table of the configuration file; all keys are optional
/// @param dt response interval [s]
TimeSteppingConfig read_time_stepping(TomlTable table, double dt);

/// Number of steps in each of the T response intervals.
std::vector<int> step_schedule(const TimeSteppingConfig& config, double dt, int intervals);

/// 1e-4 of Young's modulus (of the softest element) times the area that a node has, (volume /
/// nodes)^(2/3): strains of 1e-4 next to the node, so that R is the linear response to about that
/// share.
double default_force(const SoftBody& body, double youngs_modulus);

/// Who finds the lowest modes.
enum class ModeSolver {
  kSpectra,         ///< Spectra in one process, with a sparse Cholesky factorisation
  kSlepc,           ///< SLEPc on any number of ranks, with a factorisation by MUMPS
  kSlepcMultigrid,  ///< SLEPc on any number of ranks, with conjugate gradients and multigrid (GAMG)
};

/// [modes]: which of the elastic modes are computed. At most one of `count`, `highest_frequency`
/// and `error`; none: all of them, or fewer where all would take over a minute (see
/// default_modes()).
struct ModesConfig {
  std::optional<int> count;                 ///< the lowest so many, 1..20 000
  std::optional<double> highest_frequency;  ///< all up to this [Hz], > 0
  /// As few as keep the force under a fingertip within this share of that of all modes, 1e-4..0.5;
  /// 0: all of them.
  std::optional<double> error;
  /// Largest number of modes with which `error` is tried; the response keeps that many where they
  /// do not reach it. None: half of all modes, which are refused where they do not reach it.
  std::optional<int> most;
  /// Of that fingertip [m], > 0. What the missing modes would add is kept for nodes up to twice as
  /// far apart.
  double contact_radius = 0.015;
  ModeSolver solver = ModeSolver::kSpectra;

  /// Whether the configuration says which modes.
  bool given() const { return count || highest_frequency || error; }
  bool all() const { return !count && !highest_frequency && error.value_or(0.0) == 0.0; }
};

/// Throws Error with file and line.
ModesConfig read_modes(TomlTable table);

/// How R is obtained.
enum class Method { kModal, kTimeStepping };

/// Which form of R the model file gets.
enum class Storage { kModal, kDense, kBoth };

/// [response]
struct ResponseConfig {
  double dt = 0.002;                         ///< response interval [s], lab::kStepTime
  int steps = 500;                           ///< T, 1..1 000 000
  Method method = Method::kModal;            ///< "modal" | "time-stepping"
  Storage storage = Storage::kModal;         ///< "modal" | "dense" | "both"
  Precision precision = Precision::kSingle;  ///< of stored numbers of R: "single" | "double"
  Support support = Support::kFloating;      ///< "floating" | "fixed"
};

/// A configuration file of irdm-precompute.
struct PrecomputeConfig {
  std::string name;  ///< of the file, for messages
  MeshConfig mesh;
  /// [material]: youngs_modulus [Pa] > 0, poisson_ratio in (-1, 0.5) and density [kg/m^3] > 0 are
  /// required; rayleigh_alpha [1/s] >= 0 and rayleigh_beta [s] >= 0 are 8.0 and 2e-4 unless given.
  /// With `rigid = true` it has density alone.
  Material material;
  /// [[region]]: parts of the body of another material, of a rigid body by density alone; of those
  /// that overlap the later one counts. Each has one of `half_space`, `box`, `ball`, `group` and
  /// `elements = "values.csv"`, and but for `elements` one or more of [material]'s youngs_modulus,
  /// poisson_ratio and density.
  std::vector<MaterialRegion> regions;
  std::optional<DisplayConfig> display;  ///< none: viewers draw the surface that computes
  /// The body does not deform: there is no R, and no keys that say how to obtain it.
  bool rigid = false;
  ResponseConfig response;
  ModesConfig modes;  ///< used by method = "modal"
  /// Which nodes are clamped, with `response.support = "fixed"`; none: the body floats or is rigid.
  /// [support] has one of `half_space = { point = [..], normal = [..] }`, `box = { min = [..], max
  /// = [..] }`, `ball = { centre = [..], radius = .. }` and `group = "name"`, in m and the
  /// coordinates of the input mesh (times its unit).
  std::optional<Region> support;
  TimeSteppingConfig time_stepping;  ///< used by method = "time-stepping"
  int threads = 0;                   ///< of the command line; 0: all cores
};

/// The word of a configuration file or command line. Throws std::out_of_range for others.
Storage storage_from_word(const std::string& word);

/// The word of a configuration file or command line. Throws std::out_of_range for others.
Method method_from_word(const std::string& word);

/// Reads and checks a whole configuration. Throws Error with file and line.
PrecomputeConfig read_config(TomlTable root, const std::string& name);
PrecomputeConfig load_config(const std::filesystem::path& path);

}  // namespace irdm::precompute
