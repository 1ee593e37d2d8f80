#include "tests/support/places.h"

namespace halfshade::test {

const char* const data_folder = HALFSHADE_DATA;
const char* const sources_folder = HALFSHADE_SOURCES;
const char* const program = HALFSHADE_PROGRAM;

}  // namespace halfshade::test
