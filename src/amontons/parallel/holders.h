#pragma once
#include "amontons/parallel/bytes.h"
#include "amontons/parallel/sharing.h"

#include <functional>
#include <string>

namespace amontons
{
/// Messages of any length about items with copies: what a process has to say of an item every other process with a copy
/// hears, items that it says nothing of cost nothing. Where nothing is distributed nobody hears. Collective.
/// @param is_told whether this process says something of an item @param write says it
/// @param read called for every item and process that said something, by rank; must take out what was written
void tell_holders(const Sharing &sharing, const std::string &phase, const std::function<bool(Index)> &is_told,
                  const std::function<void(Index, ByteWriter &)> &write,
                  const std::function<void(Index, ByteReader &)> &read);
} // namespace amontons
