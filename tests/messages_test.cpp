// SPDX-License-Identifier: BSL-1.0
// docs/messages.md shows what compilers say: every sentence of ours, and nothing that none of them prints.
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <filesystem>
#include <regex>
#include <set>
#include <sstream>
#include <string>

#include "support/scratch.hpp"

using nysalt::test::contents;

namespace {

const std::filesystem::path root(NYSALT_SOURCE_DIR);

/// The string literals that stand one after the other from a place on, joined.
std::string joined_literals(const std::string& code, std::size_t at) {
  std::string result;
  while (at < code.size() && code[at] == '"') {
    const auto end = code.find('"', at + 1);
    result += code.substr(at + 1, end - at - 1);
    at = code.find_first_not_of(" \n", end + 1);
  }
  return result;
}

/// What static assertions of the headers say.
std::set<std::string> sentences_of_headers() {
  std::set<std::string> result;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root / "include")) {
    if (entry.path().extension() != ".hpp") continue;
    const std::string code = contents(entry.path());
    for (auto at = code.find("\"nysalt: "); at != std::string::npos; at = code.find("\"nysalt: ", at + 1)) {
      result.insert(joined_literals(code, at));
    }
  }
  return result;
}

/// What the cases of tests/must_not_compile expect to read, of one compiler or all.
std::set<std::string> expected_messages() {
  std::set<std::string> result;
  for (const auto& entry : std::filesystem::directory_iterator(root / "tests" / "must_not_compile")) {
    std::istringstream lines(contents(entry.path()));
    std::string message;
    for (std::string line; std::getline(lines, line) && !line.starts_with("// SPDX");) {
      static const std::regex first("// expect( [A-Za-z]+)?: (.+)");
      static const std::regex more("//   +(.+)");
      std::smatch found;
      if (std::regex_match(line, found, first)) {
        if (!message.empty()) result.insert(message);
        message = found[2];
      } else if (std::regex_match(line, found, more)) {
        message += " " + found[1].str();
      }
    }
    result.insert(message);
  }
  return result;
}

/// The lines of the fences that are marked as text, and what is quoted.
std::set<std::string> shown_messages(const std::string& page) {
  std::set<std::string> result;
  std::istringstream lines(page);
  bool inside = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("> nysalt: ")) {
      result.insert(line.substr(2));
    } else if (line.starts_with("```")) {
      inside = line == "```text";
    } else if (inside) {
      result.insert(line);
    }
  }
  return result;
}

const std::string page = contents(root / "docs" / "messages.md");

}  // namespace

BOOST_AUTO_TEST_CASE(every_sentence_of_the_headers_is_on_the_page) {
  const auto sentences = sentences_of_headers();
  BOOST_TEST(sentences.size() > 20);
  for (const std::string& sentence : sentences) {
    BOOST_TEST(page.find(sentence) != std::string::npos, "docs/messages.md does not show: " << sentence);
  }
}

BOOST_AUTO_TEST_CASE(nothing_is_on_the_page_that_no_compiler_says) {
  const auto sentences = sentences_of_headers();
  const auto expected = expected_messages();
  const auto shown = shown_messages(page);
  BOOST_TEST(shown.size() > 25);
  for (const std::string& message : shown) {
    BOOST_TEST((sentences.contains(message) || expected.contains(message)), "nobody says: " << message);
  }
  // Most sentences are shown with a case: of those that are not, the page says so.
  const auto has_case = [&](const std::string& sentence) { return expected.contains(sentence); };
  BOOST_TEST(std::ranges::count_if(sentences, has_case) > std::ssize(sentences) / 2);
}
