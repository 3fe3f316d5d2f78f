// SPDX-License-Identifier: BSL-1.0
// One seed, one result: the number of threads changes no byte, another seed changes each number, and nothing
// is tested where it was learned.
#include <boost/test/unit_test.hpp>

#include <string>
#include <vector>

#include "../../src/comparison/seeds.hpp"
#include "../support/program.hpp"
#include "nysalt/energy.hpp"
#include "nysalt/ensembles/fpu_law.hpp"

using namespace nysalt::test;

namespace {

using pointer = nlohmann::ordered_json::json_pointer;

const std::string bath = " --system pendulum --friction 0.5 --temperature 0.3 ";

/// A command, and numbers that another seed changes. Starts of all kinds, lanes that are full and not, each
/// metric, and runs of which some or all trajectories diverge (cases/exit_codes.txt).
struct command {
  std::string line;
  std::vector<const char*> numbers;
};
const std::vector<command> commands{
    {"learn --family nystrom --step 0.03 --trajectories 23 --horizon 0.3 --effort quick",
     {"/parameters/b1", "/parameters/beta1", "/loss", "/held_out_loss", "/energy_range/0"}},
    {"learn --family bab2 --system linear_chain --step 1 --horizon 10 --trajectories 20 --coordinates modes "
     "--effort quick",
     {"/parameters/b1"}},
    {"run --method srkn6b --step 0.02 --horizon 2 --trajectories 23 --sample-every 7 "
     "--observables stiff_energy,energy,q1,p6",
     {"/rows/0/3", "/rows/0/5", "/rows/9/6"}},
    {"run --method bcss3@middle --step 0.2 --horizon 20 --trajectories 3" + bath, {"/rows/0/3", "/rows/5/3"}},
    {"run --method verlet --step 0.05 --horizon 0.15 --trajectories 40", {}},
    {"run --method verlet --step 0.05 --horizon 1 --trajectories 23", {}},
    {"run --method baoab --step 0.05 --horizon 0.15 --trajectories 40 --start law --friction 1 --temperature "
     "0.1",
     {}},
    {"compare --methods verlet,verlet_2x --steps 0.0405 --horizon 0.44 --trajectories 40 --metric state", {}},
    {"compare --methods verlet,learned:nystrom --steps 0.03 --horizon 0.5 --trajectories 23 "
     "--learn-trajectories 7 "
     "--learn-horizon 0.3 --learn-effort quick --metric energy,path",
     {"/rows/0/error", "/rows/1/error", "/fits/0/loss"}},
    {"compare --methods baoab,verlet@symmetric,learned:bab3@end --steps 0.2 --horizon 2 --trajectories "
     "23 "
     "--learn-trajectories 5 --learn-horizon 0.4 --learn-effort quick" +
         bath,
     {"/rows/0/error", "/rows/2/error", "/references/0/error", "/fits/0/loss"}},
    {"compare --methods baoab,verlet@end --steps 0.2,0.3 --horizon 2 --trajectories 37 --metric "
     "distribution" +
         bath,
     {"/rows/0/error", "/rows/0/floor", "/rows/0/kinetic_temperature", "/references/0/mean"}},
    {"compare --methods baoab,verlet@end --steps 0.2,0.3 --horizon 2 --trajectories 37 --metric acf" + bath,
     {"/rows/0/error", "/rows/0/standard_error", "/rows/0/floor"}},
    {"compare --methods verlet,bcss3 --system pendulum --steps 1 --trajectories 40 --horizon 10 --metric "
     "acceptance",
     {"/rows/0/acceptance"}},
    {"sample --system linear_chain --masses 3 --method bcss3 --length 1 --chains 40 --draws 20",
     {"/scalars/0/mean"}}};

nlohmann::ordered_json document_of(const std::string& line) {
  const auto done = run(line + " --json");
  BOOST_TEST((done.code == 0 || done.code == 3), line << ": " << done.err);
  auto document = json_of(done);
  BOOST_TEST_REQUIRE(document.is_object());
  erase_times(document);
  return document;
}

}  // namespace

BOOST_AUTO_TEST_CASE(threads_change_no_byte_and_another_seed_each_number) {
  for (const auto& [line, numbers] : commands) {
    BOOST_TEST_CONTEXT(line) {
      const auto one = document_of(line + " --threads 1");
      BOOST_TEST((document_of(line + " --threads 3") == one));
      const auto other = document_of(line + " --seed 2251799813685247");  // 2^51 - 1 is the largest
      BOOST_TEST((other != one));
      for (const char* at : numbers) BOOST_TEST(one.at(pointer(at)) != other.at(pointer(at)), at);
    }
  }
}

// Along an accurate trajectory the energy stays: it tells from which start the data are.
BOOST_AUTO_TEST_CASE(no_test_starts_where_training_did) {
  using nysalt::program::role;
  const nysalt::fpu_chain<3> chain(50.0);
  const nysalt::fpu_law<3> law(chain);
  const auto energy_from = [&](role which) {
    return nysalt::energy<double>(chain, law(nysalt::program::seed_for(which, 1), 0));
  };
  const auto training = document_of("learn --family nystrom --step 0.02 --trajectories 1")["energy_range"]
                            .get<std::vector<double>>();
  const auto test = document_of("run --method verlet --step 0.02 --horizon 0.02 --observables energy");
  // Both hold exactly: the range has the start in it, and the first sample is the start.
  BOOST_TEST(training[0] <= energy_from(role::training));
  BOOST_TEST(energy_from(role::training) <= training[1]);
  BOOST_TEST(test["rows"][0][3] == energy_from(role::test));
  BOOST_TEST(training[1] - training[0] < 1e-9);
  for (const auto other : {role::held_out, role::test})
    BOOST_TEST((energy_from(other) < training[0] || energy_from(other) > training[1]));
}
