#include "problem.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <sstream>

namespace amontons::test
{
namespace
{
/// Writes down everything a run tells.
class Recorder : public Observer
{
public:
  explicit Recorder(Record &record)
    : record_(record)
  {
  }

  void start(const SolutionState &initial, std::int64_t n_dofs) override
  {
    record_.mesh = *initial.mesh;
    record_.n_dofs = n_dofs;
    for (const ContactResult &contact : initial.contacts)
      record_.impactor_nodes.push_back(contact.impactor->node_ids);
    record_.states.push_back(without_pointers(initial));
  }
  void begin_increment(int, double time, double time_step) override
  {
    record_.attempts.push_back({time, time_step, {}, false, ""});
  }
  void iteration(const IterationReport &report) override { record_.attempts.back().iterations.push_back(report); }
  void accepted(const IncrementReport &, const SolutionState &state) override
  {
    record_.attempts.back().converged = true;
    record_.states.push_back(without_pointers(state));
  }
  void rejected(const IncrementReport &, const std::string &cause) override { record_.attempts.back().cause = cause; }
  void warning(const std::string &message) override { record_.warnings.push_back(message); }
  void finish(const SolutionState &last, const Counters &counters, const Timers &, const std::string &failure) override
  {
    record_.last = without_pointers(last);
    record_.counters = counters;
    record_.failure = failure;
  }

private:
  static SolutionState without_pointers(SolutionState state)
  {
    state.mesh = nullptr;
    state.nodes = nullptr;
    for (ContactResult &contact : state.contacts)
      contact.impactor = nullptr;
    return state;
  }

  Record &record_;
};
} // namespace

Point Record::reaction(const std::string &region) const
{
  for (const Reaction &reaction : state().reactions)
    if (reaction.region == region)
      return vector(reaction.force);
  ADD_FAILURE() << "no reaction of " << region;
  return Point::Constant(std::numeric_limits<double>::quiet_NaN());
}

std::vector<int> Record::iterations() const
{
  std::vector<int> out;
  for (const Attempt &attempt : attempts)
    if (attempt.converged)
      out.push_back(static_cast<int>(attempt.iterations.size()));
  return out;
}

Point Record::displacement(Index node) const
{
  Point u = Point::Zero();
  for (int c = 0; c < mesh.dim; ++c)
    u[c] = state().displacement[static_cast<std::size_t>(node) * mesh.dim + c];
  return u;
}

Index Record::node_at(const Point &where) const
{
  Index nearest = 0;
  for (Index node = 1; node < mesh.n_nodes(); ++node)
    if ((place(node) - where).norm() < (place(nearest) - where).norm())
      nearest = node;
  return nearest;
}

Problem::Problem(const Blocks &blocks, Kinematics kinematics, Strain strain)
{
  options.mesh = options_for(folder_->write("mesh.msh", blocks.mesh().text()), kinematics);
  options.strain = strain;
}

Problem::Problem(const std::string &geometry, Kinematics kinematics, Strain strain)
{
  options.mesh = options_for(folder_->write("mesh.geo", geometry), kinematics);
  options.strain = strain;
}

BodyOptions &Problem::elastic(const std::string &region, double young, double poisson)
{
  BodyOptions body;
  body.name = region;
  body.region = region;
  body.material = {options.strain == Strain::finite ? MaterialLaw::neo_hookean : MaterialLaw::linear_elastic, young,
                   poisson};
  body.where = {"deck.yaml", 10 + static_cast<int>(options.bodies.size()), 5};
  return options.bodies.emplace_back(body);
}

void Problem::rigid(const std::string &region)
{
  BodyOptions &body = elastic(region);
  body.material = {MaterialLaw::rigid, 0, 0};
}

void Problem::rigid(const std::string &name, const Shape &shape)
{
  rigid(name);
  options.bodies.back().region.clear();
  options.bodies.back().shape = shape;
}

BoundaryOptions &Problem::on(const std::string &region)
{
  BoundaryOptions entry;
  entry.region = region;
  entry.where = {"deck.yaml", 30 + static_cast<int>(options.boundary.size()), 5};
  return options.boundary.emplace_back(entry);
}

ContactOptions &Problem::contact(const std::string &impactor, const std::string &target, double mu)
{
  ContactOptions contact;
  contact.name = impactor + "-" + target;
  contact.impactor = impactor;
  contact.target = target;
  contact.friction_coefficient = mu;
  contact.where = {"deck.yaml", 20 + static_cast<int>(options.contact.size()), 5};
  return options.contact.emplace_back(contact);
}

Record Problem::solve(const Communicator &communicator) const
{
  Record record;
  Recorder recorder(record);
  const std::array<Observer *, 1> observers{&recorder};
  record.result = run(options, observers, nullptr, communicator);
  return record;
}

namespace
{
std::string trace(const Attempt &attempt)
{
  std::ostringstream out;
  out << "\nattempt at t = " << attempt.time << ":";
  for (const IterationReport &i : attempt.iterations)
    out << "\n  " << i.iteration << ": residual " << i.residual << ", correction " << i.correction << ", step "
        << i.step_length << ", " << i.n_status_changes << " changes, " << i.n_stick << " stick, " << i.n_slip
        << " slip " << i.remark;
  out << "\n  " << attempt.cause;
  return out.str();
}
} // namespace

Record Problem::converge() const
{
  Record record = solve();
  EXPECT_TRUE(record.result.converged) << record.result.failure << trace(record.attempts.front())
                                       << trace(record.attempts.back());
  return record;
}

Expression expression(const std::string &text)
{
  return {text, {"deck.yaml", 40, 1}};
}

Expression expression(double value)
{
  std::ostringstream text;
  text.precision(17);
  text << value;
  return expression(text.str());
}

Shape ground(int dim, double height)
{
  Shape shape;
  shape.point[dim - 1] = height;
  shape.axis = {0, 0, 0};
  shape.axis[dim - 1] = 1;
  return shape;
}

Point vector(const std::array<double, 3> &a)
{
  return {a[0], a[1], a[2]};
}

Point total_force(const ContactResult &contact)
{
  return vector(contact.normal_force) + vector(contact.tangential_force);
}

Point sum_of_nodes(const ContactResult &contact)
{
  Point sum = Point::Zero();
  for (std::size_t k = 0; k < contact.force.size(); ++k)
    sum[static_cast<int>(k) % contact.dim] += contact.force[k];
  return sum;
}

double relative_difference(std::span<const double> a, std::span<const double> b)
{
  EXPECT_EQ(a.size(), b.size());
  double difference = 0, size = 0;
  for (std::size_t k = 0; k < std::min(a.size(), b.size()); ++k)
  {
    difference = std::max(difference, std::abs(a[k] - b[k]));
    size = std::max(size, std::max(std::abs(a[k]), std::abs(b[k])));
  }
  return size > 0 ? difference / size : difference;
}
} // namespace amontons::test
