#include "amontons/detection/face_boxes.h"

#include "amontons/surface/projection.h"
#include "surface/surfaces.h"

#include <gtest/gtest.h>

namespace amontons::test
{
namespace
{
TEST(FaceBoxes, FindsEveryFaceOfTheBox)
{
  std::mt19937 random(5);
  std::uniform_real_distribution<double> share(-1, 1);
  const Surface plane = curve(700, [](double s) { return std::array{std::cos(9 * s), std::sin(7 * s)}; });
  const Surface wavy = sheet(40, 30, true,
                             [](double s, double t) {
                               return Point{2 * s - 1, 2 * t - 1, 0.3 * std::sin(9 * s) * std::cos(8 * t)};
                             });
  for (const Surface *surface : {&plane, &wavy})
  {
    const FaceBoxes boxes(*surface, surface->reference);
    std::vector<Index> found;
    for (int trial = 0; trial < 300; ++trial)
    {
      const Eigen::Vector3d middle(share(random), share(random), 0.3 * share(random));
      const Eigen::Vector3d half(0.1 * std::abs(share(random)), 0.3 * std::abs(share(random)), 0.1);
      const Eigen::AlignedBox3d box(middle - half, middle + half);
      boxes.meeting(box, found);
      ASSERT_TRUE(std::is_sorted(found.begin(), found.end()));
      for (Index f = 0; f < surface->n_faces(); ++f)
      {
        const FaceCoordinates face = gather_face(surface->dim, surface->face(f), surface->reference);
        Eigen::AlignedBox3d own;
        for (int i = 0; i < face.n_nodes; ++i)
          own.extend(face.x[i]);
        bool meets = true, nearly = true;
        for (int c = 0; c < surface->dim; ++c)
        {
          meets = meets && own.min()[c] <= box.max()[c] && own.max()[c] >= box.min()[c];
          nearly = nearly && own.min()[c] <= box.max()[c] + 1e-5 && own.max()[c] >= box.min()[c] - 1e-5;
        }
        const bool is_found = std::binary_search(found.begin(), found.end(), f);
        EXPECT_TRUE(is_found || !meets) << "face " << f;
        EXPECT_TRUE(!is_found || nearly) << "face " << f;
      }
    }
  }
}
} // namespace
} // namespace amontons::test
