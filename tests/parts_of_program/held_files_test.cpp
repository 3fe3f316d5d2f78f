// SPDX-License-Identifier: BSL-1.0
// A file that one holds is refused to another, until it is let go; what is asked again is compared option by
// option. The lock belongs to an open file: two openings in one process are two processes to it.
#include <boost/test/unit_test.hpp>

#include <optional>

#include "../support/refusal.hpp"
#include "../support/scratch.hpp"
#include "comparison/journal.hpp"
#include "comparison/refusal.hpp"
#include "program/output/checkpoint_file.hpp"
#include "program/output/unfinished_file.hpp"

using namespace nysalt;
using namespace nysalt::program;
using namespace nysalt::test;

BOOST_AUTO_TEST_CASE(a_journal_is_of_one_process) {
  const scratch folder("held_journal");
  const json question{{"seed", 1}};
  std::optional<journal> first(std::in_place, folder / "j", question, false);
  for (const bool resume : {false, true}) {
    BOOST_TEST(refuses<refusal>([&] { journal(folder / "j", question, resume); },
                                {"another run is writing it", "name another --output"}));
  }
  first.reset();
  const journal second(folder / "j", question, true);
  BOOST_TEST(second.found() == 0U);
}

BOOST_AUTO_TEST_CASE(the_output_of_an_unfinished_run_is_of_one_process) {
  using enum unfinished_file::origin;
  const scratch folder("held_output");
  std::optional<unfinished_file> first(std::in_place, folder / "out.csv", made);
  first->write("a\n");
  first->put_on_disk();
  first->keep();
  for (const auto from : {left_by_another, begun_anew, made}) {
    BOOST_TEST(refuses<refusal>([&] { unfinished_file(folder / "out.csv", from); },
                                {"another run is writing it", "wait for that run"}));
  }
  const file_sum written = first->written();
  first.reset();
  unfinished_file second(folder / "out.csv", left_by_another);
  BOOST_TEST(second.cut_after(written));
}

BOOST_AUTO_TEST_CASE(every_option_that_differs_is_named) {
  const json then{{"step", 0.1}, {"seed", 1}, {"horizon", 5.0}};
  const json now{{"step", 0.2}, {"seed", 2}, {"horizon", 5.0}};
  require_question(then, then, "c");
  require_same_question(then, then, "j");
  BOOST_TEST(refuses<refusal>([&] { require_question(then, now, "c"); }, {"another run (step, seed)"}));
  BOOST_TEST(
      refuses<refusal>([&] { require_same_question(then, now, "j"); }, {"another question (step, seed)"}));
}
