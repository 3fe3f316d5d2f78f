// SPDX-License-Identifier: BSL-1.0
#include "listing.hpp"
#include "systems.hpp"

#include <array>

#include "bundled_systems.hpp"
#include "comparison/catalogue.hpp"
#include "comparison/refusal.hpp"
#include "comparison/stability.hpp"

namespace nysalt::program {

namespace {

constexpr std::array metrics{
    std::array{"path", "mean RMS error of the observable along trajectories, over its RMS"},
    std::array{"relative", "the paper's: mean RMS of (o - o_ref)/o_ref; for observables away from 0"},
    std::array{"state", "RMS error of the state in the energy norm, absolute"},
    std::array{"exchange", "mean error of the stiff springs' energies, relative to their sum (fpu)"},
    std::array{"energy", "RMS of H - H_0, over that of H_0"},
    std::array{"acceptance", "mean of min(1, exp(-(H_end - H_0)/kT)), of reversible methods; 1 is best"},
    std::array{"distribution",
               "total variation between the distributions of the observable and of the reference"},
    std::array{"acf", "RMS error of the observable's normalised autocovariance"}};

/// Of the system that is bundled under a name, or in a file.
json system_json(const std::string& name) {
  const system_declaration& declared = declaration_of(name);
  system_settings settings;
  settings.name = name;
  const auto system = make_system(settings);
  return {{"name", declared.name},
          {"options", options_of(declared)},
          {"hamiltonian", declared.title},
          {"starts", system->starts()},
          {"observables", system->observables()},
          {"default_observable", system->default_observable()},
          {"letters", declared.letters}};
}

json systems_json(const std::string& own_system) {
  json all = json::array();
  for (const auto& declared : bundled_declarations()) all.push_back(system_json(declared.name));
  if (!own_system.empty() && !is_path_of_system(own_system)) {
    refuse("--system must be the file of a system of your own, got {}", own_system);
  }
  if (!own_system.empty()) all.push_back(system_json(own_system));
  return all;
}

json aliases_of(std::string_view method) {
  json all = json::array();
  for (const auto& [alias, name] : method_aliases()) {
    if (name == method) all.push_back(alias);
  }
  return all;
}

json methods_json() {
  json all = json::array();
  for (const auto& [method, source] : classical_methods()) {
    const int evaluations = method.letters().evaluations_per_step;
    json limit = nullptr;  // of words that rotate it depends on the system
    if (!method.letters().reads_modes) limit = limit_of(method) / evaluations;
    all.push_back({{"name", method.name()},
                   {"aliases", aliases_of(method.name())},
                   {"letters", method.letters().letters()},
                   {"order", method.order},
                   {"evaluations_per_step", evaluations},
                   {"limit_per_evaluation", limit},
                   {"source", source}});
  }
  for (const auto& known : adaptive_methods()) {
    all.push_back({{"name", known.name},
                   {"aliases", aliases_of(known.name)},
                   {"letters", known.letters.letters()},
                   {"order", known.properties.order},
                   {"evaluations_per_step", known.letters.evaluations_per_step},
                   {"limit_per_evaluation", nullptr},
                   {"source", known.source}});
  }
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

}  // namespace

json listing(const std::string& own_system) {
  json all{{"version", version_of_documents},
           {"systems", systems_json(own_system)},
           {"methods", methods_json()},
           {"families", families_json()}};
  for (const auto& [name, meaning] : metrics)
    all["metrics"].push_back({{"name", name}, {"meaning", meaning}});
  return all;
}

}  // namespace nysalt::program
