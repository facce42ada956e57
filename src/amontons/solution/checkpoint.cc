#include "amontons/solution/checkpoint.h"

#include "amontons/base/hash.h"

namespace amontons
{
std::uint64_t problem_key(const ProblemOptions &options, const Mesh &mesh)
{
  Hash hash;
  hash.add(options.mesh.kinematics);
  hash.add(options.strain);
  for (const BodyOptions &body : options.bodies)
    hash.add(body.material.law);
  for (const ContactOptions &contact : options.contact)
  {
    for (const std::string &name : {contact.name, contact.impactor, contact.target})
      hash.add(std::span<const char>(name.c_str(), name.size() + 1));
    hash.add(contact.tied);
    hash.add(contact.initial_overlap);
    hash.add(contact.discretization);
  }
  hash.add(std::span<const double>(mesh.points));
  for (Index cell = 0; cell < mesh.cells.size(); ++cell)
    hash.add(std::span<const Index>(mesh.cells[cell]));
  return hash.value();
}
} // namespace amontons
