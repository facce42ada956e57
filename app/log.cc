#include "log.h"

#include <spdlog/sinks/stdout_color_sinks.h>

namespace amontons
{
std::shared_ptr<spdlog::logger> make_log(const Communicator &communicator)
{
  auto log = std::make_shared<spdlog::logger>("amontons", std::make_shared<spdlog::sinks::stderr_color_sink_mt>());
  log->set_pattern("%^%l:%$ %v");
  log->flush_on(spdlog::level::trace);
  if (!communicator.is_root())
    log->set_level(spdlog::level::off);
  return log;
}
} // namespace amontons
