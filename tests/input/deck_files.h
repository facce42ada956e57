#pragma once
#include "amontons/input/deck.h"
#include "temporary_folder.h"

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace amontons::test
{
/// A deck that is right, every line of it counted by the tests.
inline const std::string plane_deck = R"(title: A punch
mesh: {file: mesh.msh, kinematics: plane-strain}
bodies:
  - name: block
    region: block
    material: {law: linear-elastic, young: 1000, poisson: 0.3}
  - name: punch
    region: punch
    material: {law: rigid}
contact:
  - name: interface
    impactor: block_top
    target: punch_bottom
    friction: {law: coulomb, coefficient: 0.2}
boundary:
  - region: block_bottom
    fix: [x, y]
  - region: punch
    displacement: {x: 0, y: "-0.01*t"}
loading: {increments: 10}
)";

/// The text with the first occurrence of `part` replaced. @throws where it does not occur
inline std::string replaced(std::string text, const std::string &part, const std::string &by)
{
  const std::size_t at = text.find(part);
  if (at == std::string::npos)
    throw std::logic_error("'" + part + "' is not in the text");
  return text.replace(at, part.size(), by);
}

/// Reads the text as deck.yaml beside an (unread) mesh.msh and mesh.geo.
inline Deck read_text(const std::string &text, const std::vector<std::string> &overrides = {})
{
  const TemporaryFolder folder;
  folder.write("mesh.msh", "");
  folder.write("mesh.geo", "");
  return read_deck(folder.write("deck.yaml", text), overrides);
}

/// The message that reading it gives, without the folder's name; "no error" where it is read.
inline std::string error_of(const std::string &text, const std::vector<std::string> &overrides = {})
{
  const TemporaryFolder folder;
  folder.write("mesh.msh", "");
  folder.write("mesh.geo", "");
  try
  {
    read_deck(folder.write("deck.yaml", text), overrides);
  }
  catch (const UserError &error)
  {
    std::string message = error.what();
    const std::string prefix = folder.path().string() + "/";
    for (std::size_t at = 0; (at = message.find(prefix, at)) != std::string::npos;)
      message.erase(at, prefix.size());
    return message;
  }
  return "no error";
}
} // namespace amontons::test
