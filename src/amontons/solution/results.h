#pragma once
#include "amontons/bulk/mesh.h"
#include "amontons/contact/element.h"
#include "amontons/parallel/sharing.h"
#include "amontons/surface/surface.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace amontons
{
/// Everything that is known of one contact at the end of an increment; the only source of every number of force,
/// pressure, gap, slip and area. Arrays run over the nodes of the impactor surface, as far as the process has it: first
/// those that it owns, then the others of its faces, with what their owners know. Sums and extremes are the whole's.
struct ContactResult
{
  std::string name;
  const Surface *impactor = nullptr; ///< node_ids are positions in the whole mesh
  std::vector<Index> nodes;          ///< [n] positions in the process's mesh
  Index n_own = 0;
  GlobalIndex n_nodes = 0; ///< of the whole impactor
  int dim = 2;
  std::vector<double> gap;      ///< [n], length; infinity for a node without a pair; mortar: the mean at the node
  std::vector<double> pressure; ///< [n], compression positive; -lambda_n / area
  std::vector<double> traction; ///< [n * (dim-1)], on the impactor, along e_1, e_2 (contact/linearisation.h)
  std::vector<double> slip;     ///< [n * (dim-1)], summed over the increments since the node closed, same axes
  std::vector<ContactStatus> status;
  std::vector<double> force; ///< [n * dim], on the impactor node; axisymmetry: over the whole ring
  std::vector<double> area;  ///< [n], tributary, reference; mortar: of it what sees the target, if anything does
  // sums and extremes of the above
  int n_active = 0, n_stick = 0, n_slip = 0;
  std::array<double, 3> normal_force{0, 0, 0};     ///< vector, on the impactor
  std::array<double, 3> tangential_force{0, 0, 0}; ///< vector, on the impactor
  double max_pressure = 0;
  double min_gap = 0;      ///< over nodes with a pair
  double contact_area = 0; ///< of active nodes
};

/// Work done so far; the run record shows them.
struct Counters
{
  std::int64_t n_bulk_assemblies = 0;
  std::int64_t n_pattern_builds = 0;
  std::int64_t n_contact_updates = 0;
  std::int64_t n_factorizations = 0;
  std::int64_t n_preconditioner_setups = 0;
  std::int64_t n_detections = 0;
  std::int64_t n_newton_iterations = 0;
  std::int64_t n_linear_iterations = 0;
};

/// Force with which a prescribed region (an entry of `boundary`) or rigid body holds the rest, in total.
struct Reaction
{
  std::string region;
  std::array<double, 3> force{0, 0, 0};
};

/// A converged state.
struct SolutionState
{
  const Mesh *mesh = nullptr;     ///< what this process has of it
  const Sharing *nodes = nullptr; ///< of the mesh's nodes, then the points of analytic bodies
  double time = 0;
  int increment = 0;                ///< counts from 1; 0 is the initial state
  std::vector<double> displacement; ///< [n_nodes * dim]
  /// Cauchy stress, cell means, [n_cells * 6]: xx, yy, zz, xy, yz, xz (axisymmetry: zz is the hoop). Zero in rigid
  /// cells.
  std::vector<double> stress;
  std::vector<double> plastic_strain; ///< equivalent, cell means, [n_cells]; empty where no body is plastic
  std::vector<ContactResult> contacts;
  std::vector<Reaction> reactions;
};

/// One Newton iteration, as it ended.
struct IterationReport
{
  int iteration = 0;     ///< counts from 1
  double residual = 0;   ///< relative to the forces present
  double correction = 0; ///< largest displacement change over the largest displacement
  int n_status_changes = 0;
  int n_active = 0, n_stick = 0, n_slip = 0;
  double step_length = 1; ///< below 1 where the step was damped
  std::string remark;     ///< named causes, e.g. "node 812 open<->slip for the 3rd time"; empty if none
};

/// One increment, as it ended.
struct IncrementReport
{
  double time = 0; ///< at its end
  double time_step = 0;
  int newton_iterations = 0;
  int linear_iterations = 0;
  int cutbacks = 0; ///< attempts that failed before this one
};
} // namespace amontons
