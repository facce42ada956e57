#pragma once
#include "amontons/detection/detector.h"
#include "amontons/exchange/parallel_detector.h"
#include "amontons/solution/contact_interface.h"

#include <memory>
#include <span>
#include <vector>

namespace amontons
{
/// Finds the faces that impactor nodes see, of all contacts that are searched (ContactInterface::is_searched): by a
/// Detector each on one process, over several by one ParallelDetector, which finds the same.
class ContactSearch
{
public:
  /// Collective, as all members but those of the last search. @param contacts must stay where they are
  /// @param messages null on one process
  ContactSearch(std::span<const ContactInterface> contacts, const DetectionOptions &options,
                const ExchangeOptions &exchange, const std::shared_ptr<MessageExchange> &messages);

  /// @param displacement nodal, of the process; of the searched contacts' own surfaces
  /// @param reaches by contact, see Detector::detect @param reference leaves displacements out (small strain)
  void search(std::span<const double> displacement, std::span<const double> reaches, bool reference);

  /// What contact `c` has found in the last search, and the target that its faces are on.
  [[nodiscard]] const Pairing &pairs(std::size_t c) const { return *of_contact_[c].pairs; }
  [[nodiscard]] const Surface &target(std::size_t c) const { return *of_contact_[c].target; }
  /// Of this process's nodes.
  [[nodiscard]] DetectionReport report(std::size_t c) const;

private:
  struct Searched
  {
    std::vector<double> impactor_x, target_x;
    std::unique_ptr<Detector> detector; ///< on one process
    const Pairing *pairs = nullptr;
    const Surface *target = nullptr;
  };
  std::span<const ContactInterface> contacts_;
  DetectionOptions options_;
  std::shared_ptr<MessageExchange> messages_;
  std::vector<std::size_t> searched_; ///< contacts
  std::vector<Searched> of_contact_;  ///< by contact
  std::unique_ptr<ParallelDetector> parallel_;
};
} // namespace amontons
