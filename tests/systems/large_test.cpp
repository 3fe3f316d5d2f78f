// SPDX-License-Identifier: BSL-1.0
// Of many coordinates no full matrix of modes is made, and what is known of them is the same.
#include <boost/test/unit_test.hpp>

#include "../support/rounding.hpp"
#include "nysalt/detail/modal_coordinates.hpp"
#include "nysalt/methods/frequency_to_fit.hpp"
#include "nysalt/model.hpp"
#include "nysalt/systems/fpu_chain.hpp"
#include "nysalt/systems/phi4_chain.hpp"

using namespace nysalt;
using namespace nysalt::test;

BOOST_AUTO_TEST_CASE(entries_of_a_long_chain_are_those_of_the_basis_of_a_short_one) {
  const fpu_chain<> shorter(most_for_full_basis / 2, 50.0);
  const fpu_chain<> longer(most_for_full_basis / 2 + 1, 50.0);
  BOOST_TEST(shorter.modes().entries.empty());
  BOOST_TEST(shorter.modes().basis.rows() == most_for_full_basis);
  BOOST_TEST(longer.modes().basis.size() == 0);
  const auto few = modal_coordinates::of(shorter);
  const auto many = modal_coordinates::of(longer);
  BOOST_TEST(many->entries().size() == few->entries().size() + 4);
  BOOST_TEST(many->frequencies().size() == few->frequencies().size() + 2);
  const Eigen::Index pairs = shorter.pairs();
  for (std::size_t n = 0; n < few->entries().size(); ++n) {
    const auto& a = few->entries()[n];
    const auto& b = many->entries()[n];
    // Stiff modes come after all soft ones, of which the longer chain has one more.
    const Eigen::Index mode = a.mode < pairs ? a.mode : a.mode + 1;
    const bool is_same = a.coordinate == b.coordinate && mode == b.mode && a.heavy == b.heavy;
    if (!is_same) BOOST_ERROR("entry " << n << " differs");
  }
  BOOST_TEST(detail::frequency_to_fit(longer) == 50.0);
}

BOOST_AUTO_TEST_CASE(they_lead_there_and_back) {
  const fpu_chain<> chain(800, 50.0);
  const auto modes = modal_coordinates::of(chain);
  Eigen::VectorXd q(chain.size());
  Eigen::VectorXd p(chain.size());
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    q[i] = std::sin(0.1 * static_cast<double>(i));
    p[i] = std::cos(0.3 * static_cast<double>(i));
  }
  Eigen::VectorXd x = q, y = q, q_back = q, p_back = q;
  modes->to_modes(q, p, x, y);
  modes->from_modes(x, y, q_back, p_back);
  // Each is two products of a sum of two products.
  BOOST_TEST((q_back - q).cwiseAbs().maxCoeff() <= 8.0 * eps);
  BOOST_TEST((p_back - p).cwiseAbs().maxCoeff() <= 8.0 * eps);
  // The first spring's: x_1 = (q_2 - q_1)/sqrt(2).
  BOOST_TEST(std::abs(x[800] - (q[1] - q[0]) * std::sqrt(0.5)) <= 4.0 * eps);
  normal_modes wrong = chain.modes();
  wrong.entries[3].mode = chain.size();
  struct told : fpu_chain<> {
    explicit told(normal_modes given) : fpu_chain<>(800, 50.0), all(std::move(given)) {}
    normal_modes modes() const { return all; }
    normal_modes all;
  };
  BOOST_CHECK_THROW(modal_coordinates::of(told(wrong)), std::invalid_argument);
}

BOOST_AUTO_TEST_CASE(a_long_ring_has_no_modes_and_a_model_says_so) {
  BOOST_TEST(has_modes(phi4_chain<>(most_for_full_basis)));
  BOOST_TEST(!has_modes(phi4_chain<>(most_for_full_basis + 1)));
  BOOST_TEST(has_modes(model(phi4_chain<>(16))));
  BOOST_TEST(!has_modes(model(phi4_chain<>(most_for_full_basis + 1))));
  BOOST_TEST(has_modes(model(fpu_chain<>(most_for_full_basis, 50.0))));
}
