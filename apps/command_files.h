#pragma once

#include "apps/commands.h"
#include "io/files/extension.h"
#include "io/read/read_scene.h"

#include <filesystem>
#include <string>
#include <vector>

namespace halfshade {

/// A file of the command line and what messages call it: "--json", "SCENE". An empty path is none.
struct NamedFile {
  std::string name;
  std::filesystem::path path;
};

/// What a command reads and writes.
struct CommandFiles {
  std::vector<NamedFile> inputs, outputs;
};

/// What every command on a scene has: the scene, its sidecar, whether it is there or not, the
/// materials and the report.
CommandFiles scene_files(const std::filesystem::path& scene, const std::filesystem::path& materials,
                         const CommonOptions& common);
void add_outputs(CommandFiles& files, const char* name,
                 const std::vector<std::filesystem::path>& paths);

/// Form factors and the table beside them; nothing if the path is empty.
void add_factor_inputs(CommandFiles& files, const char* name, const std::filesystem::path& path);

/// Throws Error(usage), naming both, if an output is also an input, or two outputs are one.
void require_apart(const CommandFiles& files);

/// Mistakes worth telling before an hour of computing. Throws Error(usage) unless the file's
/// extension is one of `formats`, and as require_place. An empty path is fine.
void check_output(const std::filesystem::path& file, const FileFormats& formats);

/// Throws Error(unwritable) if the folder that a file is to be written to does not exist or must
/// not be written, or if the file is a folder. An empty path and a standard stream are fine.
void require_place(const std::filesystem::path& file);

/// Throws Error(unwritable) if a folder to write files into, or the one it is to be made in, must
/// not be written, or if it is a file.
void require_folder(const std::filesystem::path& folder);

/// Of lamps with pictures where light is to be all but exact.
inline constexpr double exact_lamp_tolerance = 1e-4;

/// Reads the scene of a command, its faces turned as asked for. Throws as halfshade::read_scene,
/// and Error(usage) if an output is one of the files that the scene names. Lamps with pictures are
/// cut for `lamp_tolerance`.
SceneFile read_scene(const std::filesystem::path& scene, const std::filesystem::path& materials,
                     const SceneOptions& orientation, CommandFiles files,
                     double lamp_tolerance = usual_lamp_tolerance);

/// For commands that know three channels and no balance of heat: throws Error(invalid_input) if
/// there are more bands, or temperatures to be found from several together.
void require_three_channels(const SceneFile& file, const char* command);

}  // namespace halfshade
