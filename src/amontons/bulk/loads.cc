#include "amontons/bulk/loads.h"

#include <algorithm>

namespace amontons
{
Loads::Loads(const LoadGeometry &geometry, Strain strain, const LoadRegions &regions,
             const std::vector<BoundaryOptions> &boundary, std::span<const SubdomainMatrix> patterns)
  : geometry_(geometry)
  , strain_(strain)
{
  for (const BoundaryOptions &entry : boundary)
    if (!regions.is_rigid(entry))
      add_entry(entry, regions, patterns);
}

void Loads::add_entry(const BoundaryOptions &entry, const LoadRegions &regions,
                      std::span<const SubdomainMatrix> patterns)
{
  const auto components = [&](const std::map<int, Expression> &expressions)
  { return std::make_shared<const Components>(parse_components(expressions, geometry_.dim, entry.where)); };

  add_facet_loads(entry, regions, patterns);
  if (!entry.body_force.empty())
  {
    const auto density = components(entry.body_force);
    for (EntityBlock &block : regions.cells(entry))
      terms_.push_back(make_distributed_force(geometry_, std::move(block), density));
  }
  if (!entry.force.empty())
    terms_.push_back(make_point_force(geometry_, regions.points(entry), components(entry.force)));
}

void Loads::add_facet_loads(const BoundaryOptions &entry, const LoadRegions &regions,
                            std::span<const SubdomainMatrix> patterns)
{
  if (!entry.traction.empty())
  {
    const auto density =
        std::make_shared<const Components>(parse_components(entry.traction, geometry_.dim, entry.where));
    for (EntityBlock &block : regions.facets(entry, false))
      terms_.push_back(make_distributed_force(geometry_, std::move(block), density));
  }
  if (!entry.spring.empty())
  {
    const auto stiffness =
        std::make_shared<const Components>(parse_components(entry.spring, geometry_.dim, entry.where));
    for (EntityBlock &block : regions.facets(entry, false))
    {
      const SubdomainMatrix &pattern = patterns[block.subdomain];
      terms_.push_back(make_springs(geometry_, std::move(block), stiffness, pattern));
    }
  }
  if (entry.pressure)
  {
    const auto pressure = std::make_shared<const Function>(*entry.pressure);
    for (EntityBlock &block : regions.facets(entry, true))
    {
      const SubdomainMatrix &pattern = patterns[block.subdomain];
      terms_.push_back(make_pressure(geometry_, std::move(block), pressure, strain_ == Strain::finite, pattern));
    }
  }
}

bool Loads::has_constant_tangent() const
{
  return std::all_of(terms_.begin(), terms_.end(), [](const auto &term) { return term->has_constant_tangent(); });
}

void Loads::add_external(std::span<const double> displacement, double time, std::span<double> force) const
{
  if (dead_time_ != time)
  {
    dead_.assign(geometry_.points.size(), 0);
    for (const auto &term : terms_)
      if (term->is_dead())
        term->add_external(displacement, time, dead_);
    dead_time_ = time;
  }
  for (std::size_t i = 0; i < dead_.size(); ++i)
    force[i] += dead_[i];
  for (const auto &term : terms_)
    if (!term->is_dead())
      term->add_external(displacement, time, force);
}

void Loads::add_internal(std::span<const double> displacement, double time, std::span<double> force) const
{
  for (const auto &term : terms_)
    term->add_internal(displacement, time, force);
}

void Loads::add_tangent(std::span<const double> displacement, double time, std::span<SubdomainMatrix> subdomains) const
{
  for (const auto &term : terms_)
    term->add_tangent(displacement, time, subdomains);
}
} // namespace amontons
