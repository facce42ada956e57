#pragma once
#include "amontons/base/error.h"

#include <petscksp.h>

#include <memory>
#include <string>

namespace amontons
{
/// Turns an error code of PETSc into an exception. Over several processes it may be one of the calling process alone
/// (no memory), which no other one will hear of: then nothing can go on.
inline void check_petsc(PetscErrorCode code, const char *what)
{
  if (code == 0)
    return;
  const char *text = nullptr;
  PetscErrorMessage(code, &text, nullptr);
  const std::string message = std::string("PETSc, ") + what + ": " + (text ? text : "unknown error");
  int n_processes = 1;
  MPI_Comm_size(PETSC_COMM_WORLD, &n_processes);
  if (n_processes > 1)
    throw InternalError(message);
  throw NumericalFailure(message);
}

template<auto destroy>
struct PetscDeleter
{
  template<class Object>
  void operator()(Object *object) const
  {
    destroy(&object);
  }
};

using MatHandle = std::unique_ptr<std::remove_pointer_t<Mat>, PetscDeleter<&MatDestroy>>;
using VecHandle = std::unique_ptr<std::remove_pointer_t<Vec>, PetscDeleter<&VecDestroy>>;
using KspHandle = std::unique_ptr<std::remove_pointer_t<KSP>, PetscDeleter<&KSPDestroy>>;
} // namespace amontons
