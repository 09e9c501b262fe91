#include "precompute/parallel/slepc_session.hpp"

#include <string>

#include "common/error.hpp"

namespace irdm::precompute {
namespace {

// The first of the messages of a failed call: where it began, not through which functions it went.
std::string& complaint() {
  static std::string text;
  return text;
}

PetscErrorCode note(MPI_Comm, int, const char* function, const char*, PetscErrorCode code,
                    PetscErrorType type, const char* message, void*) {
  if (type == PETSC_ERROR_INITIAL) complaint() = std::string(function) + ": " + message;
  return code;
}

}  // namespace

SlepcSession::SlepcSession() {
  int initialised = 0;
  MPI_Initialized(&initialised);
  if (initialised == 0) MPI_Init(nullptr, nullptr);  // Ranks ends it
  slepc(SlepcInitializeNoArguments());
  slepc(PetscPopSignalHandler());
  slepc(PetscPushErrorHandler(note, nullptr));
}

SlepcSession::~SlepcSession() {
  (void)PetscPopErrorHandler();
  (void)SlepcFinalize();
}

void slepc(PetscErrorCode code) {
  if (code == 0) return;
  std::string what = complaint();
  if (what.empty()) {
    const char* general = nullptr;
    PetscErrorMessage(code, &general, nullptr);
    what = general != nullptr ? general : "error " + std::to_string(code);
  }
  complaint().clear();
  throw Error("SLEPc", what,
              "check the mesh, PETSC_OPTIONS and memory, or use solver = \"spectra\" in [modes]");
}

}  // namespace irdm::precompute
