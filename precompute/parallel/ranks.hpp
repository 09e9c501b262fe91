#pragma once

namespace irdm::precompute {

/// The processes that mpirun started to work together; a single one where the program was built
/// without MPI (IRDM_WITH_MPI) or started by itself. Made once, before and outlived by all that
/// uses it.
class Ranks {
 public:
  Ranks();
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;
  ~Ranks();

  int rank() const { return rank_; }  ///< of this process, 0..size-1
  int size() const { return size_; }
  /// Waits until all have called it; whether all said yes.
  bool all(bool yes) const;
  /// Waits for rank 0 to call it; the number that rank 0 gave.
  int first_says(int number) const;

 private:
  int rank_ = 0;
  int size_ = 1;
};

}  // namespace irdm::precompute
