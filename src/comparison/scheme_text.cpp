// SPDX-License-Identifier: BSL-1.0
// Schemes and tables as they are written.

#include <algorithm>

#include "catalogue.hpp"
#include "judging.hpp"
#include "method_file.hpp"
#include "method_file_format.hpp"
#include "nysalt/version.hpp"
#include "prepared_problem.hpp"

namespace nysalt::program {

json scheme_document(const std::vector<learned_scheme>& learned, const prepared_problem& system,
                     const learn_plan& plan) {
  const fit_summary& fit = learned.front().fit;
  const bool is_curve = learned.size() > 1;
  json of_system = system.parameters();
  of_system["description"] = system.description();
  if (const std::string kind = system.kind(); !kind.empty()) of_system["kind"] = kind;
  // One value, or a list with one for each step.
  const auto at_steps = [&](const auto& value_of) {
    if (!is_curve) return json(value_of(fit));
    json all = json::array();
    for (const auto& one : learned) all.push_back(value_of(one.fit));
    return all;
  };
  const auto by_parameter = [&](double fit_summary::fitted_parameter::*value) {
    json all = json::object();
    for (std::size_t k = 0; k < fit.parameters.size(); ++k) {
      all[fit.parameters[k].name] =
          at_steps([&](const fit_summary& one) { return one.parameters[k].*value; });
    }
    return all;
  };
  const auto not_usable =
      std::find_if(learned.begin(), learned.end(), [](const learned_scheme& one) { return !one.fit.usable; });
  std::optional<energy_range> energies = learned.front().energies;
  for (const auto& one : learned) {
    if (!energies || !one.energies) continue;
    energies->include(one.energies->low);
    energies->include(one.energies->high);
  }
  const auto differs = [&](const learned_scheme& one) { return one.fit.trajectories != fit.trajectories; };
  const json trajectories = std::ranges::any_of(learned, differs)
                                ? at_steps([](const fit_summary& one) { return one.trajectories; })
                                : json(fit.trajectories);
  json document{
      {"format", scheme_format},
      {"version", is_curve     ? as_curve
                  : plan.where ? with_placement
                               : known_version},
      {"family", fit.family},
      {"parameters", by_parameter(&fit_summary::fitted_parameter::value)},
      {"standard_errors", by_parameter(&fit_summary::fitted_parameter::standard_error)},
      {is_curve ? "steps" : "step", at_steps([](const fit_summary& one) { return one.step; })},
      {"system", of_system},
      {"energy_range", nullptr},
      {"objective", fit.loss_name},
      {"loss", at_steps([](const fit_summary& one) { return one.loss; })},
      {"held_out_loss",
       fit.is_of_data ? at_steps([](const fit_summary& one) { return one.held_out_loss; }) : json(nullptr)},
      {"usable", not_usable == learned.end()},
      {"reason", not_usable == learned.end() ? "" : not_usable->fit.reason},
      {"judgement", at_steps([](const fit_summary& one) { return as_json(one.judgement); })},
      {"coordinates", fit.coordinates},
      {"reference", at_steps([](const fit_summary& one) { return one.reference; })},
      {"starts", fit.ensemble},
      {"trajectories", trajectories},
      {"horizon", plan.how.horizon_at(learned.back().fit.step)},
      {"seed", fit.seed},
      {"held_out_seed", fit.held_out_seed},
      {"versions", {{"nysalt", version}}}};
  if (energies) document["energy_range"] = {energies->low, energies->high};
  const word letters = family_named(fit.family, system.letters()).letters;
  for (const letter_facts& facts : letters.own()) {
    document["own_letters"].push_back({{"letter", std::string(1, facts.letter)},
                                       {"times", facts.times.view()},
                                       {"forces", facts.displaced_forces},
                                       {"moves_q", facts.moves_q},
                                       {"additive", facts.additive},
                                       {"symplectic", facts.symplectic}});
  }
  if (plan.where) document["placement"] = to_string(*plan.where);
  document["checksum"] = checksum(document);
  return document;
}

std::string table_text(const std::string& name, const method& method, double step,
                       const prepared_problem& system) {
  return text_of(json{{"format", table_format},
                      {"version", known_version},
                      {"name", name},
                      {"letters", method.letters().letters()},
                      {"coefficients", method.coefficients()},
                      {"step", step},
                      {"system", system.description()}});
}

}  // namespace nysalt::program
