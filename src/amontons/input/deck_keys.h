#pragma once
#include "amontons/input/deck.h"
#include "amontons/input/section.h"

namespace amontons
{
/// The one table of the deck's keys: what read_deck() accepts and deck_reference() prints.
Section<Deck> deck_keys();

/// Its parts.
Section<MeshOptions> mesh_keys();
Section<BodyOptions> body_keys();
Section<Shape> shape_keys();
Section<ContactOptions> contact_keys();
Section<BoundaryOptions> boundary_keys();
} // namespace amontons
