#include "commands.h"

#include "detection_text.h"

#include "amontons/input/deck.h"
#include "amontons/output/contact_table.h"
#include "amontons/output/pictures.h"
#include "amontons/output/record.h"
#include "amontons/output/screen.h"
#include "amontons/parallel/agreement.h"
#include "amontons/solution/run.h"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <iostream>

namespace amontons
{
namespace
{
Deck read(const DeckArguments &arguments)
{
  Deck deck = read_deck(arguments.deck, arguments.overrides);
  if (arguments.method)
    deck.detection.method = *arguments.method;
  return deck;
}

ProblemCheck check(const Deck &deck, spdlog::logger &log)
{
  ProblemCheck check = check_problem(deck);
  for (const std::string &warning : check.warnings)
    log.warn("{}", warning);
  return check;
}
} // namespace

std::filesystem::path default_folder(const std::filesystem::path &deck)
{
  return deck.stem().string() + "-results";
}

ExitCode run_deck(const DeckArguments &arguments, const Communicator &world)
{
  Deck deck;
  agree_on_errors(world, [&] { deck = read(arguments); });

  const ResultFolder folder(arguments.output.value_or(default_folder(arguments.deck)));
  Screen screen(std::cout, deck.loading.end, isatty(STDOUT_FILENO) != 0);
  RunRecord record(folder, deck.title, deck.file.string(), world.size());
  ContactTables tables(folder);
  Pictures pictures(folder, deck.output, deck.bodies);
  // The record last: when it tells of an increment, the files of that increment are there.
  const std::array<Observer *, 4> observers{&screen, &tables, &pictures, &record};

  if (!deck.title.empty())
    std::cout << deck.title << '\n';
  RunResult result;
  try
  {
    result = run(deck, observers);
  }
  catch (const std::exception &error)
  {
    record.fail(error.what());
    throw;
  }
  std::cout << "results in " << folder.path().string() << std::endl;
  return result.converged ? ExitCode::solved : ExitCode::not_converged;
}

ExitCode check_deck(const DeckArguments &arguments, spdlog::logger &log)
{
  const Deck deck = read(arguments);
  const ProblemCheck found = check(deck, log);
  std::cout << fmt::format("{}: {} nodes, {} cells, {} unknowns\n", arguments.deck.string(), found.n_nodes,
                           found.n_cells, found.n_dofs);
  for (const ContactCheck &contact : found.contacts)
    std::cout << detection_text(contact);
  std::cout << "nothing wrong found before solving\n";
  return ExitCode::solved;
}

ExitCode detect_deck(const DeckArguments &arguments, spdlog::logger &log)
{
  const Deck deck = read(arguments);
  const ProblemCheck found = check(deck, log);
  if (arguments.json)
    std::cout << detection_json(found.contacts) << '\n';
  else
    for (const ContactCheck &contact : found.contacts)
      std::cout << detection_text(contact);
  return ExitCode::solved;
}
} // namespace amontons
