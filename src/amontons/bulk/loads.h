#pragma once
#include "amontons/bulk/loads_terms.h"

#include <limits>
#include <memory>
#include <span>
#include <vector>

namespace amontons
{
/// All loads on the deformable bodies: traction, pressure, springs, body force, forces on points.
///
/// Springs count as internal forces, everything else as external. Nodal vectors are those of BodyAssembly.
class Loads
{
public:
  /// @param geometry its points must outlive this object
  /// @throws UserError as BodyAssembly
  Loads(const LoadGeometry &geometry, Strain strain, const LoadRegions &regions,
        const std::vector<BoundaryOptions> &boundary, std::span<const SubdomainMatrix> patterns);

  [[nodiscard]] bool has_constant_tangent() const;

  void add_external(std::span<const double> displacement, double time, std::span<double> force) const;
  void add_internal(std::span<const double> displacement, double time, std::span<double> force) const;
  /// += d(internal - external)/du
  void add_tangent(std::span<const double> displacement, double time, std::span<SubdomainMatrix> subdomains) const;

private:
  void add_entry(const BoundaryOptions &entry, const LoadRegions &regions, std::span<const SubdomainMatrix> patterns);
  void add_facet_loads(const BoundaryOptions &entry, const LoadRegions &regions,
                       std::span<const SubdomainMatrix> patterns);

  LoadGeometry geometry_;
  Strain strain_;
  std::vector<std::unique_ptr<LoadTerm>> terms_;
  /// Dead loads of the last time asked for: Newton's method asks for the same time again and again.
  mutable std::vector<double> dead_;
  mutable double dead_time_ = std::numeric_limits<double>::quiet_NaN();
};
} // namespace amontons
