// SPDX-License-Identifier: BSL-1.0
// Command lines that the program must refuse: exit code 2, one line that says why, nothing printed or
// written.
#pragma once

#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "program.hpp"

namespace nysalt::test {

struct bad {
  std::string arguments;
  std::vector<std::string_view> words;  // that must be said
};

inline bool is_one_line(const std::string& text) {
  return std::count(text.begin(), text.end(), '\n') == 1 && text.ends_with('\n') &&
         std::none_of(text.begin(), text.end() - 1, [](unsigned char c) { return c < ' '; });
}

/// All must be refused, in one folder that stays as it is.
inline void all_refused(const scratch& folder, const std::vector<bad>& cases) {
  const auto before = folder.files();
  for (const auto& [arguments, words] : cases) {
    const finished done = run(folder, arguments);
    BOOST_TEST_CONTEXT("nysalt " << arguments << "\nsaid: " << done.err) {
      BOOST_TEST(done.code == 2);
      BOOST_TEST(done.out == "");
      BOOST_TEST(is_one_line(done.err));
      BOOST_TEST(done.err.starts_with("nysalt: "));
      for (const auto word : words) {
        BOOST_TEST(done.err.find(word) != std::string::npos, "missing: " << word);
      }
      BOOST_TEST((folder.files() == before));
    }
  }
}
/// Each argument list behind the same beginning.
inline std::vector<bad> after(const std::string& beginning, std::vector<bad> cases) {
  for (auto& one : cases) one.arguments = beginning + " " + one.arguments;
  return cases;
}

}  // namespace nysalt::test
