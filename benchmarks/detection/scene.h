#pragma once
#include "amontons/surface/surface.h"

#include <string>
#include <vector>

namespace amontons::benchmark
{
/// Two surfaces near each other: the second is of the same kind, does not match the first, and lies at gaps from -0.2
/// to 0.8 of the local face (thin shells: of their thickness).
struct Scene
{
  std::string surface, shape; ///< shape: segments, triangles, quadrilaterals
  Surface impactor, target;
  double reach = 0;    ///< the largest gap
  double distance = 0; ///< w, as it is computed for that reach
};

/// @param surface one of scene_surfaces() @param n_nodes about how many on each side
/// @throws UserError if there is no such surface or shape
Scene make_scene(const std::string &surface, const std::string &shape, double n_nodes);

/// The names that make_scene() takes in that dimension.
std::vector<std::string> scene_surfaces(int dim);

/// Where the nodes are after `step` motions, smooth, each of which brings a node at most 0.05 w nearer to the other
/// side.
struct Positions
{
  std::vector<double> impactor, target;
};
Positions moved(const Scene &scene, int step);
} // namespace amontons::benchmark
