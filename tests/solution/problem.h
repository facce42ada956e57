#pragma once
#include "amontons/solution/run.h"
#include "blocks.h"

namespace amontons::test
{
/// One attempt at an increment.
struct Attempt
{
  double time = 0, time_step = 0;
  std::vector<IterationReport> iterations;
  bool converged = false;
  std::string cause;
};

/// Everything that a run told. States outlive the run: their pointers are null.
struct Record
{
  [[nodiscard]] const SolutionState &state() const { return states.back(); }
  [[nodiscard]] const ContactResult &contact(int c = 0) const { return states.back().contacts[c]; }
  /// Of the reaction of a region or rigid body, in the last state.
  [[nodiscard]] Point reaction(const std::string &region) const;
  /// Newton iterations of the attempts that converged.
  [[nodiscard]] std::vector<int> iterations() const;
  [[nodiscard]] Point place(Index node) const { return test::place(mesh, node); }
  [[nodiscard]] Point displacement(Index node) const;
  /// Index of the node nearest to a place of the reference.
  [[nodiscard]] Index node_at(const Point &place) const;

  RunResult result;
  Mesh mesh;
  std::int64_t n_dofs = 0;
  std::vector<std::vector<GlobalIndex>> impactor_nodes; ///< of each contact
  std::vector<Attempt> attempts;
  std::vector<SolutionState> states; ///< converged ones, the initial one first
  std::vector<std::string> warnings;
  Counters counters;
  std::string failure;
  SolutionState last;
};

/// Options of a problem on a mesh of blocks, and the folder its mesh is in.
class Problem
{
public:
  Problem(const Blocks &blocks, Kinematics kinematics, Strain strain = Strain::small);
  /// @param geometry text of a .geo
  Problem(const std::string &geometry, Kinematics kinematics, Strain strain = Strain::small);

  /// Bodies are named as their regions.
  BodyOptions &elastic(const std::string &region, double young = 1, double poisson = 0.3);
  void rigid(const std::string &region);
  void rigid(const std::string &name, const Shape &shape);
  /// A new entry of `boundary`.
  BoundaryOptions &on(const std::string &region);
  ContactOptions &contact(const std::string &impactor, const std::string &target, double mu = 0);

  [[nodiscard]] Record solve(const Communicator &communicator = Communicator::alone()) const;
  /// Solves and expects convergence.
  [[nodiscard]] Record converge() const;

  ProblemOptions options;

private:
  std::shared_ptr<TemporaryFolder> folder_ = std::make_shared<TemporaryFolder>();
};

Expression expression(const std::string &text);
Expression expression(double value);

/// The half space below y (in 3D z) = height.
Shape ground(int dim, double height = 0);

Point vector(const std::array<double, 3> &a);
/// normal_force + tangential_force
Point total_force(const ContactResult &contact);
/// Sum of the nodes' forces.
Point sum_of_nodes(const ContactResult &contact);

/// Largest difference of two sets of numbers over the largest number.
double relative_difference(std::span<const double> a, std::span<const double> b);
} // namespace amontons::test
