#pragma once

#include "tests/architecture/source_text.h"

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace halfshade::test {

/// Which rooms each room may include, itself apart: the third column of ARCHITECTURE.md's table.
using IncludeRules = std::map<std::string, std::set<std::string>>;

/// Reads the table of rooms: rows `| room | what it holds | rooms it may include |` whose first
/// cell is a folder in backquotes; the third names folders, or rooms of the same house by their
/// last part, separated by commas.
IncludeRules rules_of(std::string_view markdown);

/// One sentence for each thing that breaks the rules:
/// * an #include in quotes of a file that is not there, or of a room that the table does not allow;
/// * a file in a folder that the table does not list;
/// * a header that includes CGAL, OpenMesh, Embree or VTK, other than in a folder `detail` of its
///   room, and an #include of such a header from another room;
/// * rooms whose permissions run in a circle.
std::vector<std::string> broken_rules(const IncludeRules& rules,
                                      const std::vector<SourceText>& files);

}  // namespace halfshade::test
