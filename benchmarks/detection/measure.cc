#include "detection/measure.h"

#include "amontons/base/error.h"
#include "surface/surfaces.h"

#include <malloc.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace amontons::benchmark
{
namespace
{
using nlohmann::json;

constexpr int n_motions = 3;
constexpr double infinite = std::numeric_limits<double>::infinity();

std::size_t heap_bytes()
{
  const auto heap = mallinfo2();
  return heap.uordblks + heap.hblkhd;
}

std::unique_ptr<Method> make_method(const Scene &scene, const std::string &name)
{
  if (name == "exact" || name == "nearest-node")
    return make_own_method(scene, name, false);
  if (name == "nanoflann")
    return make_nanoflann_method(scene);
  if (name == "cgal")
    return make_cgal_method(scene);
  if (name == "embree")
    return make_embree_method(scene);
  throw UserError("no method '" + name + "': exact, nearest-node, brute, nanoflann, cgal or embree");
}

// The samples of one method; all in ns per impactor node.
struct Samples
{
  std::vector<double> setup, build, query, total, again, moved;
  std::map<std::string, std::vector<double>> steps;
  double bytes = 0; ///< per surface node, both sides
  std::vector<double> distances;
  Index n_wrong_again = 0;
};

double median(std::vector<double> values)
{
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

class Measurement
{
public:
  Measurement(const Scene &scene, const Settings &settings)
    : scene_(scene)
    , settings_(settings)
  {
    for (int step = 0; step <= n_motions; ++step)
      positions_.push_back(moved(scene, step));
    ns_ = 1e9 / scene.impactor.n_nodes();
  }

  json run()
  {
    for (int repeat = 0; repeat < settings_.repeats; ++repeat)
      for (const std::string &name : settings_.methods)
        if (name != "brute")
          sample(name, samples_[name]);
    const std::vector<Index> brute_nodes = chosen_nodes();
    std::vector<double> brute_distances;
    if (std::find(settings_.methods.begin(), settings_.methods.end(), "brute") != settings_.methods.end())
      brute_distances = brute(brute_nodes);
    const std::vector<double> least = least_distances(brute_nodes, brute_distances);
    json result = json::array();
    for (const std::string &name : settings_.methods)
      if (name != "brute")
        result.push_back(summary(name, samples_[name], least));
    if (!brute_distances.empty())
      result.push_back(brute_summary(brute_nodes.size()));
    return result;
  }

private:
  void sample(const std::string &name, Samples &samples)
  {
    const std::size_t before = heap_bytes();
    const auto method = make_method(scene_, name);
    const Phases first = method->detect(positions_[0]);
    samples.setup.push_back(first.setup * ns_);
    samples.build.push_back(first.build * ns_);
    samples.query.push_back(first.query * ns_);
    samples.total.push_back((first.build + first.query) * ns_);
    for (const auto &[step, seconds] : first.steps)
      samples.steps[step].push_back(seconds * ns_);
    const auto n_nodes = static_cast<double>(scene_.impactor.n_nodes()) + scene_.target.n_nodes();
    samples.bytes = static_cast<double>(heap_bytes() - before + method->bytes_apart()) / n_nodes;
    if (samples.distances.empty() && name != "exact" && name != "nearest-node")
      samples.distances = method->distances();
    double again = 0;
    const int n_steps = method->keeps_pairs() ? n_motions : 1;
    for (int step = 1; step <= n_steps; ++step)
    {
      const Phases phases = method->detect(positions_[step]);
      again += phases.build + phases.query;
    }
    samples.again.push_back(again / n_steps * ns_);
    if (method->keeps_pairs())
    {
      const Phases phases = make_method(scene_, name)->detect(positions_[n_steps]);
      samples.moved.push_back((phases.build + phases.query) * ns_);
    }
    if (samples.distances.empty())
      compare_own(name, samples);
  }

  // Nothing but closest points, so that they can be compared; and whether those after some motions are, number by
  // number, those from nothing.
  void compare_own(const std::string &name, Samples &samples) const
  {
    const auto kept = make_own_method(scene_, name, true), fresh = make_own_method(scene_, name, true);
    kept->detect(positions_[0]);
    samples.distances = kept->distances();
    for (int step = 1; step <= n_motions; ++step)
      kept->detect(positions_[step]);
    fresh->detect(positions_[n_motions]);
    const std::vector<double> again = kept->distances(), first = fresh->distances();
    for (std::size_t i = 0; i < first.size(); ++i)
      samples.n_wrong_again += again[i] != first[i];
  }

  // As many as brute force can do.
  [[nodiscard]] std::vector<Index> chosen_nodes() const
  {
    std::vector<Index> nodes(scene_.impactor.node_ids.size());
    std::iota(nodes.begin(), nodes.end(), 0);
    std::mt19937 random(1);
    std::shuffle(nodes.begin(), nodes.end(), random);
    const double affordable = std::max(settings_.brute_pairs / scene_.target.n_faces(), 5.0);
    nodes.resize(std::min(nodes.size(), static_cast<std::size_t>(affordable)));
    return nodes;
  }

  std::vector<double> brute(const std::vector<Index> &nodes)
  {
    std::vector<double> x;
    const int dim = scene_.impactor.dim;
    for (const Index node : nodes)
      for (int c = 0; c < dim; ++c)
        x.push_back(scene_.impactor.reference[static_cast<std::size_t>(node) * dim + c]);
    Scene part{scene_.surface, scene_.shape, test::cloud(dim, x), scene_.target, scene_.reach, scene_.distance};
    const std::size_t before = heap_bytes();
    const auto method = make_own_method(part, "brute", true);
    const Phases phases = method->detect({part.impactor.reference, part.target.reference});
    brute_bytes_ = static_cast<double>(heap_bytes() - before) / (part.impactor.n_nodes() + part.target.n_nodes());
    brute_ns_ = phases.query / static_cast<double>(nodes.size()) * 1e9;
    return method->distances();
  }

  // Every method gives the distance of some point of the target: the least of them is the best known.
  [[nodiscard]] std::vector<double> least_distances(const std::vector<Index> &brute_nodes,
                                                    const std::vector<double> &brute_distances) const
  {
    std::vector<double> least(scene_.impactor.node_ids.size(), infinite);
    for (const auto &[name, samples] : samples_)
      for (std::size_t i = 0; i < least.size(); ++i)
        least[i] = std::min(least[i], samples.distances[i]);
    for (std::size_t i = 0; i < brute_distances.size(); ++i)
      least[brute_nodes[i]] = std::min(least[brute_nodes[i]], brute_distances[i]);
    return least;
  }

  [[nodiscard]] json head(const std::string &name) const
  {
    return {{"surface", scene_.surface},
            {"dimension", scene_.target.dim},
            {"shape", scene_.shape},
            {"n_impactor", scene_.impactor.n_nodes()},
            {"n_target", scene_.target.n_nodes()},
            {"n_faces", scene_.target.n_faces()},
            {"distance", scene_.distance},
            {"method", name}};
  }

  // Adds how many nodes are farther from what was found than from the target, and by how much at most, in units of w.
  void count_wrong(json &result, const std::vector<double> &distances, const std::vector<double> &least) const
  {
    double size = 0;
    for (const double x : scene_.target.reference)
      size = std::max(size, std::abs(x));
    const double allowed = 1e-12 * scene_.distance + 4e-16 * size;
    Index n_wrong = 0, n_lost = 0;
    double worst = 0;
    for (std::size_t i = 0; i < least.size(); ++i)
    {
      const bool lost = distances[i] == infinite && least[i] < infinite;
      n_lost += lost;
      if (distances[i] < infinite && distances[i] > least[i] + allowed)
      {
        ++n_wrong;
        worst = std::max(worst, (distances[i] - least[i]) / scene_.distance);
      }
    }
    result["wrong"] = n_wrong + n_lost;
    result["lost"] = n_lost;
    result["worst_excess"] = worst;
  }

  [[nodiscard]] json summary(const std::string &name, const Samples &samples, const std::vector<double> &least) const
  {
    json result = head(name);
    result["setup_ns"] = median(samples.setup);
    result["build_ns"] = median(samples.build);
    result["query_ns"] = median(samples.query);
    result["total_ns"] = median(samples.total);
    result["redetect_ns"] = median(samples.again);
    if (!samples.moved.empty())
      result["moved_ns"] = median(samples.moved);
    result["bytes_per_node"] = samples.bytes;
    result["repeats"] = samples.total.size();
    result["fastest_total_ns"] = *std::min_element(samples.total.begin(), samples.total.end());
    for (const auto &[step, values] : samples.steps)
      result["steps_ns"][step] = median(values);
    count_wrong(result, samples.distances, least);
    if (name == "exact")
      result["wrong_again"] = samples.n_wrong_again;
    if (name == "nearest-node")
      result["occupied_cells"] = occupied_cells();
    return result;
  }

  [[nodiscard]] json brute_summary(std::size_t n_nodes) const
  {
    json result = head("brute");
    result["build_ns"] = 0;
    result["query_ns"] = result["total_ns"] = result["redetect_ns"] = brute_ns_;
    result["bytes_per_node"] = brute_bytes_;
    result["wrong"] = 0;
    result["sampled_nodes"] = n_nodes;
    return result;
  }

  // Cells of the paper's grid that hold a target node.
  [[nodiscard]] std::size_t occupied_cells() const
  {
    const int dim = scene_.target.dim;
    const std::vector<double> &x = scene_.target.reference;
    std::vector<std::array<std::int32_t, 3>> cells(scene_.target.node_ids.size(), {0, 0, 0});
    for (int c = 0; c < dim; ++c)
    {
      double low = infinite, high = -infinite;
      for (std::size_t i = c; i < x.size(); i += dim)
      {
        low = std::min(low, x[i]);
        high = std::max(high, x[i]);
      }
      low -= scene_.distance;
      const double length = high + scene_.distance - low;
      const double n_cells = std::max(std::floor(length / (2 * scene_.distance)), 1.0);
      for (std::size_t i = 0; i < cells.size(); ++i)
        cells[i][c] = static_cast<std::int32_t>((x[i * dim + c] - low) / length * n_cells);
    }
    std::sort(cells.begin(), cells.end());
    return static_cast<std::size_t>(std::unique(cells.begin(), cells.end()) - cells.begin());
  }

  const Scene &scene_;
  const Settings &settings_;
  std::vector<Positions> positions_;
  double ns_ = 0;
  std::map<std::string, Samples> samples_;
  double brute_ns_ = 0, brute_bytes_ = 0;
};
} // namespace

nlohmann::json measure(const Scene &scene, const Settings &settings)
{
  return Measurement(scene, settings).run();
}
} // namespace amontons::benchmark
