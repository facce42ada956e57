#pragma once
#include "amontons/algebra/subdomain_matrix.h"
#include "amontons/bulk/cell_histories.h"
#include "amontons/bulk/mesh.h"
#include "amontons/bulk/options.h"

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace amontons
{
/// Forces and tangent of the deformable bodies and of the loads on them, subdomain by subdomain.
///
/// Nodal vectors run over all nodes of the mesh, [n_nodes * dim]; entries of nodes of no deformable cell stay zero.
/// In axisymmetry forces are over the whole ring; in the plane per unit thickness (in plane stress of the reference,
/// for a following pressure too).
class BodyAssembly
{
public:
  /// @param boundary only the loads are taken from it (traction, pressure, spring, body_force, force on points);
  ///        supports and rigid bodies are not this class's affair
  /// @param subdomain_of_cell [n_cells], 0 .. n_subdomains-1; empty: one subdomain
  /// @throws UserError: unknown region, region of the wrong dimension, expression that does not parse, a cell in two
  /// bodies
  BodyAssembly(const Mesh &mesh, Kinematics kinematics, Strain strain, const std::vector<BodyOptions> &bodies,
               const std::vector<BoundaryOptions> &boundary, std::span<const Index> subdomain_of_cell = {});
  ~BodyAssembly();
  BodyAssembly(const BodyAssembly &) = delete;
  BodyAssembly &operator=(const BodyAssembly &) = delete;

  /// Stiffness d(internal - external)/du of each subdomain, as the last assemble_tangent() left it.
  [[nodiscard]] std::span<const SubdomainMatrix> subdomains() const;

  /// True in small strain of elastic bodies without loads that change: one assemble_tangent() serves the whole run.
  [[nodiscard]] bool tangent_is_constant() const;

  /// Cells of a linear law are assembled at the first call only.
  /// @return false where a cell is turned inside out (det F <= 0); then the values are not to be used
  [[nodiscard]] bool assemble_tangent(std::span<const double> displacement, double time);

  /// Internal and external forces, overwritten; springs are internal. Once a tangent is assembled the internal forces
  /// of linear laws are its product with the displacement. @return as above
  [[nodiscard]] bool forces(std::span<const double> displacement, double time, std::span<double> internal,
                            std::span<double> external) const;

  /// Cauchy stress, cell means (in finite strain over the current volume), [n_cells * 6]: xx, yy, zz, xy, yz, xz; zero
  /// in rigid cells. @throws NumericalFailure where a cell is turned inside out
  [[nodiscard]] std::vector<double> stress(std::span<const double> displacement) const;

  /// Takes a displacement as the end of an increment. Until the next call all of the above starts from the plastic
  /// strain that is reached there; a displacement tried in between leaves no trace.
  void commit(std::span<const double> displacement);

  /// What plastic cells remember of the last commit; takes it up. @throws UserError where it is of other cells
  [[nodiscard]] CellHistories histories() const;
  void set_histories(const CellHistories &histories);

  /// Equivalent plastic strain at the last commit, cell means, zero in cells of other laws. [n_cells], or empty where
  /// no body is plastic
  [[nodiscard]] std::vector<double> plastic_strain() const;

  /// Body of each cell, position in `bodies`, -1 for none. [n_cells]
  [[nodiscard]] std::span<const Index> body_of_cell() const;

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};
} // namespace amontons
