#include "commands.h"

#include "detection_text.h"

#include "amontons/input/deck.h"
#include "amontons/output/checkpoint_file.h"
#include "amontons/output/contact_table.h"
#include "amontons/output/pictures.h"
#include "amontons/output/record.h"
#include "amontons/output/screen.h"
#include "amontons/parallel/agreement.h"
#include "amontons/solution/run.h"

#include <fmt/format.h>
#include <unistd.h>

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
/// Collective.
ResultFolder result_folder(const DeckArguments &arguments, const Communicator &world)
{
  namespace fs = std::filesystem;
  const fs::path path = arguments.output.value_or(default_folder(arguments.deck));
  const bool goes_on_there = arguments.restart && world.is_root() && fs::exists(path) &&
                             fs::equivalent(path, fs::absolute(*arguments.restart).parent_path());
  return ResultFolder(path, world, goes_on_there);
}
} // namespace

std::filesystem::path default_folder(const std::filesystem::path &deck)
{
  return deck.stem().string() + "-results";
}

ExitCode run_deck(const DeckArguments &arguments, const Communicator &world)
{
  Deck deck;
  std::optional<SavedRun> saved; // its content on process 0 only
  agree_on_errors(world,
                  [&]
                  {
                    deck = read(arguments);
                    if (arguments.restart)
                      saved = world.is_root() ? read_checkpoint(*arguments.restart) : SavedRun();
                  });

  const ResultFolder folder = result_folder(arguments, world);
  // mpirun gives its processes a terminal even where its own output goes to a file.
  const bool terminal = world.size() == 1 && isatty(STDOUT_FILENO) != 0;
  Screen screen(std::cout, deck.loading.end, terminal);
  RunRecord record(folder, deck.title, deck.file.string());
  ContactTables tables(folder);
  Pictures pictures(folder, deck.output, deck.bodies);
  CheckpointWriter checkpoints(folder, deck.output.checkpoint, record, pictures);
  // The record after the files that it tells of.
  std::vector<Observer *> observers{&tables, &pictures, &record, &checkpoints};
  if (world.is_root())
  {
    observers.insert(observers.begin(), &screen);
    if (saved)
    {
      record.resume(std::move(saved->record), saved->checkpoint.increment);
      pictures.resume(std::move(saved->series));
    }
    if (!deck.title.empty())
      std::cout << deck.title << '\n';
  }
  RunResult result;
  try
  {
    result = run(deck, observers, saved ? &saved->checkpoint : nullptr, world);
  }
  catch (const std::exception &error)
  {
    record.fail(error.what());
    throw;
  }
  if (world.is_root())
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
