// What several processes write together. Every expectation holds on any number of processes.
#include "fixture.h"
#include "shared_folder.h"
#include "vtu_reader.h"

#include "amontons/base/error.h"
#include "amontons/output/contact_table.h"
#include "amontons/output/pictures.h"
#include "amontons/output/record.h"
#include "amontons/solution/contact_interface.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <map>
#include <sstream>

namespace amontons
{
namespace
{
using Json = nlohmann::json;

constexpr Index n_cells = 12;
constexpr Index n_nodes = 2 * (n_cells + 1) + 2; // those of a strip of squares, and a segment below it
constexpr GlobalIndex first_tag = 100;

std::array<double, 2> place(GlobalIndex id)
{
  if (id >= 2 * (n_cells + 1))
    return {id % 2 == 0 ? 0. : n_cells, -1};
  return {static_cast<double>(id / 2), static_cast<double>(id % 2)};
}

std::array<double, 2> displacement(GlobalIndex id)
{
  return {1. / static_cast<double>(id + 1), static_cast<double>(id * id)};
}

double stress(GlobalIndex cell, int component)
{
  return static_cast<double>(10 * cell + component);
}

/// The part of a strip of squares, body 1, and of a rigid segment, body 0, that a process has: every n-th square; the
/// first two nodes and the segment's nodes are on all processes, the segment on process 0.
struct Part
{
  Mesh mesh;
  Sharing nodes;
  Surface top; ///< of the squares, an impactor
  SolutionState state;

