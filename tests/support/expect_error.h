#pragma once

#include "meshing/core/error.h"

#include <gmock/gmock.h>
#include <string>
#include <utility>
#include <vector>

namespace halfshade::test {

/// Expects `call` to throw halfshade::Error with this code and all of these parts in its message.
template <typename Call>
void expect_error(Call&& call, ErrorCode code, const std::vector<std::string>& parts) {
  try {
    std::forward<Call>(call)();
    ADD_FAILURE() << "nothing was thrown";
  } catch (const Error& error) {
    EXPECT_EQ(static_cast<int>(error.code()), static_cast<int>(code)) << error.what();
    for (const std::string& part : parts) EXPECT_THAT(error.what(), testing::HasSubstr(part));
  }
}

}  // namespace halfshade::test
