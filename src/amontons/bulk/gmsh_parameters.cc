#include "amontons/bulk/gmsh_session.h"

#include <cctype>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <stdexcept>

namespace amontons
{
namespace
{
std::string read_text(const std::filesystem::path &file)
{
  std::ifstream in(file, std::ios::binary);
  if (!in)
    throw std::runtime_error("cannot read '" + file.string() + "'");
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

bool is_name_letter(char c)
{
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

/// Comments become blanks; strings stay (an Include has its file in one).
std::string without_comments(const std::string &text)
{
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i)
    if (text[i] == '"')
    {
      const std::size_t end = std::min(text.find('"', i + 1), text.size() - 1);
      out += text.substr(i, end - i + 1);
      i = end;
    }
    else if (text.compare(i, 2, "//") == 0)
    {
      i = std::min(text.find('\n', i), text.size());
      out += '\n';
    }
    else if (text.compare(i, 2, "/*") == 0)
    {
      i = std::min(text.find("*/", i + 2), text.size() - 1) + 1;
      out += ' ';
    }
    else
      out += text[i];
  return out;
}

/// Position after the next whole word `keyword`, or npos.
std::size_t find_after(const std::string &text, const std::string &keyword, std::size_t from)
{
  for (std::size_t at = text.find(keyword, from); at != std::string::npos; at = text.find(keyword, at + 1))
  {
    const std::size_t end = at + keyword.size();
    if ((at == 0 || !is_name_letter(text[at - 1])) && (end >= text.size() || !is_name_letter(text[end])))
      return end;
  }
  return std::string::npos;
}

/// Names at the head of each item of `[a = 1, b = {2, Name "c"}, d]`, `at` pointing at or before the bracket.
void collect_names(const std::string &text, std::size_t at, std::vector<std::string> &names)
{
  at = text.find_first_of("[;", at);
  if (at == std::string::npos || text[at] == ';')
    return;
  bool at_head = true;
  for (int depth = 0; at < text.size(); ++at)
  {
    const char c = text[at];
    if (c == '"')
      at = std::min(text.find('"', at + 1), text.size() - 1);
    else if (c == '[' || c == '{' || c == '(')
      ++depth;
    else if ((c == ']' || c == '}' || c == ')') && --depth == 0)
      return;
    else if (c == ',' && depth == 1)
      at_head = true;
    else if (at_head && depth == 1 && is_name_letter(c))
    {
      std::size_t end = at;
      while (end < text.size() && is_name_letter(text[end]))
        ++end;
      names.push_back(text.substr(at, end - at));
      at = end - 1;
      at_head = false;
    }
  }
}

void collect_from_file(const std::filesystem::path &file, std::set<std::filesystem::path> &seen,
                       std::vector<std::string> &names)
{
  if (!seen.insert(std::filesystem::weakly_canonical(file)).second)
    return;
  const std::string text = without_comments(read_text(file));
  for (std::size_t at = 0; (at = find_after(text, "DefineConstant", at)) != std::string::npos;)
    collect_names(text, at, names);
  for (std::size_t at = 0; (at = find_after(text, "Include", at)) != std::string::npos;)
  {
    const std::size_t begin = text.find('"', at), end = text.find('"', begin + 1);
    if (begin == std::string::npos || end == std::string::npos)
      return;
    collect_from_file(file.parent_path() / text.substr(begin + 1, end - begin - 1), seen, names);
  }
}
} // namespace

std::vector<std::string> geo_parameters(const std::string &file)
{
  std::set<std::filesystem::path> seen;
  std::vector<std::string> names;
  collect_from_file(file, seen, names);
  return names;
}
} // namespace amontons
