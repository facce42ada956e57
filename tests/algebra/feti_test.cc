#include "amontons/algebra/coupled_form.h"
#include "amontons/algebra/feti_form.h"
#include "amontons/base/error.h"
#include "element_blocks.h"

#include <gtest/gtest.h>

#include <map>

/// Total FETI against the direct solution of the coupled form.
namespace amontons
{
namespace
{
using test::ElementBlocks;
using test::ElementMaker;

enum class Case
{
  plane,
  axisymmetric,
  solid
};

/// Two lattices of bars, all nodes of a cell joined, one over the other, each cut into subdomains. The lower one is
/// held at its bottom and bears a rigid body on its right side; nodes of the upper one's bottom are the impactors.
class FetiTest : public testing::TestWithParam<Case>
{
protected:
  FetiTest()
  {
    add_lattice(0, 4);
    add_lattice(1.1, 3);
    for (std::size_t node = 0; node < places_.size(); ++node)
      for (int c = 0; c < 3; ++c)
        if (c < dim())
          options_.points.push_back(places_[node][c]);
    options_.axisymmetric = GetParam() == Case::axisymmetric;
    for (Index node = 0; node < n_nodes(); ++node)
      if (height(node) > 0.99 && height(node) < 1.2)
        options_.contact_nodes.push_back(node);
    choose_contacts();
  }

  [[nodiscard]] int dim() const { return GetParam() == Case::solid ? 3 : 2; }
  [[nodiscard]] Index n_nodes() const { return static_cast<Index>(places_.size()); }
  [[nodiscard]] double height(Index node) const { return places_[node][dim() - 1]; }

  void add_lattice(double low, int n)
  {
    const auto first = n_nodes();
    const int n_y = dim() == 3 ? n : n, n_z = dim() == 3 ? n : 0;
    for (int k = 0; k <= n_z; ++k)
      for (int j = 0; j <= n_y; ++j)
        for (int i = 0; i <= n; ++i)
        {
          Eigen::Vector3d x(double(i) / n, double(j) / n, double(k) / n);
          x += 0.02 * make_.numbers(3, 1);
          x[dim() - 1] += low;
          places_.push_back(x);
        }
    const auto node = [&](int i, int j, int k) { return first + i + (n + 1) * (j + (n_y + 1) * k); };
    std::map<int, std::vector<std::pair<Index, Index>>> bars;
    for (int k = 0; k < std::max(n_z, 1); ++k)
      for (int j = 0; j < n_y; ++j)
        for (int i = 0; i < n; ++i)
        {
          std::vector<Index> cell;
          for (int c = 0; c < (dim() == 3 ? 8 : 4); ++c)
            cell.push_back(node(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2)));
          for (const Index a : cell)
            for (const Index b : cell)
              if (a < b)
                bars[(2 * i / n) + 2 * (2 * j / n) + 4 * (dim() == 3 ? 2 * k / n : 0)].emplace_back(a, b);
        }
    for (const auto &[subdomain, list] : bars)
      add_subdomain(list);
  }

  void add_subdomain(const std::vector<std::pair<Index, Index>> &bars)
  {
    SubdomainMatrix matrix;
    matrix.n_components = dim();
    for (const auto &[a, b] : bars)
      for (const Index node : {a, b})
        matrix.nodes.push_back(node);
    std::sort(matrix.nodes.begin(), matrix.nodes.end());
    matrix.nodes.erase(std::unique(matrix.nodes.begin(), matrix.nodes.end()), matrix.nodes.end());
    const auto n = static_cast<Index>(matrix.nodes.size()) * dim();
    Eigen::MatrixXd k = Eigen::MatrixXd::Zero(n, n);
    const auto row = [&](Index node)
    { return dim() * (std::lower_bound(matrix.nodes.begin(), matrix.nodes.end(), node) - matrix.nodes.begin()); };
    for (const auto &[a, b] : bars)
    {
      const Eigen::VectorXd direction = (places_[b] - places_[a]).head(dim()).normalized();
      Eigen::VectorXd strain = Eigen::VectorXd::Zero(n);
      strain.segment(row(b), dim()) += direction;
      strain.segment(row(a), dim()) -= direction;
      k += (1 + 0.5 * make_.number()) * strain * strain.transpose();
    }
    if (GetParam() == Case::axisymmetric) // hoops
      for (Index i = 0; i < n; i += 2)
        k(i, i) += 0.3;
    matrix.row_ptr.push_back(0);
    for (Index i = 0; i < n; ++i)
    {
      for (Index j = 0; j < n; ++j)
      {
        matrix.col.push_back(j);
        matrix.values.push_back(k(i, j));
      }
      matrix.row_ptr.push_back(static_cast<Index>(matrix.col.size()));
    }
    subdomains_.push_back(std::move(matrix));
  }

