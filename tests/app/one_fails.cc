// One process of several fails while the others wait for it in a collective call, or have done their work already.
//   one_fails user|numerical|other waiting|done
#include "amontons/base/error.h"
#include "amontons/parallel/agreement.h"

#include <mpi.h>

#include <string>

int main(int argc, char **argv)
{
  using namespace amontons;
  MPI_Init(&argc, &argv);
  const Communicator world(MPI_COMM_WORLD);
  const std::string error = argv[1], others = argv[2];
  int code = 0;
  try
  {
    end_together(world,
                 [&]
                 {
                   if (world.rank() == 1)
                   {
                     if (error == "user")
                       throw UserError("bad deck");
                     if (error == "numerical")
                       throw NumericalFailure("no convergence");
                     throw std::out_of_range("vector");
                   }
                   if (others == "waiting")
                     MPI_Barrier(world.mpi());
                 });
  }
  catch (const UserError &)
  {
    code = 12;
  }
  catch (const NumericalFailure &)
  {
    code = 13;
  }
  catch (const InternalError &)
  {
    code = 14;
  }
  MPI_Finalize();
  return code;
}
