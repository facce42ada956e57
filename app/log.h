#pragma once
#include "amontons/parallel/communicator.h"

#include <spdlog/logger.h>

#include <memory>

namespace amontons
{
/// Messages to the user on standard error, as "error: ..." or "warning: ...", in colour on a terminal; only process 0
/// speaks.
std::shared_ptr<spdlog::logger> make_log(const Communicator &communicator);
} // namespace amontons
