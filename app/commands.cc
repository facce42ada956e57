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
  std::optional<SavedRun> saved;
  agree_on_errors(world,
                  [&]
                  {
                    deck = read(arguments);
                    if (arguments.restart)
                      saved = read_checkpoint(*arguments.restart);
                  });

  const std::filesystem::path path = arguments.output.value_or(default_folder(arguments.deck));
  const bool same_folder =
      saved && std::filesystem::exists(path) &&
      std::filesystem::equivalent(path, std::filesystem::absolute(*arguments.restart).parent_path());
  const ResultFolder folder(path, same_folder);
  Screen screen(std::cout, deck.loading.end, isatty(STDOUT_FILENO) != 0);
  RunRecord record(folder, deck.title, deck.file.string(), world.size());
  ContactTables tables(folder);
  Pictures pictures(folder, deck.output, deck.bodies);
  CheckpointWriter checkpoints(folder, deck.output.checkpoint, record, pictures);
  if (saved)
  {
    record.resume(std::move(saved->record), saved->checkpoint.increment);
    pictures.resume(std::move(saved->series));
  }
  // The record after the files that it tells of.
  const std::array<Observer *, 5> observers{&screen, &tables, &pictures, &record, &checkpoints};

  if (!deck.title.empty())
    std::cout << deck.title << '\n';
  RunResult result;
  try
  {
    result = run(deck, observers, saved ? &saved->checkpoint : nullptr);
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
