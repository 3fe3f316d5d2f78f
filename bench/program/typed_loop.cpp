// SPDX-License-Identifier: BSL-1.0
// What `nysalt run` does, as somebody writes it who knows system and method when compiling: the peer of
// against_types.py.
//
// usage: nysalt_typed_loop SYSTEM METHOD STEP TRAJECTORIES STEPS
// Prints the energy of each trajectory at the end, one a line, with all its digits.
#include <fmt/format.h>

#include <cstdint>
#include <cstdlib>
#include <exception>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "nysalt/energy.hpp"
#include "nysalt/ensemble.hpp"
#include "nysalt/ensembles/distributions.hpp"
#include "nysalt/ensembles/given_states.hpp"
#include "nysalt/lanes.hpp"
#include "nysalt/method.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/systems/fpu_chain.hpp"
#include "nysalt/systems/phi4.hpp"
#include "nysalt/systems/textbook.hpp"
#include "toda.hpp"

namespace nysalt::bench {

namespace {

/// Of `run --seed 1`, which draws its starts apart from those of learning.
constexpr std::uint64_t seed_of_runs = (std::uint64_t{1} << 52U) + 1;

struct plan {
  std::string_view method;
  double step;
  std::int64_t trajectories;
  std::int64_t steps;
};

/// As many trajectories side by side as fill a block of lanes, one block after the other, unobserved until
/// the end.
template <class System>
void follow(const System& system, const auto& law, const method& method, const plan& of) {
  constexpr int N = System::dimension;
  using lanes = pack<double>;
  const auto stepper = make_stepper(system, method, of.step);
  for (std::int64_t first = 0; first < of.trajectories; first += pack<double>::lanes) {
    const auto count = static_cast<int>(std::min<std::int64_t>(pack<double>::lanes, of.trajectories - first));
    const auto start = [&](int k) { return law(seed_of_runs, static_cast<std::uint64_t>(first + k)); };
    auto run = stepper.open(detail::gather<lanes, N>(count, start), static_cast<std::uint64_t>(first));
    stepper.advance(run, of.steps);
    const auto end = stepper.synchronous(run);
    for (int k = 0; k < count; ++k) fmt::print("{:.17g}\n", energy(system, lane(end, k)));
  }
}

template <class System>
void follow_by_name(const System& system, const auto& law, const plan& of) {
  if (of.method == "verlet") return follow(system, law, verlet(), of);
  if (of.method == "mclachlan2") return follow(system, law, mclachlan2(), of);
  if (of.method == "srkn6b") return follow(system, law, srkn6b(), of);
  throw std::invalid_argument(fmt::format("METHOD must be verlet, mclachlan2 or srkn6b, got {}", of.method));
}

void run(std::string_view name, const plan& of) {
  if (name == "fpu") {
    const fpu_chain<3> chain(50.0);
    return follow_by_name(chain, fpu_law<3>(chain), of);
  }
  if (name == "henon_heiles") {
    const vector<double, 2> rest(0.0, 0.0);
    return follow_by_name(henon_heiles(), normal_around<2>({rest, rest}, 0.1, 0.1), of);
  }
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(16);
  if (name == "phi4")
    return follow_by_name(phi4_chain<>(16), normal_around<Eigen::Dynamic>({rest, rest}, 0.5, 1.0), of);
  if (name == "toda")
    return follow_by_name(toda{}, normal_around<Eigen::Dynamic>({rest, rest}, 0.3, 0.5), of);
  throw std::invalid_argument(fmt::format("SYSTEM must be fpu, henon_heiles, phi4 or toda, got {}", name));
}

}  // namespace

}  // namespace nysalt::bench

int main(int count, char** arguments) {
  try {
    if (count != 6)
      throw std::invalid_argument("usage: nysalt_typed_loop SYSTEM METHOD STEP TRAJECTORIES STEPS");
    nysalt::bench::run(arguments[1], {arguments[2], std::stod(arguments[3]), std::stoll(arguments[4]),
                                      std::stoll(arguments[5])});
  } catch (const std::exception& problem) {
    fmt::print(stderr, "nysalt_typed_loop: {}\n", problem.what());
    return 2;
  }
}
