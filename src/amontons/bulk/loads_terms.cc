#include "amontons/bulk/loads_terms.h"

#include "amontons/bulk/reference_element.h"

#include <Eigen/Dense>

#include <numbers>

namespace amontons
{
void LoadTerm::add_external(std::span<const double>, double, std::span<double>) const {}
void LoadTerm::add_internal(std::span<const double>, double, std::span<double>) const {}
void LoadTerm::add_tangent(std::span<const double>, double, std::span<SubdomainMatrix>) const {}

Components parse_components(const std::map<int, Expression> &expressions, int dim, const SourceLocation &where)
{
  Components components;
  for (const auto &[component, expression] : expressions)
  {
    if (component < 0 || component >= dim)
      throw UserError(expression.where.file.empty() ? where : expression.where,
                      "a component z is given, but the mesh lies in the plane: x and y are allowed");
    components.emplace(component, Function(expression));
  }
  return components;
}

namespace
{
/// Integrates functions of the reference place times shape functions over one entity of any dimension.
class ReferenceIntegral
{
public:
  ReferenceIntegral(const LoadGeometry &geometry, EntityBlock block)
    : geometry_(geometry)
    , block_(std::move(block))
    , element_(reference_element(block_.shape, 2))
  {
  }

  [[nodiscard]] std::size_t size() const { return block_.nodes.size() / element_.n_nodes; }
  [[nodiscard]] const EntityBlock &block() const { return block_; }
  [[nodiscard]] int dim() const { return geometry_.dim; }
  [[nodiscard]] int n_nodes() const { return element_.n_nodes; }
  [[nodiscard]] std::span<const Index> nodes(std::size_t entity) const
  {
    return {block_.nodes.data() + entity * element_.n_nodes, static_cast<std::size_t>(element_.n_nodes)};
  }

  /// Calls use(place, measure, N) at each point; the measure holds 2 pi R in axisymmetry.
  template<class Use>
  void each_point(std::size_t entity, const Use &use) const
  {
    const auto X = coordinates(entity);
    for (int q = 0; q < element_.n_points; ++q)
    {
      const Eigen::Map<const Eigen::VectorXd> N(&element_.values[static_cast<std::size_t>(q) * n_nodes()], n_nodes());
      const Eigen::Map<const Eigen::MatrixXd> dN(
          &element_.gradients[static_cast<std::size_t>(q) * n_nodes() * element_.dim], element_.dim, n_nodes());
      const Small jacobian = X * dN.transpose();
      const Small metric = jacobian.transpose() * jacobian;
      const Eigen::Vector3d place = X * N;
      const double ring = geometry_.axisymmetric ? 2 * std::numbers::pi * place[0] : 1;
      use(place, element_.weights[q] * std::sqrt(metric.determinant()) * ring, N);
    }
  }

private:
  using Small = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 3, 3>;

  [[nodiscard]] Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, 8> coordinates(std::size_t entity) const
  {
    Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, 8> X;
    X.setZero(3, n_nodes());
    for (int a = 0; a < n_nodes(); ++a)
      for (int d = 0; d < geometry_.dim; ++d)
        X(d, a) = geometry_.points[static_cast<std::size_t>(nodes(entity)[a]) * geometry_.dim + d];
    return X;
  }

