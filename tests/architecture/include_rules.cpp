#include "tests/architecture/include_rules.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <regex>
#include <sstream>

namespace halfshade::test {
namespace {

constexpr std::string_view detail = "/detail";

bool is_detail(const std::string& path) {
  return path.substr(0, path.rfind('/')).ends_with(detail);
}

/// The folder, or the one that a folder `detail` is in.
std::string room_of(const std::string& path) {
  std::string folder = path.substr(0, path.rfind('/'));
  if (folder.ends_with(detail)) folder.resize(folder.size() - detail.size());
  return folder;
}

std::string house_of(const std::string& room) { return room.substr(0, room.find('/')); }

/// The words in backquotes.
std::vector<std::string> quoted(const std::string& cell) {
  static const std::regex word("`([^`]+)`");
  std::vector<std::string> words;
  for (auto at = std::sregex_iterator(cell.begin(), cell.end(), word); at != std::sregex_iterator();
       ++at)
    words.push_back((*at)[1]);
  return words;
}

std::vector<std::string> cells(const std::string& row) {
  std::vector<std::string> result;
  std::istringstream stream(row.substr(1));
  for (std::string cell; std::getline(stream, cell, '|');) result.push_back(cell);
  return result;
}

struct Include {
  std::string target;
  int line = 0;
  bool in_quotes = false;
};

std::vector<Include> includes_of(const std::string& text) {
  static const std::regex directive(R"re(^\s*#\s*include\s*(["<])([^">]+)[">])re");
  std::vector<Include> result;
  std::istringstream stream(text);
  int number = 0;
  for (std::string line; std::getline(stream, line);) {
    ++number;
    if (std::smatch found; std::regex_search(line, found, directive))
      result.push_back({found[2], number, found[1] == "\""});
  }
  return result;
}

bool is_kept_out_of_headers(const std::string& target) {
  static const std::regex library("^(CGAL/|OpenMesh/|embree3/|vtk)");
  return std::regex_search(target, library);
}

void check_file(const IncludeRules& rules, const SourceText& file,
                const std::set<std::string>& known, std::vector<std::string>& broken) {
  const std::string room = room_of(file.path);
  const auto rule = rules.find(room);
  if (rule == rules.end()) {
    broken.push_back(
        fmt::format("{} lies in {}, which the table of rooms does not list", file.path, room));
    return;
  }
  const bool is_header = file.path.ends_with(".h") && !is_detail(file.path);
  for (const Include& include : includes_of(file.text)) {
    const std::string place = fmt::format("{}:{}", file.path, include.line);
    if (!include.in_quotes) {
      if (is_header && is_kept_out_of_headers(include.target))
        broken.push_back(fmt::format("{} includes <{}>, which belongs in .cpp files only", place,
                                     include.target));
      continue;
    }
    const std::string other = room_of(include.target);
    if (!known.contains(include.target))
      broken.push_back(fmt::format("{} includes {}, which does not exist", place, include.target));
    else if (other != room && is_detail(include.target))
      broken.push_back(fmt::format("{} includes {}, a detail of {}", place, include.target, other));
    else if (other != room && !rule->second.contains(other))
      broken.push_back(fmt::format(
          "{} includes {}, but {} may include only {}", place, include.target, room,
          rule->second.empty() ? "itself" : fmt::format("{}", fmt::join(rule->second, ", "))));
  }
}

/// Depth-first; says where it comes back to a room that it is still inside of.
void check_circles(const IncludeRules& rules, std::vector<std::string>& broken) {
  std::set<std::string> done;
  std::vector<std::string> way;
  const std::function<void(const std::string&)> visit = [&](const std::string& room) {
    if (const auto start = std::find(way.begin(), way.end(), room); start != way.end()) {
      broken.push_back(fmt::format("rooms may include each other in a circle: {}, {}",
                                   fmt::join(start, way.end(), ", "), room));
      return;
    }
    if (!done.insert(room).second) return;
    const auto rule = rules.find(room);
    if (rule == rules.end()) {
      broken.push_back(fmt::format("the table allows {}, but has no row for it", room));
      return;
    }
    way.push_back(room);
    for (const std::string& next : rule->second) visit(next);
    way.pop_back();
  };
  for (const auto& [room, allowed] : rules) {
    done.erase(room);
    visit(room);
  }
}

}  // namespace

IncludeRules rules_of(std::string_view markdown) {
  IncludeRules rules;
  std::istringstream stream{std::string(markdown)};
  for (std::string line; std::getline(stream, line);) {
    if (!line.starts_with("| `")) continue;
    const std::vector<std::string> columns = cells(line);
    if (columns.size() < 3) continue;
    const std::vector<std::string> room = quoted(columns[0]);
    if (room.size() != 1) continue;
    std::set<std::string>& allowed = rules[room[0]];
    for (const std::string& name : quoted(columns[2]))
      allowed.insert(name.find('/') == std::string::npos ? house_of(room[0]) + "/" + name : name);
  }
  return rules;
}

std::vector<std::string> broken_rules(const IncludeRules& rules,
                                      const std::vector<SourceText>& files) {
  std::vector<std::string> broken;
  std::set<std::string> known;
  for (const SourceText& file : files) known.insert(file.path);
  for (const SourceText& file : files) check_file(rules, file, known, broken);
  check_circles(rules, broken);
  return broken;
}

}  // namespace halfshade::test
