// SPDX-License-Identifier: BSL-1.0
// A stiff chain at a large step: learn a method for it, run it, and compare it at equal cost.
//
// The Fermi-Pasta-Ulam chain has springs of frequency 50 between soft quartic ones. Their total energy I
// is nearly constant, and Verlet at the step 0.03 loses it. We learn the two-stage method that is best at
// this step from a hundred short trajectories, and let it run against methods of the same cost.
#include <fmt/format.h>

#include "nysalt/learn.hpp"
#include "nysalt/nysalt.hpp"

using namespace nysalt;

int main() {
  constexpr double step = 0.03;
  const fpu_chain<3> chain(50.0);
  const fpu_law<3> law(chain);
  const auto reference = fine_steps(1e-3);

  // Learn, from data of one seed, judged on data of another.
  const auto data = make_flow_map_data(chain, law, reference, {.step = step, .seed = 1});
  const auto held_out = make_flow_map_data(chain, law, reference, {.step = step, .seed = 2});
  const fit found = learn(nystrom{}, chain, data, held_out, {.loss = loss_named("state:1")});
  for (const auto& p : found.summary.parameters)
    fmt::print("{:<5} = {:.5f} +- {:.0e}\n", p.name, p.value, p.standard_error);
  fmt::print("usable: {}\n\n", found.summary.usable ? "yes" : found.summary.reason);

  // Run: one trajectory over 100 units of time, watched every 10 of them.
  const auto watch = [&](std::int64_t, double t, const auto& x) {
    fmt::print("t = {:5.1f}  I = {:.3f}\n", t, chain.stiff_energy(x));
  };
  const auto end = integrate(chain, found.method, step, law(3, 0), 3330, watch, 666);
  fmt::print("{}\n\n", end.diverged_at ? "diverged" : "did not diverge");

  // Compare, each at the cost of two force evaluations per step of 0.03.
  // [measure]
  const auto measure = relative_measure(chain, [&](const auto& x) { return chain.stiff_energy(x); });
  // [/measure]
  const auto report = [&](const method& other, double method_step, std::int64_t steps) {
    const auto result =
        trajectory_errors(chain, reference, law, other, measure,
                          {.step = method_step, .steps = steps, .trajectories = 100, .seed = 3});
    const auto& of_method = result.methods[0];
    fmt::print("{:<16} step {:.3f} {:5.1f} evaluations/time  error {:.1e} +- {:.0e}\n", other.name(),
               method_step, of_method.evaluations_per_time, of_method.error.mean,
               of_method.error.standard_error);
  };
  report(found.method, step, 16);
  report(mclachlan2{}, step, 16);
  report(bcss2{}, step, 16);
  report(verlet_2x{}, step, 16);
  report(srkn6b{}, 3 * step, 5);
}

// Expected output:
// b1    = 0.50933 +- 6e-04
// beta1 = 0.40168 +- 3e-04
// usable: yes
//
// t =   0.0  I = 8.540
// t =  20.0  I = 8.501
// t =  40.0  I = 8.632
// t =  59.9  I = 8.577
// t =  79.9  I = 8.561
// t =  99.9  I = 8.645
// did not diverge
//
// nystrom          step 0.030  66.7 evaluations/time  error 5.4e-03 +- 2e-04
// mclachlan2       step 0.030  66.7 evaluations/time  error 1.0e-02 +- 3e-04
// bcss2            step 0.030  66.7 evaluations/time  error 8.4e-03 +- 3e-04
// verlet_2x        step 0.030  68.8 evaluations/time  error 4.2e-02 +- 2e-03
// srkn6b           step 0.090  68.9 evaluations/time  error 3.0e-01 +- 1e-02