  LoadGeometry geometry_;
  EntityBlock block_;
  ReferenceElement element_;
};

std::array<double, 3> as_array(const Eigen::Vector3d &place)
{
  return {place[0], place[1], place[2]};
}

class DistributedForce final : public LoadTerm
{
public:
  DistributedForce(const LoadGeometry &geometry, EntityBlock block, std::shared_ptr<const Components> density)
    : integral_(geometry, std::move(block))
    , density_(std::move(density))
  {
  }
  void add_external(std::span<const double>, double time, std::span<double> force) const override
  {
    for (std::size_t e = 0; e < integral_.size(); ++e)
      integral_.each_point(e,
                           [&](const Eigen::Vector3d &place, double measure, const auto &N)
                           {
                             for (const auto &[component, density] : *density_)
                             {
                               const double value = measure * density(time, as_array(place));
                               for (int a = 0; a < integral_.n_nodes(); ++a)
                                 force[integral_.nodes(e)[a] * integral_.dim() + component] += N[a] * value;
                             }
                           });
  }

private:
  ReferenceIntegral integral_;
  std::shared_ptr<const Components> density_;
};

class Springs final : public LoadTerm
{
public:
  Springs(const LoadGeometry &geometry, EntityBlock block, std::shared_ptr<const Components> stiffness,
          const SubdomainMatrix &matrix)
    : integral_(geometry, std::move(block))
    , stiffness_(std::move(stiffness))
    , positions_(matrix, integral_.block().nodes, integral_.n_nodes())
  {
  }
  [[nodiscard]] bool is_dead() const override { return false; }
  [[nodiscard]] bool has_constant_tangent() const override
  {
    return std::none_of(stiffness_->begin(), stiffness_->end(),
                        [](const auto &component) { return component.second.depends_on_time(); });
  }
  void add_internal(std::span<const double> displacement, double time, std::span<double> force) const override
  {
    const int dim = integral_.dim();
    for (std::size_t e = 0; e < integral_.size(); ++e)
    {
      const Matrix K = element_matrix(e, time);
      const auto nodes = integral_.nodes(e);
      for (int row = 0; row < K.rows(); ++row)
        for (int column = 0; column < K.cols(); ++column)
          force[nodes[row / dim] * dim + row % dim] +=
              K(row, column) * displacement[nodes[column / dim] * dim + column % dim];
    }
  }
  void add_tangent(std::span<const double>, double time, std::span<SubdomainMatrix> subdomains) const override
  {
    SubdomainMatrix &matrix = subdomains[integral_.block().subdomain];
    for (std::size_t e = 0; e < integral_.size(); ++e)
      positions_.add(matrix, e, element_matrix(e, time), integral_.n_nodes(), integral_.dim());
  }

private:
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 12, 12>;

  [[nodiscard]] Matrix element_matrix(std::size_t e, double time) const
  {
    const int dim = integral_.dim();
    Matrix K;
    K.setZero(integral_.n_nodes() * dim, integral_.n_nodes() * dim);
    integral_.each_point(e,
                         [&](const Eigen::Vector3d &place, double measure, const auto &N)
                         {
                           for (const auto &[component, stiffness] : *stiffness_)
                           {
                             const double value = measure * stiffness(time, as_array(place));
                             for (int a = 0; a < integral_.n_nodes(); ++a)
                               for (int b = 0; b < integral_.n_nodes(); ++b)
                                 K(a * dim + component, b * dim + component) += value * N[a] * N[b];
                           }
                         });
    return K;
  }

  ReferenceIntegral integral_;
  std::shared_ptr<const Components> stiffness_;
  BlockPositions positions_;
};

class PointForce final : public LoadTerm
{
public:
  PointForce(const LoadGeometry &geometry, std::vector<Index> nodes, std::shared_ptr<const Components> force)
    : geometry_(geometry)
    , nodes_(std::move(nodes))
    , force_(std::move(force))
  {
  }
  void add_external(std::span<const double>, double time, std::span<double> force) const override
  {
    for (const Index node : nodes_)
    {
      const std::size_t first = static_cast<std::size_t>(node) * geometry_.dim;
      std::array<double, 3> place{};
      std::copy_n(geometry_.points.begin() + static_cast<std::ptrdiff_t>(first), geometry_.dim, place.begin());
      for (const auto &[component, value] : *force_)
        force[first + component] += value(time, place);
    }
  }

private:
  LoadGeometry geometry_;
  std::vector<Index> nodes_;
  std::shared_ptr<const Components> force_;
};
} // namespace

std::unique_ptr<LoadTerm> make_distributed_force(const LoadGeometry &geometry, EntityBlock block,
                                                 std::shared_ptr<const Components> density)
{
  return std::make_unique<DistributedForce>(geometry, std::move(block), std::move(density));
}

std::unique_ptr<LoadTerm> make_springs(const LoadGeometry &geometry, EntityBlock block,
                                       std::shared_ptr<const Components> stiffness, const SubdomainMatrix &matrix)
{
  return std::make_unique<Springs>(geometry, std::move(block), std::move(stiffness), matrix);
}

std::unique_ptr<LoadTerm> make_point_force(const LoadGeometry &geometry, std::vector<Index> nodes,
                                           std::shared_ptr<const Components> force)
{
  return std::make_unique<PointForce>(geometry, std::move(nodes), std::move(force));
}
} // namespace amontons
