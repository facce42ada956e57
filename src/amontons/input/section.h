#pragma once
#include "amontons/base/suggestion.h"
#include "amontons/bulk/options.h"
#include "amontons/input/scalars.h"

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace amontons
{
/// One row of the reference page.
struct KeyDoc
{
  std::string path; ///< "bodies[].material.young"
  std::string type;
  std::string unit;
  std::string preset; ///< default, or "required"
  std::string allowed;
  std::string meaning;
};

/// What reading one part of the deck needs to know of the rest.
struct ReadContext
{
  std::filesystem::path folder; ///< of the deck
  Kinematics kinematics = Kinematics::plane_strain;

  [[nodiscard]] int dim() const { return kinematics == Kinematics::three_dimensional ? 3 : 2; }
};

/// Whether a key must be there, and what the page says where it is not.
struct Need
{
  bool required = false;
  std::string preset; ///< empty: the value that the struct has of itself
};

inline const Need required{true, "required"};
inline const Need optional{};
inline Need otherwise(const std::string &preset)
{
  return {false, preset};
}

/// The keys of one map of the deck: reads the map into a T, strictly, and documents itself. One table for both.
template<typename T>
class Section
{
public:
  struct Key
  {
    KeyDoc doc; ///< path: the key alone
    bool required = false;
    std::function<void(const Value &, T &, ReadContext &)> read;
    std::function<std::vector<KeyDoc>()> inner; ///< keys below, their paths relative to this key
  };

  Section &key(Key key)
  {
    keys_.push_back(std::move(key));
    return *this;
  }

  Section &number(const std::string &name, double T::*member, const Range &range, const std::string &unit, Need need,
                  const std::string &meaning)
  {
    return key(row(name, "number", unit, range.text(), need, number_text(T{}.*member), meaning,
                   [=](const Value &v, T &out, ReadContext &) { out.*member = to_number(v, range); }));
  }

  /// @param word that leaves the number to the program, as does the key's absence
  Section &number_or(const std::string &word, const std::string &name, std::optional<double> T::*member,
                     const Range &range, const std::string &unit, const std::string &preset, const std::string &meaning)
  {
    return key(row(name, "number or `" + word + "`", unit, range.text(), otherwise(preset), "", meaning,
                   [=](const Value &v, T &out, ReadContext &)
                   {
                     if (v.kind == Value::Kind::scalar && v.text == word)
                       return;
                     out.*member = to_number(v, range, "a number or " + word);
                   }));
  }

  Section &number(const std::string &name, std::optional<double> T::*member, const Range &range,
                  const std::string &unit, Need need, const std::string &meaning)
  {
    return key(row(name, "number", unit, range.text(), need, "", meaning,
                   [=](const Value &v, T &out, ReadContext &) { out.*member = to_number(v, range); }));
  }

  Section &integer(const std::string &name, int T::*member, const Range &range, Need need, const std::string &meaning)
  {
    return key(row(name, "integer", "", range.text(), need, std::to_string(T{}.*member), meaning,
                   [=](const Value &v, T &out, ReadContext &) { out.*member = to_integer(v, range); }));
  }

  Section &boolean(const std::string &name, bool T::*member, Need need, const std::string &meaning)
  {
    return key(row(name, "boolean", "", "true, false", need, T{}.*member ? "true" : "false", meaning,
                   [=](const Value &v, T &out, ReadContext &) { out.*member = to_boolean(v); }));
  }

  Section &boolean(const std::string &name, std::optional<bool> T::*member, Need need, const std::string &meaning)
  {
    return key(row(name, "boolean", "", "true, false", need, "", meaning,
                   [=](const Value &v, T &out, ReadContext &) { out.*member = to_boolean(v); }));
  }

  Section &text(const std::string &name, std::string T::*member, Need need, const std::string &meaning)
  {
    return key(row(name, "text", "", "", need, T{}.*member, meaning,
                   [=](const Value &v, T &out, ReadContext &) { out.*member = to_text(v); }));
  }

  template<typename Enum>
  using Choices = std::vector<std::pair<std::string, Enum>>;

  /// @tparam Owner T or a base of it
  template<typename Enum, typename Owner>
  Section &choice(const std::string &name, Enum Owner::*member, const Choices<Enum> &choices, Need need,
                  const std::string &meaning)
  {
    std::vector<std::string> words;
    std::string preset;
    for (const auto &[word, value] : choices)
    {
      words.push_back(word);
      if (T{}.*member == value)
        preset = word;
    }
    return key(row(name, "choice", "", joined(words), need, preset, meaning,
                   [=](const Value &v, T &out, ReadContext &) { out.*member = choices[to_choice(v, words)].second; }));
  }

  /// A map below this one. @param apply what becomes of it
  template<typename Inner>
  Section &map(const std::string &name, const Section<Inner> &inner, Need need, const std::string &meaning,
               std::function<void(T &, Inner)> apply)
  {
    Key k = row(name, "map", "", "", need, "", meaning,
                [=](const Value &v, T &out, ReadContext &context)
                {
                  Inner value;
                  inner.read(v, value, context);
                  apply(out, std::move(value));
                });
    k.inner = [inner] { return inner.docs(); };
    return key(std::move(k));
  }

  /// A list of maps below this one.
  template<typename Inner>
  Section &list(const std::string &name, const Section<Inner> &inner, Need need, const std::string &meaning,
                std::function<void(T &, Inner)> append)
  {
    Key k = row(name, "list of maps", "", "", need, "", meaning,
                [=](const Value &v, T &out, ReadContext &context)
                {
                  require_list(v, "entries");
                  for (const Value &item : v.items)
                  {
                    Inner value;
                    inner.read(item, value, context);
                    append(out, std::move(value));
                  }
                });
    k.doc.path += "[]";
    k.inner = [inner] { return inner.docs(); };
    return key(std::move(k));
  }

  /// Called once the keys of a map are read, for what they only tell together.
  Section &check(std::function<void(const Value &, T &, ReadContext &)> check)
  {
    check_ = std::move(check);
    return *this;
  }

  /// @throws UserError: not a map, an unknown key, a key missing, or what a key's reading throws
  void read(const Value &value, T &out, ReadContext &context) const
  {
    if (value.kind != Value::Kind::map)
      value.fail("must be a map of the keys " + joined(names()) + ", not " + value.described());
    for (const Value &item : value.items)
      require_known(item, value);
    for (const Key &k : keys_)
      if (const Value *item = value.find(name_of(k)))
        k.read(*item, out, context);
      else if (k.required)
        value.fail("the key '" + name_of(k) + "' is missing (" + k.doc.meaning + ")");
    if (check_)
      check_(value, out, context);
  }

  /// Rows of these keys, each followed by those below it.
  [[nodiscard]] std::vector<KeyDoc> docs() const
  {
    std::vector<KeyDoc> all;
    for (const Key &k : keys_)
    {
      all.push_back(k.doc);
      if (!k.inner)
        continue;
      for (KeyDoc doc : k.inner())
      {
        doc.path = k.doc.path + "." + doc.path;
        all.push_back(std::move(doc));
      }
    }
    return all;
  }

  [[nodiscard]] std::vector<std::string> names() const
  {
    std::vector<std::string> all;
    for (const Key &k : keys_)
      all.push_back(name_of(k));
    return all;
  }

  static Key row(const std::string &name, const std::string &type, const std::string &unit, const std::string &allowed,
                 const Need &need, const std::string &own_preset, const std::string &meaning,
                 std::function<void(const Value &, T &, ReadContext &)> read)
  {
    return {{name, type, unit, need.preset.empty() ? own_preset : need.preset, allowed, meaning},
            need.required,
            std::move(read),
            {}};
  }

private:
  static std::string name_of(const Key &key) { return key.doc.path.substr(0, key.doc.path.find('[')); }

  void require_known(const Value &item, const Value &map) const
  {
    const std::vector<std::string> known = names();
    for (const std::string &name : known)
      if (name == item.key)
        return;
    throw UserError(item.key_where, "unknown key '" + item.key + "'" + (map.path.empty() ? "" : " in " + map.path) +
                                        did_you_mean(item.key, known) + "; allowed here: " + joined(known));
  }

  std::vector<Key> keys_;
  std::function<void(const Value &, T &, ReadContext &)> check_;
};
} // namespace amontons
