#include "amontons/input/deck_keys.h"

#include <cmath>

namespace amontons
{
namespace
{
constexpr Range at_least_one{1, std::numeric_limits<double>::infinity(), true};

Section<LoadingOptions> loading_keys()
{
  Section<LoadingOptions> keys;
  keys.number("end", &LoadingOptions::end, positive, "any", optional,
              "the load parameter t of all expressions runs from 0 to here");
  keys.integer("increments", &LoadingOptions::increments, at_least_one, optional,
               "how many increments of equal length to begin with");
  keys.boolean("fixed", &LoadingOptions::fixed, optional,
               "keep to these increments: never cut where one does not converge, never grow");
  keys.number("min-increment", &LoadingOptions::min_increment, positive, "that of t",
              otherwise("1e-4 of the first increment"), "an increment cut below this ends the run");
  keys.number("max-increment", &LoadingOptions::max_increment, positive, "that of t", otherwise("the first increment"),
              "increments do not grow beyond this");
  keys.check(
      [](const Value &value, LoadingOptions &loading, ReadContext &)
      {
        const double first = loading.end / loading.increments;
        if (loading.fixed)
          for (const char *name : {"min-increment", "max-increment"})
            if (const Value *v = value.find(name))
              v->fail("has no meaning with fixed: true");
        if (loading.min_increment && *loading.min_increment > first)
          value.find("min-increment")
              ->fail("must be at most the first increment, end / increments = " + number_text(first));
        if (loading.min_increment && loading.max_increment && *loading.min_increment > *loading.max_increment)
          value.find("max-increment")->fail("must be at least min-increment");
      });
  return keys;
}

/// The deck's section has keys of two rooms.
struct DetectionKeys : DetectionOptions
{
  ExchangeMode exchange = ExchangeMode::distributed;
};

template<class T>
T DetectionKeys::*detection_key(T DetectionOptions::*member)
{
  return member;
}

Section<DetectionKeys> detection_keys()
{
  Section<DetectionKeys> keys;
  keys.choice("method", detection_key(&DetectionOptions::method),
              {{"exact", DetectionMethod::exact},
               {"nearest-node", DetectionMethod::nearest_node},
               {"brute", DetectionMethod::brute}},
              optional,
              "exact: the closest point of the target; nearest-node: the four steps of the paper; brute: every face "
              "for every node, to check the others by");
  keys.number_or("auto", "distance", detection_key(&DetectionOptions::distance), positive, "length", "auto",
                 "how far from the target an impactor node is looked for; auto: from the target's faces");
  keys.number_or("auto", "extension", detection_key(&DetectionOptions::extension), not_negative, "length", "auto",
                 "how far past the target's ends its last face still counts; auto: a fraction of that face");
  keys.choice("exchange", &DetectionKeys::exchange,
              {{"distributed", ExchangeMode::distributed}, {"gathered", ExchangeMode::gathered}}, optional,
              "over several processes; distributed: surfaces go straight to who searches there; gathered: through "
              "process 0, as in the paper; the pairs are the same");
  return keys;
}

Section<SolverOptions> solver_keys()
{
  Section<SolverOptions> keys;
  keys.choice(
      "linear", &SolverOptions::linear,
      {{"auto", LinearSolverType::automatic},
       {"direct", LinearSolverType::direct},
       {"amg", LinearSolverType::amg},
       {"feti", LinearSolverType::feti}},
      optional,
      "how linear systems are solved; direct: by factorisation; amg: by iteration with algebraic multigrid; feti: "
      "by subdomains with the contact between them (small strain); auto: what is fastest for the size, and another "
      "where that one fails");
  keys.choice(
      "multipliers", &SolverOptions::multipliers,
      {{"auto", MultiplierForm::automatic},
       {"condensed", MultiplierForm::condensed},
       {"coupled", MultiplierForm::coupled}},
      optional,
      "condensed: the contact constraints are eliminated, exactly; coupled: the multipliers are unknowns of the "
      "system, which takes linear: direct; auto: condensed, but for mortar contact in finite strain");
  keys.check(
      [](const Value &value, SolverOptions &solver, ReadContext &)
      {
        if (solver.multipliers == MultiplierForm::coupled &&
            (solver.linear == LinearSolverType::amg || solver.linear == LinearSolverType::feti))
          value.find("multipliers")
              ->fail("must be condensed with linear: amg or feti; coupled goes with linear: direct or auto");
      });
  keys.number("tolerance", &SolverOptions::tolerance, {0, 1}, "1", optional,
              "Newton stops where the residual force is below this part of the forces present");
  keys.integer("max-iterations", &SolverOptions::max_iterations, at_least_one, optional,
               "of Newton in one increment, which is cut where they do not do");
  return keys;
}

Section<OutputOptions> output_keys()
{
  const std::vector<std::string> words{"displacement", "stress", "plastic-strain"}; // in the order of OutputField
  Section<OutputOptions> keys;
  keys.key(Section<OutputOptions>::row(
      "fields", "list of choices", "", joined(words), otherwise("[displacement, stress, plastic-strain]"), "",
      "what the pictures of the bodies show; plastic-strain: the equivalent one, where a body is plastic",
      [words](const Value &value, OutputOptions &output, ReadContext &)
      {
        require_list(value, "fields");
        output.fields.clear();
        for (const Value &item : value.items)
          output.fields.push_back(static_cast<OutputField>(to_choice(item, words)));
      }));
  keys.integer("every", &OutputOptions::every, not_negative, optional,
               "pictures of every n-th increment and of the last; 0: none");
  keys.integer("checkpoint", &OutputOptions::checkpoint, not_negative, optional,
               "a checkpoint after every n-th increment and the last, from which run --restart goes on; 0: none");
  return keys;
}

template<typename T>
std::function<void(Deck &, T)> into(std::vector<T> ProblemOptions::*member)
{
  return [member](Deck &deck, T value) { (deck.*member).push_back(std::move(value)); };
}
} // namespace

Section<MeshOptions> mesh_keys()
{
  using Keys = Section<MeshOptions>;
  Keys keys;
  keys.key(Keys::row("file", "path", "", "an existing .msh or .geo", required, "",
                     "the mesh (Gmsh, .msh 2.2 or 4.1) or the geometry to mesh, relative to the deck's folder",
                     [](const Value &value, MeshOptions &mesh, ReadContext &context)
                     {
                       const std::filesystem::path path = context.folder / to_text(value);
                       mesh.file = path.lexically_normal().string();
                       mesh.where = value.where;
                       if (path.extension() != ".msh" && path.extension() != ".geo")
                         value.fail("must name a .msh or a .geo, not " + value.described());
                       if (!std::filesystem::is_regular_file(path))
                         value.fail("there is no file '" + mesh.file + "'");
                     }));
  keys.key(Keys::row("parameters", "map of name to number", "as the .geo takes them",
                     "names in its DefineConstant[...]", otherwise("none"), "",
                     "numbers set in the .geo before it is meshed",
                     [](const Value &value, MeshOptions &mesh, ReadContext &)
                     {
                       require_map(value, "parameters");
                       for (const Value &item : value.items)
                         mesh.parameters[item.key] = to_number(item, any_number);
                     }));
  keys.integer("refine", &MeshOptions::refine, {0, 8, true, true}, optional,
               "how often every cell is split in 4 (plane) or 8 (3D) before the solve");
  keys.choice("kinematics", &MeshOptions::kinematics,
              {{"plane-strain", Kinematics::plane_strain},
               {"plane-stress", Kinematics::plane_stress},
               {"axisymmetric", Kinematics::axisymmetric},
               {"3d", Kinematics::three_dimensional}},
              required,
              "what the mesh stands for; axisymmetric: x is the radius, y the axis; in the plane all forces are per "
              "unit thickness");
  keys.check([](const Value &, MeshOptions &mesh, ReadContext &context) { context.kinematics = mesh.kinematics; });
  return keys;
}

Section<Deck> deck_keys()
{
  Section<Deck> keys;
  keys.text("title", &Deck::title, otherwise("none"), "what the run is about, for the reader");
  // First of all that is checked: what follows needs the kinematics.
  keys.map<MeshOptions>("mesh", mesh_keys(), required, "where the mesh comes from and what it stands for",
                        [](Deck &deck, MeshOptions mesh) { deck.mesh = std::move(mesh); });
  keys.choice("strain", &Deck::strain, {{"small", Strain::small}, {"finite", Strain::finite}}, optional,
              "small: linear kinematics, contact geometry of the reference; finite: everything current");
  keys.list<BodyOptions>("bodies", body_keys(), required, "deformable and rigid bodies", into(&Deck::bodies));
  keys.list<ContactOptions>("contact", contact_keys(), otherwise("none"), "pairs of surfaces that may touch",
                            into(&Deck::contact));
  keys.list<BoundaryOptions>("boundary", boundary_keys(), otherwise("none"), "supports, loads and rigid motions",
                             into(&Deck::boundary));
  keys.map<LoadingOptions>("loading", loading_keys(), otherwise("one increment"), "the way the load is applied",
                           [](Deck &deck, LoadingOptions loading) { deck.loading = loading; });
  keys.map<DetectionKeys>("detection", detection_keys(), otherwise("exact"), "how contact is found",
                          [](Deck &deck, const DetectionKeys &detection)
                          {
                            deck.detection = detection;
                            deck.exchange.mode = detection.exchange;
                          });
  keys.map<SolverOptions>("solver", solver_keys(), otherwise("as below"), "how the equations are solved",
                          [](Deck &deck, SolverOptions solver) { deck.solver = solver; });
  keys.map<OutputOptions>("output", output_keys(), otherwise("as below"), "what is written besides the record",
                          [](Deck &deck, OutputOptions output) { deck.output = std::move(output); });
  return keys;
}
} // namespace amontons
