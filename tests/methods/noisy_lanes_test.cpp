// SPDX-License-Identifier: BSL-1.0
// Also with noise: trajectories side by side have the bits of each alone.
#include <boost/test/unit_test.hpp>

#include "../laws/noisy_models.hpp"
#include "../laws/run_laws.hpp"
#include "../support/noises.hpp"

using namespace nysalt;
using namespace nysalt::test;

using methods_in_lanes = std::tuple<baoab, obabo, nystrom_symmetric, shared_equally<O, kick, O, O, drift, O>>;

BOOST_AUTO_TEST_CASE_TEMPLATE(each_lane_has_the_bits_of_one_trajectory, M, methods_in_lanes) {
  draws random;
  for_each<std::tuple<a_warm_fpu, a_warm_free_chain>>([&]<class Model>() {
    const auto system = Model::make();
    const auto method = any_method<M>(random);
    const auto by_type = make_stepper(system, method, 0.02, counter_noise(3));
    BOOST_TEST_CONTEXT("seed " << draws::seed << ", " << method.name() << " on " << describe(system)) {
      BOOST_TEST(lanes_are_alone<1>(by_type, random, Model::reach));
      BOOST_TEST(lanes_are_alone<8>(by_type, random, Model::reach));
      BOOST_TEST(lanes_are_alone<16>(by_type, random, Model::reach));
      BOOST_TEST(!lanes_are_alone<8>(by_type, random, Model::reach, 32));      // a step apart
      BOOST_TEST(!lanes_are_alone<8>(by_type, random, Model::reach, 31, 41));  // with another's noise
    }
  });
}

BOOST_AUTO_TEST_CASE(also_as_data_and_along_a_path) {
  draws random;
  const auto system = a_warm_fpu::make();
  for (const auto& method : {tabulated(baoab{}), tabulated(obabo{})}) {
    BOOST_TEST(lanes_are_alone<16>(make_stepper(system, method, 0.02, counter_noise(3)), random, 0.5));
    BOOST_TEST(lanes_are_alone<8>(make_stepper(system, method, 0.02, noise_of_a_path(3)), random, 0.5));
  }
}
