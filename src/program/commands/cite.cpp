// SPDX-License-Identifier: BSL-1.0
#include "../bibliography.hpp"
#include "../citations.hpp"
#include "../commands.hpp"
#include "../output.hpp"
#include "../provenance.hpp"
#include "build_info.hpp"
#include "comparison/described.hpp"
#include "comparison/refusal.hpp"

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
    print(text_of({{"version", version_of_documents}, {"references", all}}));
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
