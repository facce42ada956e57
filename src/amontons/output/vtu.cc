#include "amontons/output/vtu.h"

#include "amontons/base/error.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <iterator>

namespace amontons
{
namespace
{
constexpr std::size_t block_size = 1 << 20; // bytes compressed at a time

void append_base64(std::string &text, std::span<const unsigned char> bytes)
{
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (std::size_t i = 0; i < bytes.size(); i += 3)
  {
    const std::size_t n = std::min<std::size_t>(3, bytes.size() - i);
    unsigned group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8 | (k < n ? bytes[i + k] : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      text += k <= n ? digits[group >> (18 - 6 * k) & 63] : '=';
  }
}

std::span<const unsigned char> bytes_of(const auto &values)
{
  const auto bytes = std::as_bytes(std::span(values));
  return {reinterpret_cast<const unsigned char *>(bytes.data()), bytes.size()};
}

/// VTK's compressed form: a header {blocks, block size, size of a partial last block, compressed sizes...}, then the
/// blocks; header and blocks are coded separately.
std::string encode(std::span<const unsigned char> data)
{
  std::vector<std::uint64_t> header{(data.size() + block_size - 1) / block_size, block_size, data.size() % block_size};
  std::vector<unsigned char> compressed;
  for (std::size_t begin = 0; begin < data.size(); begin += block_size)
  {
    const auto block = data.subspan(begin, std::min(block_size, data.size() - begin));
    uLongf size = compressBound(block.size());
    const std::size_t old_size = compressed.size();
    compressed.resize(old_size + size);
    const int status = compress2(compressed.data() + old_size, &size, block.data(), block.size(), Z_BEST_SPEED);
    AMONTONS_ASSERT(status == Z_OK);
    compressed.resize(old_size + size);
    header.push_back(size);
  }
  std::string text;
  append_base64(text, bytes_of(header));
  append_base64(text, compressed);
  return text;
}

std::string component_attributes(std::string_view names)
{
  std::string text;
  for (int component = 0; !names.empty(); ++component)
  {
    const std::size_t comma = std::min(names.find(','), names.size());
    text += fmt::format(R"( ComponentName{}="{}")", component, names.substr(0, comma));
    names.remove_prefix(std::min(comma + 1, names.size()));
  }
  return text;
}

/// What an array is, as attributes.
std::string description(std::string_view type, std::string_view name, int n_components,
                        std::string_view component_names = {})
{
  return fmt::format(R"(type="{}" Name="{}" NumberOfComponents="{}"{})", type, name, n_components,
                     component_attributes(component_names));
}

std::string data_array(const std::string &description, const auto &values)
{
  return fmt::format("<DataArray {} format=\"binary\">\n{}\n</DataArray>\n", description, encode(bytes_of(values)));
}

std::string array_name(const std::string &description)
{
  return fmt::format("<PDataArray {}/>\n", description);
}

std::string points_description()
{
  return description("Float64", "Points", 3);
}

unsigned char vtk_type(CellShape shape)
{
  switch (shape)
  {
  case CellShape::segment:
    return 3;
  case CellShape::triangle:
    return 5;
  case CellShape::quadrilateral:
    return 9;
  case CellShape::tetrahedron:
    return 10;
  case CellShape::hexahedron:
    return 12;
  }
  throw InternalError("cell shape without a VTK type");
}
} // namespace

VtuGrid::VtuGrid(int dim, std::span<const double> points)
  : n_points_(points.size() / dim)
  , points_(data_array(points_description(), in_space(dim, points)))
{
}

void VtuGrid::add_cell(CellShape shape, std::span<const Index> nodes)
{
  connectivity_.insert(connectivity_.end(), nodes.begin(), nodes.end());
  offsets_.push_back(static_cast<std::int64_t>(connectivity_.size()));
  types_.push_back(vtk_type(shape));
}

void VtuGrid::add_point_data(const std::string &name, int n_components, std::span<const double> values,
                             std::string_view component_names)
{
  AMONTONS_ASSERT(values.size() == n_points() * n_components);
  const std::string what = description("Float64", name, n_components, component_names);
  point_data_ += data_array(what, values);
  point_data_names_ += array_name(what);
}

void VtuGrid::add_point_data(const std::string &name, std::span<const std::int64_t> values)
{
  AMONTONS_ASSERT(values.size() == n_points());
  const std::string what = description("Int64", name, 1);
  point_data_ += data_array(what, values);
  point_data_names_ += array_name(what);
}

void VtuGrid::add_cell_data(const std::string &name, int n_components, std::span<const double> values,
                            std::string_view component_names)
{
  AMONTONS_ASSERT(values.size() == n_cells() * n_components);
  const std::string what = description("Float64", name, n_components, component_names);
  cell_data_ += data_array(what, values);
  cell_data_names_ += array_name(what);
}

void VtuGrid::add_cell_data(const std::string &name, std::span<const std::int64_t> values)
{
  AMONTONS_ASSERT(values.size() == n_cells());
  const std::string what = description("Int64", name, 1);
  cell_data_ += data_array(what, values);
  cell_data_names_ += array_name(what);
}

std::string VtuGrid::text() const
{
  return fmt::format("<?xml version=\"1.0\"?>\n"
                     R"(<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" )"
                     R"(header_type="UInt64" compressor="vtkZLibDataCompressor">)"
                     "\n<UnstructuredGrid>\n<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n"
                     "<Points>\n{}</Points>\n<Cells>\n{}{}{}</Cells>\n"
                     "<PointData>\n{}</PointData>\n<CellData>\n{}</CellData>\n"
                     "</Piece>\n</UnstructuredGrid>\n</VTKFile>\n",
                     n_points(), n_cells(), points_, data_array(description("Int64", "connectivity", 1), connectivity_),
                     data_array(description("Int64", "offsets", 1), offsets_),
                     data_array(description("UInt8", "types", 1), types_), point_data_, cell_data_);
}

std::string VtuGrid::text_of_pieces(std::span<const std::string> files) const
{
  std::string pieces;
  for (const std::string &file : files)
    pieces += fmt::format("<Piece Source=\"{}\"/>\n", file);
  return fmt::format("<?xml version=\"1.0\"?>\n"
                     R"(<VTKFile type="PUnstructuredGrid" version="1.0" byte_order="LittleEndian" )"
                     R"(header_type="UInt64" compressor="vtkZLibDataCompressor">)"
                     "\n<PUnstructuredGrid GhostLevel=\"0\">\n"
                     "<PPoints>\n{}</PPoints>\n<PPointData>\n{}</PPointData>\n<PCellData>\n{}</PCellData>\n"
                     "{}</PUnstructuredGrid>\n</VTKFile>\n",
                     array_name(points_description()), point_data_names_, cell_data_names_, pieces);
}

std::vector<double> in_space(int dim, std::span<const double> vectors)
{
  std::vector<double> out(vectors.size() / dim * 3, 0.0);
  for (std::size_t i = 0; i < vectors.size(); ++i)
    out[i / dim * 3 + i % dim] = vectors[i];
  return out;
}

std::string pvd_text(std::span<const std::pair<double, std::string>> files)
{
  std::string text = "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n";
  for (const auto &[time, file] : files)
    text += fmt::format("<DataSet timestep=\"{:.17g}\" file=\"{}\"/>\n", time, file);
  return text + "</Collection>\n</VTKFile>\n";
}
} // namespace amontons
