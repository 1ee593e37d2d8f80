#include "io/write/write_series.h"

#include "io/files/atomic_file.h"
#include "io/files/consistency.h"
#include "io/write/result_bytes.h"
#include "meshing/core/error.h"
#include "solver/pipeline/result_at_stage.h"

#include <fmt/format.h>

#include <string_view>
#include <system_error>

namespace halfshade {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view index_name = "progressive.pvd", stage_begin = "stage_";

std::string index_text(const std::vector<RadiosityStage>& stages,
                       const std::vector<std::string>& names, const Provenance& provenance) {
  std::string text = fmt::format(
      "<?xml version=\"1.0\"?>\n<!-- halfshade {}: stages of shooting; time is the number of shots "
      "-->\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
      "  <Collection>\n",
      provenance.version);
  for (std::size_t k = 0; k < stages.size(); ++k)
    text += fmt::format("    <DataSet timestep=\"{}\" part=\"0\" file=\"{}\"/>\n", stages[k].shots,
                        names[k]);
  return text + "  </Collection>\n</VTKFile>\n";
}

/// Those of an earlier series that the new one does not replace.
void remove_leftovers(const fs::path& folder, std::size_t stages) {
  std::error_code error;
  for (std::size_t k = stages; fs::remove(folder / fmt::format("stage_{:03}.vtu", k), error); ++k) {
  }
}

}  // namespace

bool is_of_series(const fs::path& name) {
  const std::string text = name.filename().string();
  return text == index_name || text.starts_with(stage_begin);
}

fs::path write_series(const SolveResult& result, const Provenance& provenance,
                      const fs::path& folder) {
  const std::vector<RadiosityStage>& stages = result.radiosity.stages;
  if (stages.empty()) throw Error(ErrorCode::contract, "write_series", "there are no stages");
  detail::require_consistent(result, "write_series");
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw Error(ErrorCode::unwritable, folder.string(), error.message());
  const fs::path index = folder / index_name;
  fs::remove(index, error);
  std::vector<std::string> names;
  for (const RadiosityStage& stage : stages) {
    names.push_back(fmt::format("{}{:03}.vtu", stage_begin, names.size()));
    write_atomically(folder / names.back(),
                     detail::stage_bytes(result_at_stage(result, stage), stage));
  }
  remove_leftovers(folder, stages.size());
  write_atomically(index, index_text(stages, names, provenance));
  return index;
}

}  // namespace halfshade
