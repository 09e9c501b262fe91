// Writes valid messages, where fuzzing begins: write_fuzz_seeds FOLDER.
#include "tests/fuzz/seed_folder.hpp"

int main(int argc, char** argv) {
  using namespace irdm::fuzz;
  if (argc != 2) return 2;
  const Seeds seeds(argv[1]);
  write_viewer_seeds(seeds);
  write_wire_seeds(seeds);
  write_session_seeds(seeds);
  write_session_datagram_seeds(seeds);
  write_file_seeds(seeds);
  return 0;
}
