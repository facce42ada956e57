#pragma once
#include "amontons/contact/linearisation.h"
#include "amontons/contact/mortar.h"

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace amontons
{
/// Mortar in finite strain: the coupling of two surfaces where they are now, and the weights from which the slip of
/// this increment counts. Each process has both surfaces whole and couples the impactor nodes that it owns; i counts
/// these. Displacements are nodal vectors with the halo. Local.
class MovingMortar
{
public:
  /// Nodes of the surfaces go by ids. @param own ids of the own impactor nodes
  /// @param own_distance the user's; absent: some lengths of a face, or farther where more comes within reach
  MovingMortar(std::shared_ptr<const Surface> impactor, std::shared_ptr<const Surface> target, bool axisymmetric,
               std::span<const GlobalIndex> own, std::optional<double> own_distance);

  /// Nodes, by id, that the process must have.
  [[nodiscard]] std::vector<GlobalIndex> wanted_nodes() const;
  /// Takes their positions.
  void place(const std::function<Index(GlobalIndex)> &position_of);

  /// What is as near couples whatever the reach, unless the user gives a distance. [length]
  void set_least_distance(double distance);
  /// What comes within `reach` may couple from now on. [length]
  void set_reach(double reach);
  [[nodiscard]] double distance() const { return distance_; }
  /// Couples the sides in this configuration; what follows is of it. Does nothing where nothing has moved.
  /// @throws NumericalFailure if an impactor face is not convex
  void move_to(std::span<const double> displacement);
  /// Takes what the present coupling and the origins of slip need into nodes(), which otherwise only grow, so that
  /// patterns seldom change. @param forget leave out what is not needed now @return whether nodes() changed
  bool take_nodes(bool forget);

  [[nodiscard]] bool sees_target(Index i) const { return coupling_.sees_target(own_[i]); }
  /// Positions on the process of the nodes that element i is over: the impactor node, others of the impactor, the
  /// target's; the impactor node alone where it has seen no target.
  [[nodiscard]] std::vector<Index> nodes(Index i) const;
  [[nodiscard]] double gap(Index i) const;
  /// Parts of the own nodes' areas, as they are now, that see the target.
  [[nodiscard]] std::vector<double> covered_shares() const;
  /// Of node i, over nodes() where take_nodes() has brought them up to date, else over more.
  [[nodiscard]] ContactLinearisation linearise(Index i) const;

  /// The present configuration is the increment's beginning, where all slip starts.
  void begin_increment();
  /// Slip of node i starts on the way from the beginning to the present configuration, at a part of it, in [0, 1].
  void set_origin(Index i, double fraction);

private:
  /// Target nodes of the whole surface with what they count in a mean; ascending.
  using Mean = std::vector<std::pair<Index, double>>;
  /// Nodes of the whole surfaces.
  struct Nodes
  {
    std::vector<Index> impactors; ///< the own node, in 3D the two that e_1 is made of, then others as they came
    std::vector<Index> targets;   ///< as they came
    bool operator==(const Nodes &) const = default;
  };
  [[nodiscard]] std::vector<double> places(const Surface &surface, const std::vector<Index> &positions,
                                           std::span<const double> displacement) const;
  [[nodiscard]] Mean mean(Index i) const;
  /// With what the present coupling of node i and the origin of its slip need, too.
  [[nodiscard]] Nodes with_needed(Nodes nodes, Index i) const;

  std::shared_ptr<const Surface> impactor_, target_;
  bool axisymmetric_;
  std::vector<Index> own_;   ///< on the whole impactor
  std::vector<char> is_own_; ///< [n impactor nodes]
  std::vector<Index> impactor_positions_, target_positions_;
  std::optional<double> own_distance_;
  double least_distance_ = 0, distance_ = 0;
  std::vector<double> impactor_x_, target_x_; ///< where they were coupled; empty: nowhere
  MortarCoupling coupling_;
  std::vector<Nodes> nodes_;
  std::vector<Mean> start_, origin_;
};
} // namespace amontons
