#include "amontons/exchange/distributed_detector.h"

#include "amontons/exchange/contact_sides.h"
#include "amontons/exchange/measures.h"
#include "amontons/exchange/met_faces.h"
#include "amontons/exchange/part_work.h"
#include "amontons/exchange/routes.h"
#include "amontons/exchange/space_cut.h"
#include "amontons/parallel/agreement.h"

#include <algorithm>
#include <cmath>

namespace amontons
{
namespace
{
// A layer is never less than this over w, against round-off.
constexpr double least_skin = 1e-6;

class DistributedDetector : public ParallelDetector
{
public:
  DistributedDetector(const Communicator &communicator, double skin, std::vector<ContactShare> shares)
    : messages_(communicator)
    , skin_(skin)
    , shares_(std::move(shares))
    , work_(shares_)
    , sides_(messages_, false)
  {
  }

  const std::vector<MetPairing> &detect(std::span<const SharePositions> positions) override;
  [[nodiscard]] const ParallelReport &report() const override { return report_; }

private:
  const std::vector<MetPairing> &detect_all(std::span<const SharePositions> positions);
  void measure_all(std::span<const SharePositions> positions);
  void reduce_measures(std::span<const SharePositions> positions);
  [[nodiscard]] bool routes_hold() const;
  void renew_routes(std::span<const SharePositions> positions);
  std::vector<std::vector<Rank>> parts_of_nodes(std::span<const SharePositions> positions);
  void collect_work(std::size_t contact, const SharePositions &positions, std::vector<Place> &points) const;
  void reduce_regions(std::vector<PartRegions> &regions);
  void remember(std::span<const SharePositions> positions);
  void collect_pairs(std::span<const SharePositions> positions, const std::vector<Message> &found);

  [[nodiscard]] bool is_self(std::size_t contact) const { return !shares_[contact].target; }

