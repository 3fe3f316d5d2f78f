// SPDX-License-Identifier: BSL-1.0
// What the README and the docs show is what is compiled and run, and what it points at is there.
#include <boost/test/unit_test.hpp>

#include <filesystem>
#include <regex>
#include <sstream>

#include "support/scratch.hpp"

using nysalt::test::contents;

namespace {

const std::filesystem::path root(NYSALT_SOURCE_DIR);
const std::string readme = contents(root / "README.md");

/// The text between two marks; the marks take whole lines.
std::string between(const std::string& text, const std::string& first, const std::string& last) {
  const auto begin = text.find('\n', text.find(first)) + 1;
  const auto end = text.rfind('\n', text.find(last, begin)) + 1;
  BOOST_REQUIRE(text.find(first) != std::string::npos);
  BOOST_REQUIRE(text.find(last, begin) != std::string::npos);
  return text.substr(begin, end - begin);
}

/// Every line without the spaces with which the first begins.
std::string outdented(const std::string& text) {
  const auto spaces = text.find_first_not_of(' ');
  std::istringstream lines(text);
  std::string result;
  for (std::string line; std::getline(lines, line);) {
    if (!line.empty()) {
      BOOST_REQUIRE(line.find_first_not_of(' ') >= spaces);
      line.erase(0, spaces);
    }
    result += line + '\n';
  }
  return result;
}

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t n = 0;
  for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
  return n;
}

}  // namespace

BOOST_AUTO_TEST_CASE(the_code_in_the_readme_is_that_of_the_example) {
  BOOST_TEST(count(readme, "```cpp\n") == 1);
  const auto example = contents(root / "examples" / "first_steps.cpp");
  const auto shown = between(readme, "```cpp", "```");
  BOOST_TEST(shown.size() > 100);
  BOOST_TEST(shown == outdented(between(example, "// [readme]", "// [/readme]")));
}

BOOST_AUTO_TEST_CASE(the_python_in_the_docs_is_that_of_the_example) {
  const auto page = contents(root / "docs" / "program.md");
  const auto example = contents(root / "examples" / "read_run.py");
  const auto shown = between(page, "```python", "```");
  BOOST_TEST(shown.size() > 100);
  BOOST_TEST(shown == between(example, "# [docs]", "# [/docs]"));
}

BOOST_AUTO_TEST_CASE(paths_in_the_readme_exist) {
  const std::regex path("(docs|examples)/[A-Za-z0-9_./-]*[A-Za-z0-9_/]");
  int found = 0;
  for (std::sregex_iterator it(readme.begin(), readme.end(), path); it != std::sregex_iterator();
       ++it, ++found) {
    BOOST_TEST(std::filesystem::exists(root / it->str()), it->str() << " is not there");
  }
  BOOST_TEST(found > 0);
}
