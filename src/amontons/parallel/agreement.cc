#include "amontons/parallel/agreement.h"

#include "amontons/base/error.h"

#include <chrono>
#include <cstdio>
#include <exception>
#include <thread>

namespace amontons
{
namespace
{
/// How long a process that failed waits for the others.
constexpr std::chrono::seconds patience{2};
/// Between two looks whether all have come.
constexpr std::chrono::milliseconds nap{1};

/// The exit codes of base/error.h: the graver, the greater.
enum Outcome : int
{
  fine = 0,
  user_error = 2,
  numerical_failure = 3,
  internal_error = 4
};

struct Ending
{
  Outcome outcome = fine;
  std::string message;
};

Ending ending_of(const std::function<void()> &work)
{
  try
  {
    work();
    return {};
  }
  catch (const UserError &error)
  {
    return {user_error, error.what()};
  }
  catch (const NumericalFailure &error)
  {
    return {numerical_failure, error.what()};
  }
  catch (const std::exception &error)
  {
    return {internal_error, error.what()};
  }
  catch (...)
  {
    return {internal_error, "unknown exception"};
  }
}

/// @throws the gravest of all processes' errors on all of them
void throw_gravest(const Communicator &communicator, const Ending &ending)
{
  struct
  {
    int outcome;
    Rank rank;
  } mine{ending.outcome, communicator.rank()}, worst{};
  // Of equal outcomes MPI_MAXLOC takes the lowest rank.
  MPI_Allreduce(&mine, &worst, 1, MPI_2INT, MPI_MAXLOC, communicator.mpi());
  if (worst.outcome == fine)
    return;
  const std::string message = communicator.broadcast(ending.message, worst.rank);
  switch (worst.outcome)
  {
  case user_error:
    throw UserError(message);
  case numerical_failure:
    throw NumericalFailure(message);
  default:
    throw InternalError(message);
  }
}

/// A communicator of its own for calls that must meet none of the work's.
class Duplicate
{
public:
  explicit Duplicate(const Communicator &communicator) { MPI_Comm_dup(communicator.mpi(), &mpi_); }
  Duplicate(const Duplicate &) = delete;
  Duplicate &operator=(const Duplicate &) = delete;
  ~Duplicate() { MPI_Comm_free(&mpi_); }
  [[nodiscard]] Communicator communicator() const { return Communicator(mpi_); }

private:
  MPI_Comm mpi_ = MPI_COMM_NULL;
};

/// Waits, leaving the processor to others, until all processes have called this.
/// @param for_ever or for `patience` only @return whether all have
bool all_come(const Communicator &communicator, bool for_ever)
{
  MPI_Request barrier = MPI_REQUEST_NULL;
  MPI_Ibarrier(communicator.mpi(), &barrier);
  const auto end = std::chrono::steady_clock::now() + patience;
  for (int there = 0;;)
  {
    MPI_Test(&barrier, &there, MPI_STATUS_IGNORE);
    if (there != 0)
      return true;
    if (!for_ever && std::chrono::steady_clock::now() > end)
      return false;
    std::this_thread::sleep_for(nap);
  }
}
} // namespace

void agree_on_errors(const Communicator &communicator, const std::function<void()> &work)
{
  throw_gravest(communicator, ending_of(work));
}

void end_together(const Communicator &communicator, const std::function<void()> &work)
{
  if (communicator.size() == 1)
    return work();
  const Duplicate own(communicator);
  const Ending ending = ending_of(work);
  if (!all_come(own.communicator(), ending.outcome == fine))
  {
    std::fprintf(stderr, "error: process %d: %s%s\n", communicator.rank(),
                 ending.outcome == internal_error ? "internal error: " : "", ending.message.c_str());
    MPI_Abort(communicator.mpi(), ending.outcome);
  }
  throw_gravest(own.communicator(), ending);
}

bool is_greatest(const Sharing &processes, double value, double place)
{
  const double greatest = processes.maximum_over_processes(value);
  const bool is_candidate = value == greatest && value != no_candidate;
  const double first = processes.maximum_over_processes(is_candidate ? -place : no_candidate);
  return is_candidate && -place == first;
}

std::string told_by_one(const Sharing &processes, bool tells, const std::function<std::string()> &text)
{
  const double teller = processes.maximum_over_processes(tells ? processes.rank() : -1);
  const std::string own = tells ? text() : "";
  if (teller < 0 || !processes.is_distributed())
    return own;
  return processes.messages()->communicator().broadcast(own, static_cast<Rank>(teller));
}
} // namespace amontons
