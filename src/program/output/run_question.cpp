// SPDX-License-Identifier: BSL-1.0
#include "run_question.hpp"

#include "comparison/refusal.hpp"
#include "hdf5_layout.hpp"
#include "program/output.hpp"
#include "report/manifest.hpp"

namespace nysalt::program {

json question_of(const run_command& command, const prepared_problem& system, const tabulated& method,
                 std::int64_t steps, std::uint64_t seed) {
  return {{"system", system.parameters()},
          {"starts", system.starts()},
          {"letters", method.letters().letters()},
          {"coefficients", method.coefficients()},
          {"step", command.step},
          {"steps", steps},
          {"trajectories", command.trajectories},
          {"observables", command.observables},
          {"sample_every", command.sample_every},
          {"seed", seed}};
}

json about_run(const run_command& command, const prepared_problem& system, const tabulated& method,
               std::int64_t steps, std::uint64_t seed) {
  json result{{"format", "nysalt run"}, {"format_version", 1}};
  json libraries = versions();
  result["nysalt"] = libraries["nysalt"];
  libraries.erase("nysalt");
  libraries["HDF5"] = hdf5_version();
  result["libraries"] = libraries;
  result["description"] = system.description();
  result["method"] = command.method;
  result.update(question_of(command, system, method, steps, seed));
  result["observables"] = listed(command.observables);
  result["units"] =
      "those of the system's Hamiltonian, in which nothing is scaled; t = step number * step; kinetic "
      "temperatures are energies (kT)";
  return result;
}

}  // namespace nysalt::program
