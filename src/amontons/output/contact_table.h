#pragma once
#include "amontons/output/folder.h"
#include "amontons/solution/observer.h"

#include <string>

namespace amontons
{
/// The nodes of a contact's impactor surface as CSV, one row each (docs/outputs.md). `state` holds the displacements
/// and the mesh that the nodes' positions refer to. Over several processes the rows of all on process 0, by the nodes'
/// positions in the whole mesh; of no use elsewhere. Collective.
std::string contact_table(const ContactResult &contact, const SolutionState &state);

/// Keeps contact_<name>.csv at the last converged increment. To be on all processes.
class ContactTables : public Observer
{
public:
  /// `folder` must outlive it.
  explicit ContactTables(const ResultFolder &folder)
    : folder_(folder)
  {
  }
  void accepted(const IncrementReport &report, const SolutionState &state) override;

private:
  const ResultFolder &folder_;
};
} // namespace amontons
