// How a parallel code uses Amontons::exchange: each process gives what it has of two surfaces, and is told what its
// nodes see, whoever holds it. Here a bumpy sheet is pressed down on a flat one and drawn along it. Both are cut into
// strips, the upper one along x, the lower one along y, so that what lies above each other is mostly on different
// processes.
#include <amontons/exchange/parallel_detector.h>

#include <mpi.h>

#include <cmath>
#include <cstdio>
#include <exception>
#include <vector>

namespace
{
using amontons::GlobalIndex;
using amontons::Index;

constexpr int n_cells = 60; // along each edge of a sheet of unit length

/// A strip of a sheet of n by n quadrilaterals: rows [first, last) along one direction.
struct Strip
{
  int first, last;
  bool along_x;  ///< rows follow one another in the direction of x
  bool is_upper; ///< its outward normal points down
};

GlobalIndex node_id(int i, int j)
{
  return GlobalIndex{j} * (n_cells + 1) + i;
}

/// Own nodes first: those of each row's lower edge, and of the upper edge where the sheet ends.
amontons::Surface strip_surface(const Strip &strip, Index &n_own)
{
  amontons::Surface surface;
  surface.dim = 3;
  const int n_own_rows = strip.last - strip.first + (strip.last == n_cells ? 1 : 0);
  n_own = n_own_rows * (n_cells + 1);
  for (int row = strip.first; row <= strip.last; ++row)
    for (int k = 0; k <= n_cells; ++k)
    {
      const int i = strip.along_x ? row : k, j = strip.along_x ? k : row;
      surface.node_ids.push_back(node_id(i, j));
      surface.reference.insert(surface.reference.end(), {double(i) / n_cells, double(j) / n_cells, 0.0});
    }
  const auto local = [&](int row, int k) { return (row - strip.first) * (n_cells + 1) + k; };
  for (int row = strip.first; row < strip.last; ++row)
    for (int k = 0; k < n_cells; ++k)
    {
      const Index a = local(row, k), b = local(row + 1, k), c = local(row + 1, k + 1), d = local(row, k + 1);
      // Counter-clockwise seen from outside.
      if (strip.along_x != strip.is_upper)
        surface.face_nodes.insert(surface.face_nodes.end(), {a, b, c, d});
      else
        surface.face_nodes.insert(surface.face_nodes.end(), {a, d, c, b});
      surface.face_offsets.push_back(static_cast<Index>(surface.face_nodes.size()));
      surface.face_ids.push_back(GlobalIndex{row} * n_cells + k);
    }
  surface.build_adjacency();
  return surface;
}

/// The upper sheet at a time from 0 to 1: its bumps' tips reach 0.01 below z = 0 at last.
std::vector<double> upper_positions(const amontons::Surface &upper, double time)
{
  std::vector<double> x = upper.reference;
  for (std::size_t i = 0; i < x.size(); i += 3)
  {
    const double bump = 0.02 * std::cos(6.283185307179586 * 3 * x[i]) * std::cos(6.283185307179586 * 2 * x[i + 1]);
    x[i] += 0.1 * time;
    x[i + 2] = 0.03 + bump - 0.02 * time;
  }
  return x;
}

/// @return nodes that a plane z = 0 says are paired wrongly
int check(const amontons::MetPairing &met, const std::vector<double> &x, int &n_met, double &deepest)
{
  int n_wrong = 0;
  for (std::size_t i = 0; i < met.pairs.size(); ++i)
  {
    const amontons::Pair &pair = met.pairs[i];
    const bool is_above = x[3 * i] <= 1; // the rest has been drawn past the lower sheet's end
    if (pair.face < 0)
      continue;
    ++n_met;
    deepest = std::min(deepest, pair.gap);
    // What the host needs of the face it has been given: ids of the nodes, to couple their unknowns, and their places.
    double shape_x = 0;
    const auto nodes = met.target.face(pair.face);
    const double s = pair.xi[0], t = pair.xi[1];
    const double weights[] = {(1 - s) * (1 - t), s * (1 - t), s * t, (1 - s) * t};
    for (std::size_t k = 0; k < nodes.size(); ++k)
      shape_x += weights[k] * met.target_x[3 * static_cast<std::size_t>(nodes[k])];
    if (std::abs(pair.gap - x[3 * i + 2]) > 1e-12 || (is_above && std::abs(shape_x - x[3 * i]) > 1e-12))
      ++n_wrong;
  }
  return n_wrong;
}

int run(const amontons::Communicator &world)
{
  const int rank = world.rank(), size = world.size();
  const int first = n_cells * rank / size, last = n_cells * (rank + 1) / size;
  Index n_own = 0, not_used = 0;
  const amontons::Surface upper = strip_surface({first, last, true, true}, n_own);
  const amontons::Surface lower = strip_surface({first, last, false, false}, not_used);

  amontons::ContactShare share;
  share.impactor = &upper;
  share.n_own = n_own;
  share.target = &lower;
  const auto detector = amontons::make_parallel_detector(world, {}, {share});
  int n_wrong = 0;
  for (int step = 0; step <= 10; ++step)
  {
    const std::vector<double> x = upper_positions(upper, 0.1 * step);
    const auto &met = detector->detect(std::vector<amontons::SharePositions>{{x, lower.reference, 0.05}});
    int n_met = 0;
    double deepest = 0;
    n_wrong += check(met[0], x, n_met, deepest);
    std::int64_t bytes = 0;
    for (const auto &[phase, traffic] : detector->report().traffic)
      bytes += traffic.bytes;
    MPI_Allreduce(MPI_IN_PLACE, &n_met, 1, MPI_INT, MPI_SUM, world.mpi());
    MPI_Allreduce(MPI_IN_PLACE, &deepest, 1, MPI_DOUBLE, MPI_MIN, world.mpi());
    if (rank == 0)
      std::printf("step %2d: %d nodes see a face, deepest gap %.4f; process 0 sent %lld bytes%s\n", step, n_met,
                  deepest, static_cast<long long>(bytes), detector->report().kept_routes ? ", routes kept" : "");
  }
  MPI_Allreduce(MPI_IN_PLACE, &n_wrong, 1, MPI_INT, MPI_SUM, world.mpi());
  if (rank == 0 && n_wrong > 0)
    std::printf("%d pairs are wrong\n", n_wrong);
  return n_wrong > 0 ? 1 : 0;
}
} // namespace

int main(int argc, char **argv)
{
  MPI_Init(&argc, &argv);
  int code = 1;
  try
  {
    code = run(amontons::Communicator(MPI_COMM_WORLD));
  }
  catch (const std::exception &error) // the same on all processes
  {
    std::fprintf(stderr, "%s\n", error.what());
  }
  MPI_Finalize();
  return code;
}
