#pragma once
#include "amontons/detection/large_vector.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

namespace amontons
{
/// For each impactor node the target faces that were within some radius of it when it was last sought: as long as node
/// and target have moved less than what the closest face leaves of that radius, no other face can be closest (the list
/// of neighbours of molecular dynamics, Verlet 1967, here with a radius and a motion of each node's own).
template<int dim>
class NearFaces
{
public:
  struct Entry
  {
    std::uint32_t slot;
    float squared_distance; ///< not more than it was, but for round-off
  };

  void resize(std::size_t n_nodes)
  {
    if (nodes_.size() != n_nodes)
    {
      nodes_.assign(n_nodes, Node{});
      entries_.reserve(4 * n_nodes);
    }
  }

  [[nodiscard]] bool knows_faces() const { return !entries_.empty(); }

  /// Forgets the faces, of every node but the closest as a hint.
  void expire()
  {
    entries_.clear();
    for (Node &node : nodes_)
    {
      node.radius = -1;
      node.n = 0;
    }
  }

  /// A face that was the closest or near it; -1: none.
  [[nodiscard]] std::int64_t hint(std::size_t node) const { return nodes_[node].closest; }
  void set_hint(std::size_t node, std::int64_t slot) { nodes_[node].closest = static_cast<std::int32_t>(slot); }

  [[nodiscard]] std::span<const Entry> faces(std::size_t node) const
  {
    return {entries_.data() + nodes_[node].begin, nodes_[node].n};
  }
  /// Faces that are not listed are farther from x than this; negative where nothing is known.
  /// @param motion of node and target since, as motion() gives it
  [[nodiscard]] double clearance(std::size_t node, double motion) const { return nodes_[node].radius - motion; }
  /// How far node and target may have come nearer to each other.
  /// @param target_motion since the boxes of the search were made
  [[nodiscard]] double motion(std::size_t node, const double *x, double target_motion) const
  {
    double squared = 0;
    for (int c = 0; c < dim; ++c)
      squared += (x[c] - nodes_[node].x[c]) * (x[c] - nodes_[node].x[c]);
    return std::sqrt(squared) + target_motion;
  }

  /// Keeps only the hint.
  void forget(std::size_t node)
  {
    nodes_[node].radius = -1;
    nodes_[node].n = 0;
  }

  /// Starts the list of a node; add() appends to the list started last.
  void start(std::size_t node, const double *x, double radius)
  {
    Node &known = nodes_[node];
    for (int c = 0; c < dim; ++c)
      known.x[c] = x[c];
    known.radius = static_cast<float>(radius) * (1 - 1e-5F);
    known.begin = static_cast<std::uint32_t>(entries_.size());
    known.n = 0;
    last_ = node;
  }
  void add(std::uint32_t slot, float squared_distance)
  {
    if (entries_.size() == entries_.capacity())
      entries_.reserve(entries_.size() + entries_.size() / 4 + 64); // twice as much would mostly stay empty
    entries_.push_back({slot, squared_distance});
    ++nodes_[last_].n;
  }

private:
  struct Node
  {
    std::array<double, static_cast<std::size_t>(dim)> x{}; ///< where it was sought from
    float radius = -1;
    std::uint32_t begin = 0, n = 0;
    std::int32_t closest = -1;
  };
  LargeVector<Node> nodes_;
  LargeVector<Entry> entries_;
  std::size_t last_ = 0;
};
} // namespace amontons
