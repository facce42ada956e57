#include "amontons/input/deck.h"

#include "amontons/input/deck_checks.h"
#include "amontons/input/deck_keys.h"

namespace amontons
{
Deck read_deck(const std::filesystem::path &file, const std::vector<std::string> &overrides)
{
  const Value root = read_values(file, overrides);
  Deck deck;
  deck.file = file;
  ReadContext context{std::filesystem::absolute(file).parent_path()};
  deck_keys().read(root, deck, context);
  check_deck(root, deck);
  return deck;
}
} // namespace amontons
