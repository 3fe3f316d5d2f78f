// SPDX-License-Identifier: BSL-1.0
#include <array>

#include "../bundled_system.hpp"
#include "../catalogue.hpp"
#include "../commands.hpp"
#include "../output.hpp"
#include "../stability.hpp"
#include "nysalt/methods/s_aia.hpp"
#include "nysalt/report/table.hpp"

namespace nysalt::program {

namespace {

constexpr std::array metrics{
    std::array{"path", "average relative RMS error of the observable along trajectories"},
    std::array{"state", "RMS error of the state in the energy norm, absolute"},
    std::array{"exchange", "mean error of the stiff springs' energies, relative to their sum (fpu)"},
    std::array{"energy", "RMS of (H - H_0)/|H_0|"},
    std::array{"acceptance", "mean of min(1, exp(-(H_end - H_0)/kT)), of reversible methods; 1 is best"},
    std::array{"distribution", "total variation of the observable's law from the reference's"},
    std::array{"acf", "RMS error of the observable's normalised autocovariance"}};

json systems_json() {
  json all = json::array();
  for (const auto& entry : system_entries()) {
    system_settings settings;
    settings.name = entry.name;
    const auto system = make_system(settings);
    all.push_back({{"name", entry.name},
                   {"options", entry.options},
                   {"hamiltonian", entry.hamiltonian},
                   {"starts", system->starts()},
                   {"observables", system->observables()},
                   {"default_observable", system->default_observable()}});
  }
  return all;
}

json methods_json() {
  json all = json::array();
  for (const auto& [method, source] : classical_methods()) {
    const int evaluations = method.letters().evaluations_per_step;
    json limit = nullptr;  // of words that rotate it depends on the system
    if (!has_rotation(method.letters())) limit = limit_of(method) / evaluations;
    all.push_back({{"name", method.name()},
                   {"letters", method.letters().letters()},
                   {"order", method.order},
                   {"evaluations_per_step", evaluations},
                   {"limit_per_evaluation", limit},
                   {"source", source}});
  }
  all.push_back({{"name", adaptive_method},
                 {"letters", s_aia2::word::letters()},
                 {"order", s_aia2::order},
                 {"evaluations_per_step", s_aia2::word::evaluations_per_step},
                 {"limit_per_evaluation", nullptr},
                 {"source", adaptive_source}});
  return all;
}

json families_json() {
  json all = json::array();
  for (const auto& family : families()) {
    json parameters = json::array();
    for (std::size_t k = 0; k < family.ranges.size(); ++k) {
      const auto& [low, high, open] = family.ranges[k];
      parameters.push_back(
          {{"name", family.parameter_names[k]}, {"low", low}, {"high", high}, {"open", open}});
    }
    all.push_back({{"name", family.name},
                   {"letters", family.letters.letters()},
                   {"order", family.order},
                   {"symmetric", family.symmetric},
                   {"evaluations_per_step", family.letters.evaluations_per_step},
                   {"parameters", parameters}});
  }
  return all;
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
  text += observables.text() + "\nMethods (also learned:FAMILY, and files of schemes and tables):\n\n";
  table methods({"method", "letters", "order", "evaluations", "limit/evaluation"}, 2);
  for (const auto& m : all["methods"]) {
    const json& limit = m["limit_per_evaluation"];
    methods.add({m["name"], m["letters"], m["order"].dump(), m["evaluations_per_step"].dump(),
                 limit.is_null() ? "it depends" : fmt::format("{:.4f}", limit.get<double>())});
  }
  text += methods.text() + "\nFamilies that can be learned:\n\n";
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
  text += of_families.text() + "\nMetrics of compare:\n\n";
  table of_metrics({"metric", "what it is"}, 2);
  for (const auto& [name, meaning] : metrics) of_metrics.add({name, meaning});
  return text + of_metrics.text();
}

}  // namespace

int list(const common_settings& common) {
  json all{{"systems", systems_json()}, {"methods", methods_json()}, {"families", families_json()}};
  for (const auto& [name, meaning] : metrics)
    all["metrics"].push_back({{"name", name}, {"meaning", meaning}});
  print(common.json ? text_of(all) : readable(all));
  return done;
}

}  // namespace nysalt::program
