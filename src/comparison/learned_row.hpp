// SPDX-License-Identifier: BSL-1.0
// A fit in documents, and what the learned row of a comparison takes of it.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "described.hpp"
#include "judging.hpp"
#include "nysalt/family.hpp"
#include "nysalt/learning/fit_summary.hpp"
#include "plans.hpp"

namespace nysalt::program {

/// All that documents say of a fit.
struct learned_fit : fit_summary {
  std::string method;                      // as typed; empty where no row has the fit
  double horizon;                          // of a trajectory of the data
  std::optional<nysalt::placement> where;  // of the letters O
  std::string purpose;                     // that set the loss; empty if a loss was asked for
  std::optional<nysalt::energy_range> energies;
  std::optional<enough_course> course;
  std::optional<rival_judgement> losing_fewest = {};  // see loses_fewest(); only `learn` looks for it
};
learned_fit fit_of(const learned_scheme& learned, const learning_options& how, std::optional<placement> where,
                   const std::string& method = {});

/// A field of each parameter, by its name.
std::vector<std::pair<std::string, double>> by_name(const fit_summary& fit,
                                                    double fit_summary::fitted_parameter::*field);

NYSALT_DESCRIBED(fit_summary::gap, low, high)
NYSALT_DESCRIBED(energy_range, low, high)
NYSALT_DESCRIBED(fitted_frequency, value, source)

constexpr auto members(of<fit_summary::failing_method>) {
  using failing = fit_summary::failing_method;
  return std::tuple(item{"method", &failing::name}, NYSALT_MEMBERS(failing, step, times_less, reason));
}
constexpr auto members(of<enough_course::stop>) {
  using stop = enough_course::stop;
  return std::tuple(item{"trajectories", &stop::trajectories}, item{"excess_share", &stop::share},
                    item{"deciding_trajectories", &stop::deciding});
}
constexpr auto members(of<enough_course>) {
  return std::tuple(item{"reached", &enough_course::is_reached}, item{"stops", &enough_course::stops});
}

constexpr auto members(of<learned_fit>) {
  using fit = learned_fit;
  using parameter = fit::fitted_parameter;
  return std::tuple(
      NYSALT_MEMBERS(fit, method, family, system),
      item{"parameters", [](const fit& f) { return by_name(f, &parameter::value); }},
      item{"standard_errors", [](const fit& f) { return by_name(f, &parameter::standard_error); }},
      item{"standard_errors_withheld", &fit::errors_withheld}, item{"step", &fit::step},
      item{"objective", &fit::loss_name}, item{"loss", &fit::loss},
      item{"held_out_loss", [](const fit& f) { return only_if(f.is_of_data, f.held_out_loss); }},
      NYSALT_MEMBERS(fit, one_step_error, trajectory_error),
      item{"followed_steps",
           [](const fit& f) { return only_if(f.trajectory_steps > 1, f.follows ? f.loss_steps : 0); }},
      item{"trajectory_steps",
           [](const fit& f) { return only_if(f.trajectory_steps > 1, f.trajectory_steps); }},
      NYSALT_MEMBERS(fit, samples, held_out_samples, trajectories, horizon, usable, verdict, reason, rival),
      item{"rival_step", [](const fit& f) { return only_if(f.rival_step > 0.0, f.rival_step); }},
      item{"rival_loss", [](const fit& f) { return only_if(!f.rival.empty(), f.rival_loss); }},
      item{"loss_beside_rival", [](const fit& f) { return only_if(!f.rival.empty(), f.loss_beside_rival); }},
      item{"rival_loss_noise", [](const fit& f) { return only_if(!f.rival.empty(), f.rival_noise); }},
      item{"failing_rival",
           [](const fit& f) { return only_if(!f.failing_rival.name.empty(), f.failing_rival); }},
      item{"loses_fewest", &fit::losing_fewest}, item{"judgement", &fit::judgement},
      item{"seconds", [](const fit& f) { return f.data_seconds + f.fit_seconds; }},
      NYSALT_MEMBERS(fit, data_seconds, fit_seconds, learning_evaluations),
      item{"expected_excess", [](const fit& f) { return only_if(f.is_of_data, f.expected_excess); }},
      item{"excess_share", [](const fit& f) { return only_if(f.is_of_data, f.excess_share()); }},
      item{"deciding_trajectories",
           [](const fit& f) { return only_if(f.is_of_data, f.deciding_trajectories); }},
      item{"enough", &fit::course}, NYSALT_MEMBERS(fit, coordinates, reference),
      item{"reference_error", [](const fit& f) { return only_if(f.reference_checked, f.reference_error); }},
      NYSALT_MEMBERS(fit, condition, flat_directions), item{"dropped_coordinates", &fit::dropped},
      NYSALT_MEMBERS(fit, iterations, starts_tried), item{"in_valley", &fit::is_in_valley},
      item{"guard", &fit::guard}, item{"held_by_guard", &fit::is_held_by_guard},
      item{"unguarded", &fit::unguarded},
      item{"frequency",
           [](const fit& f) {
             return only_if(f.fitted_frequency > 0.0,
                            fitted_frequency{f.fitted_frequency, f.source_of_frequency});
           }},
      item{"gaps", &fit::gaps}, item{"starts", &fit::ensemble}, item{"energy_range", &fit::energies},
      NYSALT_MEMBERS(fit, seed, held_out_seed), item{"placement", &fit::where},
      item{"purpose", &fit::purpose});
}

/// What a comparison takes of a fit, from its document.
struct facts_of_fit {
  std::string method;  // as typed
  double step = 0.0;
  std::vector<std::pair<std::string, double>> parameters{};
  double one_step_error = 0.0;
  double learning_evaluations = 0.0;  // of data and search
  double seconds = 0.0;
  bool usable = false;
  std::string verdict{};
  std::string rival{};   // the formula that is as good; empty: none
  std::string reason{};  // why it is not usable
};
NYSALT_DESCRIBED(facts_of_fit, method, step, parameters, one_step_error, learning_evaluations, seconds,
                 usable, verdict, rival, reason)

/// As a work file keeps it.
struct learned_row : facts_of_fit {
  kept<learned_fit> fit{};
  json scheme{};  // the scheme file; null of a fit that is not usable

  std::vector<double> theta() const;
  bool gains_nothing() const { return verdict == to_string(nysalt::verdict::nothing_gained); }
};
NYSALT_DESCRIBED(learned_row, fit, scheme)

/// The name of the scheme file of a method that is learned at a step: "bab3_0.045.json".
std::string scheme_file(const std::string& method, double step);

/// `scheme` is null of a fit that is not usable.
learned_row learned_row_of(const learned_fit& fit, const json& scheme);
/// Of what a work file holds of the method, which people may have edited. Throws std::exception for what is
/// not whole, of another method, or not of the family.
learned_row learned_row_from(const json& kept, const std::string& method, const family& family);

}  // namespace nysalt::program
