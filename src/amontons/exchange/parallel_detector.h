#pragma once
#include "amontons/detection/options.h"
#include "amontons/exchange/options.h"
#include "amontons/parallel/message_exchange.h"
#include "amontons/surface/pairing.h"
#include "amontons/surface/surface.h"

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace amontons
{
/// What one process brings to one contact. Taken together, the shares make up the surfaces: each impactor node is owned
/// by one process, each face is given by one; a node of a face may be known to any number of them, at the same place
/// and by the same id. A process may bring nothing. Ids are unique within a side of a contact.
struct ContactShare
{
  /// The nodes that the process owns first, then those of its faces that others own. Faces serve to tell through which
  /// side of a thin body a node came (Detector); without them, nodes alone do.
  const Surface *impactor = nullptr;
  Index n_own = 0; ///< nodes of the impactor that are its own
  /// Null: self-contact, where the impactor's faces are the target's; then the reference coordinates and, if there are
  /// several bodies, Surface::face_bodies are needed.
  const Surface *target = nullptr;
  DetectionOptions detection; ///< the same on all processes
  std::optional<double> self_distance;
};

/// Where a share's nodes are.
struct SharePositions
{
  std::span<const double> impactor, target; ///< current coordinates, [n_nodes * dim]; self-contact: the impactor's only
  double reach = 0;                         ///< see Detector::detect; the same on all processes
};

/// What the impactor nodes of one process see of a target that others hold.
struct MetPairing
{
  Pairing pairs;                ///< of the own nodes, [n_own]; faces by their index on `target`
  Surface target;               ///< the faces met, nodes and faces by increasing id; without reference coordinates
  std::vector<double> target_x; ///< where its nodes are, [n_nodes * dim]
};

/// What this process did in the last detection.
struct ParallelReport
{
  bool kept_routes = false;      ///< no surface was sent, only where its nodes are
  Index n_sought = 0;            ///< impactor nodes that this process has looked for
  Index n_impactor_nodes = 0;    ///< that it held for it: with those of attached faces
  Index n_target_nodes = 0;      ///< that it held for it
  Index n_hub_nodes = 0;         ///< process 0, gathered: nodes of both sides; who tells the sides of self-contact
  std::vector<double> distances; ///< w of each contact
  std::map<std::string, Traffic> traffic; ///< what it has sent, by phase
};

/// Finds for each impactor node the face of the target that one process's Detector finds on the union of all shares,
/// its faces in the order of their ids: the same face, kind, reason, local coordinates and gap. Ties go by global ids,
/// so the result hangs neither on the number of processes nor on who brings what. All contacts go in the same messages.
class ParallelDetector
{
public:
  virtual ~ParallelDetector() = default;

  /// @param positions one entry per contact @return one entry per contact
  /// Collective.
  /// @throws on all processes: what Detector throws, UserError where the shares are not as ContactShare asks (a face
  /// given twice, a node owned twice or at two places, self-contact without reference coordinates)
  virtual const std::vector<MetPairing> &detect(std::span<const SharePositions> positions) = 0;

  /// Of the last detect(). Local.
  [[nodiscard]] virtual const ParallelReport &report() const = 0;
};

/// The shares' surfaces must outlive the detector, their adjacency must be built. Collective, as is its destruction.
std::unique_ptr<ParallelDetector> make_parallel_detector(const Communicator &communicator,
                                                         const ExchangeOptions &options,
                                                         std::vector<ContactShare> shares);
} // namespace amontons
