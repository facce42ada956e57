#pragma once
#include "amontons/input/deck.h"
#include "amontons/input/value.h"

namespace amontons
{
/// What only the parts of a deck together tell: names used twice, laws against the strain, contact pairs, conditions
/// that contradict each other or do not suit their body.
/// @param root the deck's values, for their places
/// @throws UserError at the later of the two places that do not agree
void check_deck(const Value &root, const Deck &deck);

/// Its part on `boundary`.
void check_boundary(const Value &root, const Deck &deck);
} // namespace amontons
