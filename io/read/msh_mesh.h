#pragma once

#include "io/read/read_formats.h"

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>

/// What readers of Gmsh's text and binary files have in common.
namespace halfshade::reading {

/// A mesh as its file tells it, piece by piece. Lines are for messages, 0 in binary files. All but
/// `finish` throw Error(invalid_input).
class MshMesh {
 public:
  explicit MshMesh(const std::filesystem::path& file);

  /// A line "dimension tag "name"" of the physical names.
  void add_name(std::string_view line_text, int line);
  /// Puts a surface into a physical group; the first of `groups` counts.
  void add_surface(long long tag, std::span<const long long> groups, int line);
  void add_node(long long tag, const Vec3& position, int line);
  /// Whether elements of a type are faces; those of some others are passed over.
  bool is_face(long long type, int line);
  /// `group` is the tag of its physical group; 0: none.
  void add_face(long long element, std::span<const long long> nodes, long long group, int line);
  /// The physical group of a surface; 0 if it has none.
  long long group_of(long long surface) const;

  SceneDraft finish();

 private:
  [[noreturn]] void reject(int line, const std::string& sentence) const;
  std::string group_name(long long tag) const;

  std::filesystem::path file_;
  SceneDraft draft_;
  std::map<long long, std::string> names_;          ///< of physical surfaces
  std::map<long long, long long> physical_;         ///< surface → its physical group
  std::unordered_map<long long, long long> nodes_;  ///< tag → vertex
  std::vector<long long> corners_;
  long long volumes_ = 0;
};

/// How many nodes a known element has that is_face takes; 3 of a triangle, 4 of a quadrangle.
int msh_nodes(long long type);

/// A file that says it is binary, formats 2.2 and 4.1, of either byte order. `bytes` are all of it.
SceneDraft read_binary_msh(const std::filesystem::path& path, std::string_view bytes);

}  // namespace halfshade::reading
