#include "fixture.h"

#include "amontons/output/contact_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <sstream>

namespace amontons
{
namespace
{
using Row = std::map<std::string, std::string>;

std::vector<std::string> split(const std::string &line)
{
  std::vector<std::string> fields;
  std::istringstream stream(line);
  for (std::string field; std::getline(stream, field, ',');)
    fields.push_back(field);
  return fields;
}

std::vector<Row> parse(const std::string &text)
{
  std::istringstream stream(text);
  std::string line;
  std::getline(stream, line);
  const auto names = split(line);
  std::vector<Row> rows;
  while (std::getline(stream, line))
  {
    const auto fields = split(line);
    EXPECT_EQ(fields.size(), names.size());
    Row row;
    for (std::size_t i = 0; i < names.size(); ++i)
      row[names[i]] = fields[i];
    rows.push_back(row);
  }
  return rows;
}

TEST(ContactTable, HasTheColumnsOfThePlane)
{
  const Example example;
  const std::string text = contact_table(example.state.contacts[0], example.state);
  EXPECT_EQ(text.substr(0, text.find('\n')), "id,x,y,ux,uy,gap,pressure,traction_1,slip_1,status,fx,fy,area");
}

TEST(ContactTable, PutsEachNumberInItsPlaceToTheLastBit)
{
  const Example example;
  const auto rows = parse(contact_table(example.state.contacts[0], example.state));
  ASSERT_EQ(rows.size(), 3u);
  const auto number = [&](int row, const char *column) { return std::stod(rows[row].at(column)); };
  EXPECT_EQ(rows[0].at("id"), "13");
  EXPECT_EQ(rows[2].at("id"), "11");
  EXPECT_EQ(number(0, "x"), 2);
  EXPECT_EQ(number(1, "ux"), 0.3);
  EXPECT_EQ(number(1, "uy"), 0.4);
  EXPECT_EQ(number(1, "gap"), -1e-17);
  EXPECT_TRUE(std::isinf(number(2, "gap")));
  EXPECT_EQ(number(1, "pressure"), 1.0 / 3);
  EXPECT_EQ(number(2, "traction_1"), -0.2);
  EXPECT_EQ(number(2, "slip_1"), 0.02);
  EXPECT_EQ(rows[0].at("status") + rows[1].at("status") + rows[2].at("status"), "openstickslip");
  EXPECT_EQ(number(2, "fx"), -0.1);
  EXPECT_EQ(number(1, "fy"), 1.0 / 3);
  EXPECT_EQ(number(1, "area"), 1);
}

TEST(ContactTable, HasTheColumnsOfSpace)
{
  Example example;
  example.mesh.dim = example.surface.dim = 3;
  example.surface.reference = {1, 2, 3};
  example.surface.node_ids = {1};
  example.state.displacement = {0, 0, 0, 4, 5, 6};
  ContactResult contact;
  contact.impactor = &example.surface;
  contact.nodes = {1};
  contact.n_own = 1;
  contact.dim = 3;
  contact.gap = {7};
  contact.pressure = {8};
  contact.traction = {9, 10};
  contact.slip = {11, 12};
  contact.status = {ContactStatus::slip};
  contact.force = {13, 14, 15};
  contact.area = {16};
  EXPECT_EQ(contact_table(contact, example.state),
            "id,x,y,z,ux,uy,uz,gap,pressure,traction_1,traction_2,slip_1,slip_2,status,fx,fy,fz,area\n"
            "12,1,2,3,4,5,6,7,8,9,10,11,12,slip,13,14,15,16\n");
}

TEST(ContactTables, KeepTheLastConvergedIncrement)
{
  const TemporaryFolder temporary;
  const ResultFolder folder(temporary.path(), Communicator::alone());
  Example example;
  ContactTables tables(folder);
  tables.accepted({}, example.state);
  example.state.contacts[0].pressure[1] = 0.75;
  tables.accepted({}, example.state);
  const auto rows = parse(content_of(temporary.path() / "contact_block_floor.csv"));
  EXPECT_EQ(rows.at(1).at("pressure"), "0.75");
}
} // namespace
} // namespace amontons
