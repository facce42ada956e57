#pragma once

namespace amontons
{
/// Life of MPI and of the algebra engine (PETSc) in a process: one, made first and destroyed last. Collective.
class AlgebraSession
{
public:
  /// The program's arguments are left alone: no engine option is read from them, from the environment or from a file.
  AlgebraSession();
  ~AlgebraSession();
  AlgebraSession(const AlgebraSession &) = delete;
  AlgebraSession &operator=(const AlgebraSession &) = delete;
};
} // namespace amontons
