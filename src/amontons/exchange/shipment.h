#pragma once
#include "amontons/parallel/bytes.h"
#include "amontons/surface/surface.h"

#include <map>
#include <span>
#include <vector>

namespace amontons
{
/// What of a surface goes to one process.
struct Shipment
{
  std::vector<Index> nodes; ///< those that are sent for their own sake, then those of the faces
  Index n_own = 0;          ///< the former
  std::vector<Index> faces;
};
using Shipments = std::map<Rank, Shipment>;

/// Appends to each shipment's own nodes those of its faces.
void add_nodes_of_faces(Shipments &shipments, const Surface &surface);

/// Ids and faces, bodies where the surface has them.
/// @param reference the nodes' reference coordinates, [n_nodes * dim]; empty: none are sent
/// @param room scratch, the same from call to call
void pack_topology(const Shipment &shipment, const Surface &surface, std::span<const double> reference,
                   std::vector<Index> &room, ByteWriter &writer);
/// Where the nodes are.
void pack_positions(const Shipment &shipment, int dim, std::span<const double> x, ByteWriter &writer);

/// The surface that shipments from several processes make up: nodes and faces by increasing id, each once.
class HeldSurface
{
public:
  struct Source
  {
    Rank rank = 0;
    Index n_own = 0;
    std::vector<Index> nodes, faces; ///< of its shipment, in its order: where they are on the surface
  };

  /// @param side "impactor" or "target", for messages
  HeldSurface(int dim, const char *side)
    : side_(side)
  {
    surface_.dim = dim;
  }

  void add_topology(Rank rank, ByteReader &reader);
  /// After the last add_topology().
  /// @param repeated_faces whether several may send the same face; else that is an error
  /// @throws UserError where a face is sent, or a node owned, twice
  void merge(bool repeated_faces = false);

  /// Takes in all sources' positions, in their order.
  /// @param readers one per source @throws UserError where a node is at two places
  void move(std::span<ByteReader> readers);

  [[nodiscard]] const std::vector<Source> &sources() const { return sources_; }
  /// Its reference coordinates are those sent, else where the nodes were at first.
  [[nodiscard]] const Surface &surface() const { return surface_; }
  [[nodiscard]] Surface take_surface() { return std::move(surface_); }
  /// Current coordinates, [n_nodes * dim].
  [[nodiscard]] const std::vector<double> &x() const { return x_; }

private:
  void merge_nodes();
  void merge_faces(bool repeated);
  void place(std::vector<double> &x, std::size_t source, std::span<const double> from) const;

  /// As sent; nodes of faces by their place in the shipment.
  struct Sent
  {
    std::vector<GlobalIndex> node_ids, face_ids;
    std::vector<double> reference;
    std::vector<std::uint8_t> face_sizes;
    std::vector<Index> face_nodes, face_bodies;
  };

  const char *side_;
  Surface surface_;
  std::vector<Source> sources_;
  std::vector<Sent> sent_; ///< until they are merged
  std::vector<double> x_;
};
} // namespace amontons
