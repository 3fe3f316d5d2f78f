// SPDX-License-Identifier: BSL-1.0
#include "provenance.hpp"

#include <algorithm>
#include <cstdint>
#include <exception>
#include <filesystem>

#include "bundled_systems.hpp"
#include "comparison/catalogue.hpp"
#include "comparison/json.hpp"
#include "comparison/method_file.hpp"
#include "comparison/method_file_format.hpp"
#include "comparison/method_source.hpp"
#include "comparison/refusal.hpp"
#include "output.hpp"
#include "recorded_options.hpp"
#include "report/manifest.hpp"
#include "settings.hpp"

namespace nysalt::program {

namespace {

namespace fs = std::filesystem;

bool is_file(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

/// A Hamiltonian of one's own has no name of ours.
cited_setup setup_of(const scheme& learned) {
  cited_setup setup;
  setup.learned = {learned.family};
  const std::string name = learned.system.substr(0, learned.system.find('('));
  for (const auto& declared : bundled_declarations()) {
    if (name == (declared.described.empty() ? declared.name : declared.described)) {
      setup.system = declared.name;
    }
  }
  setup.in_bath = learned.system.find(" in bath(") != std::string::npos;
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
  if (given.command() == "export") return setup;  // of no system
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

/// Adds what made a result, by its entry in a manifest; the result is read too if it is a scheme.
void add_entry(const json& entry, const fs::path& result, std::vector<cited_setup>& to) {
  if (!entry.is_object() || !entry.contains("options") || !entry["options"].is_string()) {
    refuse("the entry must be that of a manifest of nysalt");
  }
  const recorded_options given(entry["options"].get<std::string>());
  const std::vector<std::string> known{"learn", "run", "compare", "recommend", "stability", "export"};
  if (std::ranges::find(known, given.command()) == known.end()) {
    refuse("the command must be one of {}, got '{}'", listed(known), given.command());
  }
  std::vector<cited_setup> setups{setup_of(given)};
  for (const char* option : {"method", "methods", "METHOD"}) {
    for (const auto& method : given.of(option)) add_method(found_beside(result, method), setups);
  }
  const bool writes_schemes = given.command() == "learn" || given.command() == "recommend";
  if (writes_schemes && is_file(result)) add_method(result.string(), setups);
  citations_for(setups);  // what has no name is refused here, where the file is known
  to.insert(to.end(), setups.begin(), setups.end());
}

/// The same; what is refused names the manifest.
void add_entry(const json& entry, const fs::path& result, const fs::path& manifest,
               std::vector<cited_setup>& to) {
  try {
    add_entry(entry, result, to);
  } catch (const std::exception& problem) {  // also what the options cannot be read by
    refuse("cannot cite {}, {}: {}", manifest.string(), result.filename().string(), problem.what());
  }
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

/// Adds the entries of a whole manifest. What one of them rests on may not be known, as that of a scheme that
/// was deleted: a warning says so. Throws refusal if it is known of none.
void add_entries(const json& entries, const fs::path& manifest, std::vector<cited_setup>& to) {
  std::vector<std::string> problems;
  for (const auto& [name, entry] : entries.items()) {
    try {
      add_entry(entry, manifest.parent_path() / name, manifest, to);
    } catch (const refusal& problem) {
      problems.emplace_back(problem.what());
    }
  }
  if (!problems.empty() && problems.size() == entries.size()) refuse("{}", problems.front());
  for (const auto& problem : problems) warn(problem + "; this entry is left out");
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
    to.push_back(setup_of(*source.learned));
  } else if (source.family) {
    to.front().learned.push_back(*source.family);
  } else if (source.adaptive != nullptr) {
    to.front().methods.push_back(source.adaptive->name);
  } else {
    to.front().methods.push_back(source.fixed->name());
  }
}

void add_file(const std::string& file, std::vector<cited_setup>& to) {
  constexpr std::string_view earlier_ending = ".manifest.json";
  std::error_code ignored;
  fs::path path(file);
  if (fs::is_directory(path, ignored)) path /= "report.json";
  if (!path.has_parent_path()) path = "." / path;  // a file, even if a method has the same name
  const fs::path manifest = manifest_of(path);
  const json entries = is_file(manifest) ? entries_in(manifest) : json();
  if (path.filename() == manifest.filename() && entries.is_object()) {
    add_entries(entries, manifest, to);
    return;
  }
  if (file.ends_with(earlier_ending)) path.replace_extension().replace_extension();
  const fs::path earlier = earlier_manifest_of(path);
  const auto name = as_kept(path.filename().string()).get<std::string>();
  if (entries.contains(name) && !file.ends_with(earlier_ending)) {
    add_entry(entries[name], path, manifest, to);
  } else if (is_file(earlier)) {
    add_entry(document_in(earlier), path, earlier, to);
  } else if (is_file(path)) {
    add_method(path.string(), to);
  } else {
    refuse("cannot read {}: there is no such file, and no report in a folder of that name", file);
  }
}

}  // namespace nysalt::program