  [[nodiscard]] bool of_lower(Index node) const { return node < (dim() == 3 ? 125 : 25); }

  /// @param held whether the upper lattice is held at its top
  void make_layout(bool held)
  {
    const int n_rigid = GetParam() == Case::axisymmetric ? 1 : dim() + 1;
    std::vector<Index> offsets{0};
    std::vector<Term> terms;
    Index next = n_rigid;
    for (Index node = 0; node < n_nodes(); ++node)
      for (int c = 0; c < dim(); ++c)
      {
        const bool rigid = of_lower(node) && places_[node][0] > 0.95 && height(node) > 0.1;
        const bool support = height(node) < 0.05 || (held && height(node) > 2) ||
                             (GetParam() == Case::axisymmetric && c == 0 && places_[node][0] < 0.05);
        if (rigid && GetParam() == Case::axisymmetric)
        {
          if (c == 1)
            terms.push_back({0, 1});
        }
        else if (rigid)
        {
          terms.push_back({c, 1});
          if (c != 2)
            terms.push_back({dim(), c == 0 ? -places_[node][1] : places_[node][0]});
        }
        else if (!support)
          terms.push_back({next++, 1});
        offsets.push_back(static_cast<Index>(terms.size()));
      }
    layout_ = {next, static_cast<Index>(patterns_.size()) * dim(), offsets, terms};
  }

  void choose_contacts()
  {
    std::vector<Index> targets, impactors;
    for (const Index node : options_.contact_nodes)
      if (of_lower(node) && places_[node][0] < 0.7)
        targets.push_back(node);
      else if (!of_lower(node) && places_[node][0] < 0.9)
        impactors.push_back(node);
    std::size_t first = 0;
    for (const Index impactor : impactors)
    {
      ConstraintPattern pattern;
      std::vector<Index> nodes{impactor};
      for (int k = 0; k < face_size(); ++k)
        nodes.push_back(targets[(first + k) % targets.size()]);
      first += 2;
      for (const Index node : nodes)
        for (int c = 0; c < dim(); ++c)
          pattern.nodal.push_back(node * dim() + c);
      for (int m = 0; m < dim(); ++m)
        pattern.multipliers[pattern.n_multipliers++] = static_cast<Index>(patterns_.size()) * dim() + m;
      patterns_.push_back(pattern);
    }
  }
  [[nodiscard]] int face_size() const { return dim() == 3 ? 4 : 2; }

  void start(bool held = true)
  {
    make_layout(held);
    feti_ = std::make_unique<FetiForm>(layout_, subdomains_, options_);
    coupled_ = std::make_unique<CoupledForm>(layout_, subdomains_, make_direct_solver());
    for (SystemForm *form : forms())
    {
      form->set_constraints(patterns_, {});
      form->prepare();
      form->update_subdomains();
    }
  }
  [[nodiscard]] std::array<SystemForm *, 2> forms() const { return {feti_.get(), coupled_.get()}; }

  void update(std::size_t k, const ElementBlocks &blocks)
  {
    for (SystemForm *form : forms())
      form->update_constraint(k, blocks.values());
  }

  /// The difference of the two forms' solutions, over the solution.
  double difference(const std::vector<double> &rhs)
  {
    std::vector<Eigen::VectorXd> x;
    for (SystemForm *form : forms())
    {
      x.emplace_back(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(rhs.size())));
      form->prepare();
      form->factorize();
      form->solve(rhs, {x.back().data(), rhs.size()}, 1e-12);
    }
    return (x[0] - x[1]).norm() / x[1].norm();
  }
  std::vector<double> random_rhs()
  {
    std::vector<double> out(static_cast<std::size_t>(layout_.n_unknowns()));
    for (double &x : out)
      x = make_.number();
    return out;
  }

  ElementMaker make_{dim(), face_size() + 1, 5};
  std::vector<Eigen::Vector3d> places_;
  std::vector<SubdomainMatrix> subdomains_;
  FetiOptions options_;
  std::vector<ConstraintPattern> patterns_;
  Layout layout_;
  std::unique_ptr<FetiForm> feti_;
  std::unique_ptr<CoupledForm> coupled_;
};

