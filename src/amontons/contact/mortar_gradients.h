#pragma once
#include "amontons/contact/mortar.h"
#include "amontons/contact/mortar_face.h"
#include "amontons/surface/normals.h"

namespace amontons
{
/// Normals at the corners of an impactor's faces along which mortar couples, and their derivatives.
class MortarNormals
{
public:
  explicit MortarNormals(const PlacedSurface &impactor);
  /// Outward, at a corner of face f; in the plane its third component is zero.
  [[nodiscard]] Eigen::Vector3d at(Index f, int corner) const;
  [[nodiscard]] NormalGradient gradient(Index f, int corner) const;

private:
  PlacedSurface impactor_;
  std::vector<double> normals_;
};

/// From faces' derivatives by their own variables to nodes' derivatives by positions.
class MortarGradientAssembly
{
public:
  MortarGradientAssembly(const PlacedSurface &impactor, const MortarNormals &normals);
  void add(Index f, FaceCoupling coupling);
  /// @param coupling of the nodes, made of the same faces
  [[nodiscard]] MortarGradients gather(const MortarCoupling &coupling) const;

private:
  struct Face
  {
    FaceCoupling coupling;
    std::vector<Index> nodes; ///< impactor nodes on which the face's variables depend
    RowMatrix own;            ///< how they do, [OverlapIntegrals::n_own x dim * n_nodes]
    RowMatrix target;         ///< how those of a target node do on its position, [2 x dim]
  };
  /// A face round a node: which of its corners with a multiplier the node is, and the normal there.
  struct Round
  {
    const Face *face;
    std::size_t corner;
    Eigen::Vector3d normal;
    NormalGradient turning;
  };

  void set_variables_in_space(Index f, Face &face) const;
  void set_variables_in_plane(Index f, Face &face) const;
  [[nodiscard]] std::vector<Round> faces_round(Index j) const;
  [[nodiscard]] Eigen::MatrixXd weight_gradient(const std::vector<Round> &around, std::span<const Index> impactors,
                                                const MortarCoupling &coupling, Index j) const;
  [[nodiscard]] Eigen::MatrixXd normal_gradient(const std::vector<Round> &around,
                                                std::span<const Index> impactors) const;

  PlacedSurface impactor_;
  const MortarNormals &normals_;
  std::vector<Face> faces_;
  std::vector<Index> place_; ///< [n_faces], in faces_, or -1
};
} // namespace amontons
