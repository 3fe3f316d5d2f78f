// SPDX-License-Identifier: BSL-1.0
// A word as data is refused by a system that does not serve its letters, with what is missing.
#include "nysalt/detail/served_letters.hpp"

#include <boost/test/unit_test.hpp>

#include "nysalt/stepper.hpp"
#include "nysalt/systems/in_bath.hpp"
#include "nysalt/systems/linear_chain.hpp"
#include "nysalt/systems/with_quadratic_part.hpp"
#include "support/refusal.hpp"
#include "support/systems.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using wrong = std::invalid_argument;
using with_duals = dual<double, 1>;

template <Scalar T = double>
bool is_refused(const char* letters, const auto& system, std::initializer_list<std::string_view> words = {}) {
  return refuses<wrong>(
      [&] { require_served<std::decay_t<decltype(system)>, T>(run_time_word(letters), system); }, words);
}

const with_quadratic_part split(two_masses(), Eigen::MatrixXd::Identity(2, 2));

}  // namespace

BOOST_AUTO_TEST_CASE(who_serves_a_letter_steps_with_it) {
  for (const char* letters : {"ABA", "BAB", "BAGAB", "AGA", "OABAO"}) {
    BOOST_TEST(!is_refused(letters, potential_only()));
    BOOST_TEST(!is_refused(letters, black_box()));
    BOOST_TEST(!is_refused<with_duals>(letters, two_masses()));
    BOOST_TEST(!is_refused<with_duals>(letters, black_box()));
  }
  for (const char* letters : {"RSR", "SRHRS", "ROSOR", "HR"}) {
    BOOST_TEST(!is_refused(letters, split));
    BOOST_TEST(!is_refused<with_duals>(letters, split));
    BOOST_TEST(!is_refused(letters, linear_chain::between_walls(3, 1.0)));
    BOOST_TEST(!is_refused(letters, in_bath(split, bath::of_sigma(1.0, 0.1))));
  }
}

BOOST_AUTO_TEST_CASE(without_a_quadratic_part_there_is_no_rotation) {
  for (const char* letters : {"RSR", "SR", "S", "RHR"}) {
    BOOST_TEST(is_refused(letters, two_masses(),
                          {letters, "two_masses", "quadratic part", "soft_force", "with_quadratic_part"}));
    BOOST_TEST(is_refused(letters, black_box(), {letters, "quadratic part"}));
    BOOST_TEST(is_refused(letters, relativistic(), {letters, "quadratic part"}));
  }
}

BOOST_AUTO_TEST_CASE(gradient_kicks_need_a_quadratic_kinetic_energy) {
  for (const auto* letters : {"BAGAB", "GA"}) {
    BOOST_TEST(is_refused(letters, relativistic(), {letters, "relativistic", "quadratic kinetic energy"}));
    BOOST_TEST(is_refused(letters, relativistic_with_velocity(), {letters, "quadratic kinetic energy"}));
  }
  BOOST_TEST(!is_refused("ABABA", relativistic()));
}

BOOST_AUTO_TEST_CASE(the_stepper_refuses_too) {
  const two_masses system;
  BOOST_TEST(refuses<wrong>(
      [&] {
        stepper(system, run_time_word("RSR"), {0.5, 1.0, 0.5}, 0.1);
      },
      {"RSR", "quadratic part"}));
  BOOST_TEST(!refuses<wrong>([&] { stepper(split, run_time_word("RSR"), {0.5, 1.0, 0.5}, 0.1); }, {}));
  const relativistic fast;
  BOOST_TEST(refuses<wrong>(
      [&] {
        stepper(fast, run_time_word("AGA"), {0.5, 1.0, 0.01, 0.5}, 0.1);
      },
      {"AGA", "quadratic kinetic"}));
  // Two coefficients for G, and it says so.
  BOOST_TEST(refuses<wrong>(
      [&] {
        stepper(system, run_time_word("AGA"), {0.5, 1.0, 0.5}, 0.1);
      },
      {"AGA", "3 letters and 4 coefficients", "3 coefficients"}));
}
