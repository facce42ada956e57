#pragma once
#include "amontons/detection/detector.h"
#include "amontons/exchange/parallel_detector.h"
#include "surface/surfaces.h"

#include <functional>
#include <random>
#include <string>
#include <vector>

namespace amontons::test
{
/// A part of a surface, and where its nodes are on the whole.
struct Piece
{
  Surface surface;
  Index n_own = 0;
  std::vector<Index> nodes;

  [[nodiscard]] std::vector<double> of(const std::vector<double> &whole) const
  {
    std::vector<double> x;
    for (const Index node : nodes)
      for (int c = 0; c < surface.dim; ++c)
        x.push_back(whole[static_cast<std::size_t>(node) * surface.dim + c]);
    return x;
  }
};

using Choice = std::function<bool(Index)>;

/// The nodes chosen, then those of the faces chosen.
inline Piece piece_of(const Surface &whole, const Choice &own_node, const Choice &own_face)
{
  Piece piece;
  Surface &surface = piece.surface;
  surface.dim = whole.dim;
  std::vector<Index> place(whole.node_ids.size(), -1);
  const auto add = [&](Index node)
  {
    if (place[node] >= 0)
      return;
    place[node] = surface.n_nodes();
    piece.nodes.push_back(node);
    surface.node_ids.push_back(whole.node_ids[node]);
  };
  for (Index node = 0; node < whole.n_nodes(); ++node)
    if (own_node(node))
      add(node);
  piece.n_own = surface.n_nodes();
  for (Index f = 0; f < whole.n_faces(); ++f)
  {
    if (!own_face(f))
      continue;
    for (const Index node : whole.face(f))
    {
      add(node);
      surface.face_nodes.push_back(place[node]);
    }
    surface.face_offsets.push_back(static_cast<Index>(surface.face_nodes.size()));
    surface.face_ids.push_back(whole.face_ids[f]);
    if (!whole.face_bodies.empty())
      surface.face_bodies.push_back(whole.face_bodies[f]);
  }
  surface.reference = piece.of(whole.reference);
  surface.build_adjacency();
  return piece;
}

/// How surfaces are spread over processes.
enum class Spread
{
  random,   ///< each node and face on any process
  in_runs,  ///< a run of the numbering on each process
  apart,    ///< impactor and target never on the same process
  some_bare ///< the last process has nothing, the others a run of the numbering each
};

/// Who has the k-th of n things; the same on all processes.
class Dealer
{
public:
  Dealer(Spread spread, bool is_target, int n_processes, unsigned seed)
    : spread_(spread)
    , is_target_(is_target)
    , n_processes_(n_processes)
    , random_(seed)
  {
  }
  std::vector<Rank> deal(Index n)
  {
    const Rank half = n_processes_ / 2, first = spread_ == Spread::apart && is_target_ ? half : 0;
    const Rank last = spread_ == Spread::apart && !is_target_ ? std::max(half - 1, 0) : n_processes_ - 1;
    std::uniform_int_distribution<Rank> any(first, last);
    std::vector<Rank> owner;
    for (Index k = 0; k < n; ++k)
      owner.push_back(spread_ == Spread::in_runs     ? static_cast<Rank>(std::int64_t{k} * n_processes_ / n)
                      : spread_ == Spread::some_bare ? static_cast<Rank>(std::int64_t{k} * (n_processes_ - 1) / n)
                                                     : any(random_));
    return owner;
  }

private:
  Spread spread_;
  bool is_target_;
  int n_processes_;
  std::mt19937 random_;
};

inline Piece dealt(const Surface &whole, const Communicator &world, Spread spread, bool is_target)
{
  Dealer dealer(spread, is_target, world.size(), is_target ? 5 : 4);
  const std::vector<Rank> node_owner = dealer.deal(whole.n_nodes()), face_owner = dealer.deal(whole.n_faces());
  const Rank rank = world.rank();
  return piece_of(
      whole, [&](Index node) { return node_owner[node] == rank; }, [&](Index f) { return face_owner[f] == rank; });
}

inline bool is_same(const Pair &a, const Pair &b)
{
  return a.kind == b.kind && a.reason == b.reason && (a.face >= 0) == (b.face >= 0) && a.xi == b.xi && a.gap == b.gap &&
         a.distance == b.distance;
}

/// Id, ids of the nodes and their places.
inline bool is_same_face(const MetPairing &met, Index own, const Surface &target, const std::vector<double> &target_x,
                         Index one)
{
  const auto corners = met.target.face(own), real = target.face(one);
  bool same = met.target.face_ids[own] == target.face_ids[one] && corners.size() == real.size();
  for (std::size_t k = 0; same && k < corners.size(); ++k)
  {
    same = met.target.node_ids[corners[k]] == target.node_ids[real[k]];
    for (int c = 0; c < target.dim; ++c)
      same = same && met.target_x[static_cast<std::size_t>(corners[k]) * target.dim + c] ==
                         target_x[static_cast<std::size_t>(real[k]) * target.dim + c];
  }
  return same;
}

/// Own nodes of a process that have not met what one process's detector has found for them, to the last bit.
/// @param first set to what is wrong with the first of them
inline int count_wrong(const Surface &target, const std::vector<double> &target_x, const Pairing &expected,
                       const Piece &impactor, const MetPairing &met, std::string &first)
{
  int n_wrong = 0;
  for (Index node = 0; node < impactor.n_own; ++node)
  {
    const Pair &own = met.pairs.at(node), &one = expected[impactor.nodes[node]];
    if (is_same(own, one) && (own.face < 0 || is_same_face(met, own.face, target, target_x, one.face)))
      continue;
    if (++n_wrong == 1)
      first = "node " + std::to_string(impactor.surface.node_ids[node]) + ": kind " + std::to_string(int(own.kind)) +
              " for " + std::to_string(int(one.kind)) + ", reason " + std::to_string(int(own.reason)) + " for " +
              std::to_string(int(one.reason)) + ", gap " + std::to_string(own.gap) + " for " + std::to_string(one.gap);
  }
  return n_wrong;
}

/// 90 % of the nodes in a corner that takes a hundredth of the sheet, n by n faces.
inline Surface crowded_corner(int n, double height)
{
  const auto crowded = [](double s)
  {
    const double most = std::sqrt(0.9);
    return s < most ? 0.1 * s / most : 0.1 + 0.9 * (s - most) / (1 - most);
  };
  return sheet(n, n, false, [&](double s, double t) { return Point{crowded(s), crowded(t), height}; });
}
} // namespace amontons::test
