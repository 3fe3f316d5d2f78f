// SPDX-License-Identifier: BSL-1.0
#include "nysalt/ensembles/one_long_trajectory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "nysalt/detail/in_digits.hpp"
#include "nysalt/detail/sentence.hpp"
#include "nysalt/integrate.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/methods/tabulated.hpp"
#include "nysalt/noises/counter_noise.hpp"
#include "step_of_motion.hpp"

namespace nysalt::detail {

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
    throw std::runtime_error(sentence(
        "one_long_trajectory: the motion of {} must be confined and the step small enough, got a trajectory "
        "that diverged at time {} with the step {}",
        describe(in_bath), in_digits(static_cast<double>(*end.diverged_at) * step_, 6), in_digits(step_, 6)));
  }
  if (states_.empty()) {
    throw std::invalid_argument(
        sentence("one_long_trajectory: the length must leave a state to keep after a burn-in of {}, got {}; "
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
  return sentence("one_long_trajectory(length={}, burn_in={}, step={}, seed={}, from {})", options_.length,
                  options_.burn_in, in_digits(step_, 6), options_.seed, from_);
}

}  // namespace nysalt::detail
