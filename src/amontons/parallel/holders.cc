#include "amontons/parallel/holders.h"

#include <algorithm>

namespace amontons
{
void tell_holders(const Sharing &sharing, const std::string &phase, const std::function<bool(Index)> &is_told,
                  const std::function<void(Index, ByteWriter &)> &write,
                  const std::function<void(Index, ByteReader &)> &read)
{
  if (!sharing.is_distributed())
    return;
  const auto neighbours = sharing.neighbours();
  std::vector<Message> out;
  for (const Sharing::Neighbour &neighbour : neighbours)
  {
    ByteWriter writer;
    for (std::size_t k = 0; k < neighbour.items.size(); ++k)
      if (is_told(neighbour.items[k]))
      {
        writer.add(static_cast<std::int64_t>(k)); // both have the same list
        write(neighbour.items[k], writer);
      }
    if (Bytes bytes = writer.take(); !bytes.empty())
      out.push_back({neighbour.rank, std::move(bytes)});
  }
  for (const Message &message : sharing.messages()->exchange(phase, std::move(out)))
  {
    const auto from = std::find_if(neighbours.begin(), neighbours.end(),
                                   [&](const Sharing::Neighbour &neighbour) { return neighbour.rank == message.rank; });
    ByteReader reader(message.bytes);
    while (!reader.is_at_end())
      read(from->items[static_cast<std::size_t>(reader.get<std::int64_t>())], reader);
  }
}
} // namespace amontons
