#pragma once
#include "amontons/bulk/cell_pattern.h"
#include "amontons/bulk/expression.h"
#include "amontons/bulk/loads_regions.h"

#include <map>
#include <memory>
#include <span>
#include <vector>

namespace amontons
{
/// Reference geometry that all loads share. Nodal vectors are those of BodyAssembly.
struct LoadGeometry
{
  int dim = 2;
  bool axisymmetric = false;
  std::span<const double> points; ///< [n_nodes * dim]
};

/// One load of one kind on one block of entities.
class LoadTerm
{
public:
  virtual ~LoadTerm() = default;

  /// The force does not depend on the displacement.
  [[nodiscard]] virtual bool is_dead() const { return true; }
  /// d(internal - external)/du depends neither on displacement nor on time.
  [[nodiscard]] virtual bool has_constant_tangent() const { return true; }

  virtual void add_external(std::span<const double> displacement, double time, std::span<double> force) const;
  virtual void add_internal(std::span<const double> displacement, double time, std::span<double> force) const;
  /// += d(internal - external)/du
  virtual void add_tangent(std::span<const double> displacement, double time,
                           std::span<SubdomainMatrix> subdomains) const;
};

/// Components 0, 1, 2 of a vector that are given; the others are zero.
using Components = std::map<int, Function>;

/// Parses components. @throws UserError: a component that the dimension does not have, an expression in error
Components parse_components(const std::map<int, Expression> &expressions, int dim, const SourceLocation &where);

/// Force per reference area on facets or per reference volume on cells.
std::unique_ptr<LoadTerm> make_distributed_force(const LoadGeometry &geometry, EntityBlock block,
                                                 std::shared_ptr<const Components> density);

/// Springs to the ground on facets, stiffness per reference area: an internal force.
std::unique_ptr<LoadTerm> make_springs(const LoadGeometry &geometry, EntityBlock block,
                                       std::shared_ptr<const Components> stiffness, const SubdomainMatrix &matrix);

/// A force on each of the nodes; in axisymmetry over the whole ring.
std::unique_ptr<LoadTerm> make_point_force(const LoadGeometry &geometry, std::vector<Index> nodes,
                                           std::shared_ptr<const Components> force);

/// Pressure on facets that look outwards; > 0 pushes inwards.
/// @param following on the current area along the current normal, else on the reference's. In plane stress the
///        thickness stays that of the reference.
std::unique_ptr<LoadTerm> make_pressure(const LoadGeometry &geometry, EntityBlock block,
                                        std::shared_ptr<const Function> pressure, bool following,
                                        const SubdomainMatrix &matrix);
} // namespace amontons
