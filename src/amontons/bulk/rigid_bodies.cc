#include "amontons/bulk/rigid_bodies.h"

#include <Eigen/Geometry>

#include <algorithm>

namespace amontons
{
namespace
{
Eigen::Vector3d point_of(const Mesh &mesh, Index node)
{
  Eigen::Vector3d x = Eigen::Vector3d::Zero();
  for (int c = 0; c < mesh.dim; ++c)
    x[c] = mesh.points[static_cast<std::size_t>(node) * mesh.dim + c];
  return x;
}

Eigen::Matrix3d rotation_matrix(const Eigen::Vector3d &vector)
{
  const double angle = vector.norm();
  if (angle == 0)
    return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, vector / angle).toRotationMatrix();
}

void set_component(RigidComponent &component, RigidComponent::Kind kind, const Expression &expression,
                   const SourceLocation &where, const std::string &body)
{
  if (component.kind != RigidComponent::Kind::held)
    throw UserError(where, "conflicting conditions: the same component of rigid body '" + body +
                               "' is given twice; a component has either a displacement or a force");
  component.kind = kind;
  component.function.emplace(expression);
}
} // namespace

RigidBodies::RigidBodies(const Mesh &mesh, Kinematics kinematics, Strain strain, const std::vector<BodyOptions> &bodies,
                         const std::vector<BoundaryOptions> &boundary)
  : dim_(mesh.dim)
  , kinematics_(kinematics)
  , strain_(strain)
{
  for (std::size_t i = 0; i < bodies.size(); ++i)
  {
    if (bodies[i].material.law != MaterialLaw::rigid)
      continue;
    RigidBody body;
    body.name = bodies[i].name;
    body.option = static_cast<int>(i);
    body.shape = bodies[i].shape;
    if (body.shape)
    {
      body.nodes = {mesh.n_nodes() + n_extra_nodes_++};
      body.point = Eigen::Map<const Eigen::Vector3d>(body.shape->point.data());
    }
    else
    {
      body.nodes = find_group(mesh, bodies[i].region, -1, bodies[i].where).nodes();
      for (const Index node : body.nodes)
        body.point += point_of(mesh, node) / static_cast<double>(body.nodes.size());
    }
    bodies_.push_back(std::move(body));
    regions_.push_back(bodies[i].region);
  }
  for (const BoundaryOptions &entry : boundary)
    if (const int b = find(entry.region); b >= 0)
      read_conditions(entry, bodies_[b]);
  number_unknowns();
}

int RigidBodies::find(const std::string &region) const
{
  for (std::size_t b = 0; b < bodies_.size(); ++b)
    if (region == bodies_[b].name || (!regions_[b].empty() && region == regions_[b]))
      return static_cast<int>(b);
  return -1;
}

int RigidBodies::of_option(int option) const
{
  for (std::size_t b = 0; b < bodies_.size(); ++b)
    if (bodies_[b].option == option)
      return static_cast<int>(b);
  return -1;
}

void RigidBodies::read_conditions(const BoundaryOptions &entry, RigidBody &body)
{
  using Kind = RigidComponent::Kind;
  if (!entry.traction.empty() || entry.pressure || !entry.spring.empty() || !entry.body_force.empty())
    throw UserError(entry.where,
                    "rigid body '" + body.name +
                        "' takes displacement, rotation, force or moment; no traction, pressure, spring or "
                        "body force");
  const bool rotates = !entry.rotation.empty() || !entry.moment.empty();
  if (rotates && (body.shape || kinematics_ == Kinematics::axisymmetric))
    throw UserError(entry.where, body.shape
                                     ? "the analytic rigid body '" + body.name + "' does not rotate; mesh it if it must"
                                     : "a rigid body does not rotate in axisymmetry");
  for (const auto *conditions : {&entry.displacement, &entry.force})
    for (const auto &[component, expression] : *conditions)
    {
      if (kinematics_ == Kinematics::axisymmetric && component == 0)
        throw UserError(expression.where, "a rigid body moves only along the axis, y, in axisymmetry");
      set_component(body.translation[component], conditions == &entry.force ? Kind::free : Kind::prescribed, expression,
                    entry.where, body.name);
    }
  for (const auto *conditions : {&entry.rotation, &entry.moment})
    for (const auto &[component, expression] : *conditions)
      set_component(body.rotation[component], conditions == &entry.moment ? Kind::free : Kind::prescribed, expression,
                    entry.where, body.name);
  const auto has = [&](Kind kind)
  { return std::any_of(body.rotation.begin(), body.rotation.end(), [&](const auto &r) { return r.kind == kind; }); };
  if (strain_ == Strain::finite && has(Kind::free) && has(Kind::prescribed))
    throw UserError(entry.where, "rigid body '" + body.name +
                                     "' has a prescribed and a free rotation; in finite strain give one kind only");
}

