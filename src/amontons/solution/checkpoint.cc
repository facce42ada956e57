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
  [[nodiscard]] std::uint64_t value() const { return value_; }

private:
  std::uint64_t value_ = 14695981039346656037U;
};
} // namespace

std::uint64_t mesh_key(const Mesh &mesh)
{
  Hash hash;
  hash.add(std::span<const double>(mesh.points));
  for (Index cell = 0; cell < mesh.cells.size(); ++cell)
    hash.add(std::span<const Index>(mesh.cells[cell]));
  return hash.value();
}
} // namespace amontons
