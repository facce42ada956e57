#include "amontons/exchange/gathered_detector.h"

#include "amontons/exchange/contact_sides.h"
#include "amontons/exchange/grid_cut.h"
#include "amontons/exchange/measures.h"
#include "amontons/exchange/met_faces.h"
#include "amontons/exchange/part_work.h"
#include "amontons/exchange/routes.h"
#include "amontons/parallel/agreement.h"

#include <numeric>

namespace amontons
{
namespace
{
constexpr Rank hub = 0;

class GatheredDetector : public ParallelDetector
{
public:
  GatheredDetector(const Communicator &communicator, std::vector<ContactShare> shares)
    : messages_(communicator)
    , shares_(std::move(shares))
    , whole_(shares_)
    , work_(shares_)
    , sides_(messages_, true)
  {
    if (messages_.communicator().rank() == hub)
    {
      all_.resize(messages_.communicator().size());
      std::iota(all_.begin(), all_.end(), 0);
    }
  }

  const std::vector<MetPairing> &detect(std::span<const SharePositions> positions) override;
  [[nodiscard]] const ParallelReport &report() const override { return report_; }

private:
  std::vector<Message> send_to_hub(std::span<const SharePositions> positions) const;
  std::vector<Message> hand_out(std::span<const SharePositions> positions, const std::vector<Message> &surfaces);
  ContactRoutes cut_grid(const ContactShare &share, const SharePositions &positions, const Measures &measures) const;
  std::vector<Message> hand_back(const std::vector<Message> &found);
  void take_own(const Message &found);

