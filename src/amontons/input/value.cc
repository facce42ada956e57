#include "amontons/input/value.h"

#include <charconv>
#include <fstream>
#include <sstream>
#include <yaml-cpp/yaml.h>

namespace amontons
{
namespace
{
constexpr int max_depth = 32;

/// Where the marks of a piece of YAML lie: in the deck, or all of them in one override.
struct Origin
{
  SourceLocation fixed;
  bool has_marks = true;

  [[nodiscard]] SourceLocation place(const YAML::Mark &mark) const
  {
    return has_marks && !mark.is_null() ? SourceLocation{fixed.file, mark.line + 1, mark.column + 1} : fixed;
  }
};

Value converted(const YAML::Node &node, const Origin &origin, int depth = 0)
{
  Value value;
  value.where = origin.place(node.Mark());
  if (depth > max_depth)
    throw UserError(value.where, "lists and maps nested deeper than any deck needs");
  if (node.IsScalar())
  {
    value.kind = Value::Kind::scalar;
    value.text = node.Scalar();
    value.quoted = node.Tag() == "!";
  }
  else if (node.IsSequence())
  {
    value.kind = Value::Kind::list;
    for (const auto &item : node)
      value.items.push_back(converted(item, origin, depth + 1));
  }
  else if (node.IsMap())
  {
    value.kind = Value::Kind::map;
    for (const auto &entry : node)
    {
      const SourceLocation key_where = origin.place(entry.first.Mark());
      if (!entry.first.IsScalar())
        throw UserError(key_where, "a key must be a plain word");
      const std::string key = entry.first.Scalar();
      if (const Value *first = value.find(key))
        throw UserError(key_where,
                        "the key '" + key + "' stands twice in the same place; first at " + first->key_where.text());
      Value item = converted(entry.second, origin, depth + 1);
      item.key = key;
      item.key_where = key_where;
      value.items.push_back(std::move(item));
    }
  }
  return value;
}

Value parsed(const std::string &text, const Origin &origin)
{
  std::vector<YAML::Node> documents;
  try
  {
    documents = YAML::LoadAll(text);
  }
  catch (const YAML::Exception &error)
  {
    throw UserError(origin.place(error.mark), "not readable as YAML: " + error.msg);
  }
  if (documents.size() > 1)
    throw UserError(origin.place(documents[1].Mark()), "a second document; a deck is one");
  return documents.empty() ? Value{} : converted(documents[0], origin);
}

std::vector<std::string> split(const std::string &path)
{
  std::vector<std::string> parts;
  std::istringstream in(path);
  for (std::string part; std::getline(in, part, '.');)
    parts.push_back(part);
  return parts;
}

/// The item that `part` of an override's path names, made where a map lacks it.
Value &descend(Value &value, const std::string &part, const std::string &above, const SourceLocation &where)
{
  if (value.kind == Value::Kind::list)
  {
    std::size_t position = 0;
    const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), position);
    if (error != std::errc() || end != part.data() + part.size() || position >= value.items.size())
      throw UserError(where, "'" + above + "' is a list of " + std::to_string(value.items.size()) +
                                 "; its items are named by position from 0, not '" + part + "'");
    return value.items[position];
  }
  if (value.kind == Value::Kind::scalar)
    throw UserError(where, "'" + above + "' is " + value.described() + " and has no key '" + part + "'");
  if (value.kind == Value::Kind::null)
    value.where = where;
  value.kind = Value::Kind::map;
  for (Value &item : value.items)
    if (item.key == part)
      return item;
  Value &item = value.items.emplace_back();
  item.key = part;
  item.key_where = item.where = where;
  return item;
}

void set(Value &root, const std::string &override_text)
{
  const SourceLocation where{"--set " + override_text, 0, 0};
  const std::size_t equals = override_text.find('=');
  const std::vector<std::string> parts = split(override_text.substr(0, equals));
  if (equals == std::string::npos || parts.empty())
    throw UserError(where, "must be key.path=value, as in bodies.0.material.poisson=0.3");
  Value *value = &root;
  std::string above;
  for (const std::string &part : parts)
  {
    if (part.empty())
      throw UserError(where, "must be key.path=value; there is an empty key in the path");
    value = &descend(*value, part, above, where);
    above += (above.empty() ? "" : ".") + part;
  }
  Value replacement = parsed(override_text.substr(equals + 1), {where, false});
  replacement.key = value->key;
  replacement.key_where = where;
  replacement.where = where;
  *value = std::move(replacement);
}

void name_paths(Value &value)
{
  for (std::size_t i = 0; i < value.items.size(); ++i)
  {
    Value &item = value.items[i];
    const std::string name = value.kind == Value::Kind::map ? item.key : std::to_string(i);
    item.path = value.path.empty() ? name : value.path + "." + name;
    name_paths(item);
  }
}
} // namespace

const Value *Value::find(const std::string &name) const
{
  for (const Value &item : items)
    if (kind == Kind::map && item.key == name)
      return &item;
  return nullptr;
}

std::string Value::described() const
{
  switch (kind)
  {
  case Kind::null:
    return "nothing";
  case Kind::scalar:
    return (quoted ? "the text '" : "'") + text + "'";
  case Kind::list:
    return "a list";
  case Kind::map:
    return "a map of keys";
  }
  return "";
}

void Value::fail(const std::string &message) const
{
  throw UserError(where, path.empty() ? message : path + ": " + message);
}

Value read_values(const std::filesystem::path &file, const std::vector<std::string> &overrides)
{
  std::ifstream in(file, std::ios::binary);
  if (!in || std::filesystem::is_directory(file))
    throw UserError({file.string(), 0, 0}, "cannot read the deck");
  std::ostringstream text;
  text << in.rdbuf();
  Value root = parsed(text.str(), {{file.string(), 0, 0}, true});
  if (root.kind == Value::Kind::null)
    throw UserError({file.string(), 0, 0}, "the deck is empty");
  if (root.kind != Value::Kind::map)
    throw UserError(root.where, "the deck must be a map of keys, not " + root.described());
  for (const std::string &override_text : overrides)
    set(root, override_text);
  name_paths(root);
  return root;
}
} // namespace amontons
