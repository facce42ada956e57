#include "amontons/bulk/loads_pressure.h"

#include "amontons/bulk/loads_terms.h"

namespace amontons
{
namespace
{
template<class Facet>
class Pressure final : public LoadTerm
{
public:
  Pressure(const LoadGeometry &geometry, EntityBlock block, std::shared_ptr<const Function> pressure, bool following,
           const SubdomainMatrix &matrix)
    : geometry_(geometry)
    , block_(std::move(block))
    , pressure_(std::move(pressure))
    , following_(following)
    , positions_(matrix, block_.nodes, Facet::nodes)
  {
  }
  [[nodiscard]] bool is_dead() const override { return !following_; }
  [[nodiscard]] bool has_constant_tangent() const override { return !following_; }

  void add_external(std::span<const double> displacement, double time, std::span<double> force) const override
  {
    for (std::size_t f = 0; f < size(); ++f)
    {
      const auto values = kernel_.force(places(f, displacement), pressures(f, time));
      for (int a = 0; a < Facet::nodes; ++a)
        for (int i = 0; i < Facet::dim; ++i)
          force[first_entry(f, a) + i] += values[a * Facet::dim + i];
    }
  }
  void add_tangent(std::span<const double> displacement, double time,
                   std::span<SubdomainMatrix> subdomains) const override
  {
    if (!following_)
      return;
    for (std::size_t f = 0; f < size(); ++f)
    {
      const typename Facet::Matrix K = -kernel_.derivative(places(f, displacement), pressures(f, time));
      positions_.add(subdomains[block_.subdomain], f, K, Facet::nodes, Facet::dim);
    }
  }

private:
  using NodalValues = typename Facet::template NodalValues<double>;

  [[nodiscard]] std::size_t size() const { return block_.nodes.size() / Facet::nodes; }
  [[nodiscard]] std::size_t first_entry(std::size_t facet, int a) const
  {
    return static_cast<std::size_t>(block_.nodes[facet * Facet::nodes + a]) * Facet::dim;
  }
  [[nodiscard]] NodalValues gather(std::size_t facet, std::span<const double> nodal) const
  {
    NodalValues out;
    for (int a = 0; a < Facet::nodes; ++a)
      for (int i = 0; i < Facet::dim; ++i)
        out(i, a) = nodal[first_entry(facet, a) + i];
    return out;
  }
  [[nodiscard]] NodalValues places(std::size_t facet, std::span<const double> displacement) const
  {
    NodalValues x = gather(facet, geometry_.points);
    if (following_)
      x += gather(facet, displacement);
    return x;
  }
  /// The expression is one of the reference place.
  [[nodiscard]] typename PressureKernel<Facet>::Pressures pressures(std::size_t facet, double time) const
  {
    const NodalValues X = gather(facet, geometry_.points);
    typename PressureKernel<Facet>::Pressures values;
    for (int q = 0; q < Facet::points; ++q)
    {
      std::array<double, 3> place{};
      Eigen::Map<Eigen::Matrix<double, Facet::dim, 1>>(place.data()) = kernel_.place(X, q);
      values[q] = (*pressure_)(time, place);
    }
    return values;
  }

  LoadGeometry geometry_;
  EntityBlock block_;
  std::shared_ptr<const Function> pressure_;
  bool following_;
  PressureKernel<Facet> kernel_;
  BlockPositions positions_;
};
} // namespace

std::unique_ptr<LoadTerm> make_pressure(const LoadGeometry &geometry, EntityBlock block,
                                        std::shared_ptr<const Function> pressure, bool following,
                                        const SubdomainMatrix &matrix)
{
  const auto make = [&]<class Facet>(Facet) -> std::unique_ptr<LoadTerm>
  { return std::make_unique<Pressure<Facet>>(geometry, std::move(block), std::move(pressure), following, matrix); };
  switch (block.shape)
  {
  case CellShape::segment:
    return geometry.axisymmetric ? make(FacetType<CellShape::segment, true>()) : make(FacetType<CellShape::segment>());
  case CellShape::triangle:
    return make(FacetType<CellShape::triangle>());
  case CellShape::quadrilateral:
    return make(FacetType<CellShape::quadrilateral>());
  default:
    throw InternalError("a pressure acts on segments, triangles and quadrilaterals");
  }
}
} // namespace amontons
