// SPDX-License-Identifier: BSL-1.0
#include "together.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "nysalt/divergence.hpp"
#include "nysalt/method.hpp"
#include "nysalt/noises/counter_noise.hpp"
#include "nysalt/stepper.hpp"

namespace nysalt::python {

namespace {

/// The noise of each trajectory in its part of the state.
struct noise_of_each {
  static constexpr bool is_memoryless = true;
  counter_noise source;
  Eigen::Index dimension;

  template <class T, int N>
  void normals(const noise_place& at, vector<T, N>& xi) const {
    fill(at, xi, [&](const noise_place& place, vector<T, N>& one) { source.normals(place, one); });
  }
  template <class T, int N>
  void halving(const noise_place& at, vector<T, N>& zeta) const {
    fill(at, zeta, [&](const noise_place& place, vector<T, N>& one) { source.halving(place, one); });
  }

 private:
  template <class T, int N>
  void fill(noise_place at, vector<T, N>& all, const auto& draw) const {
    vector<T, N> one(dimension);
    for (Eigen::Index begin = 0; begin < all.size(); begin += dimension, ++at.trajectory) {
      draw(at, one);
      for (Eigen::Index i = 0; i < dimension; ++i) all[begin + i] = one[i];
    }
  }
};

/// Which trajectories have run away, as stepping/divergence.hpp says.
class watched_energies {
 public:
  watched_energies(const own_functions& functions, const bath& heat_bath,
                   const phase_point<double, Eigen::Dynamic>& start)
      : functions_(&functions) {
    least_ = 1.0;
    if (heat_bath.acts()) {
      least_ = heat_bath.has_temperature()
                   ? std::max(1.0, heat_bath.temperature() * static_cast<double>(functions.dimension))
                   : std::numeric_limits<double>::infinity();
    }
    initial_ = energies(start);
  }

  /// Of those that are not lost already.
  void mark(const phase_point<double, Eigen::Dynamic>& x, std::vector<bool>& lost) const {
    const auto now = energies(x);
    for (std::size_t m = 0; m < now.size(); ++m) {
      const double most = 1e3 * std::max(std::abs(initial_[m]), least_);
      if (!(std::abs(now[m] - initial_[m]) <= most)) lost[m] = true;
    }
  }

 private:
  std::vector<double> energies(const phase_point<double, Eigen::Dynamic>& x) const {
    const std::int64_t n = functions_->dimension;
    const std::int64_t count = x.q.size() / n;
    std::vector<double> all(static_cast<std::size_t>(count));
    functions_->potentials({x.q.data(), static_cast<std::size_t>(x.q.size())}, count, all);
    for (std::int64_t m = 0; m < count; ++m) {
      double kinetic = 0.0;
      for (std::int64_t i = 0; i < n; ++i)
        kinetic += x.p[m * n + i] * x.p[m * n + i] * functions_->inverse_masses[static_cast<std::size_t>(i)];
      all[static_cast<std::size_t>(m)] += 0.5 * kinetic;
    }
    return all;
  }

  const own_functions* functions_;
  double least_;
  std::vector<double> initial_;
};

}  // namespace

bool goes_together(const own_functions& functions, const nysalt::method& method) {
  return functions.forces && method.letters().letters().find_first_not_of("ABDO|") == std::string::npos;
}

void integrate_together(const std::shared_ptr<const own_functions>& functions, const bath& heat_bath,
                        const nysalt::method& method, const program::trajectories_plan& plan,
                        std::span<double> q, std::span<double> p) {
  const model system = side_by_side(functions, plan.count, heat_bath);
  const Eigen::Index n = functions->dimension;
  phase_point<double, Eigen::Dynamic> start{Eigen::Map<const Eigen::VectorXd>(q.data(), system.size()),
                                            Eigen::Map<const Eigen::VectorXd>(p.data(), system.size())};
  const watched_energies energies(*functions, heat_bath, start);
  std::vector<bool> lost(static_cast<std::size_t>(plan.count), false);
  std::ranges::fill(q, std::numeric_limits<double>::quiet_NaN());
  std::ranges::fill(p, std::numeric_limits<double>::quiet_NaN());
  const auto stepper = make_stepper(system, method, plan.step, noise_of_each{counter_noise(plan.seed), n});
  auto run = stepper.open(start, 0);
  flow_state<double, Eigen::Dynamic> checked;
  while (run.step < plan.steps) {
    stepper.advance(run, std::min(steps_between_checks, plan.steps - run.step));
    stepper.of_kernel(run, checked);
    energies.mark(checked, lost);
    for (std::int64_t m = 0; m < plan.count; ++m) {
      if (!lost[static_cast<std::size_t>(m)]) continue;
      // From here on it moves as at the start: numbers that are not finite are for no function.
      run.state.q.segment(m * n, n) = start.q.segment(m * n, n);
      run.state.p.segment(m * n, n) = start.p.segment(m * n, n);
      run.state.f.segment(m * n, n).setZero();
    }
  }
  const auto end = stepper.synchronous(run);
  for (std::int64_t m = 0; m < plan.count; ++m) {
    if (lost[static_cast<std::size_t>(m)]) continue;
    for (Eigen::Index i = m * n; i < (m + 1) * n; ++i) {
      q[static_cast<std::size_t>(i)] = end.q[i];
      p[static_cast<std::size_t>(i)] = end.p[i];
    }
  }
}

}  // namespace nysalt::python
