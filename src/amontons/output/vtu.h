#pragma once
#include "amontons/bulk/mesh.h"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace amontons
{
/// A VTK unstructured grid (.vtu): binary arrays, compressed by zlib and coded in base64, so that the file is XML.
class VtuGrid
{
public:
  /// @param points [n_points * dim]; in the plane z is 0
  VtuGrid(int dim, std::span<const double> points);

  /// @param nodes in the order of Gmsh and VTK
  void add_cell(CellShape shape, std::span<const Index> nodes);

  /// Value names may be given to components (e.g. "xx,yy"), separated by commas.
  void add_point_data(const std::string &name, int n_components, std::span<const double> values,
                      std::string_view component_names = {});
  void add_point_data(const std::string &name, std::span<const std::int64_t> values);
  void add_cell_data(const std::string &name, int n_components, std::span<const double> values,
                     std::string_view component_names = {});
  void add_cell_data(const std::string &name, std::span<const std::int64_t> values);

  [[nodiscard]] std::size_t n_points() const { return n_points_; }
  [[nodiscard]] std::size_t n_cells() const { return types_.size(); }

  /// The file.
  [[nodiscard]] std::string text() const;
  /// A file (.pvtu) that stands for all of the given ones together: grids with the same data as this one.
  [[nodiscard]] std::string text_of_pieces(std::span<const std::string> files) const;

private:
  std::size_t n_points_;
  std::string points_;
  std::vector<std::int64_t> connectivity_;
  std::vector<std::int64_t> offsets_;
  std::vector<unsigned char> types_;
  std::string point_data_; ///< <DataArray> elements
  std::string cell_data_;
  std::string point_data_names_; ///< the same as <PDataArray>: without the numbers
  std::string cell_data_names_;
};

/// Vectors of `dim` components with the missing ones zero: [n * dim] -> [n * 3].
std::vector<double> in_space(int dim, std::span<const double> vectors);

/// A ParaView collection (.pvd) of files, each with its time.
std::string pvd_text(std::span<const std::pair<double, std::string>> files);
} // namespace amontons
