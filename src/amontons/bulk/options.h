#pragma once
#include "amontons/base/error.h"
#include "amontons/surface/shape.h"

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace amontons
{
enum class Kinematics
{
  plane_strain,
  plane_stress,
  axisymmetric, ///< x is the radius, y the axis
  three_dimensional
};

enum class Strain
{
  small, ///< linear kinematics, contact geometry of the reference
  finite ///< everything current
};

struct MeshOptions
{
  std::string file;                         ///< .msh or .geo; relative to the deck's folder, made absolute by input
  std::map<std::string, double> parameters; ///< set in a .geo before it is read
  int refine = 0;                           ///< uniform refinements before the solve
  Kinematics kinematics = Kinematics::plane_strain;
  SourceLocation where;
};

enum class MaterialLaw
{
  linear_elastic,
  neo_hookean,
  von_mises, ///< elastic and plastic, small strain
  rigid
};

struct MaterialOptions
{
  MaterialLaw law = MaterialLaw::linear_elastic;
  double young = 0;   ///< stress
  double poisson = 0; ///< (-1, 0.5)
  // von Mises: the yield stress is yield_stress + isotropic_hardening p + saturation_gain (1 - exp(-saturation_rate
  // p)), p the equivalent plastic strain
  double yield_stress = 0;        ///< stress
  double isotropic_hardening = 0; ///< stress
  double saturation_gain = 0;     ///< stress
  double saturation_rate = 0;     ///< 1
  double kinematic_hardening = 0; ///< stress: slope of the uniaxial stress against plastic strain
};

struct BodyOptions
{
  std::string name;
  std::string region; ///< physical group of cells (rigid: also of faces); empty with `shape`
  MaterialOptions material;
  std::optional<Shape> shape;          ///< analytic rigid body
  std::optional<bool> mean_dilatation; ///< default: on for quadrilaterals and hexahedra, never in plane stress
  SourceLocation where;
};

/// A number or an expression of t, x, y, z (reference coordinates), as the user wrote it.
struct Expression
{
  std::string text;
  SourceLocation where;
};

/// What one entry of `boundary` prescribes. Components: 0, 1, 2 for x, y, z.
struct BoundaryOptions
{
  std::string region;                     ///< physical group (faces, edges, points) or a body's name
  std::vector<int> fix;                   ///< components held at zero
  std::map<int, Expression> displacement; ///< prescribed, length
  std::map<int, Expression> rotation;     ///< rigid bodies only, radians; about z in the plane
  std::map<int, Expression> traction;     ///< force per reference area
  std::optional<Expression> pressure;     ///< force per area (current area and normal in finite strain), > 0 pushes
  std::map<int, Expression> spring;       ///< stiffness per reference area and component, or
  std::map<int, Expression> force;      ///< rigid bodies (total; over the ring in axisymmetry; frees the component) and
                                        ///< groups of points (per node)
  std::map<int, Expression> moment;     ///< rigid bodies: frees the rotation
  std::map<int, Expression> body_force; ///< force per reference volume, on a body
  SourceLocation where;
};
} // namespace amontons
