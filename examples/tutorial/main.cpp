// SPDX-License-Identifier: BSL-1.0
// The tutorial: a Hamiltonian of our own, a method learned for it, and a fair comparison.
#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "nysalt/learner.hpp"
#include "nysalt/nysalt.hpp"

using namespace nysalt;

// [system]
/// A weight on a stiff spring, swinging in a plane: H = (p_x^2 + p_y^2)/2 + k (r - 1)^2/2 + y, r = |(x, y)|.
struct spring_pendulum {
  static constexpr int dimension = 2;
  double stiffness = 400.0;  // k: the spring swings with frequency 20, the pendulum with 1

  template <class T>
  T potential(const vector<T, 2>& q) const {
    using std::sqrt;
    const T stretch = sqrt(q[0] * q[0] + q[1] * q[1]) - 1.0;
    return stretch * stretch * (0.5 * stiffness) + q[1];
  }
  std::string description() const { return fmt::format("spring_pendulum(stiffness={})", stiffness); }
};
static_assert(NystromSystem<spring_pendulum>);
// [/system]

int main() {
  // [data]
  const spring_pendulum system;
  const phase_point<double, 2> hanging{{0.0, -1.0}, {0.0, 0.0}};
  const normal_around<2> starts(hanging, 0.02, 0.5);  // deviations of q and of p
  constexpr double step = 0.09;                       // 1.8 radians of the spring
  const fine_steps<> accurate(0.001);
  const auto data = make_flow_map_data(system, starts, accurate, {.step = step, .horizon = 1.8, .seed = 1});
  const auto unseen = make_flow_map_data(system, starts, accurate, {.step = step, .horizon = 1.8, .seed = 2});
  // [/data]

  // [learn]
  const auto [method, fit] = learn(fg_chin{}, system, data, unseen);
  for (const auto& p : fit.parameters)
    fmt::print("{} = {:.5f} +- {:.0e}\n", p.name, p.value, p.standard_error);
  fmt::print("usable: {}\n\n", fit.usable ? "yes" : fit.reason);
  // [/learn]

  // [compare]
  // A word of n evaluations takes n times the step of one evaluation: all rows cost the same.
  struct rival {
    tabulated method;
    int evaluations;
  };
  const std::vector<rival> rivals{{tabulated(method.anywhere()), 3}, {tabulated(chin4a{}), 3},
                                  {tabulated(srkn6b{}), 6},          {tabulated(pefrl{}), 4},
                                  {tabulated(mclachlan2{}), 2},      {tabulated(verlet{}), 1}};
  fmt::print("            error of q, p on [0, {:.1f}]\n", 40 * step);
  for (const auto& [its, evaluations] : rivals) {
    const double its_step = step / 3 * evaluations;
    const std::vector one{its};
    const auto result =
        trajectory_errors(system, accurate, starts, one, state_measure(system),
                          {.step = its_step, .steps = 120 / evaluations, .trajectories = 100, .seed = 3});
    const auto [error, standard_error] = result.methods[0].error;
    fmt::print("{:<10}  {:.1e} +- {:.0e}{}\n", its.name(), error, standard_error,
               result.methods[0].diverged_at.empty() ? "" : "   some diverged");
  }
  // [/compare]

  // [run]
  const auto watch = [&](std::int64_t, double t, const auto& x) {
    fmt::print("t = {:5.1f}  x = {:+.3f}  H = {:+.4f}\n", t, x.q[0], energy<double>(system, x));
  };
  fmt::print("\n");
  integrate(system, method, step, starts(4, 0), 10'000, watch, 2'500);
  // [/run]
}

// Expected output:
// b = 0.17645 +- 3e-06
// c = 0.01242 +- 1e-06
// usable: yes
//
//             error of q, p on [0, 3.6]
// fg_chin     3.6e-04 +- 3e-05
// chin4a      6.0e-02 +- 3e-03
// srkn6b      3.6e-01 +- 2e-02
// pefrl       3.9e-02 +- 3e-03
// mclachlan2  3.6e-01 +- 2e-02
// verlet      3.0e-01 +- 2e-02
//
// t =   0.0  x = -0.016  H = -0.9370
// t = 225.0  x = +0.150  H = -0.9370
// t = 450.0  x = -0.044  H = -0.9370
// t = 675.0  x = -0.137  H = -0.9370
// t = 900.0  x = +0.099  H = -0.9370
