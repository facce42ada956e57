#pragma once
#include "amontons/parallel/bytes.h"

#include <string>
#include <vector>

namespace amontons
{
/// Puts into a message what it is shown. Packer and Unpacker have the same calls, so that one function that shows a
/// structure's parts, a template over them, both writes and reads it.
struct Packer
{
  ByteWriter message;

  template<class T>
  void value(const T &value)
  {
    message.add(value);
  }
  template<class T>
  void array(const std::vector<T> &values)
  {
    message.add_array(values);
  }
  void text(const std::string &text) { message.add_array(std::vector<char>(text.begin(), text.end())); }
};

/// Takes it out again, in the same order.
struct Unpacker
{
  ByteReader message;

  template<class T>
  void value(T &value)
  {
    value = message.get<T>();
  }
  template<class T>
  void array(std::vector<T> &values)
  {
    values = message.get_array<T>();
  }
  void text(std::string &text)
  {
    const std::vector<char> letters = message.get_array<char>();
    text.assign(letters.begin(), letters.end());
  }
};
} // namespace amontons
