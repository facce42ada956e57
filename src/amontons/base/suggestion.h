#pragma once
#include <string>
#include <vector>

namespace amontons
{
/// Number of letters to insert, drop, change or swap with their neighbour to make one word of the other, letter case
/// and the difference of '-' and '_' not counted (Damerau 1964, restricted form).
int edit_distance(const std::string &a, const std::string &b);

/// The candidate that was probably meant; empty where none is near. Ties go to the first.
std::string nearest_word(const std::string &word, const std::vector<std::string> &candidates);

/// " (did you mean 'x'?)" or nothing, to be put into a message.
std::string did_you_mean(const std::string &word, const std::vector<std::string> &candidates);

/// "a, b, c"
std::string joined(const std::vector<std::string> &words);
} // namespace amontons
