#pragma once
#include "temporary_folder.h"

#include "amontons/parallel/communicator.h"

namespace amontons::test
{
/// One temporary folder for all processes, gone when all have done with it. Collective.
class SharedFolder
{
public:
  explicit SharedFolder(const Communicator &all)
    : all_(all)
    , path_(all.broadcast(own_.path().string(), 0))
  {
  }
  SharedFolder(const SharedFolder &) = delete;
  SharedFolder &operator=(const SharedFolder &) = delete;
  ~SharedFolder() { MPI_Barrier(all_.mpi()); }

  [[nodiscard]] const std::filesystem::path &path() const { return path_; }

private:
  Communicator all_;
  TemporaryFolder own_;
  std::filesystem::path path_;
};
} // namespace amontons::test
