#include "fixture.h"

#include "amontons/output/screen.h"

#include <gmock/gmock.h>

#include <sstream>

namespace amontons
{
namespace
{
using testing::HasSubstr;
using testing::Not;

void play(Screen &screen, Example &example, const std::string &failure)
{
  SolutionState initial = example.state;
  initial.increment = 0;
  screen.start(initial, 18);
  screen.begin_increment(1, 0.25, 0.25);
  screen.iteration({1, 1.5e-3, 0.1, 2, 2, 1, 1, 0.5, "node 812 open<->slip for the 3rd time"});
  example.state.increment = 1;
  example.state.time = 0.25;
  screen.accepted({0.25, 0.25, 1, 0, 0}, example.state);
  screen.rejected({0.5, 0.25, 25, 0, 0}, "the residual stays at 1e-3");
  screen.warning("two nodes start inside");
  screen.finish(example.state, {0, 0, 0, 1, 0, 3, 26, 0}, {}, failure);
}

TEST(Screen, ShowsIterationsContactsAndCauses)
{
  Example example;
  std::ostringstream out;
  Screen screen(out, 1, false);
  play(screen, example, "");
  const std::string text = out.str();
  EXPECT_THAT(text, HasSubstr("8 nodes, 3 cells, 18 unknowns\n"));
  EXPECT_THAT(text, HasSubstr("increment 1, t = 0.25 (step 0.25)\n"));
  EXPECT_THAT(text, HasSubstr("node 812 open<->slip for the 3rd time\n"));
  EXPECT_THAT(text, HasSubstr("1.50e-03"));
  EXPECT_THAT(text, HasSubstr("converged in 1 iteration\n"));
  EXPECT_THAT(text, HasSubstr("block/floor: 2 of 3 nodes closed, 1 stick, 1 slip; normal force (0, 1.33333)"));
  EXPECT_THAT(text, HasSubstr("not converged: the residual stays at 1e-3\n"));
  EXPECT_THAT(text, HasSubstr("warning: two nodes start inside\n"));
  EXPECT_THAT(text, HasSubstr("solved to t = 0.25\n"));
  EXPECT_THAT(text, HasSubstr("1 increment, 26 Newton iterations, 1 factorization, 3 detections"));
  EXPECT_THAT(text, HasSubstr("reaction of top: (0.5, -2)\n"));
}

TEST(Screen, SaysWhereAndWhyItStopped)
{
  Example example;
  std::ostringstream out;
  Screen screen(out, 1, false);
  play(screen, example, "the least step is reached");
  EXPECT_THAT(out.str(), HasSubstr("stopped at t = 0.25 of 1: the least step is reached\n"));
  EXPECT_THAT(out.str(), Not(HasSubstr("solved")));
}

TEST(Screen, DrawsABarOnATerminalOnly)
{
  Example example;
  std::ostringstream plain, terminal;
  Screen in_file(plain, 1, false), on_terminal(terminal, 1, true);
  play(in_file, example, "");
  play(on_terminal, example, "");
  EXPECT_THAT(plain.str(), Not(HasSubstr("\r")));
  EXPECT_THAT(terminal.str(), HasSubstr("[==========                              ]  25 %"));
  EXPECT_THAT(terminal.str(), Not(HasSubstr("%\n"))); // every bar is erased before the next line

  // With the bars erased, both are the same.
  std::string text = terminal.str();
  for (auto bar = text.find('['); bar != std::string::npos; bar = text.find('['))
    text.erase(bar, text.find("\033[K", bar) + 3 - bar);
  const auto before_time = [](const std::string &whole) { return whole.substr(0, whole.find("3 detections")); };
  EXPECT_EQ(before_time(text), before_time(plain.str()));
}
} // namespace
} // namespace amontons
