#pragma once
#include "amontons/surface/surface.h"

#include <Eigen/Core>

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

/// How one of these normals turns: [dim x dim * nodes.size()], its columns in the order of the nodes.
struct NormalGradient
{
  std::vector<Index> nodes;
  Eigen::MatrixXd gradient;
};

/// Of the normal at place `corner` of Surface::face_nodes, a corner of face f. Which faces are averaged is a datum.
NormalGradient smoothed_normal_gradient(const Surface &surface, std::span<const double> x, double sharp_angle, Index f,
                                        Index corner);
} // namespace amontons
