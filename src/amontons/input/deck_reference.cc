#include "amontons/input/deck_keys.h"

#include <sstream>

namespace amontons
{
namespace
{
constexpr const char *introduction = R"(# The deck

A deck is one YAML file. The table of this page is the table by which decks are read; the page is made from it by
`AMONTONS_UPDATE_REFERENCE=1 ctest -R DeckReference`.

- Keys are written as here, with hyphens. A key that is not listed, a key twice in one place and an empty list are
  errors.
- Units are any consistent set (mm, N, MPa; or m, N, Pa): the column *unit* tells what kind of quantity a number is. In
  the plane forces are per unit thickness, in axisymmetry over the whole ring.
- An *expression* is a number or a formula of `t` (the load parameter) and of the reference coordinates `x`, `y`, `z`,
  as in `"-0.01*t"`; quotes are needed where YAML would read the formula as something else.
- `a[]` is a list: its items are maps with the keys below it.
- Regions and surfaces are named by the mesh's physical groups.
- `--set key.path=value` on the command line replaces what the deck says, or adds it. Items of a list are named by
  position from 0, the value is YAML: `--set bodies.0.material.poisson=0.3 --set 'boundary.1.fix=[x, y]'`.
)";

/// A bar would end the table's cell.
std::string cell(const std::string &text, const std::string &empty = "")
{
  std::string out;
  for (const char c : text.empty() ? empty : text)
    out += c == '|' ? std::string("\\|") : std::string(1, c);
  return out;
}

std::string top(const std::string &path)
{
  return path.substr(0, path.find_first_of(".["));
}
} // namespace

std::string deck_reference()
{
  std::ostringstream page;
  page << introduction;
  std::string section;
  for (const KeyDoc &doc : deck_keys().docs())
  {
    if (section.empty() || section != top(doc.path))
      page << "\n## " << top(doc.path) << "\n\n| key | type | unit | default | allowed | meaning |\n"
           << "| --- | --- | --- | --- | --- | --- |\n";
    section = top(doc.path);
    page << "| `" << doc.path << "` | " << cell(doc.type) << " | " << cell(doc.unit) << " | " << cell(doc.preset)
         << " | " << cell(doc.allowed) << " | " << cell(doc.meaning) << " |\n";
  }
  return page.str();
}
} // namespace amontons
