#pragma once
#include "amontons/base/error.h"

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

namespace amontons
{
using Bytes = std::vector<std::byte>;

/// Puts numbers and arrays of them one after another into a message, for a process of the same kind of machine.
class ByteWriter
{
public:
  template<typename T>
  requires std::is_trivially_copyable_v<T>
  void add(const T &value)
  {
    const std::size_t at = bytes_.size();
    bytes_.resize(at + sizeof(T));
    std::memcpy(bytes_.data() + at, &value, sizeof(T));
  }

  /// The values alone: the reader is to know how many.
  template<typename T>
  requires std::is_trivially_copyable_v<T>
  void add_values(std::span<const T> values)
  {
    const std::size_t at = bytes_.size();
    bytes_.resize(at + values.size_bytes());
    if (!values.empty())
      std::memcpy(bytes_.data() + at, values.data(), values.size_bytes());
  }

  /// The length first.
  template<typename T>
  void add_array(const std::vector<T> &values)
  {
    add(static_cast<std::int64_t>(values.size()));
    add_values(std::span<const T>(values));
  }

  [[nodiscard]] Bytes take() { return std::move(bytes_); }

private:
  Bytes bytes_;
};

/// Takes them out in the same order. The message must outlive it.
class ByteReader
{
public:
  explicit ByteReader(std::span<const std::byte> bytes)
    : bytes_(bytes)
  {
  }

  template<typename T>
  requires std::is_trivially_copyable_v<T> T get()
  {
    T value;
    std::memcpy(&value, next(sizeof(T)), sizeof(T));
    return value;
  }

  template<typename T>
  requires std::is_trivially_copyable_v<T> std::vector<T> get_values(std::size_t n)
  {
    std::vector<T> values(n);
    if (n > 0)
      std::memcpy(values.data(), next(n * sizeof(T)), n * sizeof(T));
    return values;
  }

  template<typename T>
  std::vector<T> get_array()
  {
    return get_values<T>(static_cast<std::size_t>(get<std::int64_t>()));
  }

  [[nodiscard]] bool is_at_end() const { return at_ == bytes_.size(); }

private:
  const std::byte *next(std::size_t n)
  {
    AMONTONS_ASSERT(n <= bytes_.size() - at_);
    at_ += n;
    return bytes_.data() + (at_ - n);
  }

  std::span<const std::byte> bytes_;
  std::size_t at_ = 0;
};
} // namespace amontons
