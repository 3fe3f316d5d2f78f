// SPDX-License-Identifier: BSL-1.0
#include <CLI/CLI.hpp>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "../bibliography.hpp"
#include "../catalogue.hpp"
#include "../citations.hpp"
#include "../commands.hpp"
#include "../json.hpp"
#include "../method_file.hpp"
#include "../output.hpp"
#include "../refusal.hpp"
#include "build_info.hpp"

namespace nysalt::program {

namespace {

/// nysalt itself; its version is that of the program.
std::string own_entry() {
  return fmt::format(
      "@misc{{nysalt,\n  author       = {{{{The nysalt authors}}}},\n"
      "  title        = {{nysalt: learned symplectic integrators}},\n"
      "  note         = {{Software, version {}}}\n}}",
      version);
}

/// fpu_chain(pairs=3, omega=50) in bath(...): the name in a description holds that of the list.
void add_system_of(const std::string& description, cited_setup& to) {
  const std::string name = description.substr(0, description.find('('));
  for (const auto& entry : system_entries()) {
    if (name.find(entry.name) != std::string::npos) to.system = entry.name;
  }
  to.in_bath = description.find(" in bath(") != std::string::npos;
}

cited_setup setup_of(const scheme& learned) {
  cited_setup its;
  its.methods = {"learned:" + learned.family};
  add_system_of(learned.system, its);
  return its;
}

/// A method may be the file of a scheme, which names a family and a system, or a table of one's own, which
/// has nobody to cite.
void add_method(const std::string& name, std::vector<cited_setup>& to) {
  const std::string file = name.substr(0, name.find('@'));
  if (!std::filesystem::exists(file)) {
    to.front().methods.push_back(name);
    return;
  }
  const auto its = read_method_file(file);
  if (its.learned) to.push_back(setup_of(*its.learned));
}

/// What was asked for when a result was made: options as TOML, as this program wrote them.
cited_setup setup_of_options(const std::string& toml, std::vector<std::string>& methods) {
  std::istringstream options(toml);
  cited_setup its;
  its.system = system_settings().name;
  std::string section;  // the command
  for (const auto& item : CLI::ConfigTOML().from_config(options)) {
    const auto add = [&](std::vector<std::string>& to, const std::string& prefix = "") {
      for (const auto& joined : item.inputs) {
        for (const auto& one : CLI::detail::split(joined, ',')) to.push_back(prefix + one);
      }
    };
    if (!item.parents.empty()) section = item.parents.front();
    if (item.inputs.empty()) continue;
    if (item.name == "system") its.system = item.inputs.front();
    if (item.name == "friction") its.in_bath = true;
    if (item.name == "method" || item.name == "methods") add(methods);
    if (item.name == "family" || item.name == "families") add(methods, "learned:");
    if (item.name == "metric") add(its.metrics);
  }
  if (section == "compare" && its.metrics.empty()) its.metrics = compare_command().metrics;
  if (section == "recommend" && its.metrics.empty()) its.metrics = {recommend_command().metric};
  if (section == "learn" && methods.empty()) methods.push_back("learned:" + learn_command().family);
  return its;
}

/// A file of the program: a scheme or a table, a manifest, or what has a manifest beside it.
void add_file(const std::string& file, std::vector<cited_setup>& to) {
  constexpr std::string_view ending = ".manifest.json";
  std::string beside = file.ends_with(ending) ? file : file + std::string(ending);
  if (!std::filesystem::is_regular_file(beside)) {
    if (!std::filesystem::exists(file)) refuse("{}: there is no such file", file);
    add_method(file, to);
    return;
  }
  std::ifstream stream(beside);
  const json manifest = json::parse(stream, nullptr, false);
  if (!manifest.is_object() || !manifest.contains("options") || !manifest["options"].is_string()) {
    refuse("{}: this is not a manifest of nysalt", beside);
  }
  std::vector<std::string> methods;
  std::vector<cited_setup> its;
  its.push_back(setup_of_options(manifest["options"], methods));
  for (const auto& method : methods) add_method(method, its);
  to.insert(to.end(), its.begin(), its.end());
}

}  // namespace

int cite(const cite_command& command, const common_settings& common) {
  std::vector<cited_setup> setups(1);
  setups.front().system = command.system;
  setups.front().metrics = command.metrics;
  setups.front().in_bath = command.in_bath;
  for (const auto& method : command.methods) add_method(method, setups);
  for (const auto& file : command.files) add_file(file, setups);
  const auto works = citations_for(setups);
  if (common.json) {
    json all = json::array();
    all.push_back({{"key", "nysalt"}, {"for", json::array({"nysalt itself"})}, {"bibtex", own_entry()}});
    for (const auto& [key, reasons] : works) {
      all.push_back({{"key", key}, {"for", reasons}, {"bibtex", bibtex_of(key)}});
    }
    print(text_of({{"references", all}}));
    return done;
  }
  std::string text = "% nysalt itself\n" + own_entry() + "\n";
  for (const auto& [key, reasons] : works) {
    text += fmt::format("\n% for {}\n{}\n", listed(reasons), bibtex_of(key));
  }
  print(text);
  return done;
}

}  // namespace nysalt::program
