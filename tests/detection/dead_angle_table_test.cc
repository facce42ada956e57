// The table of docs/detection.md, made here: what is returned in the dead angles.
#include "amontons/detection/detector.h"
#include "amontons/surface/projection.h"
#include "detection/dead_angles.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>

namespace amontons::test
{
namespace
{
struct Row
{
  std::string where;
  Surface target;
  std::vector<double> node;
  std::optional<double> extension;
};

std::vector<Row> rows_2d()
{
  return {
      {"convex vertex, in its dead angle", roof(), {0.1, 0.5}, {}},
      {"convex vertex, on the bisector", roof(), {0, 0.5}, {}},
      {"convex vertex, inside the body", roof(), {0.1, -0.3}, {}},
      {"concave vertex, outside: two faces hold the projection", valley(), {0.1, 0.5}, {}},
      {"concave vertex, inside the body: no face holds it", valley(), {0.1, -0.4}, {}},
      {"symmetry end, on the plane", line(), {0, 0.3}, {}},
      {"symmetry end, past it by round-off", line(), {-1e-15, 0.3}, {}},
      {"free end, past it by 0.05 of the face", line(), {-0.05, 0.3}, {}},
      {"the same, penetrating", line(), {-0.05, -0.3}, {}},
      {"free end, past it by 0.15 of the face", line(), {-0.15, 0.3}, {}},
      {"the same, `extension: 0.2`", line(), {-0.15, 0.3}, 0.2},
      {"end that must not extend, `extension: 0`", line(), {-0.001, 0.3}, 0.0},
  };
}

std::vector<Row> rows_3d(bool triangles)
{
  const Surface flat = sheet(2, 2, triangles, [](double s, double t) { return Point{s, t, 0}; });
  return {
      {"convex edge, in its dead angle", bent(1, false, triangles), {0.1, 0.55, 0.5}, {}},
      {"convex edge, inside the body", bent(1, false, triangles), {0.1, 0.55, -0.3}, {}},
      {"concave edge, outside: two faces hold the projection", bent(-1, false, triangles), {0.1, 0.55, 0.5}, {}},
      {"concave edge, inside the body: no face holds it", bent(-1, false, triangles), {0.1, 0.55, -0.4}, {}},
      {"convex vertex (a cube's), in its dead angle", cube_corner(triangles), {0.1, 0.1, 0.2}, {}},
      {"the same, in the dead angle of an edge", cube_corner(triangles), {0.1, -0.4, 0.2}, {}},
      {"the same, inside the body", cube_corner(triangles), {-0.2, -0.3, -0.1}, {}},
      {"concave vertex, outside: four faces hold the projection", bent(-1, true, triangles), {0.1, 0.15, 0.5}, {}},
      {"concave vertex, inside the body: no face holds it", bent(-1, true, triangles), {0.01, 0.02, -0.3}, {}},
      {"symmetry end, on the plane", flat, {0, 0.3, 0.2}, {}},
      {"symmetry end, past it by round-off", flat, {-1e-15, 0.3, 0.2}, {}},
      {"free end, past it by 0.06 of the face", flat, {-0.03, 0.3, 0.2}, {}},
      {"corner of two free ends, past both", flat, {-0.03, -0.04, -0.2}, {}},
      {"free end, past it by 0.14 of the face", flat, {-0.07, 0.3, 0.2}, {}},
      {"the same, `extension: 0.1`", flat, {-0.07, 0.3, 0.2}, 0.1},
      {"end that must not extend, `extension: 0`", flat, {-0.001, 0.3, 0.2}, 0.0},
  };
}

Pair pair_by(DetectionMethod method, const Row &row)
{
  DetectionOptions options;
  options.method = method;
  options.extension = row.extension;
  const Surface impactor = cloud(row.target.dim, row.node);
  return make_detector(options, impactor, row.target)->detect(impactor.reference, row.target.reference, 1).front();
}

// Four digits; round-off is none of them.
std::string number(double value, double round_off = 1e-14)
{
  std::ostringstream text;
  text.precision(4);
  text << (std::abs(value) < round_off ? 0.0 : value);
  return text.str();
}

std::string numbers(std::initializer_list<double> values)
{
  std::string text;
  for (const double value : values)
    text += (text.empty() ? "" : ", ") + number(value);
  return text;
}

std::string result(const Row &row, const Pair &pair)
{
  if (pair.kind == PairKind::none)
    return pair.reason == NoPairReason::past_end ? "none: past the end | | | | | |" : "none | | | | | |";
  static const char *const kinds[] = {"none", "face", "edge", "vertex", "extension"};
  const Surface &target = row.target;
  const auto n = face_normal(gather_face(target.dim, target.face(pair.face), target.reference), pair.xi);
  const bool plane = target.dim == 2;
  return std::string(kinds[static_cast<int>(pair.kind)]) + " | " + std::to_string(pair.face) + " | " +
         (plane ? number(pair.xi[0]) : numbers({pair.xi[0], pair.xi[1]})) + " | " + number(pair.gap) + " | " +
         number(pair.distance) + " | " + (plane ? numbers({n.x(), n.y()}) : numbers({n.x(), n.y(), n.z()})) + " |";
}

std::string table(const std::vector<Row> &rows)
{
  std::ostringstream text;
  text << "\n| where | node | kind | face | xi | gap | distance | normal |\n"
       << "| --- | --- | --- | --- | --- | --- | --- | --- |\n";
  for (const Row &row : rows)
  {
    text << "| " << row.where << " | " << number(row.node[0], 0);
    for (std::size_t c = 1; c < row.node.size(); ++c)
      text << ", " << number(row.node[c], 0);
    text << " | " << result(row, pair_by(DetectionMethod::exact, row)) << '\n';
  }
  return text.str();
}

// The page's text stays, its tables are replaced: each is between two comments that name it.
std::string with_table(const std::string &page, const std::string &name, const std::string &table)
{
  const std::string from = "<!-- " + name + " -->", to = "<!-- end of " + name + " -->";
  const std::size_t begin = page.find(from), end = page.find(to);
  if (begin == std::string::npos || end == std::string::npos)
    return "no " + from + " in docs/detection.md";
  return page.substr(0, begin + from.size()) + "\n" + table + "\n" + page.substr(end);
}

/// With AMONTONS_UPDATE_REFERENCE=1 in the environment the tables are written anew instead.
TEST(DeadAngleTable, PageIsWhatIsReturned)
{
  const auto file = std::filesystem::path(__FILE__).parent_path() / "../../docs/detection.md";
  std::ostringstream page;
  page << std::ifstream(file, std::ios::binary).rdbuf();
  std::string expected = with_table(page.str(), "dead angles in the plane", table(rows_2d()));
  expected = with_table(expected, "dead angles in space", table(rows_3d(false)));
  if (const char *update = std::getenv("AMONTONS_UPDATE_REFERENCE"); update && std::string(update) == "1")
  {
    std::ofstream(file, std::ios::binary) << expected;
    return;
  }
  EXPECT_TRUE(page.str() == expected) << "docs/detection.md does not show what is returned; write it anew with\n"
                                      << "  AMONTONS_UPDATE_REFERENCE=1 ctest -R DeadAngleTable";
}

TEST(DeadAngleTable, HoldsForAllMethodsAndForTriangles)
{
  std::vector<Row> rows = rows_2d();
  for (const Row &row : rows_3d(false))
    rows.push_back(row);
  for (const Row &row : rows)
    for (const DetectionMethod method : {DetectionMethod::nearest_node, DetectionMethod::brute})
      EXPECT_EQ(result(row, pair_by(method, row)), result(row, pair_by(DetectionMethod::exact, row))) << row.where;
  const std::vector<Row> quadrilaterals = rows_3d(false), triangles = rows_3d(true);
  for (std::size_t i = 0; i < triangles.size(); ++i)
  {
    const Pair other = pair_by(DetectionMethod::exact, triangles[i]);
    const Pair pair = pair_by(DetectionMethod::exact, quadrilaterals[i]);
    EXPECT_EQ(other.kind, pair.kind) << triangles[i].where;
    EXPECT_EQ(other.reason, pair.reason) << triangles[i].where;
    if (pair.kind == PairKind::none)
      continue;
    EXPECT_NEAR(other.gap, pair.gap, 1e-14) << triangles[i].where;
    EXPECT_NEAR(other.distance, pair.distance, 1e-14) << triangles[i].where;
  }
}
} // namespace
} // namespace amontons::test
