#pragma once
#include "amontons/solution/model.h"

#include <vector>

namespace amontons
{
/// A proper rigid motion x -> x + translation + (rotation - 1)(x - centre).
struct RigidMotion
{
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d centre{0, 0, 0}, translation{0, 0, 0}; ///< of the centre

  /// Of a point, from where it is.
  [[nodiscard]] Eigen::Vector3d way(const Eigen::Vector3d &x) const
  {
    return translation + (rotation * (x - centre) - (x - centre));
  }
  [[nodiscard]] RigidMotion inverse() const { return {rotation.transpose(), centre + translation, -translation}; }
  /// Exactly.
  [[nodiscard]] bool is_nil() const { return rotation.isIdentity(0) && translation.isZero(0); }
};

/// Rigid motions that supports give to the bodies between two states: the opposite of FreeMotions.
///
/// Fitted to the body's held nodes (least squares; Kabsch 1976), and so turned with them by whatever turns all.
/// Rotations in finite strain, where all that is held of a body is nodes in all components that tell one: two places in
/// the plane, three that are not in line in space; none in axisymmetry. Else the mean translation, by component.
///
/// The *observer* is carried by the supports of the body with most held nodes (the first of the deck among equals). He
/// stands still, in all that is asked of him, in small strain, and where the problem itself tells directions of space
/// apart: by an analytic body, a node or a rigid body held in some components only, a grounded spring.
class GivenMotions
{
public:
  /// Collective.
  explicit GivenMotions(const Model &model);

  /// Of each of the deck's bodies from one state to another. A body whose supports tell no rotation turns with the
  /// observer, and one without any goes with him. Collective.
  [[nodiscard]] std::vector<RigidMotion> of_bodies(const State &from, const State &to) const;
  /// The observer's. Collective.
  [[nodiscard]] RigidMotion of_observer(const State &from, const State &to) const;

  /// The state with its bodies moved, analytic ones excepted; multipliers as they are. @param motions by body
  [[nodiscard]] State moved(State state, const std::vector<RigidMotion> &motions) const;
  [[nodiscard]] State moved(State state, const RigidMotion &motion) const
  {
    return moved(std::move(state), std::vector<RigidMotion>(n_bodies_, motion));
  }

  /// Whether the displacement of a node is given in all components. [n_state_nodes]
  [[nodiscard]] const std::vector<char> &is_held() const { return is_held_; }

private:
  struct Fit;
  void find_bodies();
  void find_held();
  void choose_observer();
  [[nodiscard]] bool tells_directions() const;
  [[nodiscard]] std::vector<Fit> fits(const State &from, const State &to) const;
  [[nodiscard]] std::vector<Fit> translations(const State &from, const State &to) const;
  void fit_rotations(std::vector<Fit> &fits, const State &from, const State &to) const;
  /// Calls add(body, place in `from`, place in `to`) for own nodes that are held.
  template<class Add>
  void over_held(const State &from, const State &to, Add &&add) const;
  [[nodiscard]] Eigen::Vector3d place(const State &state, Index node) const;

  const Model &model_;
  std::size_t n_bodies_;
  bool rotates_;                  ///< whether rotations are looked for at all
  std::vector<int> body_of_node_; ///< [n_state_nodes] position in the deck's bodies, -1: none, or an analytic one
  std::vector<char> is_held_;
  int observer_ = -1; ///< the body that carries him; -1: he stands still
};
} // namespace amontons
