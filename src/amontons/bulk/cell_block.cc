#include "amontons/bulk/cell_block.h"

#include "amontons/bulk/cell_finite.h"
#include "amontons/bulk/cell_plastic.h"
#include "amontons/bulk/cell_small.h"

namespace amontons
{
namespace
{
/// The loop over cells; Derived tells what is done in one.
template<class Cell>
class TypedBlock : public CellBlock
{
public:
  using NodalValues = typename Cell::template NodalValues<double>;
  using Vector = typename Cell::template Vector<double>;

  TypedBlock(CellList list, std::span<const double> points, const SubdomainMatrix &matrix)
    : list_(std::move(list))
    , points_(points)
    , positions_(matrix, list_.nodes, Cell::nodes)
  {
  }
  [[nodiscard]] const CellList &list() const override { return list_; }

protected:
  [[nodiscard]] std::size_t size() const { return list_.cells.size(); }
  [[nodiscard]] CellPoints<Cell> geometry(std::size_t cell) const { return tables_.at(gather(cell, points_)); }

  [[nodiscard]] NodalValues gather(std::size_t cell, std::span<const double> nodal) const
  {
    NodalValues out;
    for (int a = 0; a < Cell::nodes; ++a)
      for (int i = 0; i < Cell::dim; ++i)
        out(i, a) = nodal[first_entry(cell, a) + i];
    return out;
  }
  void scatter(std::size_t cell, const Vector &values, std::span<double> nodal) const
  {
    for (int a = 0; a < Cell::nodes; ++a)
      for (int i = 0; i < Cell::dim; ++i)
        nodal[first_entry(cell, a) + i] += values[a * Cell::dim + i];
  }
  template<class Matrix>
  void scatter(std::size_t cell, const Matrix &K, SubdomainMatrix &matrix) const
  {
    positions_.add(matrix, cell, K, std::integral_constant<int, Cell::nodes>(),
                   std::integral_constant<int, Cell::dim>());
  }
  void write(std::size_t cell, const Eigen::Matrix<double, 6, 1> &value, std::span<double> stress) const
  {
    std::copy(value.begin(), value.end(), stress.begin() + static_cast<std::ptrdiff_t>(6) * list_.cells[cell]);
  }

  CellList list_;

private:
  [[nodiscard]] std::size_t first_entry(std::size_t cell, int a) const
  {
    return static_cast<std::size_t>(list_.nodes[cell * Cell::nodes + a]) * Cell::dim;
  }

  std::span<const double> points_;
  CellTables<Cell> tables_;
  BlockPositions positions_;
};

template<class Cell>
class SmallStrainBlock final : public TypedBlock<Cell>
{
public:
  using Base = TypedBlock<Cell>;
  using Base::Base;

  [[nodiscard]] bool is_linear() const override { return true; }
  [[nodiscard]] bool add_tangent(std::span<const double>, SubdomainMatrix &matrix) const override
  {
    for (std::size_t c = 0; c < this->size(); ++c)
      this->scatter(c, stiffness(c), matrix);
    return true;
  }
  [[nodiscard]] bool add_force(std::span<const double> displacement, std::span<double> force) const override
  {
    for (std::size_t c = 0; c < this->size(); ++c)
    {
      const auto u = this->gather(c, displacement);
      const typename Base::Vector f = stiffness(c) * Eigen::Map<const typename Base::Vector>(u.data());
      this->scatter(c, f, force);
    }
    return true;
  }
  void write_stress(std::span<const double> displacement, std::span<double> stress) const override
  {
    for (std::size_t c = 0; c < this->size(); ++c)
      this->write(c, small_strain_stress<Cell>(this->geometry(c), this->list_.moduli, this->gather(c, displacement)),
                  stress);
  }

private:
  [[nodiscard]] typename Cell::template Matrix<double> stiffness(std::size_t c) const
  {
    return small_strain_stiffness<Cell>(this->geometry(c), this->list_.moduli, this->list_.mean_dilatation);
  }
};

template<class Cell>
class FiniteStrainBlock final : public TypedBlock<Cell>
{
public:
  using TypedBlock<Cell>::TypedBlock;

  [[nodiscard]] bool is_linear() const override { return false; }
  [[nodiscard]] bool add_tangent(std::span<const double> displacement, SubdomainMatrix &matrix) const override
  {
    return each(displacement, [&](std::size_t c, const auto &cell) { this->scatter(c, cell.tangent(), matrix); });
  }
  [[nodiscard]] bool add_force(std::span<const double> displacement, std::span<double> force) const override
  {
    return each(displacement, [&](std::size_t c, const auto &cell) { this->scatter(c, cell.force(), force); });
  }
  void write_stress(std::span<const double> displacement, std::span<double> stress) const override
  {
    if (!each(displacement, [&](std::size_t c, const auto &cell) { this->write(c, cell.stress(), stress); }))
      throw NumericalFailure("stress asked for a deformation that turns a cell inside out");
  }

private:
  template<class Action>
  bool each(std::span<const double> displacement, const Action &action) const
  {
    for (std::size_t c = 0; c < this->size(); ++c)
    {
      const CellPoints<Cell> points = this->geometry(c);
      const FiniteStrainCell<Cell, double> cell(points, this->list_.moduli, this->list_.mean_dilatation,
                                                this->gather(c, displacement));
      if (!cell.valid())
        return false;
      action(c, cell);
    }
    return true;
  }
};

/// Stress and tangent are functions of the displacement and of the committed history, which nothing but commit()
/// changes.
template<class Cell>
class PlasticBlock final : public TypedBlock<Cell>
{
public:
  using Base = TypedBlock<Cell>;

  PlasticBlock(CellList list, std::span<const double> points, const SubdomainMatrix &matrix)
    : Base(std::move(list), points, matrix)
    , history_(this->size() * Cell::points)
  {
  }

