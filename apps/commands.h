#pragma once

#include "io/picture/curve_picture.h"
#include "io/picture/picture.h"
#include "io/picture/value_picture.h"
#include "io/study/study.h"
#include "io/write/write_result.h"
#include "meshing/core/progress.h"
#include "meshing/repair/orientation.h"
#include "solver/factors/factor_matrix.h"
#include "solver/pipeline/mesh_scene.h"
#include "solver/pipeline/solve.h"
#include "solver/reference/classic_picture.h"

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace halfshade {

/// What the program ends with.
enum ExitCode {
  exit_done = 0,
  exit_usage = 2,
  exit_invalid_input = 3,
  exit_not_accurate = 4,  ///< the radiosity iteration stopped short; results are written and marked
  exit_unwritable = 5,
  exit_interrupted = 130  ///< what was solved so far is written and marked
};

/// Options of every subcommand.
struct CommonOptions {
  bool quiet = false;
  bool verbose = false;
  int threads = 0;                 ///< 0: as many as the machine has
  std::filesystem::path json;      ///< machine-readable report; empty: none
  SceneOptions orientation;        ///< of commands that read a scene
  std::vector<std::string> notes;  ///< of options that change nothing; told unless quiet
};

/// Where a subcommand runs.
struct Context {
  CommonOptions common;
  Provenance provenance;
  Progress progress;                    ///< may be stopped by the user
  std::function<void()> progress_ends;  ///< call before printing
  std::FILE* summary = stdout;          ///< or stderr, if results go to the standard output
  std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
};

struct SolveCommand {
  std::filesystem::path scene;
  std::filesystem::path materials;
  std::vector<std::filesystem::path>
      outputs;  ///< empty: the scene's name with .vtu, in the current folder; none with `values`
  std::filesystem::path points;       ///< at which the solution is told; empty: none
  std::filesystem::path values;       ///< a table of what it is there
  std::filesystem::path factors;      ///< by face, that were saved; empty: they are computed
  double surroundings = 0;            ///< temperature of space, K
  std::filesystem::path progressive;  ///< folder for the stages of shooting; empty: none
  bool needs_tolerance = false;       ///< of elements that were asked for, too
  SolveOptions options;
  ResultOptions result_options;
};

struct MeshCommand {
  std::filesystem::path scene;
  std::filesystem::path materials;
  /// Of the mesh; if this and the next two are empty: the scene's name with .vtu.
  std::vector<std::filesystem::path> outputs;
  std::filesystem::path curves;
  std::filesystem::path picture;
  std::string picture_of;  ///< group or number of a surface; empty: the plane with most curves
  CurvePictureOptions picture_options;
  MeshOptions options;
  bool has_tolerance = false;  ///< it was given
};

/// How pictures of scenes come about.
enum class RenderMethod {
  drawn,      ///< what a result holds, or materials under a lamp
  reference,  ///< all light by random walks
  classic     ///< local illumination
};

struct RenderCommand {
  std::filesystem::path input;
  std::filesystem::path materials;
  std::filesystem::path output;
  std::string camera;  ///< name; empty: the first of the file, or one that fits the scene
  std::optional<Vec3> position, target, up;
  double vertical_fov = 40;
  PictureOptions options;
  std::string quantity;           ///< in false colours; empty: the light itself
  std::string channel = "mean";   ///< of the quantity
  ValuePictureOptions colours;    ///< of the quantity
  std::filesystem::path curves;   ///< drawn over the picture; empty: none
  std::filesystem::path compare;  ///< what is subtracted; empty: nothing
  bool side_by_side = false;      ///< both and the difference
  RenderMethod method = RenderMethod::drawn;
  ClassicOptions classic;            ///< its mirrors are named:
  std::vector<std::string> mirrors;  ///< groups and materials
  double lens = 0;                   ///< radius, in scene units; 0: all is sharp
  double focus = 0;                  ///< distance of what is sharp
  std::optional<Vec3> move;  ///< of the camera while the shutter is open; nothing: it stands still
  double gloss = 0;          ///< share that all surfaces reflect in a lobe of the classic exponent
};

struct ProbeCommand {
  std::filesystem::path scene;
  std::filesystem::path materials;
  std::filesystem::path points;  ///< empty: a grid; "-": the standard input
  std::string group;             ///< whose surfaces carry the grid
  double spacing = 0;            ///< of the grid, in scene units
  std::filesystem::path output;  ///< "-": a table to the standard output
  bool direct_only = false;      ///< no interreflection
  bool reference = false;        ///< by random walks instead
  int samples = 1024;            ///< of them, from each point
  std::filesystem::path
      solution;                ///< that interreflection is gathered from; empty: it is solved for
  SolveOptions options;        ///< of that
  bool has_tolerance = false;  ///< it was given
};

struct FactorsCommand {
  std::filesystem::path scene;
  std::filesystem::path materials;
  std::filesystem::path output;  ///< "-": a table to the standard output
  std::filesystem::path from;    ///< a matrix by face that is summed; empty: none
  FactorOptions options;
};

struct ExplainCommand {
  std::filesystem::path scene;
  std::filesystem::path materials;
  SolveOptions options;  ///< of the solution that is explained
};

struct StudyCommand {
  std::filesystem::path scene;
  std::filesystem::path materials;
  StudyOptions options;
};

/// Each does its job and returns what the program ends with; errors are thrown as Error.
ExitCode run(const SolveCommand& command, const Context& context);
ExitCode run(const MeshCommand& command, const Context& context);
ExitCode run(const RenderCommand& command, const Context& context);
ExitCode run(const ProbeCommand& command, const Context& context);
ExitCode run(const FactorsCommand& command, const Context& context);
ExitCode run(const ExplainCommand& command, const Context& context);
ExitCode run(const StudyCommand& command, const Context& context);

}  // namespace halfshade
