#include "io/read/msh_mesh.h"

#include "io/read/read_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace halfshade::reading {
namespace {

/// What becomes of elements of a type.
enum class ElementUse { face, none, volume, curved, unknown };

ElementUse use_of(long long type) {
  const auto is_one_of = [type](std::initializer_list<long long> types) {
    return std::find(types.begin(), types.end(), type) != types.end();
  };
  if (is_one_of({2, 3})) return ElementUse::face;
  if (is_one_of({1, 8, 15, 26, 27, 28})) return ElementUse::none;  // lines and points
  if (is_one_of({4, 5, 6, 7, 11, 12, 13, 14, 17, 18, 19, 29, 30, 31, 92, 93}))
    return ElementUse::volume;
  if (is_one_of({9, 10, 16, 20, 21, 22, 23, 24, 25, 36, 37})) return ElementUse::curved;
  return ElementUse::unknown;
}

}  // namespace

MshMesh::MshMesh(const std::filesystem::path& file) : file_(file) {
  draft_.scene.source = file.string();
}

void MshMesh::add_name(std::string_view line_text, int line) {
  std::vector<std::string_view> words;
  split(line_text, words);
  const std::optional<long long> dimension = words.empty() ? std::nullopt : parse_integer(words[0]);
  const std::optional<long long> tag = words.size() < 2 ? std::nullopt : parse_integer(words[1]);
  if (!dimension || !tag)
    reject(line, fmt::format("{} is not a dimension, a number and a name in quotes",
                             in_quotes(line_text)));
  const std::size_t first = line_text.find('"'), last = line_text.rfind('"');
  if (first == last) reject(line, "the name of a physical group stands in quotes");
  if (*dimension == 2 && last > first + 1)
    draft_.named_groups.insert(names_[*tag] = line_text.substr(first + 1, last - first - 1));
}

void MshMesh::add_surface(long long tag, std::span<const long long> groups, int line) {
  if (groups.empty()) return;
  physical_[tag] = groups[0];
  if (groups.size() > 1)
    draft_.warnings.push_back(
        fmt::format("{}: surface {} is in {} physical groups; the first one counts",
                    place(file_, line), tag, groups.size()));
}

void MshMesh::add_node(long long tag, const Vec3& position, int line) {
  std::vector<Vec3>& vertices = draft_.scene.vertices;
  if (!nodes_.try_emplace(tag, static_cast<long long>(vertices.size())).second)
    reject(line, fmt::format("node {} is there twice", tag));
  if (!position.allFinite()) reject(line, fmt::format("node {} is at no finite place", tag));
  vertices.push_back(position);
}

bool MshMesh::is_face(long long type, int line) {
  switch (use_of(type)) {
    case ElementUse::face:
      return true;
    case ElementUse::none:
      return false;
    case ElementUse::volume:
      ++volumes_;
      return false;
    case ElementUse::curved:
      reject(line,
             "triangles and quadrangles of a higher order cannot be read; mesh with "
             "Mesh.ElementOrder = 1");
    case ElementUse::unknown:
      break;
  }
  reject(line, fmt::format("elements of type {} are not known", type));
}

void MshMesh::add_face(long long element, std::span<const long long> nodes, long long group,
                       int line) {
  if (group < 0)
    reject(line, fmt::format("a surface is in the physical group {} the other way round; turn the "
                             "surface instead",
                             group));
  corners_.clear();
  for (const long long tag : nodes) {
    const auto node = nodes_.find(tag);
    if (node == nodes_.end())
      reject(line, fmt::format("element {} names node {}, which is not there", element, tag));
    corners_.push_back(node->second);
  }
  reading::add_face(draft_, corners_, line, group_name(group));
}

long long MshMesh::group_of(long long surface) const {
  const auto physical = physical_.find(surface);
  return physical == physical_.end() ? 0 : physical->second;
}

SceneDraft MshMesh::finish() {
  if (volumes_ > 0)
    draft_.warnings.push_back(fmt::format(
        "{}: {} volume elements are not used; faces are triangles and quadrangles of the file",
        file_.string(), volumes_));
  return std::move(draft_);
}

void MshMesh::reject(int line, const std::string& sentence) const { fail(file_, line, sentence); }

std::string MshMesh::group_name(long long tag) const {
  if (tag == 0) return default_name;
  const auto name = names_.find(tag);
  return name != names_.end() ? name->second : fmt::format("physical {}", tag);
}

int msh_nodes(long long type) {
  static const std::map<long long, int> known = {
      {1, 2},   {2, 3},   {3, 4},   {4, 4},   {5, 8},   {6, 6},   {7, 5},   {8, 3},
      {11, 10}, {12, 27}, {13, 18}, {14, 14}, {15, 1},  {17, 20}, {18, 15}, {19, 13},
      {26, 4},  {27, 5},  {28, 6},  {29, 20}, {30, 35}, {31, 56}, {92, 64}, {93, 125}};
  return known.at(type);
}

}  // namespace halfshade::reading
