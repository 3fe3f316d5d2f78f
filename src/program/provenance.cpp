// SPDX-License-Identifier: BSL-1.0
#include "provenance.hpp"

#include <algorithm>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <fstream>

#include "bundled_systems.hpp"
#include "comparison/catalogue.hpp"
#include "comparison/json.hpp"
#include "comparison/method_file.hpp"
#include "comparison/method_file_format.hpp"
#include "comparison/method_source.hpp"
#include "comparison/refusal.hpp"
#include "output/written_arrays.hpp"
#include "recorded_options.hpp"
#include "report/result_file.hpp"
#include "settings.hpp"

namespace nysalt::program {

namespace {

namespace fs = std::filesystem;

bool is_file(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

/// Of the description of a system. A Hamiltonian of one's own has no name of ours.
cited_setup setup_of(const std::string& description) {
  cited_setup setup;
  const std::string name = description.substr(0, description.find('('));
  for (const auto& declared : bundled_declarations()) {
    if (name == (declared.described.empty() ? declared.name : declared.described)) {
      setup.system = declared.name;
    }
  }
  setup.in_bath = description.find(" in bath(") != std::string::npos;
  return setup;
}

/// The methods that `recommend` ranks: all families if none are named, and what is classical.
void add_candidates(const recorded_options& given, cited_setup& to) {
  to.learned = given.of("families");
  if (to.learned.empty()) to.learned = family_names();
  to.methods = method_names();
  to.metrics = {given.one_of("metric", recommend_command().metric)};
}

cited_setup setup_of(const recorded_options& given) {
  cited_setup setup;
  setup.in_bath = given.is_positive("friction") || given.is_positive("sigma");
  if (given.command() == "stability") {
    setup.system = given.one_of("system", "");
    setup.families = given.of("family");
    return setup;
  }
  setup.system = given.one_of("system", system_settings().name);
  if (given.command() == "learn") setup.learned = {given.one_of("family", learn_command().family)};
  if (given.command() == "recommend") add_candidates(given, setup);
  if (given.command() == "compare") {
    setup.metrics = given.of("metric");
    if (setup.metrics.empty()) setup.metrics = compare_command().metrics;
  }
  return setup;
}

/// A file is searched beside the result first, as results and schemes are often kept together.
std::string found_beside(const fs::path& result, const std::string& method) {
  const fs::path beside = result.parent_path() / method;
  return is_file(beside) ? beside.string() : method;
}

/// Adds what made a result; the result is read too if it is a scheme.
void add_made(const json& made, const fs::path& result, std::vector<cited_setup>& to) {
  if (made.contains("description")) {  // of samples
    std::vector<cited_setup> setups{setup_of(made.at("description").get<std::string>())};
    if (made.value("format", json()) == "nysalt sample") setups.front().metrics = {"acceptance"};
    add_method(found_beside(result, made.at("method").get<std::string>()), setups);
    to.insert(to.end(), setups.begin(), setups.end());
    return;
  }
  const recorded_options given(made.at("options").get<std::string>());
  const std::vector<std::string> known{"learn", "compare", "recommend", "stability"};
  if (std::ranges::find(known, given.command()) == known.end()) {
    refuse("the command must be one of {}, got '{}'", listed(known), given.command());
  }
  std::vector<cited_setup> setups{setup_of(given)};
  for (const char* option : {"method", "methods"}) {
    for (const auto& method : given.of(option)) add_method(found_beside(result, method), setups);
  }
  const bool writes_schemes = given.command() == "learn" || given.command() == "recommend";
  if (writes_schemes) add_method(result.string(), setups);
  citations_for(setups);  // what has no name is refused here, where the file is known
  to.insert(to.end(), setups.begin(), setups.end());
}

/// What a result says of how it was made; null if it says nothing.
json made_of(const fs::path& result) {
  if (is_of_arrays(result)) return written_arrays("", result.string()).about();
  std::string line(longest_method_file, '\0');
  std::ifstream input(result, std::ios::binary);
  input.read(line.data(), static_cast<std::streamsize>(line.size()));
  line.resize(static_cast<std::size_t>(input.gcount()));
  if (line.starts_with(mark_of_table))
    return parsed(std::string_view(line).substr(0, line.find('\n')).substr(mark_of_table.size()));
  const json document = document_in(result);
  return document.is_object() ? document.value("provenance", json()) : json();
}

/// Whether a method is a file of coefficients of the user, perhaps with a placement behind it. Its letters
/// may be those of a system, and are not read.
bool is_table(const std::string& typed) {
  if (const auto names = method_names(); std::ranges::count(names, canonical_method(typed)) > 0) return false;
  return std::ranges::any_of(std::vector{typed, typed.substr(0, typed.rfind('@'))}, [](const fs::path& file) {
    const json document = document_in(file, longest_method_file);
    return document.is_object() && document.contains("format") && document["format"] == table_format;
  });
}

}  // namespace

void add_method(const std::string& typed, std::vector<cited_setup>& to) {
  constexpr std::string_view to_learn = "learned:";
  if (is_word(typed) || is_table(typed)) return;  // nothing is published of it
  if (typed.starts_with(to_learn) && is_word(std::string_view(typed).substr(to_learn.size()))) {
    to.front().learned.push_back(typed.substr(to_learn.size()));
    return;
  }
  const auto source = find_method(typed);
  if (source.learned) {
    to.push_back(setup_of(source.learned->system));
    to.back().learned = {source.learned->family};
  } else if (source.family) {
    to.front().learned.push_back(*source.family);
  } else if (source.adaptive != nullptr) {
    to.front().methods.push_back(source.adaptive->name);
  } else {
    to.front().methods.push_back(source.fixed->name());
  }
}

void add_file(const std::string& file, std::vector<cited_setup>& to) {
  std::error_code ignored;
  fs::path path(file);
  if (fs::is_directory(path, ignored)) path /= "report.json";
  if (!path.has_parent_path()) path = "." / path;  // a file, even if a method has the same name
  if (!is_file(path))
    refuse("cannot read {}: there is no such file, and no report in a folder of that name", file);
  const json made = made_of(path);
  if (!made.is_object()) return add_method(path.string(), to);
  try {
    add_made(made, path, to);
  } catch (const json::exception&) {
    refuse("cannot cite {}: the provenance must be as nysalt wrote it, got other members; take another copy",
           file);
  } catch (const std::exception& problem) {  // also what the options cannot be read by
    refuse("cannot cite {}: {}", file, problem.what());
  }
}

}  // namespace nysalt::program