  explicit Part(const Communicator &all);
  Part(const Part &) = delete; // `state` points into it

private:
  void add_nodes(const Communicator &all);
  void add_contact();
  std::map<GlobalIndex, Index> position_;
};

void Part::add_nodes(const Communicator &all)
{
  std::vector<GlobalIndex> &ids = mesh.node_ids = {0, 1, n_nodes - 2, n_nodes - 1};
  for (GlobalIndex cell = n_cells - 1; cell >= 0; --cell)
    if (cell % all.size() == all.rank())
      for (const GlobalIndex id : {2 * cell + 2, 2 * cell + 3, 2 * cell, 2 * cell + 1})
        if (std::find(ids.begin(), ids.end(), id) == ids.end())
          ids.push_back(id);
  for (const GlobalIndex id : ids)
  {
    position_[id] = mesh.n_nodes();
    mesh.node_tags.push_back(id + first_tag);
    for (const double x : place(id))
      mesh.points.push_back(x);
    for (const double u : displacement(id))
      state.displacement.push_back(u);
  }
}

Part::Part(const Communicator &all)
{
  mesh.n_global_nodes = n_nodes;
  mesh.n_global_cells = n_cells;
  add_nodes(all);
  Group strip{2, {}, {}, {}}, segment{1, {}, {}, {}};
  for (GlobalIndex cell = all.rank(); cell < n_cells; cell += all.size())
  {
    const std::array nodes{position_[2 * cell], position_[2 * cell + 2], position_[2 * cell + 3],
                           position_[2 * cell + 1]};
    strip.cells.push_back(mesh.cells.size());
    strip.entities.push_back(nodes);
    mesh.cells.push_back(nodes);
    mesh.cell_ids.push_back(cell);
    for (int c = 0; c < 6; ++c)
      state.stress.push_back(stress(cell, c));
  }
  if (all.is_root())
    segment.entities.push_back(std::array{position_[n_nodes - 2], position_[n_nodes - 1]});
  mesh.groups = {{"strip", strip}, {"segment", segment}};
  nodes = Sharing(all.size() > 1 ? std::make_shared<MessageExchange>(all) : nullptr, "nodes", mesh.node_ids);
  state.mesh = &mesh;
  state.nodes = &nodes;
  add_contact();
}

/// Pressures by the nodes' ids, which owners know.
void Part::add_contact()
{
  std::vector<GlobalIndex> ids = mesh.node_ids;
  std::sort(ids.begin(), ids.end());
  const auto add = [&](bool own)
  {
    for (const GlobalIndex id : ids)
      if (id < 2 * (n_cells + 1) && id % 2 == 1 && nodes.is_own(position_[id]) == own)
      {
        top.node_ids.push_back(id);
        for (const double x : place(id))
          top.reference.push_back(x);
      }
  };
  add(true);
  ContactResult contact;
  contact.n_own = contact.n_nodes = top.n_nodes();
  add(false);
  for (const GlobalIndex cell : mesh.cell_ids)
  {
    for (const GlobalIndex id : {2 * cell + 3, 2 * cell + 1})
      top.face_nodes.push_back(
          static_cast<Index>(std::find(top.node_ids.begin(), top.node_ids.end(), id) - top.node_ids.begin()));
    top.face_offsets.push_back(static_cast<Index>(top.face_nodes.size()));
    top.face_ids.push_back(cell);
  }
  contact.name = "top";
  contact.impactor = &top;
  for (const GlobalIndex id : top.node_ids)
    contact.nodes.push_back(position_[id]);
  const std::size_t n = top.node_ids.size();
  for (std::vector<double> *values : {&contact.gap, &contact.pressure, &contact.traction, &contact.slip, &contact.area})
    values->assign(n, 0);
  contact.force.assign(2 * n, 0);
  contact.status.assign(n, ContactStatus::open);
  for (Index i = 0; i < contact.n_own; ++i)
  {
    contact.pressure[i] = static_cast<double>(top.node_ids[i]);
    contact.force[2 * i + 1] = -contact.pressure[i];
    contact.status[i] = ContactStatus::slip;
    contact.n_active += 1;
    contact.max_pressure = std::max(contact.max_pressure, contact.pressure[i]);
  }
  std::vector<char> is_own(n, 0);
  std::fill_n(is_own.begin(), contact.n_own, 1);
  complete(contact, Sharing(nodes.messages(), "nodes", top.node_ids, is_own));
  state.contacts = {contact};
}

/// The sources of a .pvtu; a .vtu is its own.
std::vector<std::string> pieces_of(const std::string &file, const std::string &text)
{
  if (file.ends_with(".vtu"))
    return {file};
  std::vector<std::string> out;
  const std::string before = "<Piece Source=\"";
  for (std::size_t at = text.find(before); at != std::string::npos; at = text.find(before, at + 1))
    out.push_back(text.substr(at + before.size(), text.find('"', at + before.size()) - at - before.size()));
  return out;
}

/// The file that a series lists.
std::string listed_file(const std::filesystem::path &folder, const std::string &series = "solution")
{
  const std::string pvd = content_of(folder / (series + ".pvd"));
  const std::size_t begin = pvd.find("file=\"") + 6;
  return pvd.substr(begin, pvd.find('"', begin) - begin);
}

class Pieces : public testing::Test
{
protected:
  Communicator all_{MPI_COMM_WORLD};
  test::SharedFolder shared_{all_};
  Part part_{all_};

