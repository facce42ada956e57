#pragma once
#include "amontons/base/error.h"

#include <petscksp.h>

#include <memory>
#include <string>

namespace amontons
{
/// Turns an error code of PETSc into an exception.
inline void check_petsc(PetscErrorCode code, const char *what)
{
  if (code == 0)
    return;
  const char *text = nullptr;
  PetscErrorMessage(code, &text, nullptr);
  throw NumericalFailure(std::string("PETSc, ") + what + ": " + (text ? text : "unknown error"));
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
