#pragma once
#include "amontons/algebra/layout.h"
#include "amontons/algebra/subdomain_matrix.h"
#include "element_blocks.h"

#include <algorithm>
#include <map>
#include <vector>

namespace amontons::test
{
enum class Space
{
  plane,
  axisymmetric,
  solid
};

/// What a form is made of, in one numbering of nodes and unknowns.
struct FormProblem
{
  int dim = 2;
  std::vector<double> points; ///< [n_nodes * dim]
  std::vector<SubdomainMatrix> subdomains;
  std::vector<Index> contact_nodes;
  std::vector<ConstraintPattern> patterns;
  Index n_rigid = 0; ///< unknowns of the rigid body: the first ones
  Layout layout;
  Sharing nodes_sharing;

  [[nodiscard]] Index n_nodes() const { return static_cast<Index>(points.size()) / dim; }
};

/// Two lattices of bars, all nodes of a cell joined, one over the other, each cut into subdomains. The lower one is
/// held at its bottom and bears a rigid body on its right side; nodes of the upper one's bottom are the impactors.
class LatticeProblem : public FormProblem
{
public:
  explicit LatticeProblem(Space space)
    : make(space == Space::solid ? 3 : 2, space == Space::solid ? 5 : 3, 5)
    , space_(space)
  {
    dim = space == Space::solid ? 3 : 2;
    add_lattice(0, 4);
    n_lower_ = n_nodes();
    add_lattice(1.1, 3);
    for (Index node = 0; node < n_nodes(); ++node)
      if (height(node) > 0.99 && height(node) < 1.2)
        contact_nodes.push_back(node);
    pair_surfaces();
  }

  [[nodiscard]] Space space() const { return space_; }
  [[nodiscard]] int face_size() const { return dim == 3 ? 4 : 2; }
  [[nodiscard]] Eigen::VectorXd place(Index node) const
  {
    return Eigen::Map<const Eigen::VectorXd>(&points[node * dim], dim);
  }
  [[nodiscard]] double height(Index node) const { return points[node * dim + dim - 1]; }
  [[nodiscard]] bool of_lower(Index node) const { return node < n_lower_; }
  [[nodiscard]] bool is_rigid(Index node) const
  {
    return of_lower(node) && place(node)[0] > 0.95 && height(node) > 0.1;
  }

  /// A constraint of an impactor node (the first) and the nodes of a face.
  void add_contact(const std::vector<Index> &nodes)
  {
    ConstraintPattern pattern;
    for (const Index node : nodes)
      for (int c = 0; c < dim; ++c)
        pattern.nodal.push_back(node * dim + c);
    for (int m = 0; m < dim; ++m)
      pattern.multipliers[pattern.n_multipliers++] = static_cast<Index>(patterns.size()) * dim + m;
    patterns.push_back(pattern);
  }

  /// Other contacts: impactor nodes that are targets too, in chains and in a circle; a node in two contacts; the rigid
  /// body on either side; a node with held components in axisymmetry (the first ones).
  void entangle()
  {
    const std::vector<Index> upper = nodes_of(Side::upper), lower = nodes_of(Side::lower),
                             rigid = nodes_of(Side::rigid);
    patterns.clear();
    add_pair(upper[0], lower, 1);
    add_pair(lower[1], upper, 2);
    add_pair(upper[2], lower, 2);
    add_pair(lower[2], upper, 0);
    add_pair(upper[1], rigid, 0);
    add_pair(upper[1], lower, 0);
    add_pair(rigid[0], upper, 2);
  }

  /// Numbers the unknowns; after the contacts are there. @param held whether the upper lattice is held at its top
  void make_layout(bool held = true)
  {
    const bool axisymmetric = space_ == Space::axisymmetric;
    n_rigid = axisymmetric ? 1 : dim + 1;
    std::vector<Index> offsets{0};
    std::vector<Term> terms;
    Index next = n_rigid;
    for (Index node = 0; node < n_nodes(); ++node)
      for (int c = 0; c < dim; ++c)
      {
        const Eigen::VectorXd x = place(node);
        const bool support =
            height(node) < 0.05 || (held && height(node) > 2) || (axisymmetric && c == 0 && x[0] < 0.05);
        if (is_rigid(node) && axisymmetric)
        {
          if (c == 1)
            terms.push_back({0, 1});
        }
        else if (is_rigid(node))
        {
          terms.push_back({c, 1});
          if (c != 2)
            terms.push_back({dim, c == 0 ? -x[1] : x[0]});
        }
        else if (!support)
          terms.push_back({next++, 1});
        offsets.push_back(static_cast<Index>(terms.size()));
      }
    layout = {next, static_cast<Index>(patterns.size()) * dim, offsets, terms};
  }

