#pragma once

#include <slepceps.h>

namespace irdm::precompute {

/// SLEPc and PETSc, started and ended, on all ranks together; outlived by Ranks. What goes wrong in
/// them is told by slepc() instead of printed, and signals stay the program's.
class SlepcSession {
 public:
  SlepcSession();  ///< Throws Error.
  SlepcSession(const SlepcSession&) = delete;
  SlepcSession& operator=(const SlepcSession&) = delete;
  ~SlepcSession();
};

/// Throws Error with PETSc's words when a call of PETSc or SLEPc failed.
void slepc(PetscErrorCode code);

/// An object of PETSc or SLEPc, given back at the end: SlepcObject<Mat, MatDestroy>.
template <typename T, PetscErrorCode (*destroy)(T*)>
class SlepcObject {
 public:
  SlepcObject() = default;
  SlepcObject(const SlepcObject&) = delete;
  SlepcObject& operator=(const SlepcObject&) = delete;
  ~SlepcObject() { (void)destroy(&object_); }
  operator T() const { return object_; }
  T* out() { return &object_; }  ///< where a function that makes it puts it

 private:
  T object_ = nullptr;
};

}  // namespace irdm::precompute