  [[nodiscard]] bool is_linear() const override { return false; }
  [[nodiscard]] bool add_tangent(std::span<const double> displacement, SubdomainMatrix &matrix) const override
  {
    each(displacement, [&](std::size_t c, const auto &cell) { this->scatter(c, cell.tangent(), matrix); });
    return true;
  }
  [[nodiscard]] bool add_force(std::span<const double> displacement, std::span<double> force) const override
  {
    each(displacement, [&](std::size_t c, const auto &cell) { this->scatter(c, cell.force(), force); });
    return true;
  }
  void write_stress(std::span<const double> displacement, std::span<double> stress) const override
  {
    each(displacement, [&](std::size_t c, const auto &cell) { this->write(c, cell.stress(), stress); });
  }
  void commit(std::span<const double> displacement) override
  {
    each(displacement,
         [&](std::size_t c, const auto &cell)
         {
           for (int q = 0; q < Cell::points; ++q)
             history_[c * Cell::points + q] = cell.history(q);
         });
  }
  void append_history(CellHistories &out) const override
  {
    for (std::size_t c = 0; c < this->size(); ++c)
    {
      out.cells.push_back(this->list_.cells[c]);
      for (int q = 0; q < Cell::points; ++q)
      {
        const PlasticHistory<double> &point = history_[c * Cell::points + q];
        out.values.insert(out.values.end(), point.strain.data(), point.strain.data() + point.strain.size());
        out.values.push_back(point.equivalent);
      }
      out.offset.push_back(out.values.size());
    }
  }
  void set_history(const CellHistories &histories, std::span<const Index> place) override
  {
    for (std::size_t c = 0; c < this->size(); ++c)
    {
      const Index at = place[this->list_.cells[c]];
      const auto n = static_cast<std::size_t>(history_[0].strain.size()) + 1;
      if (at < 0 || histories.offset[at + 1] - histories.offset[at] != Cell::points * n)
        throw UserError("the checkpoint holds no plastic strain of cell " + std::to_string(this->list_.cells[c]) +
                        ": it is of another problem");
      const double *value = histories.values.data() + histories.offset[at];
      for (int q = 0; q < Cell::points; ++q, value += n)
      {
        PlasticHistory<double> &point = history_[c * Cell::points + q];
        std::copy_n(value, n - 1, point.strain.data());
        point.equivalent = value[n - 1];
      }
    }
  }
  void write_plastic_strain(std::span<double> strain) const override
  {
    for (std::size_t c = 0; c < this->size(); ++c)
    {
      double sum = 0, volume = 0;
      const CellPoints<Cell> points = this->geometry(c);
      for (int q = 0; q < Cell::points; ++q)
      {
        sum += points[q].weight * history_[c * Cell::points + q].equivalent;
        volume += points[q].weight;
      }
      strain[this->list_.cells[c]] = sum / volume;
    }
  }

private:
  template<class Action>
  void each(std::span<const double> displacement, const Action &action) const
  {
    for (std::size_t c = 0; c < this->size(); ++c)
    {
      const CellPoints<Cell> points = this->geometry(c);
      action(c,
             PlasticCell<Cell, double>(points, this->list_.moduli, *this->list_.hardening, this->list_.mean_dilatation,
                                       &history_[c * Cell::points], this->gather(c, displacement)));
    }
  }

  std::vector<PlasticHistory<double>> history_; ///< [n_cells * Cell::points]
};

template<class Cell>
std::unique_ptr<CellBlock> make(Strain strain, CellList list, std::span<const double> points,
                                const SubdomainMatrix &matrix)
{
  if (list.hardening)
    return std::make_unique<PlasticBlock<Cell>>(std::move(list), points, matrix);
  if (strain == Strain::small)
    return std::make_unique<SmallStrainBlock<Cell>>(std::move(list), points, matrix);
  return std::make_unique<FiniteStrainBlock<Cell>>(std::move(list), points, matrix);
}

template<CellShape shape>
std::unique_ptr<CellBlock> make_plane(Kinematics kinematics, Strain strain, CellList list,
                                      std::span<const double> points, const SubdomainMatrix &matrix)
{
  switch (kinematics)
  {
  case Kinematics::plane_strain:
    return make<CellType<shape, Kinematics::plane_strain>>(strain, std::move(list), points, matrix);
  case Kinematics::plane_stress:
    return make<CellType<shape, Kinematics::plane_stress>>(strain, std::move(list), points, matrix);
  case Kinematics::axisymmetric:
    return make<CellType<shape, Kinematics::axisymmetric>>(strain, std::move(list), points, matrix);
  case Kinematics::three_dimensional:
    break;
  }
  throw InternalError("a plane cell in three-dimensional kinematics");
}
} // namespace

std::unique_ptr<CellBlock> make_cell_block(CellShape shape, Kinematics kinematics, Strain strain, CellList list,
                                           std::span<const double> points, const SubdomainMatrix &matrix)
{
  constexpr auto solid = Kinematics::three_dimensional;
  switch (shape)
  {
  case CellShape::triangle:
    return make_plane<CellShape::triangle>(kinematics, strain, std::move(list), points, matrix);
  case CellShape::quadrilateral:
    return make_plane<CellShape::quadrilateral>(kinematics, strain, std::move(list), points, matrix);
  case CellShape::tetrahedron:
    return make<CellType<CellShape::tetrahedron, solid>>(strain, std::move(list), points, matrix);
  case CellShape::hexahedron:
    return make<CellType<CellShape::hexahedron, solid>>(strain, std::move(list), points, matrix);
  case CellShape::segment:
    break;
  }
  throw InternalError("a segment is no cell");
}
} // namespace amontons
