#include "amontons/solution/given_motions.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/SVD>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace amontons
{
namespace
{
/// Held nodes nearer to each other, or to one line, than this part of the distance they would have to differ by tell no
/// rotation: of their distance from the origin, and of their extent along the line.
constexpr double same_place = 1e-8, in_line = 1e-4;
/// Radians.
constexpr double whole_turn = 1e-9;

/// The proper rotation R with the least sum of |b - R a|^2. @param moments sum of b a^T
Eigen::Matrix3d best_rotation(int dim, const Eigen::Matrix3d &moments)
{
  if (dim == 2)
    return Eigen::AngleAxisd(std::atan2(moments(1, 0) - moments(0, 1), moments(0, 0) + moments(1, 1)),
                             Eigen::Vector3d::UnitZ())
        .toRotationMatrix();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(moments, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d u = svd.matrixU();
  u.col(2) *= (u * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1;
  return u * svd.matrixV().transpose();
}

/// @param spread sum of a a^T @param distance2 sum of the squares of the places themselves
bool tell_rotation(int dim, const Eigen::Matrix3d &spread, double distance2)
{
  if (spread.trace() <= same_place * same_place * distance2)
    return false;
  if (dim == 2)
    return true;
  const Eigen::Vector3d extents2 =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread, Eigen::EigenvaluesOnly).eigenvalues();
  return extents2[1] > in_line * in_line * extents2[2];
}

/// The rotation vector of `rotation` that is nearest to `other`.
Eigen::Vector3d rotation_vector_near(const Eigen::Matrix3d &rotation, const Eigen::Vector3d &other)
{
  const Eigen::AngleAxisd turn(rotation);
  constexpr double full = 2 * std::numbers::pi;
  // After whole turns the rotation itself tells no axis.
  const Eigen::Vector3d axis = turn.angle() > whole_turn || other.isZero(0) ? turn.axis() : other.normalized();
  return (turn.angle() + full * std::round((other.dot(axis) - turn.angle()) / full)) * axis;
}
} // namespace

/// What the held nodes of a body, on all processes, have in common.
struct GivenMotions::Fit
{
  bool any = false;
  bool in_all_components = false; ///< all of them, or none
  bool moves = false;             ///< any that is held in all components
  bool has_rotation = false;
  double n = 0, distance2 = 0;          ///< held in all components: how many, their distances from the origin
  RigidMotion motion;                   ///< about the mean place of those held in all components
  Eigen::Vector3d translation{0, 0, 0}; ///< mean of all, by component
};

GivenMotions::GivenMotions(const Model &model)
  : model_(model)
  , n_bodies_(model.options().bodies.size())
  , rotates_(!model.small_strain() && model.options().mesh.kinematics != Kinematics::axisymmetric)
{
  find_bodies();
  find_held();
  if (rotates_ && !tells_directions())
    choose_observer();
}

void GivenMotions::find_bodies()
{
  std::vector<double> body(model_.rigid_of_node().size(), -1);
  const std::span<const Index> body_of_cell = model_.bodies().body_of_cell();
  for (std::size_t cell = 0; cell < body_of_cell.size(); ++cell)
    for (const Index node : model_.mesh().cells[cell])
      body[node] = std::max(body[node], static_cast<double>(body_of_cell[cell]));
  model_.nodes().maximum(body);
  body_of_node_.assign(body.begin(), body.begin() + model_.n_state_nodes());
  for (const RigidBody &rigid : model_.rigid().bodies())
    for (const Index node : rigid.nodes)
      body_of_node_[node] = rigid.shape ? -1 : rigid.option;
}

/// Nodes of supports, and of rigid bodies none of whose components is free.
void GivenMotions::find_held()
{
  const int dim = model_.dim();
  is_held_.assign(body_of_node_.size(), 0);
  std::vector<int> n_held(is_held_.size(), 0);
  for (const HeldComponent &held : model_.supports().held())
    if (++n_held[held.nodal / dim] == dim)
      is_held_[held.nodal / dim] = 1;
  for (const RigidBody &rigid : model_.rigid().bodies())
  {
    const auto is_free = [](const RigidComponent &c) { return c.unknown >= 0; };
    if (!std::any_of(rigid.translation.begin(), rigid.translation.end(), is_free) &&
        !std::any_of(rigid.rotation.begin(), rigid.rotation.end(), is_free))
      for (const Index node : rigid.nodes)
        is_held_[node] = 1;
  }
}

/// Whether the problem, seen from a turned frame, would not be of its kind any more.
bool GivenMotions::tells_directions() const
{
  const int dim = model_.dim();
  bool tells = false;
  for (const BoundaryOptions &entry : model_.options().boundary)
    tells |= !entry.spring.empty();
  for (const RigidBody &rigid : model_.rigid().bodies())
  {
    int n_free = 0;
    for (const auto *components : {&rigid.translation, &rigid.rotation})
      for (const RigidComponent &component : *components)
        n_free += component.unknown >= 0 ? 1 : 0;
    tells |= rigid.shape.has_value() || (n_free > 0 && n_free != (dim == 2 ? 3 : 6));
  }
  for (const HeldComponent &held : model_.supports().held())
    tells |= is_held_[held.nodal / dim] == 0;
  return !model_.nodes().true_on_all(!tells);
}

void GivenMotions::choose_observer()
{
  const State reference = model_.initial_state();
  const std::vector<Fit> all = fits(reference, reference);
  double most = 0;
  for (std::size_t b = 0; b < all.size(); ++b)
    if (all[b].has_rotation && all[b].n > most)
    {
      observer_ = static_cast<int>(b);
      most = all[b].n;
    }
}

Eigen::Vector3d GivenMotions::place(const State &state, Index node) const
{
  Eigen::Vector3d x = model_.reference(node);
  for (int c = 0; c < model_.dim(); ++c)
    x[c] += state.displacement[static_cast<std::size_t>(node) * model_.dim() + c];
  return x;
}

template<class Add>
void GivenMotions::over_held(const State &from, const State &to, Add &&add) const
{
  for (Index node = 0; node < static_cast<Index>(is_held_.size()); ++node)
    if (is_held_[node] && body_of_node_[node] >= 0 && model_.nodes().is_own(node))
      add(body_of_node_[node], place(from, node), place(to, node));
}

std::vector<GivenMotions::Fit> GivenMotions::translations(const State &from, const State &to) const
{
  // By body: places and ways of nodes, how many, how many that move, squares of their distances from the origin; then
  // held components, how many of each, and their ways.
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(15, static_cast<Eigen::Index>(n_bodies_));
  over_held(from, to,
            [&](int b, const Eigen::Vector3d &before, const Eigen::Vector3d &after)
            {
              sums.col(b).segment<3>(0) += before;
              sums.col(b).segment<3>(3) += after - before;
              sums.col(b).segment<3>(6) += Eigen::Vector3d(1, before != after ? 1 : 0, before.squaredNorm());
            });
  const int dim = model_.dim();
  for (const HeldComponent &held : model_.supports().held())
    if (const Index node = held.nodal / dim; body_of_node_[node] >= 0 && model_.nodes().is_own(node))
    {
      auto column = sums.col(body_of_node_[node]);
      column[9 + held.nodal % dim] += 1;
      column[12 + held.nodal % dim] += to.displacement[held.nodal] - from.displacement[held.nodal];
    }
  model_.nodes().sum_over_processes({sums.data(), static_cast<std::size_t>(sums.size())});

  std::vector<Fit> out(n_bodies_);
  for (std::size_t b = 0; b < n_bodies_; ++b)
  {
    const auto column = sums.col(static_cast<Eigen::Index>(b));
    const Eigen::Vector3d counts = column.segment<3>(9);
    Fit &fit = out[b];
    fit.n = column[6];
    fit.moves = column[7] > 0;
    fit.distance2 = column[8];
    fit.any = fit.n > 0 || !counts.isZero(0);
    fit.in_all_components = counts.isZero(0) || counts.head(dim).isConstant(fit.n, 0);
    fit.motion.centre = column.segment<3>(0) / std::max(fit.n, 1.0);
    fit.motion.translation = column.segment<3>(3) / std::max(fit.n, 1.0);
    fit.translation = column.segment<3>(12).cwiseQuotient(counts.cwiseMax(1));
  }
  return out;
}

void GivenMotions::fit_rotations(std::vector<Fit> &fits, const State &from, const State &to) const
{
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(18, static_cast<Eigen::Index>(n_bodies_));
  using Matrix = Eigen::Map<Eigen::Matrix3d>;
  over_held(from, to,
            [&](int b, const Eigen::Vector3d &before, const Eigen::Vector3d &after)
            {
              const RigidMotion &mean = fits[b].motion;
              const Eigen::Vector3d arm = before - mean.centre;
              Matrix(sums.col(b).data()) += (after - mean.centre - mean.translation) * arm.transpose();
              Matrix(sums.col(b).data() + 9) += arm * arm.transpose();
            });
  model_.nodes().sum_over_processes({sums.data(), static_cast<std::size_t>(sums.size())});
  for (std::size_t b = 0; b < n_bodies_; ++b)
  {
    double *column = sums.col(static_cast<Eigen::Index>(b)).data();
    Fit &fit = fits[b];
    fit.has_rotation = fit.in_all_components && tell_rotation(model_.dim(), Matrix(column + 9), fit.distance2);
    if (fit.has_rotation && fit.moves)
      fit.motion.rotation = best_rotation(model_.dim(), Matrix(column));
  }
}

std::vector<GivenMotions::Fit> GivenMotions::fits(const State &from, const State &to) const
{
  std::vector<Fit> out = translations(from, to);
  if (rotates_)
    fit_rotations(out, from, to);
  return out;
}

std::vector<RigidMotion> GivenMotions::of_bodies(const State &from, const State &to) const
{
  const std::vector<Fit> all = fits(from, to);
  const RigidMotion observer = observer_ < 0 ? RigidMotion() : all[observer_].motion;
  std::vector<RigidMotion> out;
  for (const Fit &fit : all)
    if (fit.has_rotation)
      out.push_back(fit.motion);
    else if (fit.any)
      out.push_back({observer.rotation, fit.motion.centre, fit.translation});
    else
      out.push_back(observer);
  return out;
}

RigidMotion GivenMotions::of_observer(const State &from, const State &to) const
{
  return observer_ < 0 ? RigidMotion() : fits(from, to)[observer_].motion;
}

State GivenMotions::moved(State state, const std::vector<RigidMotion> &motions) const
{
  const int dim = model_.dim();
  for (Index node = 0; node < static_cast<Index>(body_of_node_.size()); ++node)
    if (const int b = body_of_node_[node]; b >= 0 && !motions[b].is_nil())
    {
      const Eigen::Vector3d x = place(state, node), way = motions[b].way(x);
      for (int c = 0; c < dim; ++c)
        state.displacement[static_cast<std::size_t>(node) * dim + c] += way[c];
    }
  for (std::size_t r = 0; r < state.rigid.size(); ++r)
  {
    const RigidBody &body = model_.rigid().bodies()[r];
    if (body.shape || motions[body.option].is_nil())
      continue;
    const RigidMotion &motion = motions[body.option];
    RigidState &rigid = state.rigid[r];
    rigid.translation += motion.way(body.point + rigid.translation);
    rigid.rotation = motion.rotation * rigid.rotation;
    rigid.rotation_vector = rotation_vector_near(rigid.rotation, rigid.rotation_vector);
  }
  return state;
}
} // namespace amontons
