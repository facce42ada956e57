// One configuration of the detection benchmark: two surfaces, the methods in turn, JSON on standard output.
#include "amontons/base/error.h"
#include "detection/measure.h"

#include <iostream>
#include <map>
#include <sstream>

namespace
{
using namespace amontons;

constexpr const char *usage =
    "usage: bench_detection --surface NAME --shape segments|triangles|quadrilaterals --nodes N\n"
    "         [--methods exact,nearest-node,brute,nanoflann,cgal,embree] [--repeats 3] [--brute-pairs 2e7]\n"
    "       bench_detection --list 2|3     the surfaces in that dimension\n";

std::map<std::string, std::string> read_arguments(int n, char **arguments)
{
  std::map<std::string, std::string> values;
  for (int i = 1; i < n; i += 2)
  {
    const std::string key = arguments[i];
    if (key.rfind("--", 0) != 0 || i + 1 == n)
      throw UserError(usage);
    values[key.substr(2)] = arguments[i + 1];
  }
  return values;
}

std::string take(std::map<std::string, std::string> &values, const std::string &key, const std::string &otherwise = "")
{
  const auto found = values.find(key);
  if (found == values.end() && otherwise.empty())
    throw UserError("--" + key + " is missing\n" + usage);
  const std::string value = found == values.end() ? otherwise : found->second;
  values.erase(key);
  return value;
}

void run(std::map<std::string, std::string> values)
{
  if (values.contains("list"))
  {
    for (const std::string &name : benchmark::scene_surfaces(std::stoi(take(values, "list"))))
      std::cout << name << '\n';
    return;
  }
  const std::string surface = take(values, "surface"), shape = take(values, "shape");
  const double n_nodes = std::stod(take(values, "nodes"));
  benchmark::Settings settings;
  settings.repeats = std::stoi(take(values, "repeats", "3"));
  settings.brute_pairs = std::stod(take(values, "brute-pairs", "2e7"));
  std::istringstream methods(take(values, "methods", "exact,nearest-node,brute,nanoflann,cgal,embree"));
  for (std::string name; std::getline(methods, name, ',');)
    settings.methods.push_back(name);
  if (!values.empty())
    throw UserError("--" + values.begin()->first + " is not known\n" + usage);
  std::cout << benchmark::measure(benchmark::make_scene(surface, shape, n_nodes), settings).dump(1) << '\n';
}
} // namespace

int main(int n, char **arguments)
{
  try
  {
    run(read_arguments(n, arguments));
  }
  catch (const std::exception &error)
  {
    std::cerr << "bench_detection: " << error.what() << '\n';
    return 2;
  }
  return 0;
}
