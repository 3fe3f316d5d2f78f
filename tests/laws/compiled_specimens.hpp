// SPDX-License-Identifier: BSL-1.0
// Further models whose kernels are compiled once.
#pragma once

#include "compiled_models.hpp"
#include "nysalt/systems/gaussian.hpp"
#include "nysalt/systems/lennard_jones.hpp"
#include "nysalt/systems/logistic_regression.hpp"
#include "nysalt/systems/phi4.hpp"
#include "nysalt/systems/textbook.hpp"
#include "nysalt/systems/with_quadratic_part.hpp"

#ifndef NYSALT_TEST_EXTERN_SPECIMEN
#define NYSALT_TEST_EXTERN_SPECIMEN extern
#endif
#ifndef NYSALT_TEST_EXTERN_OF_PARTS
#define NYSALT_TEST_EXTERN_OF_PARTS extern
#endif

namespace nysalt::detail {

#define NYSALT_TEST_MODEL(...) \
  NYSALT_TEST_EXTERN_SPECIMEN template std::shared_ptr<const any_system> erased(const __VA_ARGS__&)
#define NYSALT_TEST_MODEL_OF_PARTS(...)                                          \
  NYSALT_TEST_EXTERN_OF_PARTS template std::shared_ptr<const any_system> erased( \
      const with_quadratic_part<__VA_ARGS__>&)

NYSALT_TEST_MODEL(fpu_chain<>);
NYSALT_TEST_MODEL(gaussian);
NYSALT_TEST_MODEL(kepler);
NYSALT_TEST_MODEL(lennard_jones<>);
NYSALT_TEST_MODEL(logistic_regression);
NYSALT_TEST_MODEL(phi4_lattice);
NYSALT_TEST_MODEL(test::black_box_with_derivative);
NYSALT_TEST_MODEL(test::relativistic_with_velocity);
NYSALT_TEST_MODEL_OF_PARTS(pendulum);
NYSALT_TEST_MODEL_OF_PARTS(test::dynamic_potential);
NYSALT_TEST_MODEL_OF_PARTS(test::two_masses);

#undef NYSALT_TEST_MODEL
#undef NYSALT_TEST_MODEL_OF_PARTS

}  // namespace nysalt::detail