  MessageExchange messages_;
  std::vector<ContactShare> shares_;
  PartWork whole_; ///< the hub's: the surfaces of all
  PartWork work_;
  ContactSides sides_;
  std::vector<Rank> all_; ///< the hub's: all processes
  std::vector<Measures> measures_;
  std::vector<ContactRoutes> routes_; ///< the hub's, to the parts
  std::vector<MetPairing> met_;
  ParallelReport report_;
};

const std::vector<MetPairing> &GatheredDetector::detect(std::span<const SharePositions> positions)
{
  const Communicator &all = messages_.communicator();
  messages_.forget_traffic();
  report_ = {};
  if (shares_.empty()) // on all processes alike
    return met_;
  report_.distances.assign(shares_.size(), 0.0);
  std::vector<Message> in, out;
  agree_on_errors(all, [&] { out = send_to_hub(positions); });
  in = messages_.exchange_with("to hub", std::move(out), all_);
  out.clear();
  agree_on_errors(all, [&] { out = hand_out(positions, in); });
  messages_.maximum("bounds", report_.distances); // the hub's, to all
  in = messages_.exchange("surfaces", std::move(out));
  agree_on_errors(all,
                  [&]
                  {
                    work_.take_surfaces(in);
                    work_.detect(report_.distances);
                  });
  sides_.assign(work_);
  agree_on_errors(all, [&] { out = work_.results(); });
  in = messages_.exchange_with("pairs to hub", std::move(out), destinations(routes_));
  out.clear();
  agree_on_errors(all, [&] { out = hand_back(in); });
  in = messages_.exchange_with("pairs", std::move(out), std::array{hub});
  agree_on_errors(all, [&] { take_own(in.at(0)); });
  work_.count(report_);
  report_.traffic = messages_.traffic();
  return met_;
}

// Step 1.
std::vector<Message> GatheredDetector::send_to_hub(std::span<const SharePositions> positions) const
{
  AMONTONS_ASSERT(positions.size() == shares_.size());
  std::vector<ContactRoutes> routes(shares_.size());
  for (std::size_t c = 0; c < shares_.size(); ++c)
  {
    measure(shares_[c], positions[c]); // for what it throws, where the node is
    Shipment &impactor = routes[c].impactor[hub];
    impactor.n_own = shares_[c].n_own;
    impactor.nodes.resize(shares_[c].n_own);
    std::iota(impactor.nodes.begin(), impactor.nodes.end(), 0);
    impactor.faces.resize(shares_[c].impactor->face_ids.size());
    std::iota(impactor.faces.begin(), impactor.faces.end(), 0);
    add_nodes_of_faces(routes[c].impactor, *shares_[c].impactor);
    if (!shares_[c].target)
      continue;
    Shipment &target = routes[c].target[hub];
    target.faces.resize(shares_[c].target->face_ids.size());
    std::iota(target.faces.begin(), target.faces.end(), 0);
    add_nodes_of_faces(routes[c].target, *shares_[c].target);
  }
  return pack(shares_, positions, routes, true);
}

// Step 2: nothing to do for all but the hub.
std::vector<Message> GatheredDetector::hand_out(std::span<const SharePositions> positions,
                                                const std::vector<Message> &surfaces)
{
  routes_.clear();
  measures_.clear();
  if (surfaces.empty())
    return {};
  whole_.take_surfaces(surfaces);
  std::vector<ContactShare> shares = shares_;
  std::vector<SharePositions> places(positions.begin(), positions.end());
  for (std::size_t c = 0; c < shares.size(); ++c)
  {
    const PartContact &contact = whole_.contacts()[c];
    shares[c].impactor = &contact.impactor.surface();
    shares[c].n_own = shares[c].impactor->n_nodes();
    shares[c].target = contact.is_self ? nullptr : &contact.target.surface();
    places[c].impactor = contact.impactor.x();
    places[c].target = contact.target.x();
    measures_.push_back(measure(shares[c], places[c]));
    check_distance(shares[c], places[c], least_distance(shares[c], places[c]));
    report_.distances[c] = measures_[c].distance;
    report_.n_hub_nodes += contact.impactor.surface().n_nodes() + contact.target.surface().n_nodes();
    routes_.push_back(cut_grid(shares[c], places[c], measures_[c]));
  }
  return pack(shares, places, routes_, true);
}

ContactRoutes GatheredDetector::cut_grid(const ContactShare &share, const SharePositions &positions,
                                         const Measures &measures) const
{
  const Surface &impactor = *share.impactor;
  std::vector<Rank> part_of_node(impactor.node_ids.size(), -1);
  const GridCut grid(measures.target.grown(measures.distance), measures.distance, static_cast<int>(all_.size()));
  for (Index node = 0; node < impactor.n_nodes(); ++node)
    if (const Place x = place_of(positions.impactor, impactor.dim, node); measures.target.holds(x, measures.distance))
      part_of_node[node] = grid.part_of(x);
  PartRegions regions = regions_of(share, positions, part_of_node, static_cast<int>(all_.size()));
  regions.now = grid.grown_blocks();
  return make_routes(share, positions, part_of_node, regions, 0);
}

// Step 4, which process gets which elements.
std::vector<Message> GatheredDetector::hand_back(const std::vector<Message> &found)
{
  std::vector<ByteReader> readers;
  for (const Message &message : found)
    readers.emplace_back(message.bytes);
  std::vector<ByteWriter> writers(all_.size());
  std::vector<Index> room;
  for (std::size_t c = 0; c < routes_.size(); ++c)
  {
    const HeldSurface &impactor = whole_.contacts()[c].impactor;
    const int dim = impactor.surface().dim;
    MetFaces met_faces(dim, impactor.surface().n_nodes());
    for (std::size_t m = 0; m < found.size(); ++m)
      met_faces.add(found[m].rank, nodes_sent(routes_[c], found[m].rank), readers[m]);
    MetPairing met = met_faces.finish();
    tell_outside(met.pairs, dim, impactor.x(), measures_[c].target, measures_[c].distance);
    for (const HeldSurface::Source &source : impactor.sources())
      pack_pairs(std::span(source.nodes).first(static_cast<std::size_t>(source.n_own)), met.pairs, met.target,
                 met.target_x, room, writers[source.rank]);
  }
  std::vector<Message> messages;
  for (const Rank rank : all_)
    messages.push_back({rank, writers[rank].take()});
  return messages;
}

void GatheredDetector::take_own(const Message &found)
{
  ByteReader reader(found.bytes);
  met_.clear();
  for (const ContactShare &share : shares_)
  {
    std::vector<Index> own(share.n_own);
    std::iota(own.begin(), own.end(), 0);
    MetFaces met(share.impactor->dim, share.n_own);
    met.add(hub, own, reader);
    met_.push_back(met.finish());
  }
}
} // namespace

std::unique_ptr<ParallelDetector> make_gathered_detector(const Communicator &communicator,
                                                         std::vector<ContactShare> shares)
{
  return std::make_unique<GatheredDetector>(communicator, std::move(shares));
}
} // namespace amontons
