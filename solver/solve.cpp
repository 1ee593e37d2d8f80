#include "solver/solve.h"

#include "meshing/core/error.h"
#include "meshing/patch_mesh.h"
#include "meshing/visibility.h"
#include "solver/direct_light.h"
#include "solver/recovery_estimate.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

namespace halfshade {
namespace {

/// Times the stages of a pipeline.
class Stages {
 public:
  explicit Stages(std::vector<StageReport>& reports) : reports_(reports) {}

  /// Runs `stage`, which returns how many things it made.
  template <class Stage>
  void run(const char* name, Stage stage) {
    const auto start = std::chrono::steady_clock::now();
    const std::size_t count = stage();
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    reports_.push_back({name, elapsed.count(), count, {}});
  }

  void leave_out_if(bool needless, const char* name, const std::string& because) {
    if (needless) reports_.push_back({name, 0, 0, because});
  }

 private:
  std::vector<StageReport>& reports_;
};

void material_arrays(const SoundScene& scene, const ElementTable& elements, ChannelArray& rho,
                     ChannelArray& exitance) {
  rho.resize(elements.count(), 3);
  exitance.resize(elements.count(), 3);
  for (int e = 0; e < elements.count(); ++e) {
    const auto& material =
        scene.materials[static_cast<std::size_t>(elements.material[static_cast<std::size_t>(e)])];
    rho.row(e) = material.rho.transpose();
    exitance.row(e) = material.exitance.transpose();
  }
}

/// Meshes with the length asked for, or with the one that comes nearest to the number of elements
/// asked for: narrow receivers need more than their area suggests.
ElementTable make_mesh(const SoundScene& scene, const SolveOptions& options,
                       const Progress& progress) {
  constexpr int attempts = 5;
  constexpr double near_enough = 0.1;
  PlanarMeshOptions mesh_options;
  mesh_options.max_triangles = static_cast<std::size_t>(options.max_elements);
  mesh_options.max_length =
      options.max_length > 0 ? options.max_length : length_for_count(scene, options.elements);
  ElementTable elements = PatchMesh(scene, mesh_options, progress).elements();
  if (options.max_length > 0 || progress.stopped()) return elements;
  for (int k = 1; k < attempts; ++k) {
    const double excess = elements.count() / static_cast<double>(options.elements);
    if (std::abs(excess - 1) <= near_enough) break;
    mesh_options.max_length *= std::sqrt(excess);
    elements = PatchMesh(scene, mesh_options, progress).elements();
  }
  return elements;
}

/// Why direct light needs no stage of its own; empty if it does.
std::string direct_light_needless(const SoundScene& scene, DirectLightBy choice) {
  constexpr double most = 0.5;
  if (choice == DirectLightBy::exact) return {};
  if (choice == DirectLightBy::matrix) return "the matrix was asked for";
  double all = 0, emitting = 0;
  for (const Receiver& receiver : scene.receivers) {
    const Material& material = scene.materials[static_cast<std::size_t>(receiver.material)];
    all += area(receiver);
    if ((material.exitance > 0).any()) emitting += area(receiver);
  }
  return emitting > most * all
             ? "most surfaces emit, so that direct light is no sharper than reflected"
             : "";
}

/// In a closed enclosure everything an emitter sends arrives somewhere. Averaging over elements
/// loses or gains a little where shadows cut them; one factor for each emitter puts that right.
void conserve_power(ElementDirectLight& light, const SoundScene& scene,
                    const ElementTable& elements, const Enclosures& enclosures) {
  const Eigen::Map<const Eigen::ArrayXd> areas(elements.area.data(), elements.count());
  for (std::size_t k = 0; k < light.emitters.size(); ++k) {
    const auto first =
        std::find(elements.receiver.begin(), elements.receiver.end(), light.emitters[k]);
    if (first == elements.receiver.end() ||
        !enclosures.is_closed(static_cast<int>(first - elements.receiver.begin())))
      continue;
    auto factors = light.factor.col(static_cast<Eigen::Index>(k));
    const double arriving = (areas * factors).sum();
    if (arriving > 0)
      factors *= area(scene.receivers[static_cast<std::size_t>(light.emitters[k])]) / arriving;
  }
}

void check(const SolveOptions& options) {
  if (options.elements < 1 || options.max_elements < 1 || !(options.max_length >= 0))
    throw Error(
        ErrorCode::contract, "solve",
        fmt::format("elements ({}) and max_elements ({}) must be at least 1 and max_length ({}) "
                    "not negative",
                    options.elements, options.max_elements, options.max_length));
}

}  // namespace

SolveResult solve(const Scene& scene, const SolveOptions& options, const Progress& progress) {
  check(options);
  validate(scene);
  require_emitter(scene);
  SolveResult result;
  result.cameras = scene.cameras;
  result.unit = scene.unit;
  Stages stages(result.stages);
  stages.run("repair", [&] {
    progress("repair", 0);
    result.scene = make_sound(scene);
    return result.scene.receivers.size();
  });
  stages.run("mesh", [&] {
    result.elements = make_mesh(result.scene, options, progress);
    return result.elements.corners.size();
  });
  ElementDirectLight light;
  const std::string needless = direct_light_needless(result.scene, options.direct_light);
  stages.leave_out_if(!needless.empty(), "exact direct light", needless);
  if (needless.empty())
    stages.run("exact direct light", [&] {
      const DirectLightIndex index(result.scene);
      light = element_direct_light(result.scene, result.elements, index, options.direct_points,
                                   progress);
      return light.emitters.size();
    });
  Exchange exchange;
  stages.run("form factors", [&] {
    const VisibilityIndex visibility(occluders(result.scene));
    exchange =
        compute_exchange(result.scene, result.elements, visibility, options.exchange, progress);
    return exchange.report.factors;
  });
  result.exchange = exchange.report;
  stages.leave_out_if(exchange.report.rays == 0, "visibility rays",
                      "no surface can come between two others");
  stages.leave_out_if(!exchange.report.closure_enforced && !exchange.report.closed, "closure",
                      "light can leave the scene");
  ChannelArray rho, exitance, direct_irradiance;
  if (needless.empty()) {
    if (exchange.report.closure_enforced)
      conserve_power(light, result.scene, result.elements, exchange.enclosures);
    direct_irradiance = irradiance_of(light, result.scene);
  }
  material_arrays(result.scene, result.elements, rho, exitance);
  stages.run("radiosity", [&] {
    result.solution = solve_radiosity(exchange, rho, exitance, direct_irradiance, options.radiosity,
                                      result.radiosity, progress);
    result.solution.region = std::move(light.region);
    return static_cast<std::size_t>(result.radiosity.unknowns);
  });
  stages.leave_out_if(result.radiosity.unknowns == 0, "interreflection", "no surface reflects");
  stages.leave_out_if(result.radiosity.channels == 1, "second and third channel",
                      "every material is grey");
  stages.run("error estimate", [&] {
    const ChannelArray& irradiance = result.solution.irradiance;
    result.solution.error_estimate = recovery_estimate(result.elements, irradiance);
    result.relative_error =
        relative_error(result.elements, irradiance, result.solution.error_estimate);
    return result.elements.corners.size();
  });
  result.interrupted = progress.stopped();
  return result;
}

}  // namespace halfshade
