// The command `amontons`: reads the command line, starts the engine, turns errors into exit codes.
#include "commands.h"
#include "log.h"

#include "amontons/algebra/session.h"
#include "amontons/base/error.h"
#include "amontons/base/suggestion.h"
#include "amontons/input/deck.h"
#include "amontons/output/version.h"
#include "amontons/parallel/agreement.h"

#include <CLI/CLI.hpp>

#include <functional>
#include <iostream>
#include <map>

namespace
{
using namespace amontons;

/// The options, and the command that was chosen.
struct CommandLine
{
  DeckArguments arguments;
  std::function<ExitCode(const Communicator &, spdlog::logger &)> command;
  bool is_collective = false; ///< else process 0 does it while the others wait
};

const std::map<std::string, DetectionMethod> detection_methods{{"exact", DetectionMethod::exact},
                                                               {"nearest-node", DetectionMethod::nearest_node},
                                                               {"brute", DetectionMethod::brute}};

CLI::App *add_deck_command(CLI::App &app, const std::string &name, const std::string &help, DeckArguments &arguments)
{
  CLI::App *command = app.add_subcommand(name, help);
  command->add_option("DECK", arguments.deck, "the problem (YAML)")->required();
  command
      ->add_option("--set", arguments.overrides,
                   "override a key of the deck; a list's items by position: contact.0.friction.coefficient=0.4")
      ->type_name("KEY.PATH=VALUE")
      ->take_all()
      ->expected(1);
  return command;
}

void add_commands(CLI::App &app, CommandLine &line)
{
  DeckArguments &arguments = line.arguments;
  CLI::App *run = add_deck_command(app, "run", "solve a deck", arguments);
  run->add_option("--output", arguments.output, "folder of the results [<deck>-results]")->type_name("DIR");
  run->add_option("--restart", arguments.restart, "go on from this checkpoint (output: {checkpoint: n} in the deck)")
      ->type_name("FILE");
  run->callback(
      [&]
      {
        line.command = [&](const Communicator &world, auto &) { return run_deck(arguments, world); };
        line.is_collective = true;
      });

  add_deck_command(app, "check", "tell what can be known before solving", arguments)
      ->callback([&] { line.command = [&](const auto &, auto &log) { return check_deck(arguments, log); }; });

  CLI::App *detect = add_deck_command(app, "detect", "detect contact once and tell statistics", arguments);
  detect
      ->add_option_function<std::string>(
          "--method", [&](const std::string &name) { arguments.method = detection_methods.at(name); },
          "exact, nearest-node or brute [the deck's]")
      ->check(CLI::IsMember(detection_methods))
      ->type_name("METHOD");
  detect->add_flag("--json", arguments.json, "as JSON");
  detect->callback([&] { line.command = [&](const auto &, auto &log) { return detect_deck(arguments, log); }; });

  app.add_subcommand("version", "print the version")
      ->callback(
          [&]
          {
            line.command = [](const auto &, auto &)
            {
              std::cout << "amontons " << version() << '\n';
              return ExitCode::solved;
            };
          });
  // For the documentation; no user needs it.
  app.add_subcommand("reference", "print the page of all keys of a deck")
      ->group("")
      ->callback(
          [&]
          {
            line.command = [](const auto &, auto &)
            {
              std::cout << deck_reference();
              return ExitCode::solved;
            };
          });
}

/// @throws UserError for a first word that is no command; the parser itself would only say that one is required
void check_command_name(const CLI::App &app, int argc, char **argv)
{
  if (argc < 2 || argv[1][0] == '-')
    return;
  std::vector<std::string> names;
  for (const CLI::App *command : app.get_subcommands([](const CLI::App *) { return true; }))
  {
    if (command->get_name() == argv[1])
      return;
    if (!command->get_group().empty())
      names.push_back(command->get_name());
  }
  throw UserError("no command '" + std::string(argv[1]) + "'" + did_you_mean(argv[1], names) + "; there are " +
                  joined(names));
}

ExitCode execute(int argc, char **argv, const Communicator &world, spdlog::logger &log)
{
  CLI::App app("Frictional contact between deformable bodies by finite elements.", "amontons");
  app.require_subcommand(1);
  app.footer("Exit codes: 0 solved, 2 bad deck, mesh or command line, 3 not converged, 4 internal error.");
  CommandLine line;
  add_commands(app, line);
  check_command_name(app, argc, argv);
  try
  {
    app.parse(argc, argv);
  }
  catch (const CLI::ParseError &error)
  {
    if (error.get_exit_code() == 0) // --help
      return world.is_root() ? static_cast<ExitCode>(app.exit(error)) : ExitCode::solved;
    throw UserError(std::string(error.what()) + " (see amontons --help)");
  }
  return line.is_collective || world.is_root() ? line.command(world, log) : ExitCode::solved;
}
} // namespace

int main(int argc, char **argv)
{
  const AlgebraSession session;
  const Communicator world(MPI_COMM_WORLD);
  const auto log = make_log(world);
  ExitCode code = ExitCode::internal_error;
  try
  {
    end_together(world, [&] { code = execute(argc, argv, world, *log); });
  }
  catch (const UserError &error)
  {
    log->error("{}", error.what());
    code = ExitCode::bad_input;
  }
  catch (const NumericalFailure &error)
  {
    log->error("{}", error.what());
    code = ExitCode::not_converged;
  }
  catch (const std::exception &error)
  {
    log->error("internal error: {}", error.what());
  }
  return static_cast<int>(code);
}