TEST_P(FetiTest, SolvesEveryStatusWithoutFactorisingAgain)
{
  start();
  const auto n_subdomains = static_cast<std::int64_t>(subdomains_.size());
  for (int round = 0; round < 4; ++round)
  {
    SCOPED_TRACE(round);
    for (std::size_t k = 0; k < patterns_.size(); ++k)
      update(k, (k + round) % 4 == 0   ? make_.open()
                : (k + round) % 4 == 1 ? make_.stick()
                : (k + round) % 4 == 2 ? make_.frictionless()
                                       : make_.slip(0.3, 0.4));
    EXPECT_LT(difference(random_rhs()), 1e-9);
  }
  EXPECT_EQ(feti_->counters().n_factorizations, n_subdomains);
  EXPECT_EQ(feti_->counters().n_pattern_builds, 1);
}

TEST_P(FetiTest, LumpedPreconditioner)
{
  options_.lumped = true;
  start();
  for (std::size_t k = 0; k < patterns_.size(); ++k)
    update(k, k % 2 ? make_.stick() : make_.frictionless());
  EXPECT_LT(difference(random_rhs()), 1e-9);
}

TEST_P(FetiTest, DirectionsOfFormerSolvesServeAgain)
{
  start();
  for (std::size_t k = 0; k < patterns_.size(); ++k)
    update(k, make_.stick());
  const std::vector<double> rhs = random_rhs();
  EXPECT_LT(difference(rhs), 1e-9);
  const std::int64_t first = feti_->counters().n_iterations;
  EXPECT_LT(difference(rhs), 1e-9);
  EXPECT_LE(3 * (feti_->counters().n_iterations - first), 2 * first);
  EXPECT_EQ(feti_->counters().n_preconditioner_setups, 1);
}

/// With its contacts open the upper lattice floats: its motions are held in the mean, loaded or not.
TEST_P(FetiTest, HoldsMotionsThatNothingElseHolds)
{
  start(false);
  for (std::size_t k = 0; k < patterns_.size(); ++k)
    update(k, make_.open());
  const int n_motions = GetParam() == Case::axisymmetric ? 1 : dim() == 2 ? 3 : 6;
  std::vector<std::vector<double>> modes;
  for (int m = 0; m < n_motions; ++m)
  {
    std::vector<double> nodal(static_cast<std::size_t>(layout_.n_nodal()), 0.0);
    for (Index node = 0; node < n_nodes(); ++node)
      if (!of_lower(node))
        for (int c = 0; c < dim(); ++c)
          nodal[node * dim() + c] = GetParam() == Case::axisymmetric ? c == 1
                                    : m < dim()                      ? c == m
                                    : c == m % dim()                 ? -places_[node][(m + 1) % dim()]
                                    : c == (m + 1) % dim()           ? places_[node][m % dim()]
                                                                     : 0;
    modes.emplace_back(static_cast<std::size_t>(layout_.n_displacement_unknowns()), 0.0);
    layout_.gather(nodal, modes.back());
  }
  for (SystemForm *form : forms())
    EXPECT_TRUE(form->set_held_modes(modes));
  coupled_->prepare();
  coupled_->update_subdomains();
  for (std::size_t k = 0; k < patterns_.size(); ++k)
    update(k, make_.open());
  EXPECT_LT(difference(random_rhs()), 1e-9);
  for (int m = 0; m < n_motions; ++m)
    EXPECT_NEAR(feti_->mode_reactions()[m], coupled_->mode_reactions()[m],
                1e-8 * std::abs(coupled_->mode_reactions()[0]));
}

TEST_P(FetiTest, FreeMotionIsNamed)
{
  start(false);
  for (std::size_t k = 0; k < patterns_.size(); ++k)
    feti_->update_constraint(k, make_.open().values());
  EXPECT_THROW(feti_->factorize(), NumericalFailure);
}

/// Springs between a subdomain and the ground take its kernel away.
TEST_P(FetiTest, SpringsHoldSubdomains)
{
  SubdomainMatrix &last = subdomains_.back();
  for (Index i = 0; i < last.n_rows(); ++i)
    last.values[last.row_ptr[i] + i] += 0.1;
  start(false);
  for (std::size_t k = 0; k < patterns_.size(); ++k)
    update(k, make_.open());
  EXPECT_LT(difference(random_rhs()), 1e-9);
}

INSTANTIATE_TEST_SUITE_P(All, FetiTest, testing::Values(Case::plane, Case::axisymmetric, Case::solid),
                         [](const auto &info) {
                           return info.param == Case::plane          ? "plane"
                                  : info.param == Case::axisymmetric ? "axisymmetric"
                                                                     : "solid";
                         });
} // namespace
} // namespace amontons
