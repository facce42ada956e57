#include "amontons/input/deck_checks.h"

#include "amontons/base/suggestion.h"

#include <algorithm>
#include <cctype>

namespace amontons
{
namespace
{
const Value &item(const Value &root, const std::string &list, std::size_t position)
{
  return root.find(list)->items[position];
}

/// The name becomes part of file names.
void check_name(const Value &name)
{
  const auto is_plain = [](char c)
  { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_' || c == '.'; };
  if (!std::all_of(name.text.begin(), name.text.end(), is_plain))
    name.fail("must be of letters, digits, '-', '_' and '.', not '" + name.text + "'");
}

/// @param key of each item of the list, whose value must not occur twice
void check_unique(const Value &root, const std::string &list, const std::string &key)
{
  const Value *values = root.find(list);
  if (!values)
    return;
  std::map<std::string, const Value *> first;
  for (const Value &entry : values->items)
    if (const Value *value = entry.find(key))
      if (const auto [other, is_new] = first.emplace(value->text, value); !is_new)
        value->fail("'" + value->text + "' is taken already, at " + other->second->where.text());
}

void check_bodies(const Value &root, const Deck &deck)
{
  check_unique(root, "bodies", "name");
  check_unique(root, "bodies", "region");
  for (std::size_t i = 0; i < deck.bodies.size(); ++i)
  {
    const Value &law = *item(root, "bodies", i).find("material")->find("law");
    const MaterialLaw given = deck.bodies[i].material.law;
    if (deck.strain == Strain::finite && given == MaterialLaw::linear_elastic)
      law.fail("linear-elastic holds in strain: small only; use neo-hookean with strain: finite");
    if (deck.strain == Strain::small && given == MaterialLaw::neo_hookean)
      law.fail("neo-hookean wants strain: finite; use linear-elastic with strain: small");
    if (deck.strain == Strain::finite && given == MaterialLaw::von_mises)
      law.fail("von-mises holds in strain: small only");
  }
}

const BodyOptions *analytic_body(const Deck &deck, const std::string &name)
{
  for (const BodyOptions &body : deck.bodies)
    if (body.shape && body.name == name)
      return &body;
  return nullptr;
}

/// Keys that mean something at nodes against faces only.
void check_mortar(const Value &root, const Deck &deck)
{
  const auto is_mortar = [](const ContactOptions &c) { return c.discretization == Discretization::mortar; };
  for (std::size_t i = 0; i < deck.contact.size(); ++i)
    if (const Value *normals = item(root, "contact", i).find("normals"); normals && is_mortar(deck.contact[i]))
      normals->fail("is for discretization: node-to-face; mortar takes the mean normal at each node");
  const Value *detection = root.find("detection");
  if (!detection || deck.contact.empty() || !std::all_of(deck.contact.begin(), deck.contact.end(), is_mortar))
    return;
  for (const char *key : {"method", "extension", "exchange"})
    if (const Value *value = detection->find(key))
      value->fail("is for discretization: node-to-face; mortar finds all faces that lie over each other within the "
                  "distance");
}

void check_contacts(const Value &root, const Deck &deck)
{
  check_unique(root, "contact", "name");
  std::map<std::pair<std::string, std::string>, std::string> pairs;
  for (std::size_t i = 0; i < deck.contact.size(); ++i)
  {
    const ContactOptions &contact = deck.contact[i];
    const Value &entry = item(root, "contact", i);
    check_name(*entry.find("name"));
    const Value &side = *(contact.is_self_contact() ? entry.find("surface") : entry.find("target"));
    if (contact.is_self_contact() && analytic_body(deck, contact.impactor))
      side.fail("'" + contact.impactor +
                "' is an analytic body, which cannot touch itself; make it the target of a pair");
    if (analytic_body(deck, contact.impactor))
      entry.find("impactor")
          ->fail("'" + contact.impactor + "' is an analytic body, which has no nodes; make it the target");
    const auto sides = std::minmax(contact.impactor, contact.target);
    const auto [other, is_new] = pairs.emplace(sides, contact.name);
    if (!is_new)
      side.fail("'" + contact.impactor + "' and '" + contact.target + "' are already a pair, in '" + other->second +
                "'");
  }
}
} // namespace

void check_deck(const Value &root, const Deck &deck)
{
  check_bodies(root, deck);
  check_contacts(root, deck);
  check_mortar(root, deck);
  check_boundary(root, deck);
}
} // namespace amontons
