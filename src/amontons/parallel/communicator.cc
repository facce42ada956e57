#include "amontons/parallel/communicator.h"

namespace amontons
{
Rank Communicator::rank() const
{
  Rank rank = 0;
  MPI_Comm_rank(communicator_, &rank);
  return rank;
}

int Communicator::size() const
{
  int size = 1;
  MPI_Comm_size(communicator_, &size);
  return size;
}

std::string Communicator::broadcast(std::string text, Rank root) const
{
  auto length = static_cast<int>(text.size());
  MPI_Bcast(&length, 1, MPI_INT, root, communicator_);
  text.resize(static_cast<std::size_t>(length));
  MPI_Bcast(text.data(), length, MPI_CHAR, root, communicator_);
  return text;
}
} // namespace amontons
