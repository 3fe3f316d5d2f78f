// SPDX-License-Identifier: BSL-1.0
// `mpirun -n 3` of run, compare, learn and sample has the bytes of one process, three ranks go on with what
// one process left, and a refusal is one line. More ranks, kills and signals:
// tests/long/programs/on_ranks_test.cpp.
#include <boost/test/unit_test.hpp>

#include <string>

#include "../support/mpirun.hpp"

using namespace nysalt::test;

BOOST_AUTO_TEST_CASE(three_ranks_have_the_bytes_of_one_process) {
  for (const shared_command& one : std::initializer_list<shared_command>{
           {"run --system henon_heiles --spread 2.5 --method verlet --step 0.3 --horizon 60 --trajectories "
            "70 "
            "--sample-every 7",  // some diverge
            "o.csv",
            {{3, 2}}},
           {"compare --system pendulum --methods verlet,learned:fg_chin --steps 0.5 --horizon 10 "
            "--trajectories 70 "
            "--learn-trajectories 16 --learn-horizon 4 --learn-effort quick --metric path,distribution:q1",
            "",
            {{3, 1}}},
           {"learn --family nystrom --step 0.03 --fine-step 0.001 --horizon 0.3 --trajectories 100 --effort "
            "quick",
            "o.json",
            {{3, 1}}},
           {"sample --system phi4 --masses 5 --length 1 --chains 70 --burn-in 100 --draws 20 "
            "--diagonal-masses",
            "o.csv",
            {{3, 2}}},
           // All ranks share the sites of one trajectory.
           {"run --system fpu --pairs 6000 --method verlet --step 0.01 --horizon 0.5 --sample-every 7 "
            "--observables energy,q1,p6001,q12000",
            "o.csv",
            {{3, 1}}}})
    ranks_change_no_byte(one);
}

// Each rank takes up its own of 70 trajectories, and rank 0 writes all of them in their order.
BOOST_AUTO_TEST_CASE(three_ranks_go_on_with_what_one_process_left) {
  const scratch folder("ranks_resume");
  const std::string line =
      "run --system pendulum --method verlet --step 0.01 --horizon 4 "
      "--trajectories 70 --sample-every 20 --output a.csv";
  BOOST_TEST(run(folder, line).code == 0);
  const std::string whole = contents(folder / "a.csv");
  const std::string kept = line + " --checkpoint c --every 100";
  BOOST_TEST(shell(folder, "LD_PRELOAD=$faults NYSALT_FAULT=rename:5:kill \"$nysalt\" " + kept).code == 137);
  BOOST_TEST(contents(folder / "c").size() > 2 * 70 * sizeof(double));  // with the states of all
  const auto done = run_on(3, folder, kept + " --resume");
  BOOST_TEST_REQUIRE(done.code == 0, done.err);
  BOOST_TEST(contents(folder / "a.csv") == whole);
}

// Each rank has its own trajectories, or its own sites of one.
BOOST_AUTO_TEST_CASE(three_ranks_prolong_what_one_process_finished) {
  for (const std::string of :
       {"run --system henon_heiles --spread 2.5 --method verlet --step 0.3 --trajectories 70 --sample-every "
        "7 ",
        "run --system fpu --pairs 6000 --method verlet --step 0.02 --sample-every 50 "}) {
    const scratch folder("ranks_prolong");
    const std::string line = of + "--output a.csv --horizon ";
    const std::string kept = " --checkpoint c --every 100";
    BOOST_TEST(run(folder, line + "60").code == 0);
    const std::string whole = contents(folder / "a.csv");
    BOOST_TEST(run(folder, line + "30" + kept).code == 0);
    BOOST_TEST(contents(folder / "a.csv") != whole);
    const auto done = run_on(3, folder, line + "60" + kept + " --resume");
    BOOST_TEST_REQUIRE(done.code == 0, done.err);
    BOOST_TEST(contents(folder / "a.csv") == whole);
  }
}

BOOST_AUTO_TEST_CASE(a_refusal_is_told_once) {
  const scratch folder("ranks_refused");
  const auto done = run_on(3, folder, "run --method nobody --step 0.1 --horizon 1 --output o.csv");
  BOOST_TEST(done.code == 2);
  BOOST_TEST(sentences_in(done.err) == 1, done.err);
  BOOST_TEST(done.err.find("nobody") != std::string::npos, done.err);
  BOOST_TEST(folder.files().empty());
}
