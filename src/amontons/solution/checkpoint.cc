#include "amontons/solution/checkpoint.h"

namespace amontons
{
namespace
{
/// Fowler, Noll, Vo's hash (FNV-1a).
class Hash
{
public:
  template<class T>
  void add(std::span<const T> values)
  {
    for (const std::byte byte : std::as_bytes(values))
      value_ = (value_ ^ static_cast<std::uint64_t>(byte)) * 1099511628211U;
  }
  template<class T>
  void add_value(const T &value)
  {
    add(std::span<const T>(&value, 1));
  }
  [[nodiscard]] std::uint64_t value() const { return value_; }

private:
  std::uint64_t value_ = 14695981039346656037U;
};
} // namespace

std::uint64_t problem_key(const ProblemOptions &options, const Mesh &mesh)
{
  Hash hash;
  hash.add_value(options.mesh.kinematics);
  hash.add_value(options.strain);
  for (const BodyOptions &body : options.bodies)
    hash.add_value(body.material.law);
  for (const ContactOptions &contact : options.contact)
  {
    for (const std::string &name : {contact.name, contact.impactor, contact.target})
      hash.add(std::span<const char>(name.c_str(), name.size() + 1));
    hash.add_value(contact.tied);
    hash.add_value(contact.initial_overlap);
    hash.add_value(contact.discretization);
  }
  hash.add(std::span<const double>(mesh.points));
  for (Index cell = 0; cell < mesh.cells.size(); ++cell)
    hash.add(std::span<const Index>(mesh.cells[cell]));
  return hash.value();
}
} // namespace amontons
