#pragma once

#include "io/study/study.h"

#include <string>

namespace halfshade {

/// Pictures of each method's finest result, and how it differs from the most exact of them in false
/// colours, as HTML that holds them. Writes METHOD.png and METHOD_difference.png into the folder on
/// the way. Nothing if there is no result.
std::string study_pictures(const Study& study, const StudyOptions& options);

}  // namespace halfshade
