// SPDX-License-Identifier: BSL-1.0
// `nysalt_paper` is refused on several ranks, which say so once.
#include <boost/test/unit_test.hpp>

#include "../../support/mpirun.hpp"

using namespace nysalt::test;

BOOST_AUTO_TEST_CASE(several_ranks_are_refused_once) {
  const scratch folder("paper_on_ranks");
  const auto done = run_on(3, folder, "linear --quick --output results");
  BOOST_TEST(done.code == 2);
  const auto first = done.err.find("nysalt: ");
  BOOST_TEST(first != std::string::npos, done.err);
  BOOST_TEST(done.err.find("without mpirun") != std::string::npos, done.err);
  BOOST_TEST(done.err.find("nysalt: ", first + 1) == std::string::npos, done.err);
  BOOST_TEST(folder.files().empty());
}
