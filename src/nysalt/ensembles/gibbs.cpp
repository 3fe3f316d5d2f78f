// SPDX-License-Identifier: BSL-1.0

#include "nysalt/ensembles/gibbs.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "burn_in.hpp"
#include "nysalt/detail/sentence.hpp"
#include "nysalt/integrate.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/method.hpp"
#include "nysalt/noises/counter_noise.hpp"
#include "step_of_motion.hpp"

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
    throw std::runtime_error(fmt::format(
        "gibbs: the motion of {} must be confined, got chain {} of seed {} that diverged at time {}",
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
  return fmt::format("gibbs(temperature={}, from {}, burned in for {} with friction {} and step {})",
                     in_digits(temperature_, 6), from_.description(), in_digits(report_.length, 4),
                     in_digits(report_.friction, 4), in_digits(report_.step, 4));
}

namespace {

void require_sound(const long_trajectory_options& o, double step) {
  const bool times = step > 0.0 && o.burn_in >= 0.0 && o.length > o.burn_in && o.length / step < 1e12;
  if (times && o.most_states >= 1 && o.most_states <= 100'000) return;
  throw std::invalid_argument(
      fmt::format("one_long_trajectory: 0 <= burn_in < length, step > 0, length/step < 1e12 and 1 <= "
                  "most_states <= 100000 must hold, got burn_in {}, length {}, step {} and most_states {}",
                  o.burn_in, o.length, step, o.most_states));
}

}  // namespace

long_trajectory::long_trajectory(const model& in_bath, const initial_states& from,
                                 const long_trajectory_options& options)
    : options_(options), from_(from.description()) {
  const bath& in = in_bath.bath();
  const double temperature = in.has_temperature() ? in.temperature() : 0.0;
  step_ = options.step != 0.0 ? options.step
                              : step_of_motion(in_bath, from, temperature, 0.1, "one_long_trajectory");
  require_sound(options, step_);
  const auto steps = static_cast<std::int64_t>(options.length / step_);
  const auto first = static_cast<std::int64_t>(std::ceil(options.burn_in / step_));
  const std::int64_t every = (steps - first) / options.most_states + 1;
  const auto keep = [&](std::int64_t n, double, const phase_point<double, Eigen::Dynamic>& x) {
    if (n >= first) states_.push_back(x);
  };
  const auto stepper =
      make_stepper(in_bath, tabulated(baoab{}), step_, counter_noise(options.seed, noise_purpose::burn_in));
  const auto end = integrate(stepper, sound_start(in_bath, from, options.seed, 0), steps, keep, every);
  if (end.diverged_at) {
    throw std::runtime_error(fmt::format(
        "one_long_trajectory: the motion of {} must be confined and the step small enough, got a trajectory "
        "that diverged at time {} with the step {}",
        describe(in_bath), in_digits(static_cast<double>(*end.diverged_at) * step_, 6), in_digits(step_, 6)));
  }
  if (states_.empty()) {
    throw std::invalid_argument(fmt::format(
        "one_long_trajectory: the length must leave a state to keep after a burn-in of {}, got {}; "
        "take more states or less burn-in",
        options.burn_in, options.length));
  }
}

const phase_point<double, Eigen::Dynamic>& long_trajectory::operator()(std::uint64_t seed,
                                                                       std::uint64_t n) const {
  vector<double, 1> normal;
  standard_normals(seed, {.trajectory = n, .purpose = noise_purpose::initial_state}, normal);
  const double uniform = 0.5 * std::erfc(-normal[0] * std::sqrt(0.5));
  const auto index = static_cast<std::size_t>(uniform * static_cast<double>(states()));
  return states_[std::min(index, states() - 1)];
}

std::string long_trajectory::description() const {
  return fmt::format("one_long_trajectory(length={}, burn_in={}, step={}, seed={}, from {})", options_.length,
                     options_.burn_in, in_digits(step_, 6), options_.seed, from_);
}

}  // namespace nysalt::detail
