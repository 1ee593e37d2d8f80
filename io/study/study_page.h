#pragma once

#include "io/chart/chart.h"
#include "io/study/study.h"

#include <string>
#include <vector>

namespace halfshade {

/// A chart of a study, and the name of its files without their endings.
struct StudyChart {
  std::string name;
  Chart chart;
};

/// Charts of a scene: error against time, CPU time and unknowns; the parts' errors where light is
/// reflected; estimated against true error.
std::vector<StudyChart> study_charts(const Study& study, const std::string& scene);

/// Seconds that a method needs for an error: of its fastest case at most that far off. 0 if none
/// is.
double seconds_to_reach(const Study& study, const std::string& method, double error);

/// What only the caller knows of a study.
struct StudyPageInfo {
  std::string scene;    ///< name
  std::string version;  ///< of halfshade
  std::string command;  ///< as given
};

/// One self-contained HTML page: charts, tables, pictures, what was compared with what and how sure
/// that is, the machine, and the commands to repeat. Needs no network. Draws the pictures,
/// METHOD.png in the folder, on the way.
std::string study_page(const Study& study, const StudyOptions& options, const StudyPageInfo& info);

/// Processor, threads, memory and system of the machine this runs on, in a line.
std::string machine_line();

}  // namespace halfshade