void RigidBodies::number_unknowns()
{
  for (RigidBody &body : bodies_)
    for (auto *components : {&body.translation, &body.rotation})
      for (RigidComponent &component : *components)
        if (component.kind == RigidComponent::Kind::free)
          component.unknown = n_unknowns_++;
}

std::vector<RigidState> RigidBodies::prescribe(std::vector<RigidState> state, double time, double share) const
{
  using Kind = RigidComponent::Kind;
  for (std::size_t b = 0; b < bodies_.size(); ++b)
  {
    const std::array<double, 3> point{bodies_[b].point[0], bodies_[b].point[1], bodies_[b].point[2]};
    const auto go_to_value = [&](const RigidComponent &component, double &value)
    { value += share * ((component.kind == Kind::held ? 0 : (*component.function)(time, point)) - value); };
    const bool turns_freely = std::any_of(bodies_[b].rotation.begin(), bodies_[b].rotation.end(),
                                          [](const RigidComponent &r) { return r.kind == Kind::free; });
    for (int c = 0; c < 3; ++c)
    {
      if (const auto &t = bodies_[b].translation[c]; t.kind != Kind::free)
        go_to_value(t, state[b].translation[c]);
      // A body that turns freely adds up spins: their components are not those of a rotation.
      if (const auto &r = bodies_[b].rotation[c]; r.kind == Kind::prescribed || !turns_freely)
        go_to_value(r, state[b].rotation_vector[c]);
    }
    if (!turns_freely)
      state[b].rotation = rotation_matrix(state[b].rotation_vector);
  }
  return state;
}

std::vector<RigidState> RigidBodies::advance(std::vector<RigidState> state, std::span<const double> increment) const
{
  for (std::size_t b = 0; b < bodies_.size(); ++b)
  {
    Eigen::Vector3d spin = Eigen::Vector3d::Zero();
    for (int c = 0; c < 3; ++c)
    {
      if (const Index unknown = bodies_[b].translation[c].unknown; unknown >= 0)
        state[b].translation[c] += increment[unknown];
      if (const Index unknown = bodies_[b].rotation[c].unknown; unknown >= 0)
        spin[c] = increment[unknown];
    }
    state[b].rotation_vector += spin;
    state[b].rotation = rotation_matrix(spin) * state[b].rotation;
  }
  return state;
}

Eigen::Vector3d RigidBodies::displacement(int b, const RigidState &state, const Eigen::Vector3d &reference) const
{
  const Eigen::Vector3d arm = reference - bodies_[b].point;
  if (strain_ == Strain::small)
    return state.translation + state.rotation_vector.cross(arm);
  return state.translation + state.rotation * arm - arm;
}

Eigen::Vector3d RigidBodies::spin_velocity(int b, const RigidState &state, const Eigen::Vector3d &reference,
                                           int axis) const
{
  const Eigen::Vector3d arm = reference - bodies_[b].point;
  return Eigen::Vector3d::Unit(axis).cross(strain_ == Strain::small ? arm : state.rotation * arm);
}

void RigidBodies::add_forces(double time, std::span<double> forces) const
{
  for (const RigidBody &body : bodies_)
  {
    const std::array<double, 3> point{body.point[0], body.point[1], body.point[2]};
    for (const auto *components : {&body.translation, &body.rotation})
      for (const RigidComponent &component : *components)
        if (component.unknown >= 0)
          forces[component.unknown] += (*component.function)(time, point);
  }
}
} // namespace amontons
