// SPDX-License-Identifier: BSL-1.0
// A model, in as many lanes as this is compiled for.
#include "nysalt/model.hpp"

#include <cstdio>

#include "nysalt/systems/pendulum.hpp"

int main() {
  const nysalt::model system = nysalt::pendulum{};
  std::printf("%s in %d lanes\n", system.description().c_str(), nysalt::default_lanes);
}
