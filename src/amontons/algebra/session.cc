#include "amontons/algebra/session.h"

#include "amontons/algebra/petsc.h"

#include <cstdlib>

namespace amontons
{
AlgebraSession::AlgebraSession()
{
  // PETSc would otherwise take its options from the user's home and environment, and catch signals.
  std::string name = "amontons", skip = "-skip_petscrc", signals = "-no_signal_handler";
  char *arguments[] = {name.data(), skip.data(), signals.data(), nullptr};
  char **argv = arguments;
  int argc = 3;
  unsetenv("PETSC_OPTIONS");
  check_petsc(PetscInitialize(&argc, &argv, nullptr, nullptr), "start of PETSc");
  // Errors come back as codes and become exceptions; PETSc itself prints nothing.
  check_petsc(PetscPushErrorHandler(PetscReturnErrorHandler, nullptr), "error handler");
}

AlgebraSession::~AlgebraSession()
{
  PetscFinalize();
}
} // namespace amontons
