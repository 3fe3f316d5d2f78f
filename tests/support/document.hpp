// SPDX-License-Identifier: BSL-1.0
// The JSON document that a command prints when all is well.
#pragma once

#include <boost/test/unit_test.hpp>

#include <string>

#include "program.hpp"

namespace nysalt::test {

/// What `nysalt arguments --json` printed; it must have ended well, and have said nothing else.
inline nlohmann::ordered_json document(const std::string& arguments,
                                       const scratch& folder = scratch("document")) {
  const auto done = run(folder, arguments + " --json");
  BOOST_TEST(done.code == 0, "nysalt " << arguments);
  BOOST_TEST(done.err == "", "nysalt " << arguments << " said " << done.err);
  auto result = json_of(done);
  BOOST_REQUIRE(result.is_object());
  return result;
}

}  // namespace nysalt::test
