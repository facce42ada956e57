#pragma once
#include "amontons/surface/surface.h"

#include <span>
#include <vector>

namespace amontons
{
/// Unit outward normals at the corners of a surface's faces, averaged over the faces round each node so that they agree
/// with a circle or sphere through the nodes (weights: N. Max 1999, J. Graphics Tools 4; in the plane one over the
/// length). Across an edge sharper than `sharp_angle` nothing is averaged: each side keeps its own.
/// @param x coordinates, [n_nodes * dim] @param sharp_angle between the normals of two faces, radians
/// @return [face_nodes.size() * dim], in the order of Surface::face_nodes
std::vector<double> smoothed_normals(const Surface &surface, std::span<const double> x, double sharp_angle);
} // namespace amontons