  /// Rigid motions of the upper lattice, over the displacement unknowns.
  [[nodiscard]] std::vector<std::vector<double>> upper_motions() const
  {
    const int n_motions = space_ == Space::axisymmetric ? 1 : dim == 2 ? 3 : 6;
    std::vector<std::vector<double>> modes;
    for (int m = 0; m < n_motions; ++m)
    {
      std::vector<double> nodal(static_cast<std::size_t>(layout.n_nodal()), 0.0);
      for (Index node = n_lower_; node < n_nodes(); ++node)
        for (int c = 0; c < dim; ++c)
          nodal[node * dim + c] = space_ == Space::axisymmetric ? c == 1
                                  : m < dim                     ? c == m
                                  : c == m % dim                ? -place(node)[(m + 1) % dim]
                                  : c == (m + 1) % dim          ? place(node)[m % dim]
                                                                : 0;
      modes.emplace_back(static_cast<std::size_t>(layout.n_displacement_unknowns()), 0.0);
      layout.gather(nodal, modes.back());
    }
    return modes;
  }

  [[nodiscard]] std::vector<double> random_rhs()
  {
    std::vector<double> out(static_cast<std::size_t>(layout.n_unknowns()));
    for (double &x : out)
      x = make.number();
    return out;
  }

  /// Open, stick, frictionless and slip, in turn.
  [[nodiscard]] ElementBlocks any_status(int k)
  {
    return k % 4 == 0   ? make.open()
           : k % 4 == 1 ? make.stick()
           : k % 4 == 2 ? make.frictionless()
                        : make.slip(0.3, 0.4);
  }

  ElementMaker make;

private:
  using Bars = std::vector<std::pair<Index, Index>>;

  enum class Side
  {
    upper,
    lower,
    rigid
  };
  [[nodiscard]] std::vector<Index> nodes_of(Side side) const
  {
    std::vector<Index> out;
    for (Index node = 0; node < n_nodes(); ++node)
      if (side == Side::rigid   ? is_rigid(node)
          : side == Side::lower ? of_lower(node) && !is_rigid(node) && height(node) > 0.9
                                : !of_lower(node) && height(node) < 1.2)
        out.push_back(node);
    return out;
  }
  /// The node and a face of `nodes` from `first` on.
  void add_pair(Index impactor, const std::vector<Index> &nodes, std::size_t first)
  {
    std::vector<Index> all{impactor};
    for (int k = 0; k < face_size(); ++k)
      all.push_back(nodes[(first + k) % nodes.size()]);
    add_contact(all);
  }

  void add_lattice(double low, int n)
  {
    const Index first = n_nodes();
    const int n_z = dim == 3 ? n : 0;
    for (int k = 0; k <= n_z; ++k)
      for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i)
        {
          Eigen::Vector3d x(double(i) / n, double(j) / n, double(k) / n);
          x += 0.02 * make.numbers(3, 1);
          x[dim - 1] += low;
          points.insert(points.end(), x.data(), x.data() + dim);
        }
    const auto node = [&](int i, int j, int k) { return first + i + (n + 1) * (j + (n + 1) * k); };
    std::map<int, Bars> bars; ///< by subdomain: halves in each direction
    for (int k = 0; k < std::max(n_z, 1); ++k)
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i)
        {
          std::vector<Index> cell;
          for (int c = 0; c < (dim == 3 ? 8 : 4); ++c)
            cell.push_back(node(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2)));
          for (const Index a : cell)
            for (const Index b : cell)
              if (a < b)
                bars[(2 * i / n) + 2 * (2 * j / n) + 4 * (dim == 3 ? 2 * k / n : 0)].emplace_back(a, b);
        }
    for (const auto &[subdomain, list] : bars)
      add_subdomain(list);
  }

  void add_subdomain(const Bars &bars)
  {
    SubdomainMatrix matrix;
    matrix.n_components = dim;
    for (const auto &[a, b] : bars)
      for (const Index node : {a, b})
        matrix.nodes.push_back(node);
    std::sort(matrix.nodes.begin(), matrix.nodes.end());
    matrix.nodes.erase(std::unique(matrix.nodes.begin(), matrix.nodes.end()), matrix.nodes.end());
    const auto n = static_cast<Index>(matrix.nodes.size()) * dim;
    Eigen::MatrixXd k = Eigen::MatrixXd::Zero(n, n);
    const auto row = [&](Index node)
    { return dim * (std::lower_bound(matrix.nodes.begin(), matrix.nodes.end(), node) - matrix.nodes.begin()); };
    for (const auto &[a, b] : bars)
    {
      const Eigen::VectorXd direction = (place(b) - place(a)).normalized();
      Eigen::VectorXd strain = Eigen::VectorXd::Zero(n);
      strain.segment(row(b), dim) += direction;
      strain.segment(row(a), dim) -= direction;
      k += (1 + 0.5 * make.number()) * strain * strain.transpose();
    }
    if (space_ == Space::axisymmetric) // hoops
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
    subdomains.push_back(std::move(matrix));
  }

  void pair_surfaces()
  {
    std::vector<Index> targets, impactors;
    for (const Index node : contact_nodes)
      if (of_lower(node) && place(node)[0] < 0.7)
        targets.push_back(node);
      else if (!of_lower(node) && place(node)[0] < 0.9)
        impactors.push_back(node);
    std::size_t first = 0;
    for (const Index impactor : impactors)
    {
      std::vector<Index> nodes{impactor};
      for (int k = 0; k < face_size(); ++k)
        nodes.push_back(targets[(first + k) % targets.size()]);
      first += 2;
      add_contact(nodes);
    }
  }

  Space space_;
  Index n_lower_ = 0;
};
} // namespace amontons::test
