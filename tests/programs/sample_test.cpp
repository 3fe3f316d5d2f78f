// SPDX-License-Identifier: BSL-1.0
// Hybrid Monte Carlo in the program: what it draws, what it tells, what it refuses, and learning from its
// draws.
#include <boost/test/unit_test.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>

#include "../support/bad_input.hpp"
#include "../support/document.hpp"
#include "../support/program.hpp"

using namespace nysalt::test;
using json = nlohmann::ordered_json;

namespace {
const std::string gaussian = "sample --system linear_chain --masses 3 --spring 4 --method bcss3 --length 1 ";
}  // namespace

// Springs k between walls: V = k/2 q.(2 on the diagonal, -1 beside it).q, so that <q_2^2> = kT (1/k).
BOOST_AUTO_TEST_CASE(draws_have_the_law_and_chains_agree) {
  const scratch folder("sample");
  const json found = json_of(run(folder, gaussian + "--draws 2000 --json --output draws.csv"));
  BOOST_TEST(found["converged"] == true);
  BOOST_TEST(std::abs(found["acceptance"].get<double>() - 0.9) < 0.1);
  BOOST_TEST(found["diverged"] == 0);
  const json& scalars = found["scalars"];
  BOOST_TEST_REQUIRE(scalars.size() == 4U);
  const double mean = scalars[0]["mean"];
  // <V> = 3 kT/2, by equipartition; 4 standard errors.
  BOOST_TEST(std::abs(mean - 1.5) <= 4.0 * scalars[0]["standard_error"].get<double>());
  const double deviation = scalars[2]["deviation"];
  BOOST_TEST(std::abs(deviation * deviation - 0.25) < 0.02);
  const std::string draws = contents(folder / "draws.csv");
  BOOST_TEST(draws.starts_with("chain,draw,potential,q1,q2,q3\n0,0,"));
  BOOST_TEST(std::count(draws.begin(), draws.end(), '\n') == 1 + 4 * 2000);
  BOOST_TEST(recorded(folder / "draws.csv").dump().find("sample") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(threads_change_no_byte) {
  const scratch folder("sample_threads");
  const auto of_threads = [&](int threads) {
    const std::string file = fmt::format("{}.csv", threads);
    const auto done =
        run(folder, gaussian + fmt::format("--chains 40 --draws 20 --threads {} --output {}", threads, file));
    BOOST_TEST_REQUIRE(done.code == 0, done.err);
    return contents(folder / file);
  };
  BOOST_TEST(of_threads(1) == of_threads(3));
}

BOOST_AUTO_TEST_CASE(a_displaced_kick_is_learned_from_draws_for_sampling_alone) {
  const scratch folder("sample_learn");
  const std::string lattice = "--system phi4_lattice --side 4 --coupling 4 ";
  const auto drawn =
      run(folder, "sample " + lattice + "--length 0.5 --chains 16 --draws 20 --output draws.csv");
  BOOST_TEST_REQUIRE(drawn.code == 0, drawn.err);
  const std::string learn =
      "learn " + lattice + "--start draws.csv --family fd_chin --step 0.2 --horizon 1 --effort quick ";
  const json fit = json_of(run(folder, learn + "--loss acceptance --json"));
  BOOST_TEST(fit["usable"] == true);
  BOOST_TEST(fit["held_out_loss"].get<double>() < fit["rival_loss"].get<double>());
  all_refused(folder, {{learn, {"must be symplectic except for sampling"}}});
}

// Killed without warning once there is a checkpoint, in the burn-in or after it.
BOOST_AUTO_TEST_CASE(killed_chains_go_on_to_the_same_bytes) {
  const scratch folder("sample_killed");
  const std::string line =
      "sample --system phi4_lattice --side 20 --length 0.5 --burn-in 300 --draws 300 --chains 2 --json ";
  const auto whole = run(folder, line + "--output whole.csv");
  BOOST_TEST_REQUIRE(whole.code == 0, whole.err);
  for (const int trajectories : {50, 350}) {
    const std::string checkpointed = line + "--output cut.csv --checkpoint cut.checkpoint --every 50 ";
    const std::string wait = fmt::format(
        "while kill -0 $pid 2>/dev/null; do n=\"$(head -n 1 cut.checkpoint 2>/dev/null | "
        "sed -n 's/.*\"trajectories\":\\([0-9]*\\).*/\\1/p')\"; [ \"${{n:-0}}\" -ge {} ] && break; sleep "
        ".01; "
        "done\n",
        trajectories);
    const auto killed = shell(folder, "\"$nysalt\" " + checkpointed + " >/dev/null 2>&1 & pid=$!\n" + wait +
                                          "kill -9 $pid && ! wait $pid");
    BOOST_TEST_REQUIRE(killed.code == 0, "it ended before it could be killed: " << killed.err);
    all_refused(folder, {{checkpointed, {"--resume"}},
                         {checkpointed + "--resume --seed 2", {"another run (seed)"}},
                         {checkpointed + "--resume --draws 200", {"draws"}},
                         {"run --method verlet --step 0.1 --horizon 1 --output cut.csv --every 5 --resume "
                          "--checkpoint cut.checkpoint",
                          {"must be a checkpoint of nysalt run, got sample"}}});
    const auto resumed = run(folder, checkpointed + "--resume --threads 2");
    BOOST_TEST_REQUIRE(resumed.code == 0, resumed.err);
    BOOST_TEST((contents(folder / "cut.csv") == contents(folder / "whole.csv")));
    json expected = json_of(whole);
    json found = json_of(resumed);
    for (json* document : {&expected, &found}) document->erase("output");
    BOOST_TEST(found == expected);
    all_refused(folder, {{checkpointed + "--resume", {"there is no such checkpoint"}}});
  }
}

BOOST_AUTO_TEST_CASE(a_damaged_checkpoint_is_refused) {
  const scratch folder("sample_damaged");
  const std::string line =
      "sample --system pendulum --length 1 --draws 100000 --output o\xff.csv --checkpoint c --every 100 ";
  const auto killed =
      shell(folder, "\"$nysalt\" " + line + " >/dev/null 2>&1 & pid=$!\n" +
                        "while [ ! -f c ]; do sleep .01; done; kill -9 $pid; wait $pid; [ -f c ]");
  BOOST_TEST_REQUIRE(killed.code == 0, killed.err);
  std::string text = contents(folder / "c");
  char& of_first_number = text[text.find('\n') + 1];
  of_first_number = static_cast<char>(of_first_number ^ 1);
  std::ofstream(folder / "c", std::ios::binary) << text;
  all_refused(folder, {{line + "--resume", {"not whole, or was edited"}}});
}

// Two predictors and an intercept: the posterior's means against those of the normal law at its top.
BOOST_AUTO_TEST_CASE(a_logistic_regression_is_read_from_a_file) {
  const scratch folder("sample_logistic");
  std::ofstream table(folder / "rows.csv");
  table << "died,age,dose\n";
  for (int i = 0; i < 40; ++i) table << (i % 3 == 0) << ',' << 40 + i % 7 << ',' << 0.5 * (i % 5) << '\n';
  table.close();
  const std::string line =
      "sample --system logistic_regression --data rows.csv --length 0.5 --draws 50 --json ";
  const json first = json_of(run(folder, line + "--label died"));
  BOOST_TEST(first["scalars"].size() == 4U);  // potential, intercept, age, dose
  BOOST_TEST(first["system"].get<std::string>().starts_with("logistic_regression(rows=40, coefficients=3, "));
  // The same data under another name and in another order of columns are not the same system, and a label
  // that is last needs no name.
  std::ofstream other(folder / "other.csv");
  other << "age,dose,died\r\n";
  for (int i = 0; i < 40; ++i) other << 40 + i % 7 << ',' << 0.5 * (i % 5) << ',' << (i % 3 == 0) << "\r\n";
  other.close();
  const json second = json_of(
      run(folder, "sample --system logistic_regression --data other.csv --length 0.5 --draws 50 --json"));
  BOOST_TEST(second == first);
  BOOST_TEST(json_of(run(folder, line + "--label died --standardise 0"))["system"] != first["system"]);
  BOOST_TEST(json_of(run(folder, line + "--label died --variance 2"))["system"] != first["system"]);

  std::ofstream(folder / "text.csv") << "x,y\n1,0\nfoo,1\n";
  std::ofstream(folder / "short.csv") << "x,y\n1,0\n2\n";
  std::ofstream(folder / "label.csv") << "x,y\n1,0\n2,3\n";
  std::ofstream(folder / "flat.csv") << "x,y\n1,0\n1,1\n";
  std::ofstream(folder / "names.csv") << "x,y\n";
  std::ofstream(folder / "one.csv") << "y\n1\n0\n";
  std::ofstream(folder / "empty.csv") << "";
  const std::string data = "sample --system logistic_regression --length 0.5 --data ";
  all_refused(folder, {{data + "missing.csv", {"cannot read --data missing.csv"}},
                       {data + ".", {"cannot read --data ."}},
                       {data + "empty.csv", {"cannot read --data empty.csv", "empty or"}},
                       {data + "text.csv", {"line 3, x", "'foo'"}},
                       {data + "short.csv", {"line 3 must have 2 columns", "got 1"}},
                       {data + "label.csv", {"line 3, y must be 0 or 1", "got 3"}},
                       {data + "flat.csv", {"predictor 1 must vary"}},
                       {data + "names.csv", {"must have a row"}},
                       {data + "one.csv", {"one column"}},
                       {data + "label.csv --label z", {"unknown label 'z'", "x, y"}},
                       {data + "label.csv --variance 0", {"--variance must be positive"}}});
}

BOOST_AUTO_TEST_CASE(what_cannot_be_sampled_is_one_line) {
  const scratch folder("sample_bad");
  std::ofstream(folder / "positions.csv") << "q1\n0.5\nx\n";
  std::ofstream(folder / "far.csv") << "q1,q2\n1e200,1e200\n";
  std::ofstream(folder / "one_way.json")
      << R"({"format": "nysalt table", "version": 1, "name": "one_way", "letters": "AB", "coefficients": [1, 1]})";
  all_refused(
      folder,
      after(
          "sample",
          {
              {"--system pendulum", {"--length"}},
              {"--system pendulum --length 1 --method aba3_free", {"unknown method"}},
              {"--system pendulum --length 1 --method learned:fg4", {"must be learned first"}},
              {"--system pendulum --length 1 --method one_way.json", {"must be reversible"}},
              {"--system pendulum --length 1 --resume", {"--resume must come with --checkpoint"}},
              {"--system pendulum --length 1 --every 5", {"--every must come with --checkpoint"}},
              {"--system pendulum --length 1 --checkpoint c", {"--checkpoint must come with --every"}},
              {"--system pendulum --length 1 --checkpoint c --every 0", {"--every must be"}},
              {"--system pendulum --length 1 --checkpoint c --every 5 --output c", {"name of another file"}},
              {"--system pendulum --length 1 --checkpoint c --every 5 --resume",
               {"there is no such checkpoint"}},
              {"--system pendulum --length 0", {"--length must be"}},
              {"--system pendulum --length 1 --step 1e-300", {"length must be at most", "larger step"}},
              {"--system henon_heiles --length 1 --start far.csv", {"must be finite at a start"}},
              {"--system pendulum --length 1 --chains 0", {"--chains must be"}},
              {"--system pendulum --length 1 --acceptance 1.2", {"acceptance must be between 0 and 1"}},
              {"--system pendulum --length 1 --friction 1 --temperature 1", {"must have no bath"}},
              {"--system pendulum --length 1 --step 0.1 --acceptance 0.9 --burn-in 3",
               {"burn_in must be at least 100"}},
              {"--system pendulum --length 1 --draws 100000000", {"must fit into memory"}},
              {"--system pendulum --length 1 --start positions.csv", {"line 3"}},
              {"--system henon_heiles --length 1 --start positions.csv", {"q1 to q2, got no q2"}},
              {"--system pendulum --length 1 --start missing.csv", {"cannot read --start missing.csv"}},
              {"--system pendulum --length 1 --start positions.csv --spread 2", {"--spread"}},
          }));
}
