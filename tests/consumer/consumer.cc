// What a host code does with Amontons::contact: detect, linearise, evaluate one contact element, no more than arrays.
#include <amontons/contact/element.h>
#include <amontons/contact/kinematics.h>
#include <amontons/detection/detector.h>

#include <cmath>
#include <cstdio>
#include <vector>

namespace
{
/// The upper side of a body below, y = 0 from x = 0 to 3, in three segments: outward normal +y.
amontons::Surface target_surface()
{
  amontons::Surface target;
  target.node_ids = {0, 1, 2, 3};
  target.reference = {0, 0, 1, 0, 2, 0, 3, 0};
  target.face_nodes = {1, 0, 2, 1, 3, 2};
  target.face_offsets = {0, 2, 4, 6};
  target.face_ids = {0, 1, 2};
  target.build_adjacency();
  return target;
}

/// One node that has sunk in by 0.02 at x = 1.25.
amontons::Surface impactor_surface()
{
  amontons::Surface impactor;
  impactor.node_ids = {10, 11};
  impactor.reference = {1.25, -0.02, 2.25, 0.3};
  impactor.face_nodes = {0, 1};
  impactor.face_offsets = {0, 2};
  impactor.face_ids = {3};
  impactor.build_adjacency();
  return impactor;
}

bool close(double a, double b, const char *what)
{
  const bool is_close = std::abs(a - b) < 1e-12;
  if (!is_close)
    std::printf("%s: %.15g, expected %.15g\n", what, a, b);
  return is_close;
}
} // namespace

int main()
{
  using namespace amontons;
  const Surface target = target_surface(), impactor = impactor_surface();
  const auto detector = make_detector({}, impactor, target);
  const Pair pair = detector->detect(impactor.reference, target.reference, 0)[0];
  if (pair.face != 1)
  {
    std::printf("the node was paired with face %d, expected 1\n", pair.face);
    return 1;
  }

  std::vector<double> face;
  for (const Index node : target.face(pair.face))
    face.insert(face.end(), {target.reference[2 * node], target.reference[2 * node + 1]});
  const std::vector<double> node{1.25, -0.02}, before{1.15, 0};
  const ContactLinearisation lin = linearise_finite(2, node, face, before, face, pair.xi);

  // r = 100: sigma_n = -2, sigma_t = 10 along e_1, which points to -x; with mu = 0.5 the node slips.
  const double mu = 0.5, r = 100;
  const ContactElement element = contact_element(lin, {}, mu, r, contact_status(lin, {}, mu, r));
  bool passed = element.status == ContactStatus::slip;
  passed &= close(lin.gap, -0.02, "gap");
  passed &= close(lin.slip[0], -0.1, "slip");
  passed &= close(element.force[0], 1, "friction on the node, which moved to +x (F_x stands with the internal forces)");
  passed &= close(element.force[1], -2, "normal force");
  passed &= close(element.force[2] + element.force[4], -1, "friction on the face");
  passed &= close(element.force[3] + element.force[5], 2, "normal force on the face");
  std::printf(passed ? "one contact element detected and evaluated\n" : "the element is wrong\n");
  return passed ? 0 : 1;
}
