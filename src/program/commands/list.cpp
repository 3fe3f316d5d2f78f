// SPDX-License-Identifier: BSL-1.0
#include "../listing.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <utility>

#include "../commands.hpp"
#include "../fitted_family.hpp"
#include "../output.hpp"
#include "comparison/recommendation.hpp"
#include "comparison/sampling_choice.hpp"
#include "report/comparison_report.hpp"
#include "report/result_file.hpp"
#include "report/table.hpp"

namespace nysalt::program {

namespace {

/// A palindrome of the first two letters, or of A and the only one.
std::string example_of(const std::string& letters) {
  const char inner = letters.size() > 1 ? letters[1] : 'A';
  return {letters[0], inner, letters[0]};
}

std::string readable(const json& all) {
  std::string text = "Systems (--system NAME and its options with their defaults):\n\n";
  table systems({"system", "options", "what it is"}, 3);
  for (const auto& s : all["systems"]) systems.add({s["name"], s["options"], s["hamiltonian"]});
  text += systems.text() + "\nObservables (the first is the default):\n\n";
  table observables({"system", "observables"}, 2);
  for (const auto& s : all["systems"]) {
    std::string names = s["default_observable"];
    for (const std::string name : s["observables"])
      names += name == s["default_observable"] ? "" : ", " + name;
    observables.add({s["name"], names});
  }
  text += observables.text();
  for (const auto& s : all["systems"]) {
    if (s["letters"].get<std::string>().empty()) continue;
    text += fmt::format("\nLetters of {}, for words such as word:{}: {}\n", s["name"].get<std::string>(),
                        example_of(s["letters"]), s["letters"].get<std::string>());
  }
  text += "\nMethods (also word:LETTERS, learned:FAMILY, and files of schemes and tables):\n\n";
  table methods({"method", "letters", "order", "evaluations", "limit/evaluation"}, 2);
  for (const auto& m : all["methods"]) {
    const json& limit = m["limit_per_evaluation"];
    methods.add({m["name"], m["letters"], m["order"].dump(), m["evaluations_per_step"].dump(),
                 limit.is_null() ? "it depends" : fmt::format("{:.4f}", limit.get<double>())});
  }
  text += methods.text();
  for (const auto& m : all["methods"]) {
    std::string aliases;
    for (const std::string alias : m["aliases"]) aliases += (aliases.empty() ? "" : ", ") + alias;
    if (!aliases.empty()) text += fmt::format("\n{} is also {}.", m["name"].get<std::string>(), aliases);
  }
  text += "\n\nFamilies that can be learned:\n\n";
  table of_families({"family", "letters", "parameters", "order", "evaluations"}, 3);
  for (const auto& f : all["families"]) {
    std::string parameters;
    for (const auto& p : f["parameters"]) {
      if (!parameters.empty()) parameters += ", ";
      parameters += p["name"].get<std::string>();
    }
    of_families.add(
        {f["name"], f["letters"], parameters, f["order"].dump(), f["evaluations_per_step"].dump()});
  }
  text +=
      of_families.text() +
      "\nFAMILY+pJ is a symmetric family whose letters are among A, B and G, with a processor of J pairs of "
      "letters, as in fg4+p3.\n\nMetrics of compare:\n\n";
  table of_metrics({"metric", "what it is"}, 2);
  for (const auto& m : all["metrics"]) of_metrics.add({m["name"], m["meaning"]});
  return text + of_metrics.text();
}

}  // namespace

int list(const list_command& command, const common_settings& common) {
  if (!command.schemas.empty()) {
    const std::filesystem::path folder(command.schemas);
    make_folder(folder);
    for (const auto& [name, schema] :
         {std::pair("compare", schema_of_comparison()), std::pair("learn", fitted_family::schema()),
          std::pair("recommend", recommendation::schema()),
          std::pair("recommend_sampling", sampling_choice::schema()), std::pair("run", schema_of_run()),
          std::pair("sample", schema_of_sample()), std::pair("stability", schema_of_stability())}) {
      const auto file = folder / fmt::format("{}.json", name);
      require_result(file);
      write_result(file, text_of(schema));
      print(line_of_written(file.string()));
    }
    return done;
  }
  const json all = listing(command.system);
  print(common.json ? text_of(all) : readable(all));
  return done;
}

}  // namespace nysalt::program
