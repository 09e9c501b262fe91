// The lowest modes of a cube on one rank or, under mpirun, on several: time and memory of each.
// bench_shared_modes CELLS [MODES] [spectra|slepc|slepc-multigrid]; PETSC_OPTIONS=-log_view tells
// more.
#include <sys/resource.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "precompute/blas.hpp"
#include "precompute/mesh/box_mesh.hpp"
#include "precompute/mesh/tetgen_program.hpp"
#include "precompute/modal/lowest_modes.hpp"
#include "precompute/modal/shared_modes.hpp"

using namespace irdm;
using namespace irdm::precompute;

namespace {

const Material kMaterial{2000.0, 0.4, 110.0, 8.0, 2e-4};

double seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

rusage used() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return usage;
}

// A rank that waits for another one counts as busy: MPI spins.
double processor_seconds() {
  const timeval time = used().ru_utime;
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

double most_memory() {
  return static_cast<double>(used().ru_maxrss) / 1e6;
}

ElasticModes by_spectra(const TetMesh& mesh, const Eigen::VectorXd& mass, int count) {
  const ElasticStatics statics(assemble_stiffness(mesh, kMaterial), mesh.nodes, mass, {});
  return lowest_modes(statics, count);
}

ElasticModes by_slepc(const TetMesh& mesh, const Eigen::VectorXd& mass, int count,
                      ModeSolver solver, const Ranks& ranks) {
  const auto shared = make_shared_modes(mesh, kMaterial, mass, {}, solver, ranks);
  if (ranks.rank() == 0) return shared->lowest(count);
  shared->help();
  return {};
}

}  // namespace

int main(int argc, char** argv) {
  use_fast_blas_kernel(argv);
  const int cells = argc > 1 ? std::atoi(argv[1]) : 12;
  const int count = argc > 2 ? std::atoi(argv[2]) : 40;
  const std::string word = argc > 3 ? argv[3] : "spectra";
  const Ranks ranks;
  const SingleThreadedBlas single;
  const TetMesh mesh = tetrahedralise(box_surface(Vector3::Constant(0.12), {cells, cells, cells}));
  const Eigen::VectorXd mass = lumped_mass(mesh, kMaterial);
  const double before = most_memory();
  const double start = seconds();
  const double worked = processor_seconds();
  const ElasticModes modes =
      word == "spectra"
          ? by_spectra(mesh, mass, count)
          : by_slepc(mesh, mass, count,
                     word == "slepc" ? ModeSolver::kSlepc : ModeSolver::kSlepcMultigrid, ranks);
  std::printf(
      "%s rank %d of %d: %d tetrahedra, %d nodes, %d modes, %.2f s, %.2f s of the processor, %.3f "
      "GB of memory (%.3f before)%s\n",
      word.c_str(), ranks.rank(), ranks.size(), mesh.tet_count(), mesh.node_count(), count,
      seconds() - start, processor_seconds() - worked, most_memory(), before,
      modes.angular_frequency.size() == 0
          ? ""
          : (", omega " + std::to_string(modes.angular_frequency(0)) + " to " +
             std::to_string(modes.angular_frequency(count - 1)))
                .c_str());
}
