#pragma once

namespace halfshade::test {

/// Where this build's things are. They are told to places.cpp alone, so that the tests compile to
/// the same in every folder and what a compiler cache has of them serves all.
extern const char* const data_folder;     ///< data/
extern const char* const sources_folder;  ///< the repository
extern const char* const program;         ///< halfshade

}  // namespace halfshade::test
