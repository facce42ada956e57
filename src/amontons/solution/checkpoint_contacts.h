#pragma once
#include "amontons/solution/checkpoint.h"

#include <span>
#include <vector>

/// What contacts remember, taken apart and put together; for the checkpoint's own source. Local.
namespace amontons
{
/// Where a contact node's history and multipliers are.
struct ContactPlace
{
  GlobalIndex node;                ///< position in the whole mesh
  std::size_t part, i, multiplier; ///< which part, which of its nodes, first of its multipliers
};

/// Of a contact's nodes in several parts, by their positions in the whole.
std::vector<ContactPlace> contact_places(std::span<const Checkpoint *const> parts, std::size_t contact, int dim);

/// Adds a contact's history and multipliers, which are those at some places of it in several parts.
void add_contact(Checkpoint &out, std::span<const Checkpoint *const> parts, std::size_t contact,
                 std::span<const ContactPlace> places, int dim);

void forget_contacts(Checkpoint &checkpoint);

/// Whether arrays of contacts are as long as each other asks for, nodes in ascending order.
bool is_whole(const Checkpoint &checkpoint, std::size_t n_contacts, int dim);
} // namespace amontons
