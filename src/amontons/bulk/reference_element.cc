#include "amontons/bulk/reference_element.h"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_simplex_p.h>

// The only source that includes deal.II in this room: its headers take longer to compile than the room does.
namespace amontons
{
namespace
{
/// @param vertex deal.II's number of each of our nodes
template<int dim>
ReferenceElement tabulate(const dealii::FiniteElement<dim> &element, const dealii::Quadrature<dim> &rule,
                          const std::vector<unsigned int> &vertex)
{
  ReferenceElement out;
  out.dim = dim;
  out.n_nodes = static_cast<int>(vertex.size());
  out.n_points = static_cast<int>(rule.size());
  out.weights = rule.get_weights();
  for (const auto &point : rule.get_points())
    for (const unsigned int v : vertex)
    {
      out.values.push_back(element.shape_value(v, point));
      const auto gradient = element.shape_grad(v, point);
      for (int d = 0; d < dim; ++d)
        out.gradients.push_back(gradient[d]);
    }
  return out;
}

template<int dim>
ReferenceElement simplex(int order)
{
  std::vector<unsigned int> vertex;
  for (unsigned int v = 0; v <= dim; ++v)
    vertex.push_back(v);
  return tabulate<dim>(dealii::FE_SimplexP<dim>(1), dealii::QGaussSimplex<dim>(static_cast<unsigned int>(order)),
                       vertex);
}

/// deal.II runs through the vertices of a cube with x fastest, Gmsh and VTK round each square.
template<int dim>
ReferenceElement cube(int order)
{
  std::vector<unsigned int> vertex{0, 1, 3, 2, 4, 5, 7, 6};
  vertex.resize(1u << dim);
  if constexpr (dim == 1)
    vertex = {0, 1};
  return tabulate<dim>(dealii::FE_Q<dim>(1), dealii::QGauss<dim>(static_cast<unsigned int>(order)), vertex);
}
} // namespace

ReferenceElement reference_element(CellShape shape, int order)
{
  switch (shape)
  {
  case CellShape::segment:
    return cube<1>(order);
  case CellShape::triangle:
    return simplex<2>(order);
  case CellShape::quadrilateral:
    return cube<2>(order);
  case CellShape::tetrahedron:
    return simplex<3>(order);
  case CellShape::hexahedron:
    return cube<3>(order);
  }
  throw InternalError("reference_element: not a shape");
}
} // namespace amontons
