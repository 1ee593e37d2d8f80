#pragma once

#include "io/study/study.h"

#include <string>
#include <vector>

namespace halfshade {

/// The methods that a study has cases of, in the order of all.
std::vector<std::string> methods_in(const Study& study);

/// The fastest case of a method that is at most that far off; null if there is none.
const StudyRow* fastest_case(const Study& study, const std::string& method, double error);

/// The round errors that can be told from none and that some method reached, the largest first.
std::vector<double> reached_errors(const Study& study);

/// Where another method is faster than the default, as HTML; nothing if there is no other, or not
/// the default.
std::string where_the_default_loses(const Study& study);

/// How many times as long the fastest other method and the fastest classic one take for errors of
/// 0.01 and below, and what of it is light that both find in the same way; as HTML. Nothing if
/// there is nothing to compare.
std::string what_the_default_gains(const Study& study);

}  // namespace halfshade
