#include "fixture.h"

#include "amontons/output/record.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace amontons
{
namespace
{
using Json = nlohmann::json;

class Record : public testing::Test
{
protected:
  [[nodiscard]] Json read() const { return Json::parse(content_of(temporary_.path() / "record.json")); }

  void solve_one_increment()
  {
    record_.start(example_.state, 42);
    example_.state.increment = 1;
    example_.state.time = 0.5;
    record_.rejected({1, 1, 25, 0, 0}, "no convergence");
    record_.accepted({0.5, 0.5, 4, 7, 1}, example_.state);
  }

  TemporaryFolder temporary_;
  ResultFolder folder_{temporary_.path(), Communicator::alone()};
  Example example_;
  RunRecord record_{folder_, "A title", "/decks/a.yml"};
};

TEST_F(Record, IsThereFromTheStart)
{
  record_.start(example_.state, 42);
  const Json record = read();
  EXPECT_EQ(record["status"], "running");
  EXPECT_EQ(record["n_dofs"], 42);
  EXPECT_EQ(record["title"], "A title");
  EXPECT_EQ(record["deck"], "/decks/a.yml");
  EXPECT_EQ(record["processes"], 1);
  EXPECT_EQ(record["version"], AMONTONS_EXPECTED_VERSION);
  EXPECT_EQ(record["increments"], Json::array());
}

TEST_F(Record, TellsOfEachIncrementAsItEnds)
{
  solve_one_increment();
  const Json record = read();
  EXPECT_EQ(record["status"], "running");
  EXPECT_EQ(record["increments"], Json::parse(R"([{
    "increment": 1, "time": 0.5, "time_step": 0.5, "newton_iterations": 4, "linear_iterations": 7, "cutbacks": 1,
    "contacts": [{"name": "block/floor", "n_impactor_nodes": 3, "n_active": 2, "n_stick": 1, "n_slip": 1,
      "normal_force": [0.0, 1.3333333333333333], "tangential_force": [0.25, 0.0], "max_pressure": 2.0,
      "min_gap": -1e-17, "contact_area": 1.5}],
    "reactions": [{"region": "top", "force": [0.5, -2.0]}]}])"));
  EXPECT_EQ(record["rejected"], Json::parse(R"([{"time": 1.0, "time_step": 1.0, "newton_iterations": 25,
    "cause": "no convergence"}])"));
}

TEST_F(Record, ClosesWithTotals)
{
  solve_one_increment();
  Timers timers;
  {
    const auto scope = timers.measure("linear_solve");
  }
  record_.warning("two nodes start inside the target");
  record_.finish(example_.state, {1, 2, 3, 4, 5, 6, 7, 8}, timers, "");
  const Json record = read();
  EXPECT_EQ(record["status"], "converged");
  EXPECT_FALSE(record.contains("failure"));
  EXPECT_EQ(record["warnings"], Json::parse(R"(["two nodes start inside the target"])"));
  Json totals = record["totals"];
  EXPECT_GE(totals["wall_s"].get<double>(), totals["timings"]["linear_solve"].get<double>());
  EXPECT_GT(totals["peak_rss_mb"].get<double>(), 1);
  EXPECT_LT(totals["peak_rss_mb"].get<double>(), 10000);
  for (const char *varying : {"wall_s", "peak_rss_mb", "timings"})
    totals.erase(varying);
  EXPECT_EQ(totals, Json::parse(R"({"n_bulk_assemblies": 1, "n_pattern_builds": 2, "n_contact_updates": 3,
    "n_factorizations": 4, "n_preconditioner_setups": 5, "n_detections": 6, "n_newton_iterations": 7,
    "n_linear_iterations": 8})"));
}

TEST_F(Record, OfAFailureKeepsWhatConverged)
{
  solve_one_increment();
  record_.finish(example_.state, {}, {}, "increment 2: the least step is reached");
  const Json record = read();
  EXPECT_EQ(record["status"], "failed");
  EXPECT_EQ(record["failure"], "increment 2: the least step is reached");
  EXPECT_EQ(record["increments"].size(), 1u);
}

TEST_F(Record, OfAnExceptionIsWrittenEvenBeforeTheStart)
{
  record_.fail("bad mesh");
  EXPECT_EQ(read()["status"], "failed");
  EXPECT_EQ(read()["failure"], "bad mesh");
}

TEST_F(Record, WritesNullWhereThereIsNoGap)
{
  example_.state.contacts[0].min_gap = std::numeric_limits<double>::infinity();
  record_.accepted({}, example_.state);
  EXPECT_TRUE(read()["increments"][0]["contacts"][0]["min_gap"].is_null());
}
} // namespace
} // namespace amontons
