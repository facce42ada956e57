#pragma once
#include "amontons/surface/pairing.h"
#include "amontons/surface/surface.h"

#include <Eigen/Core>

#include <span>
#include <vector>

namespace amontons
{
/// Decides who is impactor and who is target where one surface is both (after Yastrebov, Cailletaud, Feyel 2011: all
/// nodes that see a face are found first, then each zone is told its sides).
///
/// Two nodes that face each other must not both be impactors: their constraints would depend on one another. So the
/// nodes that see a face are given two colours: nodes of one face alike, unless the surface turns by more than 60
/// degrees between them; the nodes of the face that a node sees the other colour. Colours spread from a start across
/// contact first, then along the surface, so that in a fold they meet at its crease. What is connected so is a *zone*.
///
/// - The zone's impactor is the finer side (mean size of the nodes' share of the surface, by 10 % at least), else the
///   one that holds the smallest node id.
/// - Nodes keep their role from detection to detection, out of contact too, and hand it on to those that join their
///   zone, until they face only nodes of the same role; these are then decided anew.
/// - A target node that sees a face without any impactor node is impactor for as long as that lasts, or its contact
///   would be missed.
/// - Two impactor nodes each on the other's face: the one of smaller id keeps its face.
class Roles
{
public:
  enum class Role : signed char
  {
    target = -1,
    none = 0,
    impactor = 1
  };

  /// Nodes that see no face may be left out of the surface, with the faces that hold none that does and are not seen.
  /// @param kept last roles of the nodes, by local index, [n_nodes]; empty: none
  explicit Roles(const Surface &surface, std::vector<Role> kept = {});

  /// Takes their faces from the nodes that are targets (NoPairReason::target_side).
  /// @param pairing what each node sees @param normals of the nodes now, see Exclusions
  void assign(Pairing &pairing, std::span<const Eigen::Vector3f> normals);

  /// Of the last assign(): zones of contact.
  [[nodiscard]] Index n_zones() const { return n_zones_; }
  /// The last role of each node, out of contact too.
  [[nodiscard]] std::span<const Role> kept() const { return kept_; }

private:
  static Role opposite(Role role) { return static_cast<Role>(-static_cast<int>(role)); }

  void keep_old(const Pairing &pairing);
  void spread(const Pairing &pairing, std::span<const Eigen::Vector3f> normals, std::vector<Index> front,
              std::vector<Index> &reached);
  void decide_zone(std::span<const Index> zone);
  void count_zones(const Pairing &pairing, std::span<const Eigen::Vector3f> normals);
  void serve_uncovered(const Pairing &pairing);
  void part_mutual(const Pairing &pairing);
  /// Calls visit(node, across) for each node with a face that is linked to this one, by contact or along the surface.
  template<typename Visit>
  void visit_links(const Pairing &pairing, std::span<const Eigen::Vector3f> normals, Index node, Visit visit) const;

  const Surface &surface_;
  std::vector<Index> by_id_;   ///< nodes by increasing id
  std::vector<double> size_;   ///< of the node's share of the surface, length
  std::vector<Role> kept_;     ///< the last role of each node
  std::vector<Role> role_;     ///< in this detection
  std::vector<bool> impactor_; ///< who keeps its face
  Index n_zones_ = 0;
};
} // namespace amontons
