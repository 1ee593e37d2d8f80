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
#include <initializer_list>
#include <limits>
#include <map>
#include <memory>
#include <optional>
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
      add_places(mesh, input, mirrored);
    }
  }

  /// Where the corners of a face, just added, are in the pictures of its material.
  void add_places(const aiMesh& mesh, const aiFace& face, bool mirrored) {
    std::vector<Vec2>& places = draft_.picture_places.emplace_back();
    if (mesh.mMaterialIndex >= input_.mNumMaterials) return;
    const auto use = place_sets_.find(mesh.mMaterialIndex);
    if (use == place_sets_.end() || !mesh.HasTextureCoords(use->second)) return;
    for (unsigned i = 0; i < face.mNumIndices; ++i) {
      const unsigned v = face.mIndices[mirrored ? face.mNumIndices - 1 - i : i];
      const aiVector3D& place = mesh.mTextureCoords[use->second][v];
      places.emplace_back(static_cast<double>(place.x), static_cast<double>(place.y));
    }
    const bool is_finite = std::all_of(places.begin(), places.end(),
                                       [](const Vec2& place) { return place.allFinite(); });
    if (!is_finite) places.clear();
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
    read_pictures(index, material, draft_.origins.back());
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

  void read_pictures(unsigned index, Material& material, MaterialOrigin& origin) {
    origin.picture = picture(index, {aiTextureType_BASE_COLOR, aiTextureType_DIFFUSE});
    origin.exitance_picture = picture(index, {aiTextureType_EMISSIVE});
    // Where there is a picture, COLLADA has no colour beside it, and that of 3DS does not count.
    if (is_gltf(file_)) return;
    if (origin.picture) material.rho.setOnes();
    if (origin.exitance_picture) material.exitance.setOnes();
  }

  std::optional<PictureUse> picture(unsigned index, std::initializer_list<aiTextureType> types) {
    const aiMaterial& input = *input_.mMaterials[index];
    for (const aiTextureType type : types) {
      aiString name;
      unsigned set = 0;
      if (input.GetTexture(type, 0, &name, nullptr, &set) != aiReturn_SUCCESS) continue;
      const std::shared_ptr<const Texture> texture = texture_named(name.C_Str());
      if (!texture) return std::nullopt;
      if (aiUVTransform moved; input.Get(AI_MATKEY_UVTRANSFORM(type, 0), moved) == aiReturn_SUCCESS)
        warn_of_transform(name.C_Str());
      const auto [known, is_new] = place_sets_.try_emplace(index, set);
      if (!is_new && known->second != set)
        draft_.warnings.push_back(
            fmt::format("{}: material {} has pictures with different places; all are laid as the "
                        "first is",
                        file_.string(), in_quotes(input.GetName().C_Str())));
      return PictureUse{texture, Vec2::Ones(), Vec2::Zero()};
    }
    return std::nullopt;
  }

  void warn_of_transform(const std::string& name) {
    draft_.warnings.push_back(
        fmt::format("{}: that the picture {} is moved, turned or scaled is not used",
                    file_.string(), in_quotes(name)));
  }

  /// A picture in the file or beside it; none, with a warning, if there is none.
  std::shared_ptr<const Texture> texture_named(const std::string& name) {
    const auto [entry, is_new] = textures_.try_emplace(name);
    if (!is_new) return entry->second;
    const aiTexture* inside = input_.GetEmbeddedTexture(name.c_str());
    if (inside != nullptr && inside->mHeight == 0) {  // a file's bytes
      const std::string bytes(reinterpret_cast<const char*>(inside->pcData), inside->mWidth);
      entry->second = std::make_shared<const Texture>(read_texture(file_ / name, bytes));
      return entry->second;
    }
    const std::filesystem::path path = find_picture(file_, name);
    if (path.empty()) {
      draft_.warnings.push_back(
          fmt::format("{}: there is no picture {}: its material has its colours alone",
                      file_.string(), in_quotes(name)));
      return nullptr;
    }
    draft_.files.push_back(path);
    entry->second = std::make_shared<const Texture>(read_texture(path, read_bytes(path)));
    return entry->second;
  }

  const std::filesystem::path& file_;
  const aiScene& input_;
  SceneDraft draft_;
  long long skipped_ = 0;
  std::vector<int> material_ids_;  ///< of assimp's materials, −1 until used
  std::map<std::string, double> emissive_strengths_;
  std::map<unsigned, unsigned>
      place_sets_;  ///< material → which of a mesh's places its pictures use
  std::map<std::string, std::shared_ptr<const Texture>> textures_;
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
  draft.files.insert(draft.files.begin(), files.begin(), files.end());
  return draft;
}

}  // namespace halfshade::reading
