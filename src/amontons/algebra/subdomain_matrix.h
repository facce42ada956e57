#pragma once
#include "amontons/base/ids.h"

#include <span>
#include <vector>

namespace amontons
{
/// Stiffness of one subdomain in its own numbering, compressed rows over scalar unknowns.
///
/// Local unknown = local node * n_components + component. The pattern has whole node blocks, columns sorted.
struct SubdomainMatrix
{
  int n_components = 0;
  std::vector<Index> nodes;   ///< [n_local_nodes] node of the process (mesh) that each local node is
  std::vector<Index> row_ptr; ///< [n_local_nodes * n_components + 1]
  std::vector<Index> col;
  std::vector<double> values;

  [[nodiscard]] Index n_rows() const { return static_cast<Index>(row_ptr.size()) - 1; }
};

/// y += K x over process-wide nodal vectors [n_nodes * n_components].
void multiply_add(const SubdomainMatrix &matrix, std::span<const double> x, std::span<double> y);
} // namespace amontons
