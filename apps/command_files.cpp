#include "apps/command_files.h"

#include "io/files/same_file.h"
#include "io/read/read_factors.h"
#include "meshing/core/error.h"

#include <fmt/format.h>

#include <cerrno>
#include <system_error>
#include <unistd.h>
#include <utility>

namespace halfshade {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const NamedFile& output, const std::string& sentence) {
  throw Error(ErrorCode::usage, output.path.string(), sentence);
}

}  // namespace

CommandFiles scene_files(const fs::path& scene, const fs::path& materials,
                         const CommonOptions& common) {
  return {{{"SCENE", scene},
           {"the sidecar of SCENE", fs::path(scene).replace_extension(".json")},
           {"--materials", materials}},
          {{"--json", common.json}}};
}

void add_outputs(CommandFiles& files, const char* name, const std::vector<fs::path>& paths) {
  for (const fs::path& path : paths) files.outputs.push_back({name, path});
}

void add_factor_inputs(CommandFiles& files, const char* name, const fs::path& path) {
  if (path.empty()) return;
  files.inputs.push_back({name, path});
  files.inputs.push_back({fmt::format("the names of {}", name), factor_names_file(path)});
}

void require_apart(const CommandFiles& files) {
  for (std::size_t k = 0; k < files.outputs.size(); ++k) {
    const NamedFile& output = files.outputs[k];
    for (const NamedFile& input : files.inputs)
      if (is_same_file(output.path, input.path))
        refuse(output, fmt::format("{} would overwrite {} ({}); give it another name", output.name,
                                   input.name, input.path.string()));
    for (std::size_t j = 0; j < k; ++j) {
      const NamedFile& other = files.outputs[j];
      const bool both_streams = is_standard_stream(output.path) && is_standard_stream(other.path);
      if (both_streams || is_same_file(output.path, other.path))
        refuse(output, fmt::format("{} and {} ({}) write to the same file; give one another name",
                                   output.name, other.name, other.path.string()));
    }
  }
}

void check_output(const fs::path& file, const FileFormats& formats) {
  if (file.empty()) return;
  require_format(file, formats);
  require_place(file);
}

void require_place(const fs::path& file) {
  if (file.empty() || is_standard_stream(file)) return;
  std::error_code error;
  const fs::path folder = file.parent_path();
  const auto refuse_place = [&](const std::string& sentence) {
    throw Error(ErrorCode::unwritable, file.string(), sentence);
  };
  if (!folder.empty() && !fs::is_directory(folder, error))
    refuse_place(fmt::format("the folder '{}' does not exist", folder.string()));
  if (fs::is_directory(file, error)) refuse_place("this is a folder, not a file");
  const fs::path place = resolved(file);
  if (fs::exists(place, error) && access(place.c_str(), W_OK) != 0)
    refuse_place(
        fmt::format("the file must not be written ({})", std::generic_category().message(errno)));
  if ((!fs::exists(place, error) || fs::is_regular_file(place, error)) &&
      access(place.parent_path().c_str(), W_OK) != 0)
    refuse_place(fmt::format("the folder '{}' cannot be written to ({})",
                             place.parent_path().string(), std::generic_category().message(errno)));
}

void require_folder(const fs::path& folder) {
  std::error_code error;
  fs::path place = fs::absolute(folder);
  while (!fs::exists(place, error) && place.has_relative_path()) place = place.parent_path();
  if (!fs::is_directory(place, error))
    throw Error(ErrorCode::unwritable, place.string(), "this is a file, not a folder");
  if (access(place.c_str(), W_OK) != 0)
    throw Error(ErrorCode::unwritable, place.string(),
                fmt::format("the folder cannot be written to ({})",
                            std::generic_category().message(errno)));
}

SceneFile read_scene(const fs::path& scene, const fs::path& materials,
                     const SceneOptions& orientation, CommandFiles files, double lamp_tolerance) {
  LampOptions lamps;
  lamps.tolerance = lamp_tolerance > 0 ? lamp_tolerance : usual_lamp_tolerance;
  lamps.turned = [&](const Scene& given) { return oriented(given, orientation); };
  SceneFile file = read_scene(scene, materials, lamps);
  for (const fs::path& path : file.files) files.inputs.push_back({"a file that SCENE names", path});
  require_apart(files);
  file.scene = oriented(std::move(file.scene), orientation);
  return file;
}

void require_three_channels(const SceneFile& file, const char* command) {
  const int bands = bands_of(file.heat);
  if (bands > most_channels)
    throw Error(ErrorCode::invalid_input, file.scene.source,
                fmt::format("the materials have {} bands, and {} knows at most {}; solve knows any "
                            "number",
                            bands, command, most_channels));
  if (balances_faces(file.heat, file.scene.materials))
    throw Error(
        ErrorCode::invalid_input, file.scene.source,
        fmt::format("a material has a net flux of 0 {}, so that its temperature has to be "
                    "found; solve does that, {} does not",
                    bands > 1 ? fmt::format("in {} bands", bands) : "on two sides", command));
}

}  // namespace halfshade
