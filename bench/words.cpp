// SPDX-License-Identifier: BSL-1.0
// Words of each kind of letter, of one trajectory and in lanes: on a system by its type, and on its model.
#include <benchmark/benchmark.h>

#include <cstdint>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "agree.hpp"
#include "nysalt/ensembles/distributions.hpp"
#include "nysalt/lanes.hpp"
#include "nysalt/method.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/model.hpp"
#include "nysalt/noises/counter_noise.hpp"
#include "nysalt/systems/fpu_chain.hpp"
#include "nysalt/systems/in_bath.hpp"
#include "races.hpp"

namespace nysalt::bench {

namespace {

constexpr double h = 0.01;
constexpr std::int64_t steps = 4000;

const fpu_chain<3> chain(50.0);
const in_bath<fpu_chain<3>> bathed(chain, bath::of_sigma(0.01, 0.05));

/// States of the trajectories in the lanes of T after all steps.
template <class T>
std::vector<double> ends_of(const auto& stepper) {
  constexpr int N = std::remove_cvref_t<decltype(stepper)>::dimension;
  static const auto starts = detail::gather<T, 6>(
      lanes_in<T>, [](int k) { return fpu_law<3>(chain)(1, static_cast<std::uint64_t>(k)); });
  auto run = stepper.open(phase_point<T, N>{starts.q, starts.p});
  stepper.advance(run, steps);
  const auto all = stepper.synchronous(run);
  std::vector<double> result;
  for (int k = 0; k < lanes_in<T>; ++k) {
    const auto x = lane(all, k);
    result.insert(result.end(), x.q.begin(), x.q.end());
    result.insert(result.end(), x.p.begin(), x.p.end());
  }
  return result;
}

template <class T>
class words {
 public:
  /// `evaluations` of a step: forces, and derivatives of forces.
  template <class S, class... Noise>
  void add(const std::string& letters, const S& system, const auto& method, int evaluations,
           const Noise&... noise) {
    const auto typed = make_stepper(system, method, h, noise...);
    const auto known = std::make_shared<const model>(system);
    const auto by_library = make_stepper(*known, method, h, noise...);
    require_agreement(letters, ends_of<T>(typed), ends_of<T>(by_library), 0.0);
    const double work = static_cast<double>(steps * evaluations * lanes_in<T>);
    runners.push_back({letters, work, [typed] { benchmark::DoNotOptimize(ends_of<T>(typed)); }});
    runners.push_back({letters + ", by the library", work,
                       [known, by_library] { benchmark::DoNotOptimize(ends_of<T>(by_library)); }});
  }

  std::vector<runner> runners;
};

/// A unit of work is an evaluation of the force on one trajectory.
template <class T>
void race_words(const std::string& name) {
  words<T> all;
  all.add("A B", chain, verlet{}, 1);
  all.add("A B, eleven stages", chain, srkn11b{}, 11);
  all.add("G", chain, chin4a{}, 3);
  all.add("R S", chain, impulse{}, 1);
  all.add("O", bathed, baoab{}, 1, counter_noise(1));
  race(name, std::move(all.runners));
}

}  // namespace

void race_words() {
  race_words<double>("words, one trajectory");
  race_words<pack<double>>("words, lanes");
}

}  // namespace nysalt::bench
