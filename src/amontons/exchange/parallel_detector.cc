#include "amontons/exchange/parallel_detector.h"

#include "amontons/base/error.h"

#include "amontons/exchange/distributed_detector.h"
#include "amontons/exchange/gathered_detector.h"
#include "amontons/parallel/agreement.h"

#include <cmath>
#include <string>

namespace amontons
{
std::unique_ptr<ParallelDetector> make_parallel_detector(const Communicator &communicator,
                                                         const ExchangeOptions &options,
                                                         std::vector<ContactShare> shares)
{
  agree_on_errors(communicator,
                  [&]
                  {
                    if (!(options.skin >= 0) || !std::isfinite(options.skin))
                      throw UserError("exchange: the skin must be a finite number, at least 0, not " +
                                      std::to_string(options.skin));
                  });
  if (options.mode == ExchangeMode::gathered)
    return make_gathered_detector(communicator, std::move(shares));
  return make_distributed_detector(communicator, options.skin, std::move(shares));
}
} // namespace amontons
