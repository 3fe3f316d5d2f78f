// SPDX-License-Identifier: BSL-1.0
// examples/first_steps.cpp of somebody who does not learn: for its compile time.
#include <fmt/format.h>

#include "nysalt/nysalt.hpp"

int main() {
  using namespace nysalt;
  const fpu_chain<3> chain(50.0);
  const fpu_law<3> starts(chain);
  const auto accurate = fine_steps(1e-3);
  const auto data = make_flow_map_data(chain, starts, accurate, {.step = 0.03, .seed = 1});
  const auto method = member(nystrom{}, {0.5, 0.4});
  fmt::print("{} pairs\n", data.pairs());
  const auto end = integrate(chain, method, 0.03, starts(3, 0), 1000);
  fmt::print("{}\n", end.diverged_at ? "diverged" : "still there after 1000 steps");
}
