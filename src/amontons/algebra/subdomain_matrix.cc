#include "amontons/algebra/subdomain_matrix.h"

namespace amontons
{
void multiply_add(const SubdomainMatrix &matrix, std::span<const double> x, std::span<double> y)
{
  const int n = matrix.n_components;
  std::vector<double> local(static_cast<std::size_t>(matrix.n_rows()));
  for (std::size_t node = 0; node < matrix.nodes.size(); ++node)
    for (int c = 0; c < n; ++c)
      local[node * n + c] = x[static_cast<std::size_t>(matrix.nodes[node]) * n + c];
  for (std::size_t node = 0; node < matrix.nodes.size(); ++node)
    for (int c = 0; c < n; ++c)
    {
      const std::size_t row = node * n + c;
      double sum = 0;
      for (Index k = matrix.row_ptr[row]; k < matrix.row_ptr[row + 1]; ++k)
        sum += matrix.values[k] * local[matrix.col[k]];
      y[static_cast<std::size_t>(matrix.nodes[node]) * n + c] += sum;
    }
}
} // namespace amontons
