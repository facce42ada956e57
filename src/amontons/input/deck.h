#pragma once
#include "amontons/output/options.h"
#include "amontons/solution/options.h"

#include <filesystem>
#include <string>
#include <vector>

namespace amontons
{
/// Everything a deck says, with defaults filled in and ranges checked.
struct Deck : ProblemOptions
{
  std::filesystem::path file;
  std::string title;
  OutputOptions output;
};

/// Reads a deck.
/// @param overrides "key.path=value" in order, list items by position ("bodies.0.material.poisson=0.3").
/// @throws UserError with file:line:column, what is allowed and what was probably meant.
Deck read_deck(const std::filesystem::path &file, const std::vector<std::string> &overrides = {});

/// The reference page of all keys, in Markdown, from the table that the reader itself uses.
std::string deck_reference();
} // namespace amontons
