#include "apps/command_options.h"
#include "apps/idle_options.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <array>
#include <string_view>

namespace halfshade {
namespace {

/// They ask for what form factors by face, that were computed before, leave no room for.
constexpr const char* needless_with_saved_factors[] = {
    "--tolerance",   "--order",     "--refine",       "--method",           "--elements",
    "--regions",     "--rays",      "--visibility",   "--hemicube",         "--closure",
    "--force",       "--events",    "--direct-light", "--no-discontinuity", "--progressive",
    "--goal",        "--subdivide", "--gradient",     "--interpolate",      "--deviation",
    "--final-gather"};

constexpr const char* needs_matrix = "is for constant elements; give --method matrix";

void add_accuracy(CLI::App& app, SolveOptions& options) {
  add_not_negative(
      app, "--tolerance", options.tolerance,
      "Error allowed, of the irradiance in the L2 norm over all surfaces and channels, relative\n"
      "to it, so that a channel with little light may be off by more of its own (with --method\n"
      "matrix curves that change the mean by less are left out, too)")
      ->capture_default_str();
  app.add_option("--goal", options.goal,
                 "Name of a group: the tolerance is that of its mean irradiance, and effort goes\n"
                 "only where that feels it")
      ->type_name("GROUP");
  add_whole_or_auto(app, "--order", options.order, {0, max_order},
                    "Order of all elements, or chosen for each ('auto')");
  add_choice(
      app, "--refine", {"adaptive", "uniform"},
      [&options](std::size_t k) {
        options.refine = std::array{Refinement::adaptive, Refinement::uniform}.at(k);
      },
      "Elements as the tolerance takes them, or all of the size of --elements or --max-length");
  add_solve_method(app, options);
}

void add_size(CLI::App& app, SolveOptions& options) {
  add_elements(app, options.elements,
               "About how many elements to make, with --refine uniform or --method matrix");
  add_positive(app, "--max-length", options.max_length,
               "Longest element edge in scene units (instead of --elements)");
  add_max_elements(app, options.max_elements);
  add_whole(
      app, "--max-unknowns", options.max_unknowns, {1, 100000000},
      "Make no more coefficients than this, for each channel (default: 4 for each of these\n"
      "elements, at least 1000000), nor trace more than 200 rays to emitters for each of them");
}

void add_light(CLI::App& app, SolveCommand& command) {
  SolveOptions& options = command.options;
  add_whole(app, "--bounces", options.radiosity.bounces, {0, 100000},
            "Only light that arrives after at most N reflections: 0 is direct light, 1 adds one\n"
            "reflection (default: all)");
  app.add_flag("--each-bounce", options.each_bounce,
               "With --bounces N: tell the light apart by how often it was reflected, as arrays\n"
               "irradiance_bounce_0 (direct light) to irradiance_bounce_N");
  add_not_negative(app, "--surroundings", command.surroundings,
                   "Temperature in K of all that is seen through openings; 0: dark")
      ->capture_default_str()
      ->excludes("--bounces")
      ->excludes("--goal");
  app.add_flag("--regions", options.regions,
               "Say of each element whether it is lit, in penumbra or umbra of each emitter");
  add_visibility(app, options);
  add_choice(
      app, "--final-gather", {"auto", "on", "off"},
      [&options](std::size_t k) {
        options.final_gather =
            std::array{FinalGather::automatic, FinalGather::on, FinalGather::off}.at(k);
      },
      "Reflected light in files: the polynomials it was solved for as ('off'), or gathered once\n"
      "more at points of each element, which is more exact and takes longer ('on'); 'auto' does\n"
      "so where the tolerance was not reached, if that takes but a few times as long");
  add_factors_by(app, options.exchange, &command.factors);
  add_choice(
      app, "--solver",
      {"conjugate-gradients", "jacobi", "gauss-seidel", "southwell", "southwell-ambient"},
      [&options](std::size_t k) { options.radiosity.solver = static_cast<RadiositySolver>(k); },
      "How to solve with --method matrix: the last four are what radiosity began with, to compare");
  add_choice(
      app, "--closure", {"auto", "enforce", "leave"},
      [&options](std::size_t k) {
        options.exchange.closure =
            std::array{Closure::automatic, Closure::enforce, Closure::leave}.at(k);
      },
      "Scale form factors so that rows sum to 1: 'auto' in closed scenes, 'enforce', 'leave';\n"
      "with --method matrix");
  add_choice(
      app, "--direct-light", {"auto", "exact", "matrix"},
      [&options](std::size_t k) {
        options.direct_light =
            std::array{DirectLightBy::automatic, DirectLightBy::exact, DirectLightBy::matrix}.at(k);
      },
      "By closed forms ('exact'), like reflected light ('matrix'), or 'auto'");
}

void add_constant_elements(CLI::App& app, SolveOptions& options) {
  add_whole(
      app, "--subdivide", options.subdivision.rounds, {0, 20},
      "With --method matrix: split elements in four where the light is steep, and look again,\n"
      "so many times; those there were at first, the patches, send the light");
  add_positive(
      app, "--gradient", options.subdivision.gradient,
      "What --subdivide calls steep: a change of irradiance from one element to the next,\n"
      "as a share of the mean")
      ->capture_default_str();
  app.add_flag("--interpolate", options.interpolate,
               "With --method matrix: light linear between values at the elements' corners, means\n"
               "of the elements around, extrapolated at borders");
}

void add_curves(CLI::App& app, SolveOptions& options) {
  app.add_flag_callback(
      "--no-discontinuity", [&options] { options.discontinuities = false; },
      "Do not mesh along the curves where the light breaks");
  add_events(app, options.events, options.secondary);
  add_deviation(app, options.deviation);
}

void note_idle_of_size(const CLI::App& app, const SolveOptions& options,
                       std::vector<std::string>& notes) {
  if (is_given(app, "--max-length"))
    note_idle(app, {{"--elements"}}, "has no part where --max-length says how long they are",
              notes);
  if (options.method == SolveMethod::fields && options.refine == Refinement::adaptive)
    note_idle(app, {{"--elements"}, {"--max-length"}},
              "has no part where elements are as the tolerance takes them (--refine adaptive)",
              notes);
}

void note_idle_of_curves(const CLI::App& app, const SolveOptions& options,
                         std::vector<std::string>& notes) {
  if (options.discontinuities) return;
  note_idle(app, {{"--events"}, {"--secondary"}, {"--deviation"}},
            "has no part where no curves are looked for (--no-discontinuity)", notes);
  if (options.force.discontinuities || options.force.eee)
    note_idle(app, {{"--force"}}, "finds no curves with --no-discontinuity", notes);
}

void note_idle_of_method(const CLI::App& app, const SolveOptions& options,
                         std::vector<std::string>& notes) {
  note_idle_factors(app, options, notes);
  if (options.method == SolveMethod::fields) {
    note_idle(app, {{"--closure", {"auto"}}, {"--solver"}, {"--gradient"}}, needs_matrix, notes);
    if (options.direct_light == DirectLightBy::matrix && !options.force.exact_direct_light)
      note_idle(app, {{"--order", {"auto"}}, {"--events"}, {"--secondary"}, {"--deviation"}},
                "is of direct light by closed forms, which --direct-light matrix leaves out",
                notes);
    return;
  }
  note_idle(app, {{"--refine", {"uniform"}}, {"--order", {"auto", "0"}}, {"--max-unknowns"}},
            "has no part in constant elements and a matrix (--method matrix)", notes);
  if (options.subdivision.rounds == 0)
    note_idle(app, {{"--gradient"}}, "says what --subdivide divides; give that, too", notes);
  if (options.radiosity.bounces >= 0)
    note_idle(app, {{"--solver"}}, "has no part where reflections are counted (--bounces)", notes);
}

}  // namespace

void note_idle_factors(const CLI::App& app, const SolveOptions& options,
                       std::vector<std::string>& notes) {
  if (options.method == SolveMethod::fields)
    return note_idle(app, {{"--factors"}, {"--hemicube"}, {"--rays"}}, needs_matrix, notes);
  note_idle(app, {{"--visibility", {"auto"}}},
            "has no part in constant elements and a matrix, whose form factors are by --factors",
            notes);
  if (options.exchange.factors != FactorsBy::rays)
    note_idle(app, {{"--rays"}}, "is for --factors rays", notes);
  if (options.exchange.factors != FactorsBy::hemicube)
    note_idle(app, {{"--hemicube"}}, "is for --factors hemicube", notes);
}

void keep_to_limit(const CLI::App& app, SolveOptions& options) {
  if (options.max_elements == 0 || options.elements <= options.max_elements) return;
  const bool are_made =
      options.method == SolveMethod::matrix || options.refine == Refinement::uniform;
  if (is_given(app, "--elements") && are_made && options.max_length == 0)
    throw CLI::ValidationError("--elements",
                               fmt::format("{} are more than the {} that --max-elements allows",
                                           options.elements, options.max_elements));
  options.elements = options.max_elements;
}

void add_max_elements(CLI::App& app, int& elements) {
  add_whole(app, "--max-elements", elements, {1, 10000000},
            "Make no more elements than this (default: 400 for each polygon, at least 40000, at\n"
            "most 1000000, or 16 for each if that is more; with --method matrix 40000)");
}

void add_solve_method(CLI::App& app, SolveOptions& options) {
  add_choice(
      app, "--method", {"fields", "matrix"},
      [&options](std::size_t k) {
        options.method = std::array{SolveMethod::fields, SolveMethod::matrix}.at(k);
      },
      "Light as polynomials, or constant elements and a matrix of form factors");
}

void add_factors_by(CLI::App& app, ExchangeOptions& options, std::filesystem::path* saved) {
  const std::vector<std::string> words = {"rays", "hemicube", "exact"};
  const auto choose = [&options](std::size_t k) {
    options.factors = std::array{FactorsBy::rays, FactorsBy::hemicube, FactorsBy::exact}.at(k);
  };
  const std::string help =
      "Form factors with --method matrix: closed forms times what rays find visible ('rays'), an\n"
      "item buffer round each centroid ('hemicube'), or exactly visible parts ('exact')";
  if (saved == nullptr)
    add_choice(app, "--factors", words, choose, help.c_str());
  else
    add_choice_or_file(app, "--factors", words, choose, ".mtx", *saved,
                       (help + ".\nFILE.mtx: what 'factors --by face' has saved of this scene; "
                               "radiosity is then constant on\neach face")
                           .c_str());
  add_even(app, "--hemicube", options.hemicube_pixels, {2, 4096},
           "Pixels along an edge of hemicubes")
      ->capture_default_str();
  add_whole(app, "--rays", options.rays_per_pair, {1, 4096},
            "Visibility rays for a pair of elements, on average, with --factors rays")
      ->capture_default_str();
}

void add_solve(CLI::App& program, SolveCommand& command, CommonOptions& common) {
  CLI::App& app =
      *program.add_subcommand("solve", "Mesh a scene, solve for its radiosity, write the result");
  add_scene(app, command.scene);
  add_outputs(app, command.outputs,
              "Result: .vtu, .vtp, .ply or .png; may repeat (default: SCENE.vtu in this folder)");
  add_materials(app, command.materials,
                "JSON: object, group or material name -> reflectance, exitance, two_sided; or\n"
                "emissivity, temperature (K), net_flux (0); bands: channels with names");
  CLI::Option* points =
      add_file(app, "--points", command.points, "Points on surfaces, a table as for probe");
  CLI::Option* values = add_file(app, "--values", command.values,
                                 "What the solution is at these points (.csv): H_r,H_g,H_b all\n"
                                 "irradiance, D_r,D_g,D_b direct; then no other output is needed");
  points->needs(values);
  values->needs(points);
  add_file(app, "--progressive", command.progressive,
           "Folder for the stages of shooting as a series that ParaView plays, progressive.pvd;\n"
           "with --method matrix and --solver southwell or southwell-ambient");
  app.add_flag(
      "--linear", command.result_options.linear,
      "Straight triangles in .vtu, for readers that know no polynomials: as many as the\n"
      "tolerance takes, if that is not more than 2 million (constant elements are straight\n"
      "as they are)");
  add_accuracy(app, command.options);
  add_size(app, command.options);
  add_light(app, command);
  add_constant_elements(app, command.options);
  add_curves(app, command.options);
  add_force(app, command.options.force);
  add_orientation(app, common.orientation);
  add_common(app, common);
  app.parse_complete_callback([&app, &command, &common] {
    SolveOptions& options = command.options;
    const auto given = [&app](const char* name) { return is_given(app, name); };
    options.radiosity.stages = given("--progressive");
    // Saved factors are a matrix: that this is the method is all that may be said of it.
    const bool is_matrix = options.method == SolveMethod::matrix;
    if (!command.factors.empty()) options.method = SolveOptions().method;
    if ((given("--elements") || given("--max-length")) && !given("--refine"))
      options.refine = Refinement::uniform;
    command.needs_tolerance = given("--tolerance") && (options.refine == Refinement::uniform ||
                                                       options.method == SolveMethod::matrix);
    note_idle_of_size(app, options, common.notes);
    keep_to_limit(app, options);
    note_idle_of_curves(app, options, common.notes);
    // With saved factors, and for stages of shooting, others say what goes with them.
    if (command.factors.empty() && !given("--progressive"))
      note_idle_of_method(app, options, common.notes);
    if (command.factors.empty()) return;
    for (const char* name : needless_with_saved_factors)
      if (given(name) && !(is_matrix && std::string_view(name) == "--method"))
        throw CLI::ValidationError(
            name, fmt::format("has no part in a solution by saved form factors (--factors {})",
                              command.factors.string()));
  });
  app.footer(footer(
      "Examples:\n"
      "  halfshade solve data/cornell_box.obj -o cornell.vtu -o cornell.ply -o cornell.png\n"
      "  halfshade solve data/l_room.obj --elements 3000 --bounces 1 -o l_room.vtu\n"
      "  halfshade solve data/s1.obj --tolerance 1e-6 -o s1.vtu\n"
      "  halfshade solve data/s1.obj --method matrix --factors hemicube --hemicube 32 -o "
      "s1_cube.vtu\n"
      "  halfshade solve data/thermal_furnace.obj --surroundings 300 -o furnace.vtu --json "
      "furnace.json\n"
      "  halfshade solve data/l_room.obj --method matrix --solver southwell --elements 300 "
      "--progressive stages\n"
      "  halfshade solve data/l_room.obj --method matrix --elements 150 --subdivide 2 "
      "--interpolate "
      "-o fine.vtu\n"
      "  halfshade solve data/furnace_cube.obj --method matrix --elements 600 --json report.json "
      "-q\n\n"));
}

}  // namespace halfshade
