#include "amontons/solution/contact_search.h"

#include <algorithm>

namespace amontons
{
namespace
{
/// Current coordinates of a surface's nodes. @param displacement empty: the reference
std::vector<double> places(const Surface &surface, std::span<const Index> nodes, std::span<const double> displacement)
{
  std::vector<double> x(surface.reference);
  if (!displacement.empty())
    for (Index i = 0; i < surface.n_nodes(); ++i)
      for (int c = 0; c < surface.dim; ++c)
        x[i * surface.dim + c] += displacement[static_cast<std::size_t>(nodes[i]) * surface.dim + c];
  return x;
}
} // namespace

ContactSearch::ContactSearch(std::span<const ContactInterface> contacts, const DetectionOptions &options,
                             const ExchangeOptions &exchange, const std::shared_ptr<MessageExchange> &messages)
  : contacts_(contacts)
  , options_(options)
  , messages_(messages)
  , of_contact_(contacts.size())
{
  std::vector<ContactShare> shares;
  for (std::size_t c = 0; c < contacts.size(); ++c)
  {
    const ContactInterface &contact = contacts[c];
    if (!contact.is_searched())
      continue;
    searched_.push_back(c);
    const bool self = contact.options().is_self_contact();
    if (messages)
      shares.push_back({&contact.impactor(), contact.n_nodes(), self ? nullptr : contact.target(), options,
                        contact.options().self_distance});
    else
      of_contact_[c].detector = self ? make_self_detector(options, contact.impactor(), contact.options().self_distance)
                                     : make_detector(options, contact.impactor(), *contact.target());
  }
  if (!shares.empty())
    parallel_ = make_parallel_detector(messages->communicator(), exchange, std::move(shares));
}

void ContactSearch::search(std::span<const double> displacement, std::span<const double> reaches, bool reference)
{
  const std::span<const double> u = reference ? std::span<const double>() : displacement;
  std::vector<SharePositions> positions;
  for (const std::size_t c : searched_)
  {
    const ContactInterface &contact = contacts_[c];
    Searched &own = of_contact_[c];
    own.impactor_x = places(contact.impactor(), contact.surfaces().nodes, u);
    if (!contact.options().is_self_contact())
      own.target_x = places(*contact.target(), contact.target_nodes(), u);
    const std::vector<double> &target_x = contact.options().is_self_contact() ? own.impactor_x : own.target_x;
    if (parallel_)
      positions.push_back({own.impactor_x, own.target_x, reaches[c]});
    else
    {
      own.pairs = &own.detector->detect(own.impactor_x, target_x, reaches[c]);
      own.target = contact.target();
    }
  }
  if (!parallel_)
    return;
  const std::vector<MetPairing> &met = parallel_->detect(positions);
  for (std::size_t k = 0; k < searched_.size(); ++k)
  {
    of_contact_[searched_[k]].pairs = &met[k].pairs;
    of_contact_[searched_[k]].target = &met[k].target;
  }
  messages_->add_traffic(parallel_->report().traffic);
}

DetectionReport ContactSearch::report(std::size_t c) const
{
  const Searched &own = of_contact_[c];
  const ContactInterface &contact = contacts_[c];
  if (!contact.is_searched())
    return contact.detection_report();
  if (own.detector)
    return own.detector->report();
  DetectionReport out;
  out.method = name_of(options_.method);
  const auto place = std::lower_bound(searched_.begin(), searched_.end(), c) - searched_.begin();
  out.distance = parallel_->report().distances[static_cast<std::size_t>(place)];
  count_pairs(*own.pairs, contact.options().is_self_contact(), out);
  const int dim = contact.impactor().dim;
  if (out.deepest_node >= 0)
    std::copy_n(own.impactor_x.begin() + static_cast<std::ptrdiff_t>(out.deepest_node) * dim, dim,
                out.deepest_point.begin());
  return out;
}
} // namespace amontons
