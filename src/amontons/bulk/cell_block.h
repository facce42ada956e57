#pragma once
#include "amontons/bulk/cell_histories.h"
#include "amontons/bulk/cell_pattern.h"
#include "amontons/bulk/material_von_mises.h"

#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace amontons
{
/// Cells of one shape, body and subdomain, and where their matrices go.
struct CellList
{
  std::vector<Index> cells; ///< cells of the mesh, ascending
  std::vector<Index> nodes; ///< [n_cells * n_cell_nodes]
  Index subdomain = 0;
  ElasticModuli moduli;
  std::optional<Hardening> hardening; ///< of a plastic body
  bool mean_dilatation = false;
};

/// What one list of cells adds to the forces and to the stiffness. Nodal vectors are those of BodyAssembly.
class CellBlock
{
public:
  virtual ~CellBlock() = default;

  /// @return false where a cell is turned inside out
  [[nodiscard]] virtual bool add_tangent(std::span<const double> displacement, SubdomainMatrix &matrix) const = 0;
  [[nodiscard]] virtual bool add_force(std::span<const double> displacement, std::span<double> force) const = 0;
  /// Writes the rows of its own cells: xx, yy, zz, xy, yz, xz.
  virtual void write_stress(std::span<const double> displacement, std::span<double> stress) const = 0;

  /// Takes the displacement as the end of an increment: the next ones start from its plastic strain.
  virtual void commit(std::span<const double> /*displacement*/) {}
  /// Appends what was committed. / Takes it up. @param place of each cell of the mesh in `histories`, -1 for none
  virtual void append_history(CellHistories & /*histories*/) const {}
  virtual void set_history(const CellHistories & /*histories*/, std::span<const Index> /*place*/) {}
  /// Writes the rows of its own cells: mean equivalent plastic strain at the last commit.
  virtual void write_plastic_strain(std::span<double> /*strain*/) const {}

  /// Whether the force is the product of a constant stiffness with the displacement.
  [[nodiscard]] virtual bool is_linear() const = 0;
  [[nodiscard]] virtual const CellList &list() const = 0;
};

/// @param points reference coordinates of all nodes; must outlive the block
std::unique_ptr<CellBlock> make_cell_block(CellShape shape, Kinematics kinematics, Strain strain, CellList list,
                                           std::span<const double> points, const SubdomainMatrix &matrix);
} // namespace amontons
