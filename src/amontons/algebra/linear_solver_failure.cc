#include "amontons/algebra/linear_solver_failure.h"

#include "amontons/parallel/agreement.h"

namespace amontons
{
void agree_on_failures(const Sharing &processes, const std::function<void()> &work)
{
  if (!processes.is_distributed())
    return work();
  const Communicator &communicator = processes.messages()->communicator();
  std::string failure;
  agree_on_errors(communicator,
                  [&]
                  {
                    try
                    {
                      work();
                    }
                    catch (const LinearSolverFailure &error)
                    {
                      failure = error.what();
                    }
                  });
  // Of several that failed the lowest rank speaks.
  const int n = communicator.size();
  const double first = processes.maximum_over_processes(failure.empty() ? 0. : n - communicator.rank());
  if (first > 0)
    throw LinearSolverFailure(communicator.broadcast(failure, n - static_cast<int>(first)));
}
} // namespace amontons
