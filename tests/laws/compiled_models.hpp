// SPDX-License-Identifier: BSL-1.0
// Models whose kernels are compiled once for all tests; compiled_specimens.hpp has more.
#pragma once

#include <memory>

#include "../support/systems.hpp"
#include "nysalt/model.hpp"
#include "nysalt/systems/fpu_chain.hpp"
#include "nysalt/systems/linear_chain.hpp"
#include "nysalt/systems/phi4.hpp"
#include "nysalt/systems/textbook.hpp"

#ifndef NYSALT_TEST_EXTERN
#define NYSALT_TEST_EXTERN extern
#endif

namespace nysalt::detail {

#define NYSALT_TEST_MODEL(...) \
  NYSALT_TEST_EXTERN template std::shared_ptr<const any_system> erased(const __VA_ARGS__&)

NYSALT_TEST_MODEL(fpu_chain<3>);
NYSALT_TEST_MODEL(harmonic_oscillator);
NYSALT_TEST_MODEL(henon_heiles);
NYSALT_TEST_MODEL(linear_chain);
NYSALT_TEST_MODEL(pendulum);
NYSALT_TEST_MODEL(phi4_chain<>);
NYSALT_TEST_MODEL(test::black_box);
NYSALT_TEST_MODEL(test::dynamic_potential);
NYSALT_TEST_MODEL(test::in_lanes<fpu_chain<3>, 1>);
NYSALT_TEST_MODEL(test::relativistic);
NYSALT_TEST_MODEL(test::two_masses);

#undef NYSALT_TEST_MODEL

}  // namespace nysalt::detail
