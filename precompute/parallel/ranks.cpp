#include "precompute/parallel/ranks.hpp"

#ifdef IRDM_WITH_MPI
#include <mpi.h>

#include <cstdlib>
#endif

namespace irdm::precompute {

#ifdef IRDM_WITH_MPI

// Open MPI tells its processes by this; without mpirun there is nothing to set up.
Ranks::Ranks() {
  if (std::getenv("OMPI_COMM_WORLD_SIZE") == nullptr) return;
  MPI_Init(nullptr, nullptr);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &size_);
}

Ranks::~Ranks() {
  int initialised = 0;
  MPI_Initialized(&initialised);
  if (initialised != 0) MPI_Finalize();
}

bool Ranks::all(bool yes) const {
  if (size_ == 1) return yes;
  int mine = yes ? 1 : 0;
  int least = 0;
  MPI_Allreduce(&mine, &least, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
  return least == 1;
}

int Ranks::first_says(int number) const {
  if (size_ > 1) MPI_Bcast(&number, 1, MPI_INT, 0, MPI_COMM_WORLD);
  return number;
}

#else

Ranks::Ranks() = default;
Ranks::~Ranks() = default;
bool Ranks::all(bool yes) const {
  return yes;
}
int Ranks::first_says(int number) const {
  return number;
}

#endif

}  // namespace irdm::precompute
