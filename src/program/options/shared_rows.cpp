// SPDX-License-Identifier: BSL-1.0
// Options that several commands have.
#include <fmt/format.h>

#include "../settings.hpp"
#include "comparison/purpose.hpp"
#include "comparison/spelling.hpp"
#include "nysalt/losses/loss_choice.hpp"

namespace nysalt::program {

std::string spelled_in(std::string_view text) {
  std::string all;
  while (true) {
    const auto from = text.find('{');
    const auto to = text.find('}', from);
    all += text.substr(0, from);
    if (to == std::string_view::npos) return all;
    all += spelled(text.substr(from + 1, to - from - 1));
    text.remove_prefix(to + 1);
  }
}

option_rows common_rows(common_settings& common, const char* forced, bool has_details) {
  option_rows rows{
      {"json", &common.json, in_output, "print one JSON document and nothing else", trait::program_only}};
  if (has_details)
    rows.push_back({"verbose", &common.verbose, in_output, "print all details", trait::program_only});
  rows.insert(rows.end(), {{"seed", &common.seed, in_general, "the seed of all random numbers"},
                           {"threads", &common.execution.threads, in_general,
                            "the most threads to use [all cores]; results do not depend on their number",
                            trait::machine}});
  if (*forced != '\0') rows.push_back({"force", &common.force, in_general, forced});
  return rows;
}

option_rows formula_rows(typed_potential& potential) {
  return {{"variables", &potential.variables, in_system,
           "the coordinates of the formula: x,y, or q[16] for sixteen"},
          {"mass", &potential.masses, in_system,
           "the masses of the coordinates of the formula: one, or one each [1]"},
          {"around", &potential.around, in_system, "where the starts of the formula are: x=1 [0]",
           trait::rare | trait::by_name, "NAME=VALUE,..."}};
}

option_rows start_rows(system_settings& system) {
  return {
      {"friction", &system.bath.friction, in_system,
       "the friction of a bath that the system is in; {temperature} comes with it"},
      {"temperature", &system.bath.temperature, in_system,
       "the temperature kT of the bath, an energy; or {sigma}"},
      {"start", &system.start, in_system,
       "where to start: law (the initial distribution), gibbs, trajectory, or a file"},
      {"at", &system.at, in_system,
       "a state to start at: 'x=1,y=0; px=0,py=0.5'; for several give {at} again", trait::whole, "STATE",
       "start"},
      {"spread", &system.spread, in_system,
       "factor of the standard deviations of the initial distribution [1]", trait::rare},
      {"sigma", &system.bath.sigma, in_system,
       "the noise of the bath, in place of {temperature}, which is sigma^2/(2 friction)", trait::rare},
      {"start_step", &system.start_step, in_system,
       "of a {start} that nysalt run wrote: the step to start at [the last]",
       trait::rare | trait::program_only},
      {"frequency", &system.frequency, in_system,
       "the angular frequency that phase_fitted_... and s_aia... methods are fitted to, and the highest one "
       "where none is known [that which the system declares, or which is seen along the motion]",
       trait::rare}};
}

option_rows system_rows(system_settings& system) {
  return with(joined({{{"system", &system.name, in_system,
                        "a name of nysalt list, or a file of your own; it or {potential} is required"},
                       {"parameter", &system.potential.parameters, in_system,
                        "parameters of the system, as nysalt list shows them: omega=50,pairs=4",
                        trait::by_name, "NAME=VALUE,..."},
                       {"potential", &system.potential.text, in_system,
                        "in place of {system}: V(q) as a formula, such as '0.5*k*(x^2 + y^2)'", 0, "FORMULA",
                        "system"}},
                      formula_rows(system.potential),
                      start_rows(system)}),
              trait::program_only);
}

option_rows placement_rows(std::string& placement) {
  return {{"placement", &placement, in_method,
           "where letters O of a bath are in a method without them: end, symmetric or middle [symmetric]",
           trait::rare}};
}

option_rows resume_rows(bool& resume) {
  return {{"resume", &resume, in_output, "go on where the work for this output was stopped",
           trait::program_only}};
}

option_rows learning_rows(learning_options& how, const std::string& prefix) {
  return {
      {"purpose", &how.purpose, in_learning,
       fmt::format("what the runs to come are for: {} [state]", purposes())},
      {prefix + "trajectories", &how.trajectories, in_learning, "number of trajectories to learn from"},
      {prefix + "effort", &how.effort, in_learning,
       "how long to search for parameters: quick, normal or thorough"},
      {prefix + "loss", &how.loss, in_learning,
       fmt::format("the loss to minimise: {}, or {} after K steps [by {{purpose}}: state has trajectory, in "
                   "a bath state:1; energy and distribution state:1; sampling acceptance]",
                   nysalt::detail::loss_patterns(false), nysalt::detail::loss_patterns(true)),
       trait::rare},
      {"coordinates", &how.coordinates, in_learning,
       "the coordinates in which the loss measures a state: qp, modes or energy [energy for the loss "
       "trajectory of a system with modes, else qp]",
       trait::rare},
      {"fix", &how.fix, in_learning,
       "a parameter of the family that is not learned but has this value: b1=0.5",
       trait::rare | trait::whole | trait::by_name, "NAME=VALUE"},
      {prefix + "random_starts", &how.random_starts, in_learning,
       "number of random parameters that the search begins from, beside those of the family [by the effort]",
       trait::rare},
      {prefix + "horizon", &how.horizon, in_learning,
       "length of the trajectories to learn from, a time [200 steps; of losses after K steps 0.5, or ten "
       "steps if that is longer]",
       trait::rare},
      {"fine_step", &how.fine_step, in_learning,
       "the fine step of the reference, which must divide the step [omega h <= 5e-3]", trait::rare}};
}

}  // namespace nysalt::program
