#include "amontons/parallel/agreement.h"

#include "amontons/base/error.h"

#include <exception>

namespace amontons
{
namespace
{
enum Outcome : int
{
  fine,
  user_error,
  numerical_failure,
  internal_error
};

Outcome outcome_of(const std::function<void()> &work, std::string &message)
{
  try
  {
    work();
    return fine;
  }
  catch (const UserError &error)
  {
    message = error.what();
    return user_error;
  }
  catch (const NumericalFailure &error)
  {
    message = error.what();
    return numerical_failure;
  }
  catch (const std::exception &error)
  {
    message = error.what();
  }
  catch (...)
  {
    message = "unknown exception";
  }
  return internal_error;
}
} // namespace

void agree_on_errors(const Communicator &communicator, const std::function<void()> &work)
{
  struct
  {
    int outcome;
    Rank rank;
  } mine{fine, communicator.rank()}, worst{};
  std::string message;
  mine.outcome = outcome_of(work, message);
  // Of equal outcomes MPI_MAXLOC takes the lowest rank.
  MPI_Allreduce(&mine, &worst, 1, MPI_2INT, MPI_MAXLOC, communicator.mpi());
  if (worst.outcome == fine)
    return;
  message = communicator.broadcast(message, worst.rank);
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
} // namespace amontons