  MessageExchange messages_;
  double skin_;
  std::vector<ContactShare> shares_;
  PartWork work_;
  ContactSides sides_;
  std::vector<Measures> measures_; ///< by contact; of all processes once they are reduced
  std::vector<ContactRoutes> routes_;
  std::vector<double> layers_;                                   ///< that routes hold for
  std::vector<std::vector<double>> impactor_then_, target_then_; ///< where nodes were when routes were made
  std::vector<MetPairing> met_;
  ParallelReport report_;
};

const std::vector<MetPairing> &DistributedDetector::detect(std::span<const SharePositions> positions)
{
  try
  {
    return detect_all(positions);
  }
  catch (...)
  {
    routes_.clear(); // on all processes
    throw;
  }
}

const std::vector<MetPairing> &DistributedDetector::detect_all(std::span<const SharePositions> positions)
{
  const Communicator &all = messages_.communicator();
  messages_.forget_traffic();
  report_ = {};
  measure_all(positions);
  report_.kept_routes = routes_hold();
  std::vector<Message> in, out;
  if (!report_.kept_routes)
    renew_routes(positions);
  agree_on_errors(all, [&] { out = pack(shares_, positions, routes_, !report_.kept_routes); });
  in = report_.kept_routes ? messages_.exchange_with("positions", std::move(out), work_.sources())
                           : messages_.exchange("surfaces", std::move(out));
  agree_on_errors(all,
                  [&]
                  {
                    if (report_.kept_routes)
                      work_.take_positions(in);
                    else
                      work_.take_surfaces(in);
                    work_.detect(report_.distances);
                  });
  report_.n_hub_nodes = sides_.assign(work_);
  agree_on_errors(all, [&] { out = work_.results(); });
  in = messages_.exchange_with("pairs", std::move(out), destinations(routes_));
  agree_on_errors(all, [&] { collect_pairs(positions, in); });
  work_.count(report_);
  report_.traffic = messages_.traffic();
  return met_;
}

void DistributedDetector::measure_all(std::span<const SharePositions> positions)
{
  const Communicator &all = messages_.communicator();
  std::vector<double> least(shares_.size());
  agree_on_errors(all,
                  [&]
                  {
                    AMONTONS_ASSERT(positions.size() == shares_.size());
                    measures_.clear();
                    for (std::size_t c = 0; c < shares_.size(); ++c)
                    {
                      const int dim = shares_[c].impactor->dim;
                      Measures &own = measures_.emplace_back(measure(shares_[c], positions[c]));
                      least[c] = least_distance(shares_[c], positions[c]);
                      if (routes_.empty())
                        continue;
                      own.impactor_motion = motion(dim, impactor_then_[c], positions[c].impactor);
                      own.target_motion = motion(dim, target_then_[c], target_positions(shares_[c], positions[c]));
                    }
                  });
  reduce_measures(positions);
  if (std::none_of(shares_.begin(), shares_.end(),
                   [](const ContactShare &share) { return is_to_be_checked(share.detection); }))
    return;
  messages_.maximum("bounds", least);
  agree_on_errors(all,
                  [&]
                  {
                    for (std::size_t c = 0; c < shares_.size(); ++c)
                      check_distance(shares_[c], positions[c], least[c]);
                  });
}

// Each side's least corner is the greatest of what is negated.
void DistributedDetector::reduce_measures(std::span<const SharePositions> positions)
{
  std::vector<double> values;
  for (std::size_t c = 0; c < shares_.size(); ++c)
  {
    const Measures &own = measures_[c];
    for (const Box *box : {&own.impactor, &own.target})
      for (std::size_t k = 0; k < 3; ++k)
        values.insert(values.end(), {-box->low[k], box->high[k]});
    values.insert(values.end(),
                  {own.distance, own.impactor_motion, own.target_motion, positions[c].reach, -positions[c].reach});
  }
  messages_.maximum("bounds", values);
  const double *value = values.data();
  report_.distances.clear();
  for (Measures &all : measures_)
  {
    for (Box *box : {&all.impactor, &all.target})
      for (std::size_t k = 0; k < 3; ++k)
      {
        box->low[k] = -*value++;
        box->high[k] = *value++;
      }
    all.distance = *value++;
    all.impactor_motion = *value++;
    all.target_motion = *value++;
    const double greatest_reach = *value++, least_reach = -*value++;
    AMONTONS_ASSERT(greatest_reach == least_reach); // on all processes or on none
    report_.distances.push_back(all.distance);
  }
}

// A target point within w of a node now was within w and both motions of where the node was.
bool DistributedDetector::routes_hold() const
{
  if (routes_.empty())
    return false;
  for (std::size_t c = 0; c < shares_.size(); ++c)
    if (measures_[c].distance + measures_[c].approach() > layers_[c])
      return false;
  return true;
}

void DistributedDetector::renew_routes(std::span<const SharePositions> positions)
{
  layers_.clear();
  for (const Measures &measures : measures_)
    layers_.push_back((1 + std::max(skin_, least_skin)) * measures.distance);
  const std::vector<std::vector<Rank>> parts = parts_of_nodes(positions);
  const int n_parts = messages_.communicator().size();
  std::vector<PartRegions> regions;
  for (std::size_t c = 0; c < shares_.size(); ++c)
    regions.push_back(regions_of(shares_[c], positions[c], parts[c], n_parts));
  reduce_regions(regions);
  routes_.clear();
  for (std::size_t c = 0; c < shares_.size(); ++c)
    routes_.push_back(make_routes(shares_[c], positions[c], parts[c], regions[c], layers_[c]));
  remember(positions);
}

// Nodes that nothing of the other side can come near to need not be looked for, nor faces.
std::vector<std::vector<Rank>> DistributedDetector::parts_of_nodes(std::span<const SharePositions> positions)
{
  std::vector<Place> points;
  for (std::size_t c = 0; c < shares_.size(); ++c)
    if (!is_self(c))
      collect_work(c, positions[c], points);
  const SpaceCut common(messages_, "cut", points);
  std::vector<std::vector<Rank>> parts;
  for (std::size_t c = 0; c < shares_.size(); ++c)
  {
    const Surface &impactor = *shares_[c].impactor;
    std::vector<Rank> &own = parts.emplace_back(impactor.node_ids.size(), -1);
    if (is_self(c))
    {
      points.clear();
      for (Index node = 0; node < shares_[c].n_own; ++node)
        points.push_back(place_of(impactor.reference, impactor.dim, node));
      const SpaceCut cut(messages_, "cut", points);
      for (Index node = 0; node < impactor.n_nodes(); ++node)
        own[node] = cut.part_of(place_of(impactor.reference, impactor.dim, node));
      continue;
    }
    for (Index node = 0; node < impactor.n_nodes(); ++node)
      if (const Place x = place_of(positions[c].impactor, impactor.dim, node); measures_[c].target.holds(x, layers_[c]))
        own[node] = common.part_of(x);
  }
  return parts;
}

void DistributedDetector::collect_work(std::size_t contact, const SharePositions &positions,
                                       std::vector<Place> &points) const
{
  const ContactShare &share = shares_[contact];
  const double layer = layers_[contact];
  for (Index node = 0; node < share.n_own; ++node)
    if (const Place x = place_of(positions.impactor, share.impactor->dim, node);
        measures_[contact].target.holds(x, layer))
      points.push_back(x);
  for (Index f = 0; f < share.target->n_faces(); ++f)
    if (const Box box = box_of(positions.target, share.target->dim, share.target->face(f));
        measures_[contact].impactor.meets(box, layer))
      points.push_back(box.centre());
}

void DistributedDetector::reduce_regions(std::vector<PartRegions> &regions)
{
  std::vector<double> values;
  const auto each_box = [&regions](auto visit)
  {
    for (PartRegions &contact : regions)
      for (std::vector<Box> *boxes : {&contact.now, &contact.reference})
        for (Box &box : *boxes)
          visit(box);
  };
  each_box(
      [&](const Box &box)
      {
        for (std::size_t k = 0; k < 3; ++k)
          values.insert(values.end(), {-box.low[k], box.high[k]});
      });
  for (const PartRegions &contact : regions)
    values.insert(values.end(), contact.near.begin(), contact.near.end());
  messages_.maximum("cut", values);
  const double *value = values.data();
  each_box(
      [&](Box &box)
      {
        for (std::size_t k = 0; k < 3; ++k)
        {
          box.low[k] = -*value++;
          box.high[k] = *value++;
        }
      });
  for (PartRegions &contact : regions)
    for (double &near : contact.near)
      near = *value++;
}

void DistributedDetector::remember(std::span<const SharePositions> positions)
{
  impactor_then_.clear();
  target_then_.clear();
  for (std::size_t c = 0; c < shares_.size(); ++c)
  {
    const auto target_x = target_positions(shares_[c], positions[c]);
    impactor_then_.emplace_back(positions[c].impactor.begin(), positions[c].impactor.end());
    target_then_.emplace_back(target_x.begin(), target_x.end());
  }
}

void DistributedDetector::collect_pairs(std::span<const SharePositions> positions, const std::vector<Message> &found)
{
  std::vector<ByteReader> readers;
  for (const Message &message : found)
    readers.emplace_back(message.bytes);
  met_.clear();
  for (std::size_t c = 0; c < shares_.size(); ++c)
  {
    MetFaces met(shares_[c].impactor->dim, shares_[c].n_own);
    for (std::size_t m = 0; m < found.size(); ++m)
      met.add(found[m].rank, nodes_sent(routes_[c], found[m].rank), readers[m]);
    tell_outside(met_.emplace_back(met.finish()).pairs, shares_[c].impactor->dim, positions[c].impactor,
                 measures_[c].target, measures_[c].distance);
  }
}
} // namespace

std::unique_ptr<ParallelDetector> make_distributed_detector(const Communicator &communicator, double skin,
                                                            std::vector<ContactShare> shares)
{
  return std::make_unique<DistributedDetector>(communicator, skin, std::move(shares));
}
} // namespace amontons
