// SPDX-License-Identifier: BSL-1.0
#include "nysalt/ensembles/gibbs.hpp"

#include <fmt/format.h>

#include <stdexcept>
#include <utility>

#include "burn_in.hpp"
#include "nysalt/detail/in_digits.hpp"
#include "nysalt/detail/sentence.hpp"

namespace nysalt::detail {

namespace {

/// kT. Throws std::invalid_argument unless the bath has a temperature, and that is positive.
double temperature_to_sample(const bath& in) {
  if (!in.has_temperature()) {
    throw std::invalid_argument(fmt::format(
        "gibbs: the bath must have a temperature, got a {}; give one, or friction", in.description()));
  }
  if (in.temperature() > 0.0) return in.temperature();
  throw std::invalid_argument(
      "gibbs: the temperature must be > 0, got 0, at which the system rests at the minimum "
      "of the potential; start from another ensemble");
}

}  // namespace

gibbs_chains::gibbs_chains(const model& in_bath, initial_states from, const burn_in_options& options)
    : base_(in_bath.base()), from_(std::move(from)), temperature_(temperature_to_sample(in_bath.bath())) {
  report_ = with_scalar_of(
      base_, [&]<class T>(T) { return burn_in_search<T>(base_, temperature_, from_, options).find(); });
}

template <class T>
phase_point<T, Eigen::Dynamic> gibbs_chains::block(std::uint64_t seed, std::int64_t first, int count) const {
  const burn_in_chains chains(base_, temperature_, report_.friction, report_.step, seed);
  auto run = chains.open(sound_starts<T>(base_, from_, seed, first, count), first, count);
  run.go_on(report_.steps);
  for (int k = 0; k < count; ++k) {
    if (!run.diverged_at(k)) continue;
    throw std::runtime_error(
        sentence("gibbs: the motion of {} must be confined, got chain {} of seed {} that diverged at time {}",
                 describe(base_), first + k, seed,
                 in_digits(static_cast<double>(*run.diverged_at(k)) * report_.step, 6)));
  }
  auto x = run.synchronous();
  chains.draw_momenta(x, first, report_.steps);
  return x;
}

template phase_point<double, Eigen::Dynamic> gibbs_chains::block<double>(std::uint64_t, std::int64_t,
                                                                         int) const;
template phase_point<lanes, Eigen::Dynamic> gibbs_chains::block<lanes>(std::uint64_t, std::int64_t,
                                                                       int) const;

std::string gibbs_chains::description() const {
  return sentence("gibbs(temperature={}, from {}, burned in for {} with friction {} and step {})",
                  in_digits(temperature_, 6), from_.description(), in_digits(report_.length, 4),
                  in_digits(report_.friction, 4), in_digits(report_.step, 4));
}

}  // namespace nysalt::detail
