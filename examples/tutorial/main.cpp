// SPDX-License-Identifier: BSL-1.0
// The tutorial: a Hamiltonian of our own, a method learned for it, and a fair comparison.
// [includes]
#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <optional>
#include <vector>

#include "nysalt/compare.hpp"
#include "nysalt/learn.hpp"
#include "nysalt/nysalt.hpp"

using namespace nysalt;
// [/includes]

// [system]
/// A weight on a stiff spring, swinging in a plane: H = (p_x^2 + p_y^2)/2 + k (r - 1)^2/2 + y, r = |(x, y)|.
struct spring_pendulum {
  static constexpr int dimension = 2;
  double stiffness = 400.0;  // k: the spring swings with frequency 20, the pendulum with 1

  template <class T>
  T potential(const vector<T, 2>& q) const {
    using std::sqrt;
    const T elongation = sqrt(q[0] * q[0] + q[1] * q[1]) - 1.0;
    return elongation * elongation * (0.5 * stiffness) + q[1];
  }
  template <class T>
  void force(const vector<T, 2>& q, vector<T, 2>& f) const {  // -k (r - 1)/r q - (0, 1)
    using std::sqrt;
    const T pull = (1.0 / sqrt(q[0] * q[0] + q[1] * q[1]) - 1.0) * stiffness;
    f[0] = q[0] * pull;
    f[1] = q[1] * pull - 1.0;
  }
  std::string description() const { return fmt::format("spring_pendulum(stiffness={})", stiffness); }
};
// [/system]

int main() {
  // [ask]
  require_suited<spring_pendulum>();  // compiles to nothing; else a sentence says what is wrong
  // [/ask]
  // [data]
  const spring_pendulum system;
  const phase_point<double, 2> hanging{{0.0, -1.0}, {0.0, 0.0}};
  const normal_around<2> starts(hanging, 0.02, 0.5);  // deviations of q and of p
  constexpr double step = 0.09;                       // 1.8 radians of the spring
  const auto accurate = fine_steps(step / 90);        // 0.001; it must divide every step below
  const auto data = make_flow_map_data(system, starts, accurate, {.step = step, .horizon = 1.8, .seed = 1});
  const auto unseen = make_flow_map_data(system, starts, accurate, {.step = step, .horizon = 1.8, .seed = 2});
  // [/data]

  // [learn]
  const fit found = learn(fg_chin{}, system, data, unseen);
  for (const auto& p : found.summary.parameters) fmt::print("{} = {:.5f}\n", p.name, p.value);
  fmt::print("usable: {}\n\n", found.summary.usable ? "yes" : found.summary.reason);
  if (!found.summary.usable) return 1;
  // [/learn]

  // [compare]
  // A word of n evaluations takes n times the step of one evaluation: all rows cost the same.
  struct rival {
    nysalt::method method;
    int evaluations;            // of a step
    std::function<void()> run;  // a thousand times over [0, 40 step], 120 evaluations
  };
  const auto start = starts(3, 0);
  auto finish = start;
  const auto rival_of = [&](const nysalt::method& each, int evaluations) {
    const auto stepper = make_stepper(system, each, step / 3 * evaluations);
    const auto run = [&, stepper, evaluations] {
      for (int n = 0; n < 1000; ++n) finish = integrate(stepper, start, 120 / evaluations).finish;
    };
    return rival{each, evaluations, run};
  };
  const double z = std::sqrt(system.stiffness) * step / 3;  // of the spring, an evaluation
  const std::vector<rival> rivals{rival_of(found.method.anywhere(), 3),
                                  rival_of(phase_fitted(fg_chin{}, chin4a{}, 3 * z), 3),
                                  rival_of(phase_fitted(aba<4>{}, pefrl{}, 4 * z), 4),
                                  rival_of(phase_fitted(aba<5>{}, mclachlan5{}, 5 * z), 5),
                                  rival_of(chin4a{}, 3),
                                  rival_of(srkn6b{}, 6),
                                  rival_of(pefrl{}, 4),
                                  rival_of(verlet{}, 1)};
  std::vector<std::function<void()>> runs;
  for (const auto& one : rivals) runs.push_back(one.run);
  const auto seconds = interleaved_seconds(runs, 21);  // in turns, the least and the median of 21

  fmt::print("{:25}error of q, p on [0, {:.1f}]   ns an evaluation (median)\n", "", 40 * step);
  std::optional<estimate> null_model;  // of what stays where it starts
  for (std::size_t i = 0; i < rivals.size(); ++i) {
    const auto& [each, evaluations, run] = rivals[i];
    const auto result = trajectory_errors(system, accurate, starts, each, state_measure(system),
                                          {.step = step / 3 * evaluations,
                                           .steps = 120 / evaluations,
                                           .trajectories = 100,
                                           .seed = 3,
                                           .null_model = true});
    const auto [error, standard_error] = result.methods[0].error;
    fmt::print("{:<23}  {:.1e} +- {:.0e}          {:6.1f} ({:.1f}){}\n", each.name(), error, standard_error,
               seconds[i].least / 120'000 * 1e9, seconds[i].median / 120'000 * 1e9,
               result.methods[0].diverged_at.empty() ? "" : "   some diverged");
    null_model = result.null_model;
  }
  fmt::print("null model               {:.1e} +- {:.0e}\n", null_model->mean, null_model->standard_error);
  // [/compare]

  // [run]
  const auto watch = [&](std::int64_t, double t, const auto& x) {
    fmt::print("t = {:5.1f}  x = {:+.3f}  H = {:+.4f}\n", t, x.q[0], energy<double>(system, x));
  };
  fmt::print("\n");
  const auto end = integrate(system, found.method, step, starts(4, 0), 10'000, watch, 2'500);
  fmt::print("after {} steps x = {:+.3f}{}\n", end.steps, end.finish.q[0],
             end.diverged_at ? ", diverged" : "");
  // [/run]

  // [report]
  const initial_value_problem problem{.system = system, .starts = starts};
  const comparison_options asked{.methods = {"learned:fg_chin", "chin4a", "pefrl", "verlet_2x"},
                                 .steps = {0.02, 0.03},  // of a force evaluation
                                 .equal_cost = true,
                                 .horizon = 3.6,
                                 .trajectories = 100,
                                 .metrics = {"state", "energy"}};
  report(problem, asked, "page");
  // [/report]
  fmt::print("page/report.html\n");
}

// Expected output:
// b = 0.17644
// c = 0.01243
// usable: yes
//
//                          error of q, p on [0, 3.6]   ns an evaluation (median)
// fg_chin                  2.6e-04 +- 3e-05            ~ (~)
// phase_fitted_chin4a      2.6e-04 +- 3e-05          ~ (~)
// phase_fitted_pefrl       4.6e-04 +- 6e-05          ~ (~)
// phase_fitted_mclachlan5  6.0e-04 +- 7e-05          ~ (~)
// chin4a                   6.0e-02 +- 3e-03          ~ (~)
// srkn6b                   3.6e-01 +- 2e-02          ~ (~)
// pefrl                    3.9e-02 +- 3e-03          ~ (~)
// verlet                   3.0e-01 +- 2e-02          ~ (~)
// null model               9.8e-01 +- 4e-02
//
// t =   0.0  x = -0.016  H = -0.9370
// t = 225.0  x = +0.150  H = -0.9370
// t = 450.0  x = -0.044  H = -0.9370
// t = 675.0  x = -0.137  H = -0.9370
// t = 900.0  x = +0.099  H = -0.9370
// after 10000 steps x = +0.099
// page/report.html
