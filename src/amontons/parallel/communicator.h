#pragma once
#include "amontons/base/ids.h"

#include <mpi.h>

#include <string>

namespace amontons
{
/// A group of processes. Does not own the MPI communicator, which must outlive it.
class Communicator
{
public:
  explicit Communicator(MPI_Comm communicator)
    : communicator_(communicator)
  {
  }

  /// The calling process alone.
  [[nodiscard]] static Communicator alone() { return Communicator(MPI_COMM_SELF); }

  [[nodiscard]] Rank rank() const;
  [[nodiscard]] int size() const;
  [[nodiscard]] bool is_root() const { return rank() == 0; }
  [[nodiscard]] MPI_Comm mpi() const { return communicator_; }

  /// The text of process `root` on all. Collective.
  [[nodiscard]] std::string broadcast(std::string text, Rank root) const;

private:
  MPI_Comm communicator_;
};
} // namespace amontons
