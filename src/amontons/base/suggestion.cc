#include "amontons/base/suggestion.h"

#include <algorithm>
#include <cctype>

namespace amontons
{
namespace
{
std::string folded(std::string word)
{
  for (char &c : word)
    c = c == '_' ? '-' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return word;
}
} // namespace

int edit_distance(const std::string &word_a, const std::string &word_b)
{
  const std::string a = folded(word_a), b = folded(word_b);
  const std::size_t n = b.size() + 1;
  std::vector<int> table((a.size() + 1) * n);
  const auto at = [&](std::size_t i, std::size_t j) -> int & { return table[i * n + j]; };
  for (std::size_t i = 0; i <= a.size(); ++i)
    for (std::size_t j = 0; j < n; ++j)
    {
      if (i == 0 || j == 0)
      {
        at(i, j) = static_cast<int>(i + j);
        continue;
      }
      const int changed = at(i - 1, j - 1) + (a[i - 1] == b[j - 1] ? 0 : 1);
      at(i, j) = std::min({at(i - 1, j) + 1, at(i, j - 1) + 1, changed});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        at(i, j) = std::min(at(i, j), at(i - 2, j - 2) + 1);
    }
  return table.back();
}

std::string nearest_word(const std::string &word, const std::vector<std::string> &candidates)
{
  std::string nearest;
  const int length = static_cast<int>(word.size());
  int least = std::min(std::max(1, (length + 1) / 3) + 1, length);
  for (const std::string &candidate : candidates)
    if (const int distance = edit_distance(word, candidate); distance < least)
    {
      least = distance;
      nearest = candidate;
    }
  return nearest;
}

std::string did_you_mean(const std::string &word, const std::vector<std::string> &candidates)
{
  const std::string nearest = nearest_word(word, candidates);
  return nearest.empty() ? "" : " (did you mean '" + nearest + "'?)";
}

std::string joined(const std::vector<std::string> &words)
{
  std::string out;
  for (const std::string &word : words)
    out += (out.empty() ? "" : ", ") + word;
  return out;
}
} // namespace amontons
