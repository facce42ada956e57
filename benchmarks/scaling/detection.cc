// Contact detection over many processes: what each sends and holds, and whether each node sees what it sees on one.
// JSON on standard output of process 0.
#include "amontons/base/error.h"
#include "detection/scene.h"
#include "exchange/shares.h"

#include <nlohmann/json.hpp>

#include <iostream>
#include <map>

namespace
{
using namespace amontons;
using nlohmann::json;

constexpr const char *usage =
    "usage: mpirun -n N bench_scaling --surface NAME|crowded|all --shape segments|triangles|quadrilaterals --nodes N\n"
    "         [--mode distributed|gathered|both] [--spread random|in-runs|apart|some-bare] [--steps 3]\n"
    "         [--distance w, of itself where it is not given]\n";

using Arguments = std::map<std::string, std::string>;

Arguments read_arguments(int n, char **given)
{
  Arguments arguments{{"mode", "distributed"}, {"spread", "random"}, {"steps", "3"}};
  for (int i = 1; i + 1 < n; i += 2)
    arguments[std::string(given[i]).substr(2)] = given[i + 1];
  if (!arguments.contains("surface") || !arguments.contains("shape") || !arguments.contains("nodes"))
    throw UserError(usage);
  return arguments;
}

template<typename Value>
Value choice(const std::string &word, const std::map<std::string, Value> &values)
{
  if (!values.contains(word))
    throw UserError("'" + word + "' is not known\n" + usage);
  return values.at(word);
}

benchmark::Scene scene_of(const std::string &surface, const Arguments &arguments)
{
  const double n_nodes = std::stod(arguments.at("nodes"));
  if (surface != "crowded")
    return benchmark::make_scene(surface, arguments.at("shape"), n_nodes);
  const int n = static_cast<int>(std::sqrt(n_nodes));
  const double fine = 0.1 / n; // an edge in the corner
  return {"crowded", "quadrilaterals", test::crowded_corner(n + 2, 0.3 * fine), test::crowded_corner(n - 1, 0),
          fine,      5 * fine};
}

/// One process's figures of one detection, under names that are the same on all.
std::map<std::string, double> figures(const ParallelReport &report)
{
  std::map<std::string, double> result{{"nodes sought", report.n_sought},
                                       {"impactor nodes held", report.n_impactor_nodes},
                                       {"target nodes held", report.n_target_nodes},
                                       {"nodes held", report.n_impactor_nodes + report.n_target_nodes},
                                       {"hub nodes held", report.n_hub_nodes},
                                       {"messages", 0},
                                       {"bytes", 0},
                                       {"reductions", 0},
                                       {"reduced bytes", 0}};
  for (const char *phase : {"surfaces", "positions", "pairs", "to hub", "pairs to hub"})
    result[std::string("bytes, ") + phase] = result[std::string("messages, ") + phase] = 0;
  for (const auto &[phase, traffic] : report.traffic)
  {
    const auto bytes = static_cast<double>(traffic.bytes), messages = static_cast<double>(traffic.messages);
    if (traffic.reductions == 0)
    {
      result["bytes, " + phase] = bytes;
      result["messages, " + phase] = messages;
    }
    result["bytes"] += bytes;
    result["messages"] += messages;
    result["reductions"] += static_cast<double>(traffic.reductions);
    result["reduced bytes"] += static_cast<double>(traffic.reduced_bytes);
  }
  return result;
}

/// Mean and greatest of each figure over the processes. Collective.
json over_processes(const std::map<std::string, double> &own, const Communicator &world)
{
  json result;
  for (const auto &[name, value] : own)
  {
    double sum = value, greatest = value;
    MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_DOUBLE, MPI_SUM, world.mpi());
    MPI_Allreduce(MPI_IN_PLACE, &greatest, 1, MPI_DOUBLE, MPI_MAX, world.mpi());
    result[name] = {{"mean", sum / world.size()}, {"most", greatest}};
  }
  return result;
}

/// A few detections one after another, held against those of one process.
json measure(const benchmark::Scene &scene, const std::string &mode, const Arguments &arguments,
             const Communicator &world)
{
  const auto spread = choice<test::Spread>(arguments.at("spread"), {{"random", test::Spread::random},
                                                                    {"in-runs", test::Spread::in_runs},
                                                                    {"apart", test::Spread::apart},
                                                                    {"some-bare", test::Spread::some_bare}});
  const ExchangeOptions options{
      choice<ExchangeMode>(mode, {{"distributed", ExchangeMode::distributed}, {"gathered", ExchangeMode::gathered}})};
  const test::Piece impactor = test::dealt(scene.impactor, world, spread, false);
  const test::Piece target = test::dealt(scene.target, world, spread, true);
  DetectionOptions detection;
  if (arguments.contains("distance"))
    detection.distance = std::stod(arguments.at("distance"));
  const auto parallel =
      make_parallel_detector(world, options, {{&impactor.surface, impactor.n_own, &target.surface, detection, {}}});
  const auto one = make_detector(detection, scene.impactor, scene.target);
  json detections = json::array();
  for (int step = 0; step < std::stoi(arguments.at("steps")); ++step)
  {
    const benchmark::Positions x = benchmark::moved(scene, step);
    const std::vector<double> own_x = impactor.of(x.impactor), target_x = target.of(x.target);
    const auto &met = parallel->detect(std::vector<SharePositions>{{own_x, target_x, scene.reach}});
    std::string first;
    int n_wrong = test::count_wrong(scene.target, x.target, one->detect(x.impactor, x.target, scene.reach), impactor,
                                    met.at(0), first);
    MPI_Allreduce(MPI_IN_PLACE, &n_wrong, 1, MPI_INT, MPI_SUM, world.mpi());
    json found = over_processes(figures(parallel->report()), world);
    found["wrong"] = n_wrong;
    found["routes kept"] = parallel->report().kept_routes;
    detections.push_back(found);
  }
  return {{"surface", scene.surface},
          {"shape", scene.shape},
          {"processes", world.size()},
          {"mode", mode},
          {"distance", arguments.contains("distance") ? "given" : "auto"},
          {"spread", arguments.at("spread")},
          {"n_impactor", scene.impactor.n_nodes()},
          {"n_target", scene.target.n_nodes()},
          {"detections", detections}};
}

json run(const Arguments &arguments, const Communicator &world)
{
  std::vector<std::string> surfaces{arguments.at("surface")}, modes{arguments.at("mode")};
  if (surfaces[0] == "all")
    surfaces = benchmark::scene_surfaces(arguments.at("shape") == "segments" ? 2 : 3);
  if (modes[0] == "both")
    modes = {"distributed", "gathered"};
  json results = json::array();
  for (const std::string &surface : surfaces)
  {
    const benchmark::Scene scene = scene_of(surface, arguments);
    for (const std::string &mode : modes)
      results.push_back(measure(scene, mode, arguments, world));
  }
  return results;
}
} // namespace

int main(int n, char **given)
{
  MPI_Init(&n, &given);
  int code = 0;
  try
  {
    const Communicator world(MPI_COMM_WORLD);
    const json result = run(read_arguments(n, given), world);
    if (world.is_root())
      std::cout << result.dump() << '\n';
  }
  catch (const std::exception &error)
  {
    std::cerr << "bench_scaling: " << error.what() << '\n';
    code = 2;
  }
  MPI_Finalize();
  return code;
}
