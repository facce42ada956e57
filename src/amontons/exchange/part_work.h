#pragma once
#include "amontons/detection/detector.h"
#include "amontons/exchange/parallel_detector.h"
#include "amontons/exchange/shipment.h"

#include <memory>
#include <span>
#include <vector>

namespace amontons
{
/// One contact in the part that a process looks after. Local.
struct PartContact
{
  HeldSurface impactor, target;       ///< self-contact: impactor only
  std::unique_ptr<Detector> detector; ///< made when it is first needed
  Pairing pairs;
  bool is_self = false;

  [[nodiscard]] const HeldSurface &target_side() const { return is_self ? impactor : target; }
};

/// The part of all contacts that one process looks after: what others have sent, and what is found there. Local.
class PartWork
{
public:
  explicit PartWork(std::vector<ContactShare> shares)
    : shares_(std::move(shares))
  {
  }

  /// What pack() of routes.h has put together, with the topology.
  void take_surfaces(std::span<const Message> messages);
  /// Positions only, from the same processes as the surfaces.
  void take_positions(std::span<const Message> messages);

  /// @param distances w of each contact
  void detect(std::span<const double> distances);

  /// The pairs of each source's own nodes, to it: pack_pairs() contact by contact.
  [[nodiscard]] std::vector<Message> results() const;

  /// Who has sent something, by increasing rank.
  [[nodiscard]] const std::vector<Rank> &sources() const { return sources_; }
  [[nodiscard]] std::vector<PartContact> &contacts() { return contacts_; }
  void count(ParallelReport &report) const;

private:
  void move(std::vector<ByteReader> &readers);

  std::vector<ContactShare> shares_; ///< for their options
  std::vector<Rank> sources_;
  std::vector<PartContact> contacts_;
};
} // namespace amontons
