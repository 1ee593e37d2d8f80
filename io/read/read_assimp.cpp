// glTF, COLLADA and 3DS through assimp, which keeps positions in single precision as the
// formats mostly do. Nothing is triangulated or joined; node transforms are applied in double.

#include "io/files/trial_run.h"
#include "io/read/read_formats.h"
#include "io/read/read_text.h"
#include "meshing/core/error.h"

#include <Eigen/Geometry>
#include <assimp/DefaultIOSystem.h>
#include <assimp/Importer.hpp>
#include <assimp/config.h>
#include <assimp/material.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <limits>
#include <map>
#include <vector>

namespace halfshade::reading {
namespace {

using Transform = Eigen::Affine3d;

Transform to_eigen(const aiMatrix4x4& m) {
  Eigen::Matrix4d result;
  for (unsigned r = 0; r < 4; ++r)
    for (unsigned c = 0; c < 4; ++c)
      result(static_cast<int>(r), static_cast<int>(c)) = static_cast<double>(m[r][c]);
  return Transform(result);
}

Rgb to_rgb(const aiColor4D& colour) {
  return {static_cast<double>(colour.r), static_cast<double>(colour.g),
          static_cast<double>(colour.b)};
}

class AssimpReader {
 public:
  AssimpReader(const std::filesystem::path& file, const aiScene& input)
      : file_(file), input_(input) {
    draft_.scene.source = file.string();
    material_ids_.assign(input.mNumMaterials, -1);
    if (is_gltf(file)) emissive_strengths_ = gltf_emissive_strengths(file);
  }

  SceneDraft read() {
    if (input_.mRootNode != nullptr) walk();
    if (skipped_ > 0)
      draft_.warnings.push_back(
          fmt::format("{}: {} points and lines are not used", file_.string(), skipped_));
    return std::move(draft_);
  }

 private:
  /// Visits the nodes depth first, without recursion: files may nest them as deep as they like.
  void walk() {
    struct Visit {
      const aiNode* node;
      Transform to_world;
    };
    std::vector<Visit> open = {{input_.mRootNode, to_eigen(input_.mRootNode->mTransformation)}};
    while (!open.empty()) {
      const Visit visit = open.back();
      open.pop_back();
      for (unsigned i = 0; i < visit.node->mNumMeshes; ++i) {
        const unsigned mesh = visit.node->mMeshes[i];
        if (mesh < input_.mNumMeshes)
          add_mesh(*input_.mMeshes[mesh], group_name(*visit.node, *input_.mMeshes[mesh]),
                   visit.to_world);
      }
      for (unsigned i = visit.node->mNumChildren; i-- > 0;) {
        const aiNode* child = visit.node->mChildren[i];
        open.push_back({child, visit.to_world * to_eigen(child->mTransformation)});
      }
    }
  }

  /// The node's name, or the mesh's; names that assimp makes up in angle brackets do not count.
  static std::string group_name(const aiNode& node, const aiMesh& mesh) {
    for (const aiString* name : {&node.mName, &mesh.mName})
      if (name->length > 0 && name->data[0] != '<') return name->C_Str();
    return default_name;
  }

  void add_mesh(const aiMesh& mesh, const std::string& group_name, const Transform& to_world) {
    Scene& scene = draft_.scene;
    const std::size_t first = scene.vertices.size();
    if (first + mesh.mNumVertices > static_cast<std::size_t>(std::numeric_limits<int>::max()))
      throw Error(ErrorCode::too_large, file_.string(), "there are more than 2^31 vertices");
    for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
      const aiVector3D& p = mesh.mVertices[v];
      scene.vertices.push_back(to_world * Vec3(static_cast<double>(p.x), static_cast<double>(p.y),
                                               static_cast<double>(p.z)));
    }
    // A mirror turns the front to the back.
    const bool mirrored = to_world.linear().determinant() < 0;
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const aiFace& input = mesh.mFaces[f];
      if (input.mNumIndices < 3) {
        ++skipped_;
        continue;
      }
      Face face;
      face.group = group_id(draft_, group_name);
      face.material = material(mesh.mMaterialIndex);
      for (unsigned i = 0; i < input.mNumIndices; ++i) {
        const unsigned v = input.mIndices[mirrored ? input.mNumIndices - 1 - i : i];
        if (v >= mesh.mNumVertices)
          fail(file_, 0,
               fmt::format("face {} of mesh {} names vertex {}, but the mesh has {}", f,
                           in_quotes(mesh.mName.C_Str()), v, mesh.mNumVertices));
        face.vertices.push_back(static_cast<int>(first + v));
      }
      scene.faces.push_back(std::move(face));
    }
  }

