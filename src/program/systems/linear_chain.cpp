// SPDX-License-Identifier: BSL-1.0
#include "nysalt/systems/linear_chain.hpp"
#include "comparison/prepared_problem.hpp"
#include "nysalt/ensembles/given_states.hpp"
#include "nysalt/system_declaration.hpp"
#include "with_exact_flow.hpp"

namespace nysalt::program {

system_declaration declare_linear_chain() {
  system_declaration result{.name = "linear_chain",
                            .title = "equal masses between walls, joined by linear springs"};
  result.parameters = {{.name = "masses",
                        .usual = 8,
                        .meaning = "number of masses",
                        .least = 1,
                        .most = 1000},  // the modes of a chain are found from a full matrix: seconds
                       {.name = "spring", .usual = 1.0, .meaning = "stiffness of the springs"}};
  result.make = [](const parameter_values& values, const bath& in, double spread) {
    const auto masses = values.whole("masses");
    const auto chain = linear_chain::between_walls(masses, values.real("spring"));
    const double fastest = chain.frequency_bands().back().high;
    const Eigen::VectorXd rest = Eigen::VectorXd::Zero(masses);
    const normal_around<Eigen::Dynamic> law({rest, rest}, spread / fastest, spread);
    return with_exact_flow(chain, in, detail::made_of(chain, in, law, fastest));
  };
  return result;
}

}  // namespace nysalt::program
