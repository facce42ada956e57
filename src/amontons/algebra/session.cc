#include "amontons/algebra/session.h"

#include "amontons/algebra/petsc.h"

#include <cstdlib>

namespace amontons
{
AlgebraSession::AlgebraSession()
{
  // PETSc would otherwise take its options from the user's home and environment, and catch signals.
  std::string name = "amontons", skip = "-skip_petscrc", signals = "-no_signal_handler", none;
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

int AlgebraSession::n_processes() const
{
  int n = 1;
  MPI_Comm_size(PETSC_COMM_WORLD, &n);
  return n;
}

int AlgebraSession::rank() const
{
  int r = 0;
  MPI_Comm_rank(PETSC_COMM_WORLD, &r);
  return r;
}
} // namespace amontons
