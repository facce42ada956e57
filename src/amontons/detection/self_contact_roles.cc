#include "amontons/detection/self_contact_roles.h"

#include "amontons/base/disjoint_sets.h"
#include "amontons/base/error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace amontons
{
namespace
{
// Cosine of the turn between two nodes of a face beyond which they are not of one side.
constexpr float one_side = 0.5F;
// A side is finer if its nodes are smaller than this fraction of the other's.
constexpr double finer = 0.9;

bool contains(std::span<const Index> nodes, Index node)
{
  return std::find(nodes.begin(), nodes.end(), node) != nodes.end();
}
} // namespace

Roles::Roles(const Surface &surface, std::vector<Role> kept)
  : surface_(surface)
  , by_id_(surface.node_ids.size())
  , size_(tributary_areas(surface, false))
  , kept_(std::move(kept))
{
  kept_.resize(surface.node_ids.size(), Role::none);
  AMONTONS_ASSERT(surface.node_face_offsets.size() == surface.node_ids.size() + 1);
  std::iota(by_id_.begin(), by_id_.end(), 0);
  std::sort(by_id_.begin(), by_id_.end(), [&](Index a, Index b) { return surface.node_ids[a] < surface.node_ids[b]; });
  for (double &size : size_)
    size = std::pow(size, 1.0 / (surface.dim - 1));
}

template<typename Visit>
void Roles::visit_links(const Pairing &pairing, std::span<const Eigen::Vector3f> normals, Index node, Visit visit) const
{
  for (const Index other : surface_.face(pairing[node].face))
    if (pairing[other].face >= 0)
      visit(other, true);
  for (const Index f : surface_.faces_of_node(node))
    for (const Index other : surface_.face(f))
      if (other != node && pairing[other].face >= 0 && normals[node].dot(normals[other]) > one_side)
        visit(other, false);
}

// A node keeps its role unless it faces old nodes of its own role only.
void Roles::keep_old(const Pairing &pairing)
{
  role_.assign(kept_.size(), Role::none);
  for (Index node = 0; node < surface_.n_nodes(); ++node)
  {
    if (pairing[node].face < 0 || kept_[node] == Role::none)
      continue;
    bool faces_same = false, faces_other = false;
    for (const Index other : surface_.face(pairing[node].face))
      if (pairing[other].face >= 0)
      {
        faces_same = faces_same || kept_[other] == kept_[node];
        faces_other = faces_other || kept_[other] == opposite(kept_[node]);
      }
    if (faces_other || !faces_same)
      role_[node] = kept_[node];
  }
}

// From nodes with a role to those without: across contact at once, along the surface one step after another.
void Roles::spread(const Pairing &pairing, std::span<const Eigen::Vector3f> normals, std::vector<Index> front,
                   std::vector<Index> &reached)
{
  std::vector<Index> next;
  while (!front.empty())
  {
    for (std::size_t i = 0; i < front.size(); ++i)
      visit_links(pairing, normals, front[i],
                  [&](Index other, bool across)
                  {
                    if (across && role_[other] == Role::none)
                    {
                      role_[other] = opposite(role_[front[i]]);
                      front.push_back(other);
                    }
                  });
    reached.insert(reached.end(), front.begin(), front.end());
    next.clear();
    for (const Index node : front)
      visit_links(pairing, normals, node,
                  [&](Index other, bool across)
                  {
                    if (!across && role_[other] == Role::none)
                    {
                      role_[other] = role_[node];
                      next.push_back(other);
                    }
                  });
    front.swap(next);
  }
}

// The zone's colours so far are arbitrary: impactor is the side of its first node, that of the smallest id.
void Roles::decide_zone(std::span<const Index> zone)
{
  std::array<double, 2> sum{0, 0};
  std::array<Index, 2> n{0, 0};
  for (const Index node : zone)
  {
    const std::size_t side = role_[node] == Role::impactor ? 0 : 1;
    sum[side] += size_[node];
    ++n[side];
  }
  if (n[1] > 0 && sum[1] / n[1] < finer * sum[0] / n[0])
    for (const Index node : zone)
      role_[node] = opposite(role_[node]);
}

void Roles::count_zones(const Pairing &pairing, std::span<const Eigen::Vector3f> normals)
{
  std::vector<Index> parent(role_.size());
  std::iota(parent.begin(), parent.end(), 0);
  n_zones_ = 0;
  for (Index node = 0; node < surface_.n_nodes(); ++node)
    if (pairing[node].face >= 0)
    {
      ++n_zones_;
      visit_links(pairing, normals, node,
                  [&](Index other, bool) { parent[find_root(parent, other)] = find_root(parent, node); });
    }
  for (Index node = 0; node < surface_.n_nodes(); ++node)
    if (pairing[node].face >= 0 && find_root(parent, node) != node)
      --n_zones_;
}

void Roles::serve_uncovered(const Pairing &pairing)
{
  for (const Index node : by_id_)
  {
    if (role_[node] != Role::target)
      continue;
    const auto seen = surface_.face(pairing[node].face);
    impactor_[node] = std::none_of(seen.begin(), seen.end(), [this](Index other) { return impactor_[other]; });
  }
}

void Roles::part_mutual(const Pairing &pairing)
{
  for (const Index node : by_id_)
    if (impactor_[node])
      for (const Index other : surface_.face(pairing[node].face))
        if (impactor_[other] && contains(surface_.face(pairing[other].face), node))
          impactor_[other] = false;
}

void Roles::assign(Pairing &pairing, std::span<const Eigen::Vector3f> normals)
{
  keep_old(pairing);
  std::vector<Index> front, reached;
  for (const Index node : by_id_)
    if (role_[node] != Role::none)
      front.push_back(node);
  spread(pairing, normals, front, reached);
  for (const Index node : by_id_)
    if (pairing[node].face >= 0 && role_[node] == Role::none)
    {
      role_[node] = Role::impactor;
      reached.clear();
      spread(pairing, normals, {node}, reached);
      decide_zone(reached);
    }
  count_zones(pairing, normals);
  for (std::size_t node = 0; node < role_.size(); ++node)
    if (role_[node] != Role::none)
      kept_[node] = role_[node];

  impactor_.assign(role_.size(), false);
  for (std::size_t node = 0; node < role_.size(); ++node)
    impactor_[node] = role_[node] == Role::impactor;
  serve_uncovered(pairing);
  part_mutual(pairing);
  for (Index node = 0; node < surface_.n_nodes(); ++node)
    if (pairing[node].face >= 0 && !impactor_[node])
    {
      pairing[node] = Pair{};
      pairing[node].reason = NoPairReason::target_side;
    }
}
} // namespace amontons
