#pragma once
#include "amontons/solution/newton.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

/// What the parts of Newton's method share; for its own sources.
namespace amontons
{
using Closed = std::vector<std::pair<int, Index>>;

/// The residual at a state, and what is needed to go on from it.
struct Newton::Evaluation
{
  bool valid = false;
  std::vector<double> pending;       ///< prescribed motion still to come, as in a state
  std::vector<double> residual;      ///< internal - external + contact, nodal
  std::vector<double> rhs;           ///< minus the residual, over the unknowns, prescribed motion included
  std::vector<ContactStatus> status; ///< of the own contact nodes
  std::uint64_t signature = 0;       ///< of all processes' statuses and faces
  double norm = 0, scale = 0;        ///< force
  double pending_motion = 0;         ///< length
};

struct Newton::Iterate
{
  bool has_trial = false; ///< nodes that close know where their slip starts
  State state;
  Evaluation at;
};

inline double norm2(std::span<const double> v)
{
  double sum = 0;
  for (const double x : v)
    sum += x * x;
  return sum;
}

inline double largest(std::span<const double> v)
{
  double out = 0;
  for (const double x : v)
    out = std::max(out, std::abs(x));
  return out;
}
} // namespace amontons
