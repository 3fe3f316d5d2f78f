// SPDX-License-Identifier: BSL-1.0

#include "nysalt/ensembles/gibbs.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "burn_in.hpp"
#include "nysalt/core/sentence.hpp"
#include "nysalt/integrate.hpp"
#include "nysalt/method.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/noises/counter_noise.hpp"
#include "nysalt/references/exact_linear.hpp"
#include "nysalt/systems/modal_coordinates.hpp"
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

/// The chains of gibbs.
class gibbs_chains {
 public:
  gibbs_chains(model base, initial_states from, double temperature, burn_in_report report)
      : base_(std::move(base)),
        from_(std::move(from)),
        temperature_(temperature),
        report_(std::move(report)) {}

  phase_point<double, Eigen::Dynamic> operator()(std::uint64_t seed, std::uint64_t n) const {
    return block<double>(seed, static_cast<std::int64_t>(n), 1);
  }
  template <class T>
  phase_point<T, Eigen::Dynamic> block(std::uint64_t seed, std::int64_t first, int count) const {
    const burn_in_chains chains(base_, bath::of_temperature(report_.friction, temperature_), report_.step,
                                seed);
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
  std::string description() const {
    return fmt::format("gibbs(temperature={}, from {}, burned in for {} with friction {} and step {})",
                       in_digits(temperature_, 6), from_.description(), in_digits(report_.length, 4),
                       in_digits(report_.friction, 4), in_digits(report_.step, 4));
  }

 private:
  model base_;
  initial_states from_;
  double temperature_;
  burn_in_report report_;
};

burn_in_report found(const model& base, double temperature, const initial_states& from,
                     const burn_in_options& options) {
  return with_scalar_of(
      base, [&]<class T>(T) { return burn_in_search<T>(base, temperature, from, options).find(); });
}

}  // namespace

gibbs_states::gibbs_states(const model& in_bath, const initial_states& from, const burn_in_options& options)
    : report_(found(in_bath.base(), temperature_to_sample(in_bath.bath()), from, options)),
      chains_(gibbs_chains(in_bath.base(), from, in_bath.bath().temperature(), report_)) {}

modal_gibbs::modal_gibbs(const model& system, double temperature) : temperature_(temperature) {
  exact_linear(system);  // refuses any other
  modes_ = modal_coordinates::of(system);
  if (!(temperature > 0.0) || !std::isfinite(temperature) ||
      !(std::ranges::min(modes_->frequencies()) > 0.0)) {
    throw std::invalid_argument(
        fmt::format("gibbs_of_modes: temperature and the frequency of each mode must be above 0, got {} at "
                    "temperature {}",
                    describe(system), temperature));
  }
}

phase_point<double, Eigen::Dynamic> modal_gibbs::start(std::uint64_t seed, std::uint64_t n) const {
  Eigen::VectorXd x(modes_->size());
  Eigen::VectorXd y(modes_->size());
  noise_counter at = {.trajectory = n, .purpose = noise_purpose::initial_state};
  standard_normals(seed, at, x);
  at.slot += slots_for(static_cast<std::uint64_t>(x.size()));
  standard_normals(seed, at, y);
  const double deviation = std::sqrt(temperature_);
  for (Eigen::Index k = 0; k < x.size(); ++k) {
    x[k] *= deviation / modes_->frequencies()[static_cast<std::size_t>(k)];
    y[k] *= deviation;
  }
  phase_point<double, Eigen::Dynamic> state{Eigen::VectorXd(x.size()), Eigen::VectorXd(x.size())};
  modes_->from_modes(x, y, state.q, state.p);
  return state;
}

std::string modal_gibbs::description() const {
  return fmt::format("gibbs_of_modes(temperature={})", in_digits(temperature_, 6));
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
  std::vector<phase_point<double, Eigen::Dynamic>> kept;
  const auto keep = [&](std::int64_t n, double, const phase_point<double, Eigen::Dynamic>& x) {
    if (n >= first) kept.push_back(x);
  };
  const auto stepper =
      make_stepper(in_bath, method(baoab{}), step_, counter_noise(options.seed, noise_purpose::burn_in));
  const auto end = integrate(stepper, sound_start(in_bath, from, options.seed, 0), steps, keep, every);
  if (end.diverged_at) {
    throw std::runtime_error(fmt::format(
        "one_long_trajectory: the motion of {} must be confined and the step small enough, got a trajectory "
        "that diverged at time {} with the step {}",
        describe(in_bath), in_digits(static_cast<double>(*end.diverged_at) * step_, 6), in_digits(step_, 6)));
  }
  if (kept.empty()) {
    throw std::invalid_argument(fmt::format(
        "one_long_trajectory: the length must leave a state to keep after a burn-in of {}, got {}; "
        "take more states or less burn-in",
        options.burn_in, options.length));
  }
  states_ = std::make_shared<const std::vector<phase_point<double, Eigen::Dynamic>>>(std::move(kept));
}

const phase_point<double, Eigen::Dynamic>& long_trajectory::start(std::uint64_t seed, std::uint64_t n) const {
  vector<double, 1> normal;
  standard_normals(seed, {.trajectory = n, .purpose = noise_purpose::initial_state}, normal);
  return (*states_)[index_by_normal(normal[0], states())];
}

std::string long_trajectory::description() const {
  return fmt::format("one_long_trajectory(length={}, burn_in={}, step={}, seed={}, from {})", options_.length,
                     options_.burn_in, in_digits(step_, 6), options_.seed, from_);
}

}  // namespace nysalt::detail
