// SPDX-License-Identifier: BSL-1.0
// The ten lines of the README: learn a method for a chain at a step, and run it.
#include <fmt/format.h>

#include "nysalt/analyse.hpp"
#include "nysalt/core.hpp"
#include "nysalt/learn.hpp"

int main() {
  // [readme]
  using namespace nysalt;
  const fpu_chain<3> chain(50.0);          // the system: any H = K(p) + V(q) of yours
  const fpu_law<3> starts(chain);          // where its trajectories start
  const auto accurate = fine_steps(1e-3);  // a reference flow
  const auto data = make_flow_map_data(chain, starts, accurate, {.step = 0.03, .seed = 1});
  const auto unseen = make_flow_map_data(chain, starts, accurate, {.step = 0.03, .seed = 2});
  const auto [theta, summary, method] = learn(nystrom{}, chain, data, unseen);
  fmt::print("b1 = {:.4f}, beta1 = {:.4f}\n", theta[0], theta[1]);
  const auto end = integrate(chain, method, 0.03, starts(3, 0), 1000);
  fmt::print("{}\n", end.diverged_at ? "diverged" : "still there after 1000 steps");
  // [/readme]
}

// Expected output:
// b1 = 0.5079, beta1 = 0.4010
// still there after 1000 steps
