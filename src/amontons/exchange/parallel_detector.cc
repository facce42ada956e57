#include "amontons/exchange/parallel_detector.h"

#include "amontons/exchange/distributed_detector.h"
#include "amontons/exchange/gathered_detector.h"

namespace amontons
{
std::unique_ptr<ParallelDetector> make_parallel_detector(const Communicator &communicator,
                                                         const ExchangeOptions &options,
                                                         std::vector<ContactShare> shares)
{
  if (options.mode == ExchangeMode::gathered)
    return make_gathered_detector(communicator, std::move(shares));
  return make_distributed_detector(communicator, options.skin, std::move(shares));
}
} // namespace amontons