  int material(unsigned index) {
    if (index >= input_.mNumMaterials) return material_id(draft_, default_name);
    int& id = material_ids_[index];
    if (id >= 0) return id;
    const aiMaterial& input = *input_.mMaterials[index];
    std::string name = input.GetName().C_Str();
    if (is_made_up(name, index)) return id = material_id(draft_, default_name);
    if (name.empty()) name = fmt::format("material {}", index + 1);
    // Different materials may have one name in the file.
    std::string unique = name;
    for (int n = 2; draft_.material_ids.contains(unique); ++n)
      unique = fmt::format("{} {}", name, n);
    id = material_id(draft_, unique);
    Material& material = draft_.scene.materials.back();
    read_material(input, material);
    if (const auto strength = emissive_strengths_.find(name); strength != emissive_strengths_.end())
      material.exitance *= strength->second;
    return id;
  }

  /// True for the material that assimp adds for meshes or formats without materials.
  bool is_made_up(const std::string& name, unsigned index) const {
    return name == AI_DEFAULT_MATERIAL_NAME || name == "%%%DEFAULT" ||
           (is_gltf(file_) && name.empty() && index + 1 == input_.mNumMaterials);
  }

  static void read_material(const aiMaterial& input, Material& material) {
    aiColor4D colour;
    if (input.Get(AI_MATKEY_BASE_COLOR, colour) == aiReturn_SUCCESS ||
        input.Get(AI_MATKEY_COLOR_DIFFUSE, colour) == aiReturn_SUCCESS)
      material.rho = to_rgb(colour);
    if (input.Get(AI_MATKEY_COLOR_EMISSIVE, colour) == aiReturn_SUCCESS)
      material.exitance = to_rgb(colour);
    int two_sided = 0;
    if (input.Get(AI_MATKEY_TWOSIDED, two_sided) == aiReturn_SUCCESS)
      material.two_sided = two_sided != 0;
  }

  const std::filesystem::path& file_;
  const aiScene& input_;
  SceneDraft draft_;
  long long skipped_ = 0;
  std::vector<int> material_ids_;  ///< of assimp's materials, −1 until used
  std::map<std::string, double> emissive_strengths_;
};

/// Notes which files are read: a scene may name others.
class NotingFiles : public Assimp::DefaultIOSystem {
 public:
  explicit NotingFiles(std::vector<std::filesystem::path>& files) : files_(files) {}

  Assimp::IOStream* Open(const char* file, const char* mode) override {
    Assimp::IOStream* stream = DefaultIOSystem::Open(file, mode);
    if (stream != nullptr) files_.emplace_back(file);
    return stream;
  }

 private:
  std::vector<std::filesystem::path>& files_;
};

/// Null, with a sentence in the importer or thrown, if there is no scene in the file.
const aiScene* load(Assimp::Importer& importer, const std::filesystem::path& path) {
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_USE_COLLADA_NAMES, true);  // not the ids
  return importer.ReadFile(path.string(), 0);
}

/// Assimp's older importers crash or hang on some damaged files. That of glTF checks what it reads.
void require_harmless(const std::filesystem::path& path) {
  if (is_gltf(path)) return;
  constexpr double bytes = 1e6;  // of a megabyte
  const double megabytes = static_cast<double>(std::filesystem::file_size(path)) / bytes;
  TrialLimits limits;
  limits.seconds = 3 + static_cast<int>(2 * std::min(megabytes, 1e4));
  limits.megabytes = 200 + 100 * megabytes;
  const auto try_import = [&] {
    Assimp::Importer importer;
    load(importer, path);
  };
  if (!survives(try_import, limits))
    fail(path, 0,
         fmt::format("the file is damaged: reading it crashes, or takes over {} s or {:.0f} MB",
                     limits.seconds, limits.megabytes));
}

}  // namespace

SceneDraft read_with_assimp(const std::filesystem::path& path) {
  require_readable(path);
  if (is_gltf(path)) require_whole_glb(path);
  require_harmless(path);
  std::vector<std::filesystem::path> files;
  Assimp::Importer importer;
  importer.SetIOHandler(new NotingFiles(files));  // which the importer deletes
  const aiScene* input = nullptr;
  try {
    input = load(importer, path);
  } catch (const std::exception& error) {
    fail(path, 0, fmt::format("the file cannot be read: {}", error.what()));
  }
  if (input == nullptr)
    fail(path, 0, fmt::format("the file cannot be read: {}", importer.GetErrorString()));
  SceneDraft draft = AssimpReader(path, *input).read();
  draft.files = std::move(files);
  return draft;
}

}  // namespace halfshade::reading
