#pragma once
#include "amontons/bulk/cell_geometry.h"

#include <gtest/gtest.h>

#include <complex>
#include <random>
#include <vector>

/// Cells of random shape and displacement, for derivatives by complex steps.
namespace amontons
{
using Complex = std::complex<double>;

/// Corners of the reference cell in the order of Gmsh.
inline constexpr double corners[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                         {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};

template<class Cell>
struct RandomCell
{
  static std::vector<bool> mean_dilatation()
  {
    return Cell::plane_stress ? std::vector<bool>{false} : std::vector<bool>{false, true};
  }
  using NodalValues = typename Cell::template NodalValues<double>;
  using ComplexValues = typename Cell::template NodalValues<Complex>;

  static NodalValues values(unsigned seed, double size)
  {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> value(-size, size);
    return NodalValues::NullaryExpr([&] { return value(random); });
  }
  static NodalValues reference(unsigned seed)
  {
    NodalValues X = values(seed, 0.15);
    for (int a = 0; a < Cell::nodes; ++a)
      for (int d = 0; d < Cell::dim; ++d)
        X(d, a) += Cell::simplex ? (a == d + 1) : corners[a][d];
    X.row(0).array() += 0.4; // a radius
    return X;
  }
  /// u with an imaginary step of 1e-40 of one unknown.
  static ComplexValues step(const NodalValues &u, int unknown)
  {
    ComplexValues out = u.template cast<Complex>();
    out(unknown % Cell::dim, unknown / Cell::dim) += Complex(0, 1e-40);
    return out;
  }
};

/// Every kind of small-strain cell.
using AllCells = testing::Types<CellType<CellShape::triangle, Kinematics::plane_strain>,
                                CellType<CellShape::triangle, Kinematics::plane_stress>,
                                CellType<CellShape::triangle, Kinematics::axisymmetric>,
                                CellType<CellShape::quadrilateral, Kinematics::plane_strain>,
                                CellType<CellShape::quadrilateral, Kinematics::plane_stress>,
                                CellType<CellShape::quadrilateral, Kinematics::axisymmetric>,
                                CellType<CellShape::tetrahedron, Kinematics::three_dimensional>,
                                CellType<CellShape::hexahedron, Kinematics::three_dimensional>>;
} // namespace amontons
