#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

namespace amontons
{
/// Hash of the bytes of values in their order (Fowler, Noll, Vo: FNV-1a, 64 bits).
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
  void add(const T &value)
  {
    add(std::span<const T>(&value, 1));
  }
  [[nodiscard]] std::uint64_t value() const { return value_; }

private:
  std::uint64_t value_ = 14695981039346656037U;
};
} // namespace amontons
