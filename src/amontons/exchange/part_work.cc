#include "amontons/exchange/part_work.h"

#include "amontons/exchange/met_faces.h"

namespace amontons
{
namespace
{
std::vector<ByteReader> readers_of(std::span<const Message> messages)
{
  std::vector<ByteReader> readers;
  for (const Message &message : messages)
    readers.emplace_back(message.bytes);
  return readers;
}

void make_detector_of(const ContactShare &share, PartContact &contact)
{
  const Surface &impactor = contact.impactor.surface();
  contact.detector = contact.is_self ? make_sight_detector(share.detection, impactor, share.self_distance)
                                     : make_detector(share.detection, impactor, contact.target.surface());
}
} // namespace

void PartWork::take_surfaces(std::span<const Message> messages)
{
  std::vector<ByteReader> readers = readers_of(messages);
  sources_.clear();
  for (const Message &message : messages)
    sources_.push_back(message.rank);
  contacts_.clear();
  for (const ContactShare &share : shares_)
  {
    const int dim = share.impactor->dim;
    PartContact contact{HeldSurface(dim, "impactor"), HeldSurface(dim, "target"), nullptr, {}, !share.target};
    for (std::size_t s = 0; s < messages.size(); ++s)
    {
      contact.impactor.add_topology(messages[s].rank, readers[s]);
      if (!contact.is_self)
        contact.target.add_topology(messages[s].rank, readers[s]);
    }
    contact.impactor.merge();
    contact.target.merge();
    contacts_.push_back(std::move(contact));
  }
  move(readers);
}

void PartWork::take_positions(std::span<const Message> messages)
{
  std::vector<ByteReader> readers = readers_of(messages);
  move(readers);
}

void PartWork::move(std::vector<ByteReader> &readers)
{
  for (PartContact &contact : contacts_)
  {
    contact.impactor.move(readers);
    if (!contact.is_self)
      contact.target.move(readers);
  }
}

void PartWork::detect(std::span<const double> distances)
{
  for (std::size_t c = 0; c < contacts_.size(); ++c)
  {
    PartContact &contact = contacts_[c];
    if (!contact.detector)
      make_detector_of(shares_[c], contact);
    contact.pairs = contact.detector->detect_within(contact.impactor.x(), contact.target_side().x(), distances[c]);
  }
}

std::vector<Message> PartWork::results() const
{
  std::vector<Message> messages;
  std::vector<Index> room;
  for (std::size_t s = 0; s < sources_.size(); ++s)
  {
    ByteWriter writer;
    for (const PartContact &contact : contacts_)
    {
      const HeldSurface::Source &source = contact.impactor.sources()[s];
      const HeldSurface &target = contact.target_side();
      pack_pairs(std::span(source.nodes).first(static_cast<std::size_t>(source.n_own)), contact.pairs, target.surface(),
                 target.x(), room, writer);
    }
    messages.push_back({sources_[s], writer.take()});
  }
  return messages;
}

void PartWork::count(ParallelReport &report) const
{
  report.n_sought = report.n_impactor_nodes = report.n_target_nodes = 0;
  for (const PartContact &contact : contacts_)
  {
    for (const HeldSurface::Source &source : contact.impactor.sources())
      report.n_sought += source.n_own;
    report.n_impactor_nodes += contact.impactor.surface().n_nodes();
    report.n_target_nodes += contact.target.surface().n_nodes();
  }
}
} // namespace amontons
