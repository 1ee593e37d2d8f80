#pragma once

#include "io/read/read_scene.h"
#include "meshing/core/scene.h"
#include "solver/heat/heat.h"

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

/// One reader per family of formats. They throw Error(invalid_input) with file and line or element.
namespace halfshade::reading {

/// A picture that a material library names, and how it is laid: coordinates times `scale`, plus
/// `offset`.
struct PictureUse {
  std::shared_ptr<const Texture> texture;
  Vec2 scale = Vec2::Ones(), offset = Vec2::Zero();
};

/// Where a material comes from, so that a message about its values can point there.
struct MaterialOrigin {
  std::string name;             ///< as the scene file has it, whatever became of the material
  std::string rho_place;        ///< "file:line"; empty if not given
  std::string exitance_place;   ///< "file:line"; empty if not given
  std::string undefined_place;  ///< where it is used, if no file defines it; else empty
  bool from_json = false;       ///< given by a materials file or a sidecar
  HeatMaterial heat;            ///< as the last file says
  bool says_heat = false;       ///< an emissivity, a temperature or a net flux was given
  std::optional<Eigen::ArrayXd> rho_by_band, exitance_by_band;  ///< given with the bands known
  std::optional<PictureUse> picture;                            ///< that multiplies the reflectance
  std::optional<PictureUse> exitance_picture;                   ///< that multiplies the exitance
};

struct MissingFile {
  std::string place;     ///< "file:line"
  std::string sentence;  ///< that it is missing
};

/// A scene that has not been checked as a whole yet.
struct SceneDraft {
  Scene scene;
  std::vector<MaterialOrigin> origins;  ///< one a material
  std::vector<std::string> warnings;
  std::vector<std::filesystem::path> files;  ///< read besides the scene itself
  /// Material libraries that are not there; an error unless JSON files give all materials.
  std::vector<MissingFile> missing;
  std::unordered_map<std::string, int> material_ids;  ///< by the name in the scene file
  std::unordered_map<std::string, int> group_ids;
  /// Where the corners of each face are in a picture; a face that has no such places has none.
  std::vector<std::vector<Vec2>> picture_places;
  std::vector<Band> bands;             ///< channels that a file names
  std::set<std::string> named_groups;  ///< that the file names, whether they have faces or not
};

/// The name of the material and of the group of faces that the file gives none.
inline constexpr const char* default_name = "default";

SceneDraft read_obj(const std::filesystem::path& path);
SceneDraft read_ply(const std::filesystem::path& path);
SceneDraft read_off(const std::filesystem::path& path);
SceneDraft read_stl(const std::filesystem::path& path);
SceneDraft read_vs3(const std::filesystem::path& path);
SceneDraft read_msh(const std::filesystem::path& path);
SceneDraft read_with_assimp(const std::filesystem::path& path);

/// Adds what an MTL file defines to the draft's materials.
void read_mtl(const std::filesystem::path& path, SceneDraft& draft);

/// A picture named by a scene or library, in a file beside it; empty if there is none. Some
/// programs write the paths of the machine they ran on.
std::filesystem::path find_picture(const std::filesystem::path& scene, std::string_view name);

/// Reads the bytes of a PNG or JPEG, linear in light. Throws Error(invalid_input) with `path` for
/// anything else.
Texture read_texture(const std::filesystem::path& path, const std::string& bytes);

/// A face whose exitance a picture multiplies.
struct PaintedEmitter {
  int face = 0;
  Paint paint;
};

/// Lays pictures on the faces of materials that have one, by an affine map each. Warns where faces
/// have no places in it, or where places are not affine, and where light is heat, which has no
/// colours. What multiplies reflectances is the scene's then; the rest is returned.
std::vector<PaintedEmitter> lay_pictures(SceneDraft& draft);

/// Cuts lamps along lines of their pictures into pieces that shine evenly, each with the mean of
/// the picture over it, until the picture differs little from them or there are many, and then on
/// until what the light of them is off is little beside the tolerance, or there are very many. The
/// first piece takes the face's place, others come after all faces; parts of a material that differ
/// in exitance become materials of their own. Faces no longer have `picture_places` then. Warns
/// where that is not enough.
LampPictures cut_painted_lights(SceneDraft& draft, const std::vector<PaintedEmitter>& lamps,
                                const LampOptions& options);

/// True for .gltf and .glb files.
bool is_gltf(const std::filesystem::path& path);

/// Fails if the chunks of a binary glTF file are longer than the file: assimp would ask for memory
/// for them.
void require_whole_glb(const std::filesystem::path& path);

/// The factors of KHR_materials_emissive_strength, which assimp leaves out, by material name.
std::map<std::string, double> gltf_emissive_strengths(const std::filesystem::path& path);

/// The id of the material with this name, which is appended with the default values if it is new.
int material_id(SceneDraft& draft, const std::string& name);

/// The id of the group with this name, which is appended if it is new.
int group_id(SceneDraft& draft, const std::string& name);

/// Appends a polygon whose corners count from 0. Fails if a corner is out of range of the vertices
/// read so far or if there are fewer than three.
void add_face(SceneDraft& draft, const std::vector<long long>& corners, int line,
              const std::string& group, const std::string& material = default_name);

/// The same with the default material and group.
void add_plain_face(SceneDraft& draft, const std::vector<long long>& corners, int line);

}  // namespace halfshade::reading
