#pragma once
#include "amontons/detection/options.h"
#include "amontons/parallel/communicator.h"

#include <spdlog/logger.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace amontons
{
/// What the shell is told. Exceptions say the rest: UserError 2, any other 4.
enum class ExitCode : int
{
  solved = 0,
  bad_input = 2,
  not_converged = 3,
  internal_error = 4
};

/// The command line after its parsing, for every command that takes a deck.
struct DeckArguments
{
  std::filesystem::path deck;
  std::vector<std::string> overrides;           ///< "key.path=value"
  std::optional<std::filesystem::path> output;  ///< folder; default_folder() where absent
  std::optional<std::filesystem::path> restart; ///< the checkpoint to go on from
  std::optional<DetectionMethod> method;        ///< the deck's where absent
  bool json = false;
};

/// "<deck's name>-results" in the current directory.
std::filesystem::path default_folder(const std::filesystem::path &deck);

/// Solves and writes. Collective. @return solved or not_converged
ExitCode run_deck(const DeckArguments &arguments, const Communicator &world);

/// Prints what can be known before solving. Local, as is detect_deck().
ExitCode check_deck(const DeckArguments &arguments, spdlog::logger &log);

/// Prints statistics of one detection.
ExitCode detect_deck(const DeckArguments &arguments, spdlog::logger &log);
} // namespace amontons