  void write()
  {
    const ResultFolder folder(shared_.path(), all_);
    std::vector<BodyOptions> bodies(2);
    bodies[0].region = "segment";
    bodies[1].region = "strip";
    Pictures pictures(folder, {{OutputField::displacement, OutputField::stress}, 1}, bodies);
    pictures.start(part_.state, 0);
    MPI_Barrier(all_.mpi()); // process 0 writes last
  }
};

TEST_F(Pieces, TogetherHoldEveryCellOnceAndEveryNode)
{
  write();
  const std::string file = listed_file(shared_.path());
  const std::vector<std::string> pieces = pieces_of(file, content_of(shared_.path() / file));
  ASSERT_EQ(pieces.size(), static_cast<std::size_t>(all_.size()));
  std::vector<GlobalIndex> cells, nodes;
  for (const std::string &piece : pieces)
  {
    const VtuReader vtu(content_of(shared_.path() / piece));
    const auto tags = vtu.integers<GlobalIndex>("node");
    const auto points = vtu.numbers("Points"), moved = vtu.numbers("displacement"), stresses = vtu.numbers("stress");
    for (std::size_t i = 0; i < tags.size(); ++i)
      for (int c = 0; c < 2; ++c)
      {
        EXPECT_EQ(points[3 * i + c], place(tags[i] - first_tag)[c]);
        EXPECT_EQ(moved[3 * i + c], displacement(tags[i] - first_tag)[c]);
      }
    nodes.insert(nodes.end(), tags.begin(), tags.end());
    const auto offsets = vtu.integers<GlobalIndex>("offsets"), connectivity = vtu.integers<GlobalIndex>("connectivity");
    const auto body = vtu.integers<GlobalIndex>("body");
    for (std::size_t k = 0; k < offsets.size(); ++k)
    {
      const auto first = tags.at(connectivity.at(k == 0 ? 0 : offsets[k - 1])) - first_tag;
      const bool is_segment = first == n_nodes - 2;
      EXPECT_EQ(body[k], is_segment ? 0 : 1);
      const GlobalIndex cell = is_segment ? n_cells : first / 2;
      for (int c = 0; c < 6; ++c)
        EXPECT_EQ(stresses[6 * k + c], is_segment ? 0 : stress(cell, c));
      cells.push_back(cell);
    }
  }
  std::sort(cells.begin(), cells.end());
  ASSERT_EQ(cells.size(), static_cast<std::size_t>(n_cells) + 1);
  for (GlobalIndex cell = 0; cell <= n_cells; ++cell)
    EXPECT_EQ(cells[cell], cell);
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  EXPECT_EQ(nodes.size(), static_cast<std::size_t>(n_nodes));
}

TEST_F(Pieces, OfAContactHoldEveryFaceOnceWithWhatOwnersKnow)
{
  write();
  const std::string file = listed_file(shared_.path(), "contact_top");
  std::vector<GlobalIndex> faces;
  for (const std::string &piece : pieces_of(file, content_of(shared_.path() / file)))
  {
    const VtuReader vtu(content_of(shared_.path() / piece));
    const auto tags = vtu.integers<GlobalIndex>("node"), status = vtu.integers<GlobalIndex>("status");
    const auto pressure = vtu.numbers("pressure"), force = vtu.numbers("force");
    for (std::size_t i = 0; i < tags.size(); ++i)
    {
      EXPECT_EQ(pressure[i], static_cast<double>(tags[i] - first_tag));
      EXPECT_EQ(force[3 * i + 1], -pressure[i]);
      EXPECT_EQ(status[i], static_cast<GlobalIndex>(ContactStatus::slip));
    }
    const auto connectivity = vtu.integers<GlobalIndex>("connectivity");
    for (std::size_t k = 0; k < connectivity.size(); k += 2)
      faces.push_back((tags.at(connectivity[k]) - first_tag) / 2 - 1);
  }
  std::sort(faces.begin(), faces.end());
  ASSERT_EQ(faces.size(), static_cast<std::size_t>(n_cells));
  for (GlobalIndex face = 0; face < n_cells; ++face)
    EXPECT_EQ(faces[face], face);
}

TEST_F(Pieces, ATableHasEachNodeOnceInTheOrderOfTheMesh)
{
  const ContactResult &contact = part_.state.contacts[0];
  EXPECT_EQ(contact.n_nodes, n_cells + 1);
  EXPECT_EQ(contact.n_active, n_cells + 1);
  EXPECT_EQ(contact.max_pressure, 2 * n_cells + 1);
  const std::string table = contact_table(contact, part_.state);
  if (!all_.is_root())
    return;
  std::istringstream lines(table);
  std::string line;
  std::getline(lines, line);
  for (GlobalIndex id = 1; id < 2 * (n_cells + 1); id += 2)
  {
    ASSERT_TRUE(std::getline(lines, line));
    EXPECT_TRUE(line.starts_with(std::to_string(id + first_tag) + "," + std::to_string(id / 2) + ",1,")) << line;
  }
  EXPECT_FALSE(std::getline(lines, line));
}

TEST_F(Pieces, LeaveOutNodesWithoutACellOfTheirs)
{
  const VtuReader vtu(body_grid(part_.state, {}, {}).text());
  const auto tags = vtu.integers<GlobalIndex>("node");
  for (Index node = 0; node < part_.mesh.n_nodes(); ++node)
  {
    const auto &used = part_.mesh.cells.nodes;
    const bool wanted = part_.nodes.is_own(node) || std::find(used.begin(), used.end(), node) != used.end();
    EXPECT_EQ(std::count(tags.begin(), tags.end(), part_.mesh.node_tags[node]), wanted ? 1 : 0);
  }
}

TEST_F(Pieces, OfAllAreDescribedByTheFileThatHoldsThemTogether)
{
  write();
  const std::string file = listed_file(shared_.path());
  EXPECT_EQ(file, all_.size() == 1 ? "solution_00000.vtu" : "solution_00000.pvtu");
  const std::string text = content_of(shared_.path() / file);
  for (const char *array : {R"(type="Float64" Name="displacement" NumberOfComponents="3")",
                            R"(type="Int64" Name="node" NumberOfComponents="1")",
                            R"(type="Float64" Name="stress" NumberOfComponents="6" ComponentName0="xx")",
                            R"(type="Float64" Name="Points" NumberOfComponents="3")"})
    EXPECT_NE(text.find((all_.size() == 1 ? "<DataArray " : "<PDataArray ") + std::string(array)), std::string::npos)
        << array;
}

TEST_F(Pieces, AFolderThatCannotBeUsedIsAnErrorOfAll)
{
  if (all_.is_root())
    std::ofstream(shared_.path() / "file") << "x";
  EXPECT_THROW(ResultFolder(shared_.path() / "file", all_), UserError);
}

TEST_F(Pieces, RecordComparesTheProcesses)
{
  const ResultFolder folder(shared_.path(), all_);
  RunRecord record(folder, "", "a.yaml");
  Timers timers;
  if (all_.is_root())
    const auto scope = timers.measure("linear_solve");
  if (part_.nodes.is_distributed())
  {
    MessageExchange &messages = *part_.nodes.messages();
    messages.forget_traffic();
    std::vector<double> numbers(2, 0.0);
    messages.sum("sums", numbers);
    const Rank next = (all_.rank() + 1) % all_.size();
    (void)messages.exchange("ring", {{next, Bytes(static_cast<std::size_t>(all_.rank() + 1))}});
  }
  record.finish(part_.state, {}, timers, "");
  MPI_Barrier(all_.mpi());
  const Json written = Json::parse(content_of(shared_.path() / "record.json"));
  EXPECT_EQ(written["processes"], all_.size());
  const Json &totals = written["totals"];
  if (all_.size() == 1)
  {
    EXPECT_FALSE(totals.contains("processes"));
    return;
  }
  const Json &processes = totals["processes"];
  EXPECT_EQ(processes["n_cells"]["sum"], n_cells);
  EXPECT_EQ(processes["n_contact_nodes"]["sum"], n_cells + 1);
  EXPECT_EQ(processes["n_cells"]["max"], (n_cells + all_.size() - 1) / all_.size());
  EXPECT_EQ(processes["n_cells"]["min"], n_cells / all_.size());
  EXPECT_EQ(processes["peak_rss_mb"]["max"], totals["peak_rss_mb"]);
  EXPECT_LE(processes["peak_rss_mb"]["min"], processes["peak_rss_mb"]["max"]);
  EXPECT_GT(processes["cpu_s"]["min"], 0);
  EXPECT_EQ(processes["timings"]["linear_solve"]["min"], 0);
  EXPECT_GT(processes["timings"]["linear_solve"]["max"], 0);
  const int n = all_.size();
  EXPECT_EQ(processes["traffic"]["ring"]["bytes"], (Json{{"min", 1}, {"max", n}, {"sum", n * (n + 1) / 2}}));
  EXPECT_EQ(processes["traffic"]["ring"]["messages"], (Json{{"min", 1}, {"max", 1}, {"sum", n}}));
  EXPECT_EQ(processes["traffic"]["sums"]["reductions"], (Json{{"min", 1}, {"max", 1}, {"sum", n}}));
  EXPECT_EQ(processes["traffic"]["sums"]["reduced_bytes"], (Json{{"min", 16}, {"max", 16}, {"sum", 16 * n}}));
}
} // namespace
} // namespace amontons
